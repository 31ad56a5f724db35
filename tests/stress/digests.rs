//! One digest of worlds after violent motion, for every backend configuration.

use sorb::{Options, SimdLevel, World, scene::Scene};

use crate::{
    common, pick,
    scenes::{crushed, dry, wet, with_ball},
};

/// Digest after so many seconds; the second half in a copy of the world.
fn digest(scene: &Scene, seconds: f64, threads: usize, simd: SimdLevel) -> u64 {
    let options = Options { threads: Some(threads), simd: Some(simd), ..Options::default() };
    let mut world = World::with_options(scene, &options).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(world.cpu().threads(), threads, "too few rows for threads to matter");
    let particles = world.particle_ids().len();
    while world.clock().time < 0.5 * seconds {
        common::steps(&mut world, 1);
    }
    // One thread continues the world, more threads a copy.
    let mut world = if threads == 1 { world } else { world.clone() };
    while world.clock().time < seconds {
        common::steps(&mut world, 1);
    }
    assert_eq!(common::unhealthy(&world, particles), None);
    world.digest()
}

/// A world has the same bits on all threads and SIMD levels, and others with another gravity.
fn has_one_digest(scene: &Scene, resolution: f32, seconds: f64) {
    let seconds = pick(0.012, seconds);
    let scene = scene.scaled(resolution).unwrap_or_else(|error| panic!("{error}"));
    let expected = digest(&scene, seconds, 1, SimdLevel::Fallback);
    for (threads, simd) in [(2, SimdLevel::Fallback), (1, SimdLevel::best()), (2, SimdLevel::best())] {
        assert_eq!(digest(&scene, seconds, threads, simd), expected, "{threads} threads, {simd}");
    }
    // Negative control: one bit of gravity.
    let mut other = scene;
    other.gravity.y = other.gravity.y.next_up();
    assert_ne!(digest(&other, seconds, 2, SimdLevel::best()), expected, "gravity by one bit");
}

#[test]
fn a_ball_at_100_meters_a_second() {
    let mut fast = with_ball(wet(), 2000.0, 100.0);
    fast.time.minimum_step = 1e-8;
    has_one_digest(&fast, 1.2, 0.2);
}

#[test]
fn crushed_wet() {
    // Up to a quarter of its volume: later a particle has hundreds of neighbours, and a step takes a second.
    has_one_digest(&crushed(wet(), &[0, 1, 2], 0.012), 1.2, 0.1);
}

#[test]
fn crushed_dry() {
    has_one_digest(&crushed(dry(), &[1], 0.004), 3.0, 0.2);
}

#[test]
fn drag_of_a_permeability_of_1e_minus_14() {
    has_one_digest(&common::with(&wet(), &["sponges[0].permeability=1e-14"]), 1.2, 0.2);
}
