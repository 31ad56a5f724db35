//! One digest, over threads, SIMD levels and interruptions. Runs without any are compared in `tests/determinism.rs`.

use sorb::{Player, Recorder, Recording, SimdLevel, Snapshot, World, scene::Scene};

use super::{RESOLUTION, busy, common, levels, options, restored, saved, world_on};

const STEPS: u32 = 24;
/// Steps between interruptions.
const EVERY: u32 = 7;
const THREADS: [usize; 4] = [1, 2, 3, 8];

fn straight(scene: &Scene, threads: usize, simd: SimdLevel) -> World {
    let mut world = world_on(scene, threads, simd);
    common::steps(&mut world, STEPS);
    world
}

/// Saves and restores every seven steps, on other threads and at another level each time.
fn restored_again_and_again(scene: &Scene, threads: usize, simd: SimdLevel) -> u64 {
    let all = levels();
    let mut world = world_on(scene, threads, simd);
    for step in 0..STEPS {
        if step % EVERY == EVERY - 1 {
            let bytes = saved(&world);
            let turn = threads + (step / EVERY) as usize;
            world = restored(&bytes, &options(THREADS[turn % 4], all[turn % all.len()]));
            assert_eq!(saved(&world), bytes, "{}: step {step}: the same bytes after a restore", scene.name);
        }
        common::steps(&mut world, 1);
    }
    world.digest()
}

/// Goes three steps too far every seven steps, and rolls back.
fn rolled_back_again_and_again(scene: &Scene, threads: usize, simd: SimdLevel) -> u64 {
    let mut world = world_on(scene, threads, simd);
    let mut snapshot = Snapshot::new();
    for step in 0..STEPS {
        if step % EVERY == EVERY - 1 {
            world.snapshot_into(&mut snapshot);
            let before = saved(&world);
            common::steps(&mut world, 3);
            assert_ne!(saved(&world), before, "{}: it has not moved", scene.name);
            world.rollback(&snapshot).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(
                saved(&world),
                before,
                "{}: step {step}: the same bytes after a roll back",
                scene.name
            );
        }
        common::steps(&mut world, 1);
    }
    world.digest()
}

/// Single steps with key frames.
fn recorded(scene: &Scene) -> Recording {
    let mut world = world_on(scene, 1, SimdLevel::Fallback);
    let recorder = Recorder::new(&world, Some(EVERY));
    let mut recorder = recorder.unwrap_or_else(|error| panic!("{}: {error}", scene.name));
    for _ in 0..STEPS {
        recorder.step(&mut world).unwrap_or_else(|error| panic!("{}: {error}", scene.name));
    }
    recorder.into_recording()
}

/// Every step is compared.
fn replayed(recording: &Recording, threads: usize, simd: SimdLevel) -> u64 {
    let player = Player::new(recording, &options(threads, simd));
    let mut player = player.unwrap_or_else(|error| panic!("{error}"));
    while player.advance().unwrap_or_else(|error| panic!("{error}")) {}
    player.world().digest()
}

fn matrix(name: &str) {
    let scene = busy::scene(name, RESOLUTION);
    let first = straight(&scene, 1, SimdLevel::Fallback);
    let expected = first.digest();
    let recording = recorded(&scene);
    // Levels by turns: runs that are restored change theirs on the way, and `tests/determinism.rs` has every pair.
    for (threads, simd) in THREADS.into_iter().zip(levels().into_iter().cycle()) {
        let is = |what: &str, digest: u64| {
            assert_eq!(digest, expected, "{name}: {threads} threads, {simd}, {what}");
        };
        is("saved and restored", restored_again_and_again(&scene, threads, simd));
        is("replayed", replayed(&recording, threads, simd));
        is("rolled back", rolled_back_again_and_again(&scene, threads, simd));
    }
    // The control: one step less, and one bit of gravity.
    let mut other = world_on(&scene, 2, SimdLevel::best());
    common::steps(&mut other, STEPS - 1);
    assert_ne!(other.digest(), expected, "{name}: one step less");
    let mut scene = scene;
    scene.gravity.y = scene.gravity.y.next_up();
    assert_ne!(straight(&scene, 1, SimdLevel::best()).digest(), expected, "{name}: gravity by one bit");
}

macro_rules! scenes {
    ($($scene:ident)+) => {
        $(#[test]
        fn $scene() {
            matrix(stringify!($scene));
        })+
    };
}
for_every_scene!(scenes);
