//! Scenes of which parts come to rest while others move.

use sorb::{
    World,
    glam::Vec3,
    scene::{Body, Fluid, FluidBlock, FluidSolver, Motion, Scene, ShapeKind, Sponge},
};

/// Time at which a plate slides away below what stands on it \[s\].
pub(crate) const START: f64 = 2.0;

/// A pool behind a dam, with a speed; the other half of the box is dry. The step is short enough for all of it.
pub(crate) fn basin(speed: f32) -> Scene {
    let (low, high) = (Vec3::new(-0.12, 0.0, -0.02), Vec3::new(-0.04, 0.03, 0.02));
    let pool = FluidBlock { velocity: Vec3::X * speed, ..FluidBlock::new(low, high) };
    // The default solver goes on moving by some millimetres a second.
    let solver = Some(FluidSolver::Dfsph);
    let fluid = Fluid { spacing: 0.005, blocks: vec![pool], solver, ..Fluid::default() };
    let dam = ShapeKind::Cuboid { half_extents: Vec3::new(0.02, 0.1, 0.03) };
    let mut scene = Scene::new("basin")
        .in_box(low, Vec3::new(0.2, 0.25, 0.02))
        .with_fluid(fluid)
        .with_body(Body::fixed("dam", dam, Vec3::new(-0.02, 0.1, 0.0)));
    scene.time.maximum_step = 0.0025;
    scene
}

pub(crate) fn cube(name: &str, place: Vec3) -> Sponge {
    Sponge { cells: [3, 3, 3].into(), edge: 0.01, young_modulus: 3e3, ..Sponge::new(name, place) }
}

/// A sponge on the floor, and one that is thrown up beside it, far from the water and from each other.
pub(crate) fn one_lies_one_flies() -> Scene {
    let mut thrown = cube("thrown", Vec3::new(0.04, 0.05, -0.015));
    thrown.velocity = Vec3::new(0.0, 1.5, 0.0);
    basin(0.3).with_sponge(cube("cube", Vec3::new(0.13, 0.0, -0.015))).with_sponge(thrown)
}

/// A plate that slides away along z at [`START`].
pub(crate) fn plate(place: Vec3, half: Vec3) -> Body {
    let start = START as f32;
    let slide = Motion::Linear { velocity: Vec3::Z * 0.8, start, end: start + 0.2, ease: 0.0 };
    Body {
        friction: 0.0,
        ..Body::kinematic("plate", ShapeKind::Cuboid { half_extents: half }, place, vec![slide])
    }
}

pub(crate) fn vector(row: &[f32; 4]) -> Vec3 {
    Vec3::new(row[0], row[1], row[2])
}

/// Positions and velocities of the nodes of a sponge.
pub(crate) fn nodes(world: &World, sponge: u32) -> Vec<([f32; 4], [f32; 4])> {
    let rows = world.node_positions().iter().zip(world.node_velocities());
    let own = rows.zip(&world.lattice().node_sponge).filter(|(_, own)| **own == sponge);
    own.map(|((position, velocity), _)| (*position, *velocity)).collect()
}

pub(crate) fn fastest(world: &World) -> f32 {
    world.node_velocities().iter().map(|row| vector(row).length()).fold(0.0, f32::max)
}

/// Smallest distance of a node from a body, negative inside.
pub(crate) fn distance(world: &World, body: usize) -> f32 {
    let body = &world.bodies()[body];
    world.node_positions().iter().map(|row| body.distance(vector(row))).fold(f32::INFINITY, f32::min)
}

/// A ball on a plate over a sponge.
pub(crate) fn over_a_sponge() -> Scene {
    let ball = ShapeKind::Sphere { radius: 0.012 };
    let mut scene = Scene::new("over_a_sponge")
        .in_box(Vec3::new(-0.05, 0.0, -0.05), Vec3::new(0.05, 0.3, 0.3))
        .with_sponge(cube("cube", Vec3::new(-0.015, 0.0, -0.015)))
        .with_body(plate(Vec3::new(0.0, 0.15, 0.0), Vec3::new(0.02, 0.005, 0.02)))
        .with_body(Body { friction: 0.0, ..Body::dynamic("ball", ball, Vec3::new(0.0, 0.1671, 0.0), 300.0) });
    // How deep the ball goes depends on the step by up to 2 mm, and while the sponge sleeps nothing bounds it.
    scene.time.maximum_step = 0.0005;
    scene
}

/// Places of the particles, by identity.
pub(crate) fn positions(world: &World) -> Vec<Vec3> {
    let mut places = vec![Vec3::ZERO; world.particle_ids().len()];
    for (id, x) in world.particle_ids().iter().zip(world.particle_positions()) {
        places[*id as usize] = Vec3::new(x[0], x[1], x[2]);
    }
    places
}
