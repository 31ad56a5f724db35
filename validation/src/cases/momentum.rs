//! Water, sponge and a ball collide without external forces.

use sorb::{
    World,
    glam::{DVec3, UVec3, Vec3},
    scene::{Body, Fluid, FluidBlock, Scene, ShapeKind, Sponge},
};

use crate::case::{Case, Failure, Figure, Setting, Subject};

/// Conservation of momentum.
pub(super) static CASE: Case = Case {
    name: "momentum",
    title: "a jet hits a sponge and a ball hits both, without external forces",
    source: "conservation of momentum",
    subject: Subject::Coupling,
    control: "gravity of 0.1 m/s^2",
    run,
};

/// Arm of the angular momentum \[m\]: half of the sponge.
const ARM: f64 = 0.03;

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let mut world = setting.world(&scene(setting))?;
    // The first step sets the forces of the state.
    world.step()?;
    let first = world.measures();
    let (mut linear, mut angular, mut exchanged) = (0.0_f64, 0.0_f64, 0.0);
    let mut water = water_momentum(&world);
    for _ in 0..setting.pick(1000, 300) {
        world.step()?;
        let (now, measures) = (water_momentum(&world), world.measures());
        exchanged += (now - water).length();
        water = now;
        linear = linear.max((measures.linear_momentum - first.linear_momentum).length());
        angular = angular.max((measures.angular_momentum - first.angular_momentum).length());
    }
    if exchanged == 0.0 {
        return Err(Failure::Nothing("nothing is exchanged".to_owned()));
    }
    let lost = (world.measures().water_mass - first.water_mass).abs();
    Ok(vec![
        Figure::error("linear momentum, drift over what is exchanged", "1", linear / exchanged, 1e-5),
        Figure::error("angular momentum, the same with an arm of 3 cm", "1", angular / exchanged / ARM, 1e-5),
        Figure::error("mass of the water, change", "kg", lost, 0.0),
    ])
}

fn water_momentum(world: &World) -> DVec3 {
    let mass = f64::from(world.particle_mass());
    let velocity = |row: &[f32; 4]| Vec3::new(row[0], row[1], row[2]).as_dvec3();
    world.particle_velocities().iter().map(velocity).sum::<DVec3>() * mass
}

fn scene(setting: &Setting) -> Scene {
    let cells = setting.count(6);
    let edge = 0.06 / cells as f32;
    let fluid = Fluid {
        spacing: 0.5 * edge,
        blocks: vec![FluidBlock {
            velocity: Vec3::new(0.0, -0.5, 0.1),
            ..FluidBlock::new(Vec3::new(-0.02, 0.035, -0.02), Vec3::new(0.02, 0.065, 0.02))
        }],
        ..Fluid::default()
    };
    let sponge = Sponge {
        edge,
        cells: UVec3::splat(cells),
        saturation: 0.5,
        ..Sponge::new("sponge", Vec3::splat(-0.03))
    };
    let ball = Body {
        linear_velocity: Vec3::new(0.0, 0.6, 0.0),
        angular_velocity: Vec3::new(0.0, 5.0, 0.0),
        ..Body::dynamic("ball", ShapeKind::Sphere { radius: 0.015 }, Vec3::new(0.01, -0.05, 0.005), 2500.0)
    };
    let gravity = Vec3::new(0.0, setting.planted(0.0, -0.1), 0.0);
    Scene { gravity, ..Scene::new("free") }.with_fluid(fluid).with_sponge(sponge).with_body(ball)
}
