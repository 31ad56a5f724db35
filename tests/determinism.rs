//! The same bits on every run, number of threads and SIMD level, and after continuing a copy.

mod common;

use std::sync::Arc;

use common::busy;
use sorb::{
    Cpu, Options, SimdLevel, World,
    internal::{self, columns::Column},
    scene::Scene,
};

/// More than one chunk of nodes and several chunks of particles, so that threads matter.
const RESOLUTION: f32 = 0.6;
const STEPS: u32 = 40;

fn with(scene: &Scene, threads: usize, simd: SimdLevel) -> World {
    let options = Options { threads: Some(threads), simd: Some(simd), ..Options::default() };
    World::with_options(scene, &options).unwrap_or_else(|error| panic!("{}: {error}", scene.name))
}

fn digest_after(mut world: World, steps: u32) -> u64 {
    common::steps(&mut world, steps);
    world.digest()
}

/// The levels of this machine; the others are printed, so that a log does not claim what was not run.
#[expect(clippy::print_stdout, reason = "the log of a test says what it did not run")]
fn levels() -> impl Iterator<Item = SimdLevel> {
    for missing in SimdLevel::ALL.into_iter().filter(|level| !level.is_supported()) {
        println!("SKIPPED: {missing}, which this machine lacks");
    }
    SimdLevel::supported()
}

/// The scene must be worth the comparison: everything interacts.
fn assert_is_busy(world: &World, is_pushed: bool) {
    let name = &world.scene().name;
    if !world.particle_ids().is_empty() && !world.node_positions().is_empty() {
        assert!(common::water_is_inside(world), "{name}: no water in the sponge");
    }
    // Grips hold nodes, and receive nothing from them.
    if world.scene().bodies.iter().any(|body| !body.grip) {
        assert!(is_pushed, "{name}: nothing touches the bodies");
    }
}

fn matrix(name: &str) {
    let scene = busy::scene(name, RESOLUTION);
    let mut first = with(&scene, 1, SimdLevel::Fallback);
    let mut is_pushed = false;
    for _ in 0..STEPS {
        common::steps(&mut first, 1);
        is_pushed |= common::bodies_are_pushed(&first);
    }
    let expected = first.digest();
    assert_is_busy(&first, is_pushed);
    for simd in levels() {
        for threads in [1, 2, 3, 8] {
            let digest = digest_after(with(&scene, threads, simd), STEPS);
            assert_eq!(digest, expected, "{name}: {threads} threads, {simd}");
        }
    }
    assert_eq!(digest_after(with(&scene, 1, SimdLevel::Fallback), STEPS), expected, "{name}: run twice");
    if name != "empty" {
        // The smallest possible change of one number must show, or the comparison above means nothing.
        let mut other = scene.clone();
        other.gravity.y = other.gravity.y.next_up();
        assert_ne!(digest_after(common::world(&other), STEPS), expected, "{name}: gravity by one bit");
    }
    assert_ne!(digest_after(common::world(&scene), STEPS - 1), expected, "{name}: one step less");
    let text =
        format!("{}\n{}\ndigest {:016x}", first.scene().title, common::line(&first), first.state_digest());
    common::golden(&format!("digest_{name}"), &text);
}

/// Leaves a copy every seven steps, returns to it, and continues.
fn copies(name: &str) {
    let scene = busy::scene(name, RESOLUTION);
    let expected = digest_after(common::world(&scene), STEPS);
    let mut world = common::world(&scene);
    for step in 0..STEPS {
        if step % 7 == 6 {
            let saved = world.clone();
            assert_eq!(saved.digest(), world.digest());
            common::steps(&mut world, 3);
            assert_ne!(saved.digest(), world.digest(), "{name}: it has not moved");
            world = saved;
        }
        common::steps(&mut world, 1);
    }
    assert_eq!(world.digest(), expected, "{name}: after going back");
}

macro_rules! scenes {
    ($($scene:ident)+) => {
        $(mod $scene {
            #[test]
            fn is_the_same_on_all_threads_and_levels() {
                super::matrix(stringify!($scene));
            }

            #[test]
            fn continues_from_a_copy() {
                super::copies(stringify!($scene));
            }
        })+
    };
}
sorb::for_every_preset!(scenes ball_drop_paper dry_paper life_pbf ball_drop_smoothed ball_drop_divergence);

#[test]
fn a_pool_of_the_host_changes_nothing() {
    let scene = busy::scene("ball_drop", RESOLUTION);
    let expected = digest_after(with(&scene, 1, SimdLevel::Fallback), STEPS);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().map(Arc::new);
    let pool = pool.unwrap_or_else(|error| panic!("{error}"));
    let cpu = Cpu::serial(SimdLevel::best()).unwrap_or_else(|error| panic!("{error}"));
    let cpu = cpu.with_pool(Arc::clone(&pool));
    assert_eq!(cpu.threads(), 3);
    let world = World::on(&scene, cpu, &Options::default()).unwrap_or_else(|error| panic!("{error}"));
    // From inside a job of the pool, as in a task of the host.
    let mut other = world.clone();
    let inside = pool.install(|| {
        common::steps(&mut other, STEPS);
        other.digest()
    });
    assert_eq!(inside, expected, "stepped by a thread of the pool");
    assert_eq!(digest_after(world, STEPS), expected, "stepped from outside");
}

#[test]
fn frames_and_observed_columns_change_nothing_but_the_length_of_steps() {
    let scene = busy::scene("standing", 0.5);
    let mut plain = common::world(&scene);
    let cpu = plain.cpu().clone();
    let mut observed = World::on(&scene, cpu, &Options::default()).unwrap_or_else(|error| panic!("{error}"));
    internal::observe(&mut observed, Column::ALL).unwrap_or_else(|error| panic!("{error}"));
    for _ in 0..2 {
        common::frame(&mut plain);
        common::frame(&mut observed);
    }
    assert_eq!(plain.digest(), observed.digest());
}
