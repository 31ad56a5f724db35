//! Worlds that have survived have one digest, whatever ran them.

use sorb::{Options, SimdLevel, World, scene::Scene};

use crate::{
    common, pick,
    scenes::{crushed, dry, wet, with_ball},
};

fn digest(scene: &Scene, threads: usize, simd: SimdLevel) -> u64 {
    let options = Options { threads: Some(threads), simd: Some(simd), ..Options::default() };
    let mut world = World::with_options(scene, &options).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(world.cpu().threads(), threads, "too few rows for threads to matter");
    let particles = world.particle_ids().len();
    while world.clock().time < pick(0.012, 0.2) {
        common::steps(&mut world, 1);
    }
    assert_eq!(common::unhealthy(&world, particles), None);
    world.digest()
}

#[test]
fn what_survives_is_the_same_on_all_threads_and_levels() {
    let mut fast = with_ball(wet(), 2000.0, 100.0);
    fast.time.minimum_step = 1e-8;
    let scenes = [
        ("a ball at 100 m/s", fast, 1.2),
        ("crushed wet", crushed(wet(), &[0, 1, 2], 0.012), 1.2),
        ("crushed dry", crushed(dry(), &[1], 0.004), 3.0),
        ("drag of a permeability of 1e-14", common::with(&wet(), &["sponges[0].permeability=1e-14"]), 1.2),
    ];
    for (name, scene, resolution) in scenes {
        let scene = scene.scaled(resolution).unwrap_or_else(|error| panic!("{name}: {error}"));
        let expected = digest(&scene, 1, SimdLevel::Fallback);
        for (threads, simd) in [(2, SimdLevel::Fallback), (1, SimdLevel::best()), (2, SimdLevel::best())] {
            assert_eq!(digest(&scene, threads, simd), expected, "{name}: {threads} threads, {simd}");
        }
        // The control: one bit of gravity.
        let mut other = scene;
        other.gravity.y = other.gravity.y.next_up();
        assert_ne!(digest(&other, 2, SimdLevel::best()), expected, "{name}: gravity by one bit");
    }
}
