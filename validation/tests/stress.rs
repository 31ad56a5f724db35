//! A scene that tries to break every solver of the water: the state stays finite and inside, and no water is lost.
//! `tests/stress` of the library tests the defaults.
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

/// Runs for some time and checks every frame; the first fault, if any.
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

/// The first fault of a state.
fn unhealthy(world: &World, particles: usize) -> Option<String> {
    let mut ids = world.particle_ids().to_vec();
    ids.sort_unstable();
    if ids.len() != particles || ids.iter().enumerate().any(|(index, id)| *id as usize != index) {
        return Some("particles are lost".to_owned());
    }
    let Domain::Box { minimum, maximum, .. } = world.scene().domain else { return None };
    let slack = Vec3::splat(1e-3);
    let bad = |row: &&[f32; 4], slack: Vec3| {
        let point = Vec3::new(row[0], row[1], row[2]);
        !point.is_finite() || point.cmplt(minimum - slack).any() || point.cmpgt(maximum + slack).any()
    };
    let particle = world.particle_positions().iter().find(|row| bad(row, Vec3::ZERO));
    let node = world.node_positions().iter().find(|row| bad(row, slack));
    particle.or(node).map(|row| format!("outside or not finite: {row:?}"))
}

/// Plates that close from both sides of some axes to a gap, stay, and open again.
fn crushed(mut scene: Scene, axes: &[usize], gap: f32) -> Scene {
    let sponge = &scene.sponges[0];
    let centre = sponge.position + 0.5 * sponge.size();
    let (half, thickness) = (0.5 * sponge.size(), 0.004);
    let mut plates = Vec::new();
    for axis in axes {
        for (name, sign) in [("low", -1.0_f32), ("high", 1.0)] {
            let mut unit = Vec3::ZERO;
            unit[*axis] = sign;
            let mut half_extents = Vec3::splat(0.03);
            half_extents[*axis] = thickness;
            // Plates of several axes pass each other: each is as wide as the sponge.
            let way = half[*axis] - 0.5 * gap;
            let motion =
                |velocity: Vec3, start: f32| Motion::Linear { velocity, start, end: start + 0.2, ease: 0.0 };
            let closes = motion(-unit * (way / 0.2), 0.0);
            let opens = motion(unit * (way / 0.2), 0.3);
            let position = centre + unit * (half[*axis] + thickness);
            let shape = ShapeKind::Cuboid { half_extents };
            plates.push(Body::kinematic(&format!("{name}{axis}"), shape, position, vec![closes, opens]));
        }
    }
    scene.bodies = plates;
    scene
}

#[test]
fn crushed_wet() {
    // `divergence` refuses sponges.
    for name in SolverKind::Water.names().into_iter().filter(|name| name != "divergence") {
        let solvers = Solvers { water: Some(name.clone()), ..Solvers::default() };
        let scene = solvers.applied(&crushed(wet(), &[1], 0.01)).unwrap();
        let result = ran(&scene, pick(0.5, 4.0)).err();
        assert!(result.is_none(), "{name}: {result:?}");
    }
}

#[test]
fn the_look_after_every_frame_sees_what_is_outside() {
    // Negative control: a sponge whose box is moved away from below it.
    let mut world = World::new(&Scene { sponges: without_water(&dry()), ..dry() }).unwrap();
    assert_eq!(unhealthy(&world, 0), None);
    let away = Scene { domain: Domain::Open, ..world.scene().clone() };
    world = World::new(&Scene { sponges: without_water(&away), ..away }).unwrap();
    assert!(unhealthy(&world, 1).is_some());
}
