//! Sponges with properties that depend on wetness: keys, state, and cost for other scenes.

mod common;

use sorb::{
    Options, SimdLevel, World,
    internal::{self, Verdict},
    scene::Scene,
};

const KEYS: [&str; 5] = [
    "sponges[0].softening=0.5",
    "sponges[0].swelling=0.1",
    "sponges[0].wetting_time=0.02",
    "sponges[0].relative_permeability_exponent=3",
    "sponges[0].receding_pressure=2000",
];

fn wetting() -> Scene {
    common::with(&common::preset("ball_drop", 0.5), &KEYS)
}

#[test]
fn what_is_not_asked_for_has_no_state() {
    let mut plain = common::world(&common::preset("ball_drop", 0.5));
    common::steps(&mut plain, 2);
    assert!(internal::columns(&plain).nodes.wetting.is_empty());
    let runs = |world: &World| {
        let line = world.plan().lines().iter().find(|line| line.name == "couple::wetting");
        line.is_some_and(|line| line.verdict == Verdict::Runs)
    };
    assert!(!runs(&plain));
    let asked = common::world(&wetting());
    assert!(runs(&asked) && !internal::columns(&asked).nodes.wetting.is_empty());
}

#[test]
fn every_key_changes_what_happens() {
    let after = |scene: &Scene| {
        let mut world = common::world(scene);
        common::steps(&mut world, 60);
        world.digest()
    };
    let plain = common::preset("ball_drop", 0.5);
    let base = after(&plain);
    for key in KEYS {
        // A time alone has no effect.
        let changes = after(&common::with(&plain, &[key])) != base;
        assert_eq!(changes, !key.contains("wetting_time"), "{key}");
    }
}

#[test]
fn a_copy_goes_on_with_the_same_bits_and_wetness_is_part_of_the_digest() {
    let mut world = common::world(&wetting());
    common::steps(&mut world, 60);
    let wet = internal::columns(&world).nodes.wetting.iter().filter(|row| row[0] > 0.3).count();
    assert!(wet > 10, "{wet} nodes are wet");
    let mut copy = world.clone();
    common::steps(&mut world, 20);
    common::steps(&mut copy, 20);
    assert_eq!(world.digest(), copy.digest());
    for (threads, simd) in [(1, SimdLevel::Fallback), (3, SimdLevel::best())] {
        let options = Options { threads: Some(threads), simd: Some(simd), ..Options::default() };
        let mut other = World::with_options(&wetting(), &options).unwrap_or_else(|error| panic!("{error}"));
        common::steps(&mut other, 80);
        assert_eq!(world.digest(), other.digest(), "{threads} threads, {simd}");
    }
}

#[test]
fn a_wet_sponge_stays_whole_and_heavy_as_it_was() {
    let mut world = common::world(&wetting());
    let weights = |world: &World| -> f64 {
        let nodes = world.node_positions().iter().filter(|row| row[3] > 0.0);
        nodes.map(|row| 1.0 / f64::from(row[3])).sum()
    };
    let (before, particles) = (weights(&world), world.particle_ids().len());
    for _ in 0..90 {
        common::frame(&mut world);
        assert_eq!(common::unhealthy(&world, particles), None);
    }
    assert!((weights(&world) / before - 1.0).abs() < 1e-12);
    let rest = world.lattice().rest_volume(0).unwrap_or(f64::NAN);
    let grown = world.measures().sponge_volume / rest;
    assert!(grown > 1.1, "{grown:.3} of its dry volume");
}

#[test]
fn what_cannot_be_is_refused_with_the_key_and_the_range() {
    let plain = common::preset("ball_drop", 0.5);
    for (key, needle) in [
        ("sponges[0].softening=1", "softening"),
        ("sponges[0].swelling=-0.1", "swelling"),
        ("sponges[0].relative_permeability_exponent=0", "relative_permeability_exponent"),
        ("sponges[0].wetting_time=-1", "wetting_time"),
        ("sponges[0].receding_pressure=1", "entry_pressure"),
    ] {
        let error =
            plain.with_overrides([key]).and_then(|scene| scene.validate()).expect_err(key).to_string();
        assert!(error.contains(needle), "{key}: {error}");
    }
    for (paper, key) in [
        ("fluid.coupling=paper", "sponges[0].softening=0.5"),
        ("sponges[0].solver=sbd", "sponges[0].swelling=0.1"),
        ("fluid.solver=wcsph", "sponges[0].relative_permeability_exponent=3"),
        ("fluid.coupling=paper", "sponges[0].receding_pressure=3000"),
    ] {
        let error = plain.with_overrides([paper, key]).and_then(|scene| scene.validate());
        let error = error.expect_err(key).to_string();
        assert!(error.contains("porous"), "{key}: {error}");
    }
}
