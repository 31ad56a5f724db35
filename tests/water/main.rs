//! Water that comes and goes while a world runs: nothing is lost, and the bits are the same however it runs.

#[path = "../common/mod.rs"]
mod common;
mod flows;
mod matrix;
mod pours;
mod refused;
mod sleeping;

use sorb::{
    Command, Region, World,
    glam::{UVec3, Vec3},
    scene::{Body, Fluid, FluidBlock, FluidSolver, Scene, ShapeKind, Sponge},
};

const LOW: Vec3 = Vec3::new(-0.05, 0.0, -0.05);
const HIGH: Vec3 = Vec3::new(0.05, 0.15, 0.05);

/// A cup with that much water \[m\], or none.
fn cup(depth: f32, solver: FluidSolver) -> Scene {
    let mut fluid = Fluid { solver: Some(solver), sound_speed: Some(15.0), ..Fluid::default() };
    if depth > 0.0 {
        fluid.blocks.push(FluidBlock::new(LOW, Vec3::new(HIGH.x, depth, HIGH.z)));
    }
    Scene::new("cup").in_box(LOW, HIGH).with_fluid(fluid)
}

/// The same with a sponge and a ball.
fn busy_cup(depth: f32, solver: FluidSolver) -> Scene {
    let sponge = Sponge { cells: UVec3::splat(4), ..Sponge::new("sponge", Vec3::new(-0.045, 0.0, -0.045)) };
    let ball = Body::dynamic("ball", ShapeKind::Sphere { radius: 0.012 }, Vec3::new(0.03, 0.05, 0.03), 600.0);
    cup(depth, solver).with_sponge(sponge).with_body(ball)
}

fn push(world: &mut World, command: Command) {
    world.push(command).unwrap_or_else(|error| panic!("{error}"));
}

fn cuboid(low: [f32; 3], high: [f32; 3]) -> Region {
    Region::Box { minimum: low.into(), maximum: high.into() }
}

fn pour(region: Region) -> Command {
    Command::Pour { region, velocity: Vec3::new(0.0, -0.5, 0.0) }
}

/// The books balance to the particle, and every particle is a number inside of the container.
#[track_caller]
fn audit(world: &World) {
    let ledger = world.ledger();
    assert_eq!(ledger.lost, 0);
    assert_eq!(ledger.present, ledger.seeded + ledger.poured - ledger.removed - ledger.drained);
    assert_eq!(world.particle_positions().len() as u64, ledger.present);
    assert_eq!(world.particle_count() as u64, ledger.present);
    let mut ids = world.particle_ids().to_vec();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len() as u64, ledger.present, "every identity once");
    assert!(ids.last().is_none_or(|last| u64::from(*last) < ledger.seeded + ledger.poured));
    for ([x, y, z, _], velocity) in world.particle_positions().iter().zip(world.particle_velocities()) {
        let point = Vec3::new(*x, *y, *z);
        assert!(point.cmpge(LOW - 1e-3).all() && point.cmple(HIGH + 1e-3).all(), "{point}");
        assert!(Vec3::new(velocity[0], velocity[1], velocity[2]).length() < 20.0, "{velocity:?}");
    }
}
