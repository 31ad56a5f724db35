//! Random commands give one digest: on any threads, at any SIMD level, twice, and after saves, roll backs and recordings.

use sorb::{
    Command, FlowHandle, Nodes, Options, Player, Recorder, Region, SimdLevel, Snapshot, World,
    glam::Vec3,
    scene::{Drain, Emitter, FluidSolver, Scene},
};

use super::{audit, busy_cup, common::random::Random};

const FRAMES: u64 = 12;

impl Random {
    fn point(&mut self) -> Vec3 {
        Vec3::new(self.unit() - 0.5, self.unit() * 1.6, self.unit() - 0.5) * 0.1
    }
}

/// A command, good or bad.
fn command(random: &mut Random, next: FlowHandle) -> Command {
    let (point, other, radius) = (random.point(), random.point(), 0.005 + 0.02 * random.unit());
    let region = match random.next() % 3 {
        0 => Region::Sphere { centre: point, radius },
        1 => Region::Cylinder { start: point, end: other, radius },
        _ => Region::Box { minimum: point.min(other), maximum: point.max(other) },
    };
    let velocity = (random.point() - Vec3::Y * 0.1) * 10.0;
    let (number, seconds) = (next.number() + (random.next() % 4 / 3) as u32, 0.3 * random.unit());
    match random.next() % 13 {
        0..=3 => Command::Pour { region, velocity },
        4 | 5 => Command::Remove { region },
        6 => Command::Impulse { body: 0.into(), impulse: velocity * 1e-3, angular_impulse: Vec3::ZERO },
        7 => Command::Gravity { gravity: Vec3::new(random.unit() - 0.5, -9.0, random.unit()) },
        8 => {
            let emitter = Emitter {
                position: point,
                velocity,
                radius: 0.4 * radius,
                end: seconds,
                ..Emitter::default()
            };
            Command::Emit { number: number.into(), emitter }
        }
        9 => {
            let (minimum, maximum) = (point.min(other), point.max(other));
            Command::Drain {
                number: number.into(),
                drain: Drain { minimum, maximum, rate: 0.2, end: seconds, ..Drain::default() },
            }
        }
        10 => Command::EndFlow { number: number.saturating_sub(1).into() },
        11 => Command::Grip { body: 0.into(), nodes: Nodes::Sphere { centre: point, radius } },
        _ => Command::Release { nodes: Nodes::Sphere { centre: point, radius: 1.0 } },
    }
}

/// The commands before a frame, which are functions of seed, frame and the numbers of flows alone.
fn commands(world: &World, seed: u64, frame: u64) -> Vec<Command> {
    let mut random = Random(seed.wrapping_mul(1000) + frame);
    (0..random.next() % 4).map(|_| command(&mut random, world.next_flow())).collect()
}

fn scene(solver: FluidSolver, sleeps: bool) -> Scene {
    let mut scene = busy_cup(0.02, solver);
    if sleeps {
        (scene.time.sleep_after, scene.time.sleep_speed) = (0.03, 0.5);
    }
    scene
}

fn options(threads: usize, simd: SimdLevel) -> Options {
    Options { threads: Some(threads), simd: Some(simd), ..Options::default() }
}

fn world(scene: &Scene, threads: usize, simd: SimdLevel) -> World {
    World::with_options(scene, &options(threads, simd)).unwrap_or_else(|error| panic!("{error}"))
}

fn advance(world: &mut World, seed: u64, frame: u64) {
    for command in commands(world, seed, frame) {
        let before = world.digest();
        if world.push(command).is_err() {
            assert_eq!(world.digest(), before, "a refused command changes nothing");
        }
    }
    world.advance_frame().unwrap_or_else(|error| panic!("seed {seed}, frame {frame}: {error}"));
    audit(world);
}

fn straight(scene: &Scene, seed: u64, threads: usize, simd: SimdLevel) -> World {
    let mut world = world(scene, threads, simd);
    (0..FRAMES).for_each(|frame| advance(&mut world, seed, frame));
    world
}

fn saved(world: &World) -> Vec<u8> {
    let mut bytes = Vec::new();
    world.save(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
    bytes
}

/// Saved and restored after every frame, with commands that wait, on other threads each time.
fn restored(scene: &Scene, seed: u64) -> u64 {
    let mut own = world(scene, 1, SimdLevel::Fallback);
    for frame in 0..FRAMES {
        for command in commands(&own, seed, frame) {
            let _ = own.push(command);
        }
        let bytes = saved(&own);
        let other = options(1 + frame as usize % 3, SimdLevel::best());
        own = World::restore(&bytes[..], &other).unwrap_or_else(|error| panic!("{seed}, {frame}: {error}"));
        assert_eq!(saved(&own), bytes, "seed {seed}, frame {frame}: the same bytes after a restore");
        own.advance_frame().unwrap_or_else(|error| panic!("{error}"));
    }
    own.digest()
}

/// Every frame twice, with other commands the first time.
fn rolled_back(scene: &Scene, seed: u64) -> u64 {
    let (mut own, mut snapshot) = (world(scene, 2, SimdLevel::best()), Snapshot::new());
    for frame in 0..FRAMES {
        own.snapshot_into(&mut snapshot);
        let before = saved(&own);
        advance(&mut own, seed + 77, frame);
        own.rollback(&snapshot).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(saved(&own), before, "seed {seed}, frame {frame}: the same bytes after a roll back");
        advance(&mut own, seed, frame);
    }
    own.digest()
}

fn replayed(scene: &Scene, seed: u64) -> u64 {
    let mut own = world(scene, 2, SimdLevel::best());
    let mut recorder = Recorder::new(&own, Some(5)).unwrap_or_else(|error| panic!("{error}"));
    for frame in 0..FRAMES {
        for command in commands(&own, seed, frame) {
            let _ = recorder.push(&mut own, command);
        }
        recorder.advance_frame(&mut own).unwrap_or_else(|error| panic!("{error}"));
    }
    let recording = recorder.into_recording();
    let mut bytes = Vec::new();
    recording.write(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
    let recording = sorb::Recording::read(&bytes[..]).unwrap_or_else(|error| panic!("{error}"));
    let one = options(1, SimdLevel::Fallback);
    let mut player = Player::new(&recording, &one).unwrap_or_else(|error| panic!("{error}"));
    while player.advance().unwrap_or_else(|error| panic!("seed {seed}: {error}")) {}
    assert_eq!(player.world().digest(), own.digest());
    player.seek(FRAMES - 1).unwrap_or_else(|error| panic!("{error}"));
    assert!(player.advance().unwrap_or_else(|error| panic!("{error}")));
    own.digest()
}

fn one_digest(scene: &Scene, seed: u64) -> u64 {
    let first = straight(scene, seed, 1, SimdLevel::Fallback).digest();
    for (threads, simd) in [(2, SimdLevel::best()), (3, SimdLevel::Fallback), (2, SimdLevel::best())] {
        assert_eq!(straight(scene, seed, threads, simd).digest(), first, "seed {seed}: {threads} {simd}");
    }
    assert_eq!(restored(scene, seed), first, "seed {seed}: restored");
    assert_eq!(rolled_back(scene, seed), first, "seed {seed}: rolled back");
    assert_eq!(replayed(scene, seed), first, "seed {seed}: replayed");
    first
}

macro_rules! matrix {
    ($($name:ident: $solver:ident, $sleeps:literal;)+) => {
        $(#[test]
        fn $name() {
            let scene = scene(FluidSolver::$solver, $sleeps);
            let other = straight(&scene, 2, 2, SimdLevel::best()).digest();
            assert_ne!(one_digest(&scene, 1), other, "negative control: other commands");
        })+
    };
}
matrix! {
    random_commands_with_the_solve_for_the_divergence: Divergence, false;
    random_commands_with_the_solve_for_the_density: Dfsph, false;
    random_commands_with_an_equation_of_state: Wcsph, false;
    random_commands_with_sleep: Dfsph, true;
}

/// Seeds that are tried; `SORB_STRESS=1` tries many more.
fn seeds() -> std::ops::Range<u64> {
    100..if std::env::var_os("SORB_STRESS").is_some() { 500 } else { 108 }
}

#[test]
fn any_commands_give_an_error_or_a_sound_world() {
    for seed in seeds() {
        let solvers = [FluidSolver::Divergence, FluidSolver::Dfsph, FluidSolver::Pbf];
        let scene = scene(solvers[(seed % 3) as usize], seed % 2 == 0);
        let world = straight(&scene, seed, 2, SimdLevel::best());
        assert!(world.clock().frames == FRAMES, "seed {seed}");
    }
}
