//! Scenes that try to break the defaults: whatever they are asked, the state stays finite and inside, and no water is lost.
//!
//! `SORB_STRESS=1 cargo test -p sorb-validation --test stress` runs the long form.

use sorb::{
    World,
    glam::{UVec3, Vec3},
    scene::{Body, Domain, Fluid, FluidBlock, Motion, Scene, ShapeKind, Sponge},
};
use sorb_validation::{SolverKind, Solvers};

/// Half of the width of the box \[m\].
const BOX: f32 = 0.06;

fn long() -> bool {
    std::env::var_os("SORB_STRESS").is_some()
}

/// One of two values: the second in the long form.
fn pick<T>(short: T, long_form: T) -> T {
    if long() { long_form } else { short }
}

/// A box with a pool, a wet sponge on its floor and nothing else.
fn wet() -> Scene {
    let corner = Vec3::new(-BOX, 0.0, -BOX);
    let fluid = Fluid {
        spacing: 0.006,
        blocks: vec![FluidBlock::new(corner, Vec3::new(BOX, 0.012, BOX))],
        ..Fluid::default()
    };
    Scene { ..dry() }.with_fluid(fluid)
}

fn dry() -> Scene {
    let corner = Vec3::new(-BOX, 0.0, -BOX);
    Scene::new("stress").in_box(corner, Vec3::new(BOX, 0.12, BOX)).with_sponge(Sponge {
        edge: 0.012,
        cells: UVec3::splat(4),
        saturation: 0.5,
        ..Sponge::new("sponge", Vec3::new(-0.024, 0.0, -0.024))
    })
}

/// Runs for some time and looks after every frame.
fn survives(scene: &Scene, seconds: f64) -> World {
    ran(scene, seconds).unwrap_or_else(|error| panic!("{error}"))
}

/// The same, or what went wrong.
fn ran(scene: &Scene, seconds: f64) -> Result<World, String> {
    let scene = &Scene { sponges: without_water(scene), ..scene.clone() };
    let mut world = World::new(scene).map_err(|error| error.to_string())?;
    let particles = world.particle_ids().len();
    let mass = world.measures().water_mass;
    while world.clock().time < seconds {
        world.advance_frame().map_err(|error| error.to_string())?;
        if let Some(what) = unhealthy(&world, particles) {
            return Err(format!("at {} s: {what}", world.clock().time));
        }
    }
    assert_eq!(world.measures().water_mass.to_bits(), mass.to_bits());
    Ok(world)
}

/// The sponges, dry where there is no water in the scene.
fn without_water(scene: &Scene) -> Vec<Sponge> {
    let dry = |sponge: &Sponge| match scene.fluid {
        Some(_) => sponge.clone(),
        None => Sponge { saturation: 0.0, ..sponge.clone() },
    };
    scene.sponges.iter().map(dry).collect()
}

/// The first thing that is wrong with a state.
fn unhealthy(world: &World, particles: usize) -> Option<String> {
    let mut ids = world.particle_ids().to_vec();
    ids.sort_unstable();
    if ids.len() != particles || ids.iter().enumerate().any(|(index, id)| *id as usize != index) {
        return Some("particles are lost".to_owned());
    }
    let Domain::Box { minimum, maximum } = world.scene().domain else { return None };
    let slack = Vec3::splat(1e-3);
    let bad = |row: &&[f32; 4], slack: Vec3| {
        let point = Vec3::new(row[0], row[1], row[2]);
        !point.is_finite() || point.cmplt(minimum - slack).any() || point.cmpgt(maximum + slack).any()
    };
    let particle = world.particle_positions().iter().find(|row| bad(row, Vec3::ZERO));
    let node = world.node_positions().iter().find(|row| bad(row, slack));
    particle.or(node).map(|row| format!("outside or not finite: {row:?}"))
}

/// Volume of the sponges over that at rest.
fn volume(world: &World) -> f64 {
    world.measures().sponge_volume / world.lattice().rest_volume(0).unwrap_or(f64::NAN)
}

/// Time after which the volume is back to 95 % for good \[s\].
fn recovery(scene: &Scene, released: f64, seconds: f64) -> f64 {
    let mut world = survives(scene, released);
    let mut recovered = f64::INFINITY;
    while world.clock().time < released + seconds {
        world.advance_frame().unwrap_or_else(|error| panic!("{error}"));
        recovered = match volume(&world) {
            ratio if ratio < 0.95 => f64::INFINITY,
            _ => recovered.min(world.clock().time - released),
        };
    }
    recovered
}

/// Plates that close from both sides of some axes to a gap, stay, and open again.
fn crushed(mut scene: Scene, axes: &[usize], gap: f32) -> Scene {
    let sponge = &scene.sponges[0];
    let centre = sponge.position + 0.5 * sponge.size();
    let (half, thick) = (0.5 * sponge.size(), 0.004);
    let mut plates = Vec::new();
    for axis in axes {
        for (name, sign) in [("low", -1.0_f32), ("high", 1.0)] {
            let mut unit = Vec3::ZERO;
            unit[*axis] = sign;
            let mut half_extents = Vec3::splat(0.03);
            half_extents[*axis] = thick;
            // Plates of several axes pass each other: each is as wide as the sponge.
            let way = half[*axis] - 0.5 * gap;
            let motion = |velocity: Vec3, start: f32| Motion::Linear { velocity, start, end: start + 0.2 };
            let closes = motion(-unit * (way / 0.2), 0.0);
            let opens = motion(unit * (way / 0.2), 0.3);
            let position = centre + unit * (half[*axis] + thick);
            let shape = ShapeKind::Cuboid { half_extents };
            plates.push(Body::kinematic(&format!("{name}{axis}"), shape, position, vec![closes, opens]));
        }
    }
    scene.bodies = plates;
    scene
}

#[test]
fn steps_that_are_ten_and_a_hundred_times_too_long() {
    for factor in [10.0, 100.0] {
        for mut scene in [wet(), dry()] {
            scene.time.maximum_step = (0.002_f32 * factor).min(0.1);
            scene.time.courant = 1.0;
            survives(&scene, pick(0.3, 3.0));
        }
    }
}

#[test]
fn stiffness_over_six_decades() {
    for exponent in pick(vec![1, 4, 7], (1..=7).collect()) {
        let modulus = 10.0_f32.powi(exponent);
        let mut scene = dry();
        let sponge = &mut scene.sponges[0];
        (sponge.stretch_modulus, sponge.shear_modulus) = (modulus.max(10.0), (0.5 * modulus).max(10.0));
        sponge.volume_modulus = modulus.max(10.0);
        let ball = ShapeKind::Sphere { radius: 0.015 };
        scene = scene.with_body(Body::dynamic("ball", ball, Vec3::Y * 0.08, 500.0));
        // Stiff sponges take short steps.
        survives(&scene, pick(if exponent > 5 { 0.05 } else { 0.4 }, 2.0));
    }
}

#[test]
fn crushed_flat_and_to_a_point_and_let_go() {
    for (axes, gap) in [(&[1][..], 0.004), (&[0, 1, 2], 0.012)] {
        let mut scene = crushed(dry(), axes, gap);
        // Away from the floor, so that a plate fits below.
        scene.sponges[0].position.y = 0.036;
        let scene = crushed(scene, axes, gap);
        let time = recovery(&scene, 0.5, pick(1.0, 4.0));
        assert!(time < 1.0, "{axes:?}: back to 95 % of its volume after {time} s");
    }
}

#[test]
fn crushed_wet() {
    for name in SolverKind::Water.names() {
        let solvers = Solvers { water: Some(name.clone()), ..Solvers::default() };
        let scene = solvers.applied(&crushed(wet(), &[1], 0.01)).unwrap();
        let result = ran(&scene, pick(0.5, 4.0)).err();
        assert!(result.is_none(), "{name}: {result:?}");
    }
}

#[test]
fn turned_inside_out_and_back() {
    // The right end is moved through the left one, which inverts every tet between them, and back.
    let mut scene = dry();
    scene.gravity = Vec3::ZERO;
    scene.sponges[0].position.y = 0.03;
    let grip = |name: &str, x: f32, motions: Vec<Motion>| {
        let shape = ShapeKind::Cuboid { half_extents: Vec3::new(0.002, 0.03, 0.03) };
        let place = Vec3::new(x, 0.054, 0.0);
        let body = if motions.is_empty() {
            Body::fixed(name, shape, place)
        } else {
            Body::kinematic(name, shape, place, motions)
        };
        Body { grip: true, ..body }
    };
    let there = Motion::Linear { velocity: Vec3::X * -0.3, start: 0.0, end: 0.2 };
    let back = Motion::Linear { velocity: Vec3::X * 0.3, start: 0.3, end: 0.5 };
    scene =
        scene.with_body(grip("left", -0.024, Vec::new())).with_body(grip("right", 0.024, vec![there, back]));
    let time = recovery(&scene, 0.5, pick(1.0, 4.0));
    assert!(time < 1.0, "back to 95 % of its volume after {time} s");
}

#[test]
fn a_body_at_a_hundred_metres_a_second() {
    for mut scene in [wet(), dry()] {
        let ball = Body {
            linear_velocity: Vec3::Y * -100.0,
            ..Body::dynamic("ball", ShapeKind::Sphere { radius: 0.015 }, Vec3::Y * 0.09, 2000.0)
        };
        scene = scene.with_body(ball);
        scene.time.minimum_step = 1e-8;
        survives(&scene, pick(0.1, 1.0));
    }
}

#[test]
fn water_at_a_hundred_metres_a_second() {
    let mut scene = wet();
    if let Some(fluid) = &mut scene.fluid {
        fluid.blocks.push(FluidBlock {
            velocity: Vec3::Y * -100.0,
            ..FluidBlock::new(Vec3::new(-0.03, 0.08, -0.03), Vec3::new(0.03, 0.11, 0.03))
        });
    }
    scene.time.minimum_step = 1e-8;
    survives(&scene, pick(0.05, 1.0));
}

#[test]
fn the_look_after_every_frame_sees_what_is_outside() {
    // The control: a sponge whose box is moved away from under it.
    let mut world = World::new(&Scene { sponges: without_water(&dry()), ..dry() }).unwrap();
    assert_eq!(unhealthy(&world, 0), None);
    let away = Scene { domain: Domain::Open, ..world.scene().clone() };
    world = World::new(&Scene { sponges: without_water(&away), ..away }).unwrap();
    assert!(unhealthy(&world, 1).is_some());
}
