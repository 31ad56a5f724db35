//! What a host steers while a world runs: bodies and sponges that come, go or are put elsewhere, materials; and the same bits after
//! interruptions.

mod bodies;
#[path = "../common/mod.rs"]
mod common;
mod materials;
mod matrix;
mod places;
mod random;
mod sponges;

use sorb::{
    Command, World,
    glam::{UVec3, Vec3},
    scene::{Body, Fluid, FluidBlock, Scene, ShapeKind, Sponge},
};

const LOW: Vec3 = Vec3::new(-0.06, 0.0, -0.06);
const HIGH: Vec3 = Vec3::new(0.06, 0.16, 0.06);

fn push(world: &mut World, command: Command) {
    world.push(command).unwrap_or_else(|error| panic!("{error}"));
}

/// The text of what is refused; empty if it is not.
fn refused(world: &mut World, command: Command) -> String {
    world.push(command).err().map(|error| error.to_string()).unwrap_or_default()
}

fn sponge(name: &str, position: Vec3) -> Sponge {
    Sponge { cells: UVec3::splat(3), ..Sponge::new(name, position) }
}

/// A pool with a wet and a dry sponge, and a ball above it.
fn pool() -> Scene {
    let fluid = Fluid {
        blocks: vec![FluidBlock::new(LOW, HIGH.with_y(0.02))],
        sound_speed: Some(20.0),
        ..Fluid::default()
    };
    let wet = Sponge { saturation: 1.0, ..sponge("wet", Vec3::new(-0.05, 0.03, -0.05)) };
    let dry = sponge("dry", Vec3::new(0.01, 0.03, 0.01));
    let ball = Body::dynamic("ball", ShapeKind::Sphere { radius: 0.012 }, Vec3::new(0.03, 0.1, -0.03), 700.0);
    Scene::new("pool").in_box(LOW, HIGH).with_fluid(fluid).with_sponge(wet).with_sponge(dry).with_body(ball)
}

/// Everything is finite, in the container, and accounted for.
fn audit(world: &World) {
    let ledger = world.ledger();
    let mut ids = world.particle_ids().to_vec();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!((ledger.lost, ids.len() as u64), (0, ledger.present), "{ledger:?}");
    // What a body holds goes where that takes it.
    let is_free = |row: &&[f32; 4]| row[3] > 0.0;
    for (row, slack) in (world.particle_positions().iter().map(|row| (row, 0.0)))
        .chain(world.node_positions().iter().filter(is_free).map(|row| (row, 2e-3)))
    {
        let point = Vec3::new(row[0], row[1], row[2]);
        let is_in = point.cmpge(LOW - slack).all() && point.cmple(HIGH + slack).all();
        assert!(is_in, "{point} at {} s", world.clock().time);
    }
    let fastest = |rows: &[[f32; 4]]| {
        rows.iter().map(|row| Vec3::new(row[0], row[1], row[2]).length()).fold(0.0, f32::max)
    };
    let fastest = [world.particle_velocities(), world.node_velocities()].map(fastest);
    let is_slow = fastest.iter().all(|speed| *speed < 20.0);
    assert!(is_slow, "particles and nodes at {fastest:?} m/s, {} s", world.clock().time);
}
