//! Water that comes and goes on a device: the books balance, the same bits however the buffers were made, and the CPU agrees.

use std::sync::Arc;

use sorb::{
    Command, Offload, Options, Region, Snapshot, World,
    glam::{UVec3, Vec3},
    internal,
    scene::{Body, Drain, Emitter, Fluid, FluidBlock, FluidSolver, Scene, ShapeKind, Sponge},
};

use super::{common, difference, gpu};

const LOW: Vec3 = Vec3::new(-0.05, 0.0, -0.05);
const HIGH: Vec3 = Vec3::new(0.05, 0.15, 0.05);

fn scene(solver: FluidSolver, depth: f32) -> Scene {
    let mut fluid =
        Fluid { spacing: 0.007, solver: Some(solver), sound_speed: Some(15.0), ..Fluid::default() };
    if depth > 0.0 {
        fluid.blocks.push(FluidBlock::new(LOW, Vec3::new(HIGH.x, depth, HIGH.z)));
    }
    let sponge = Sponge { cells: UVec3::splat(4), ..Sponge::new("sponge", Vec3::new(-0.045, 0.0, -0.045)) };
    let ball = Body::dynamic("ball", ShapeKind::Sphere { radius: 0.012 }, Vec3::new(0.03, 0.05, 0.03), 600.0);
    Scene::new("cup").in_box(LOW, HIGH).with_fluid(fluid).with_sponge(sponge).with_body(ball)
}

fn options() -> Options {
    Options { offload: Offload::Gpu, gpu: Some(Arc::clone(&gpu())), ..Options::default() }
}

fn world(scene: &Scene) -> World {
    World::with_options(scene, &options()).unwrap_or_else(|error| panic!("{error}"))
}

/// What the host does before a frame.
fn commands(frame: u32) -> Option<Command> {
    let velocity = Vec3::new(0.1, -0.3, 0.0);
    let ball = |x: f32, radius: f32| Region::Sphere { centre: Vec3::new(x, 0.11, -0.01), radius };
    match frame {
        1 => Some(Command::Pour { region: ball(-0.02, 0.012), velocity }),
        2 => Some(Command::Pour { region: ball(0.02, 0.025), velocity }),
        4 => Some(Command::Remove {
            region: Region::Box { minimum: Vec3::splat(-0.06), maximum: Vec3::ZERO.with_y(0.2) },
        }),
        5 => Some(Command::Gravity { gravity: Vec3::new(0.5, -9.0, 0.0) }),
        6 => Some(Command::Pour { region: ball(-0.01, 0.015), velocity }),
        _ => None,
    }
}

const FRAMES: u32 = 8;

fn advance(world: &mut World, frame: u32) {
    if let Some(command) = commands(frame) {
        world.push(command).unwrap_or_else(|error| panic!("frame {frame}: {error}"));
    }
    common::frame(world);
}

fn audit(world: &World) {
    let ledger = world.ledger();
    let mut ids = world.particle_ids().to_vec();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!((ledger.lost, ids.len() as u64), (0, ledger.present));
    for [x, y, z, _] in world.particle_positions() {
        let point = Vec3::new(*x, *y, *z);
        assert!(point.cmpge(LOW - 1e-3).all() && point.cmple(HIGH + 1e-3).all(), "{point}");
    }
}

/// The digest of a device with buffers that are kept, made anew before every frame, and kept over roll backs.
fn one_digest(solver: FluidSolver) {
    let scene = scene(solver, 0.02);
    let mut kept = world(&scene);
    let (mut anew, mut rolled) = (kept.clone(), kept.clone());
    let mut snapshot = Snapshot::new();
    for frame in 0..FRAMES {
        advance(&mut kept, frame);
        audit(&kept);
        // A restored world has buffers of its own.
        let mut bytes = Vec::new();
        anew.save(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
        anew = World::restore(&bytes[..], &options()).unwrap_or_else(|error| panic!("{error}"));
        advance(&mut anew, frame);
        rolled.snapshot_into(&mut snapshot);
        rolled.push(commands(1).unwrap_or_else(|| panic!("a pour"))).ok();
        common::frame(&mut rolled);
        rolled.rollback(&snapshot).unwrap_or_else(|error| panic!("{error}"));
        advance(&mut rolled, frame);
        assert_eq!(kept.digest(), anew.digest(), "frame {frame}");
        assert_eq!(kept.digest(), rolled.digest(), "frame {frame}");
    }
    // Negative control: other water.
    let mut without = world(&scene);
    (0..FRAMES).for_each(|_| common::frame(&mut without));
    assert_ne!(kept.digest(), without.digest());
}

#[test]
fn one_digest_with_the_solve_for_the_divergence() {
    one_digest(FluidSolver::Divergence);
}

#[test]
fn one_digest_with_the_solve_for_the_density() {
    one_digest(FluidSolver::Dfsph);
}

/// A device and the CPU by turns, with kept buffers and new ones.
#[test]
fn one_digest_by_turns() {
    let scene = scene(FluidSolver::Dfsph, 0.02);
    let by_turns = || Options { offload: Offload::From("sph::forces"), ..options() };
    let build = || World::with_options(&scene, &by_turns()).unwrap_or_else(|error| panic!("{error}"));
    let (mut kept, mut anew) = (build(), build());
    for frame in 0..4 {
        advance(&mut kept, frame);
        audit(&kept);
        let mut bytes = Vec::new();
        anew.save(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
        anew = World::restore(&bytes[..], &by_turns()).unwrap_or_else(|error| panic!("{error}"));
        advance(&mut anew, frame);
        assert_eq!(kept.digest(), anew.digest(), "frame {frame}");
    }
    assert!(kept.ledger().poured > 0);
}

#[test]
fn the_cpu_pours_and_removes_the_same() {
    for solver in [FluidSolver::Divergence, FluidSolver::Wcsph] {
        let scene = scene(solver, 0.0);
        let mut on_gpu = world(&scene);
        let mut on_cpu = common::world(&scene);
        for frame in 0..FRAMES {
            advance(&mut on_gpu, frame);
            advance(&mut on_cpu, frame);
            audit(&on_gpu);
            let (own, other) = (on_gpu.ledger(), on_cpu.ledger());
            if frame < 4 {
                assert_eq!((own.poured, own.left_out), (other.poured, other.left_out), "{solver:?}: {frame}");
                let (far, what) = difference(&on_gpu.measures(), &on_cpu.measures());
                assert!(far < 0.02, "{solver:?}: frame {frame}: {what} differs by {far}");
            }
        }
    }
}

#[test]
fn buffers_that_suffice_stay() {
    let mut world = world(&scene(FluidSolver::Dfsph, 0.05));
    let memory = |world: &World| internal::resident(world).map_or(0, |resident| resident.memory());
    common::frame(&mut world);
    let before = memory(&world);
    for frame in 0..6 {
        let centre = Vec3::new(-0.02, 0.1, -0.02 + 0.004 * frame as f32);
        let region = Region::Sphere { centre, radius: 0.01 };
        world.push(Command::Pour { region, velocity: Vec3::NEG_Y }).unwrap_or_else(|error| panic!("{error}"));
        common::frame(&mut world);
        world
            .push(Command::Remove { region: Region::Box { minimum: LOW - 1.0, maximum: HIGH.with_y(0.004) } })
            .ok();
        common::frame(&mut world);
    }
    let after = memory(&world);
    assert!(after >= before && after < 2 * before, "{before} and {after} bytes");
    audit(&world);
}

#[test]
fn emitters_and_drains_flow_on_a_device() {
    let emitter = Emitter {
        position: Vec3::new(0.01, 0.12, 0.01),
        velocity: Vec3::new(0.0, -0.8, 0.0),
        end: 0.15,
        ..Emitter::default()
    };
    let (minimum, maximum) = (Vec3::new(-0.05, -0.01, -0.05), Vec3::new(0.05, 0.01, 0.05));
    let drain = Drain { minimum, maximum, rate: 0.1, ..Drain::default() };
    let scene = scene(FluidSolver::Dfsph, 0.02).with_emitter(emitter).with_drain(drain);
    let mut on_gpu = world(&scene);
    let mut on_cpu = common::world(&scene);
    let mut twice = on_gpu.clone();
    for _ in 0..12 {
        common::frame(&mut on_gpu);
        common::frame(&mut on_cpu);
        common::frame(&mut twice);
        audit(&on_gpu);
    }
    assert_eq!(on_gpu.digest(), twice.digest());
    let (own, other) = (on_gpu.ledger(), on_cpu.ledger());
    // The CPU lets them flow in every step, the device once a frame.
    assert!(own.poured.abs_diff(other.poured) < other.poured / 10, "{own:?} {other:?}");
    assert!(own.drained.abs_diff(other.drained) < other.drained / 5, "{own:?} {other:?}");
    assert!(own.drained > 0 && on_gpu.emitters().count() == 0);
    // The same questions have the same answers where the state is the same.
    let mut bytes = Vec::new();
    on_gpu.save(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
    let restored = World::restore(&bytes[..], &Options::default()).unwrap_or_else(|error| panic!("{error}"));
    let points = [Vec3::new(0.0, 0.01, 0.0), Vec3::new(-0.03, 0.02, -0.03)];
    assert_eq!(on_gpu.probe(&points), restored.probe(&points));
    let places = [[0.0, 0.0], [0.03, 0.03]];
    assert_eq!(on_gpu.water_levels(&places), restored.water_levels(&places));
    assert_eq!(on_gpu.body_loads(), restored.body_loads());
}
