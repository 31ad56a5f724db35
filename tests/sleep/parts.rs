//! Parts of scenes that sleep while others move.

use sorb::{
    Options, SimdLevel, World,
    glam::Vec3,
    scene::{Body, Motion, Scene, ShapeKind, Sponge},
};

use crate::{
    common::{
        self,
        resting::{START, basin, cube, distance, fastest, nodes, over_a_sponge, plate, positions},
    },
    frame,
};

fn world(scene: &Scene, sleep_after: f32) -> World {
    let mut scene = scene.clone();
    scene.time.sleep_after = sleep_after;
    common::world(&scene)
}

#[test]
fn a_sponge_sleeps_beside_water_that_moves() {
    let scene = basin(0.3).with_sponge(cube("cube", Vec3::new(0.1, 0.0, -0.015)));
    let (mut sleeps, mut awake) = (world(&scene, 0.2), world(&scene, 0.0));
    let mut before = None;
    while sleeps.clock().time < 0.9 {
        assert_eq!(frame(&mut sleeps).steps, frame(&mut awake).steps);
        assert!(!sleeps.is_fluid_asleep() && !sleeps.is_asleep());
        // The water continues with the same bits.
        assert!(positions(&sleeps) == positions(&awake), "after {} s", sleeps.clock().time);
        if !sleeps.is_sponge_asleep(0) {
            assert!(before.is_none(), "it must sleep on");
            continue;
        }
        let now = nodes(&sleeps, 0);
        assert!(*before.get_or_insert_with(|| now.clone()) == now, "a sponge that sleeps moved");
    }
    assert!(before.is_some(), "it must fall asleep");
    assert_ne!(sleeps.digest(), awake.digest(), "what sleeps is part of the digest");
    // The plan shows the rest of the step.
    let skips = |world: &World| world.step_plan().to_string().contains("skip  pbd::velocity");
    assert!(skips(&sleeps) && !skips(&awake));
    assert!(sleeps.plan().to_string() == awake.plan().to_string());
    // Negative control: in the pool it stays awake as long as that moves.
    let scene = basin(0.3).with_sponge(cube("cube", Vec3::new(-0.09, 0.0, -0.015)));
    let mut wet = world(&scene, 0.2);
    while wet.clock().time < 0.9 {
        frame(&mut wet);
        assert!(!wet.is_sponge_asleep(0) && !wet.is_fluid_asleep());
    }
}

#[test]
fn a_pool_sleeps_while_a_sponge_falls() {
    let scene = basin(0.0)
        .with_sponge(cube("cube", Vec3::new(0.04, 0.111, -0.015)))
        .with_body(plate(Vec3::new(0.055, 0.105, 0.0), Vec3::new(0.03, 0.005, 0.02)));
    let mut world = world(&scene, 0.25);
    while world.clock().time < START - 1e-6 {
        frame(&mut world);
    }
    assert!(world.is_asleep() && world.is_fluid_asleep() && world.is_sponge_asleep(0));
    let (water, fluid_steps) = (positions(&world), calls(&world, "sph::density"));
    let (mut fell, mut highest) = (false, 0.0_f32);
    while world.clock().time < START + 1.0 {
        let report = frame(&mut world);
        fell |= !world.is_sponge_asleep(0);
        highest = highest.max(report.maximum_speed);
        assert!(world.is_fluid_asleep() && positions(&world) == water, "after {} s", report.time);
        let skips = world.step_plan().to_string().contains("sph::density: no fluid");
        assert!(skips && !world.plan().to_string().contains("sph::density: no fluid"));
    }
    assert!(fell && highest > 1.0, "it must fall: {highest} m/s");
    assert_eq!(calls(&world, "sph::density"), fluid_steps, "no phase of the fluid may run");
    assert!(nodes(&world, 0).iter().all(|(row, _)| row[1] < 0.05), "it lies on the floor");
    // Negative control: a sponge that falls into the pool wakes it.
    let mut scene = scene;
    scene.sponges[0].position.x = -0.09;
    scene.bodies[1].position.x = -0.075;
    let mut wet = self::world(&scene, 0.25);
    while wet.clock().time < START - 1e-6 {
        frame(&mut wet);
    }
    assert!(wet.is_asleep());
    let (mut woke, mut gap) = (false, 0.0);
    while wet.clock().time < START + 0.6 && !woke {
        let water = positions(&wet);
        wet.step().unwrap_or_else(|error| panic!("{error}"));
        woke = !wet.is_fluid_asleep();
        let top = water.iter().map(|place| place.y).fold(0.0, f32::max);
        gap = nodes(&wet, 0).iter().map(|(row, _)| row[1]).fold(1.0, f32::min) - top;
    }
    assert!(woke && gap > 0.01, "it must wake before it is touched: {gap} m");
}

/// How often a phase has run.
fn calls(world: &World, name: &str) -> u64 {
    world.phase_times().iter().find(|time| time.name == name).map_or(0, |time| time.calls)
}

#[test]
fn a_ball_wakes_a_sponge_before_it_touches() {
    let scene = over_a_sponge();
    let (mut world, mut awake) = (world(&scene, 0.25), world(&scene, 0.0));
    while world.clock().time < START - 1e-6 {
        frame(&mut world);
        frame(&mut awake);
    }
    assert!(world.is_asleep() && world.is_body_asleep(1) && world.is_sponge_asleep(0));
    assert!(!world.is_body_asleep(0) && !world.is_body_asleep(7) && !world.is_sponge_asleep(1));
    assert!(!awake.is_body_asleep(1), "the control may not sleep");
    let (ball, before) = (world.bodies()[1].state, nodes(&world, 0));
    // The plate moves: the ball wakes, and the sponge sleeps until the ball is near.
    world.step().unwrap_or_else(|error| panic!("{error}"));
    assert!(!world.is_asleep() && !world.is_body_asleep(1) && world.is_sponge_asleep(0));
    assert!(world.bodies()[1].state.position.distance(ball.position) < 1e-4, "no jump");
    while world.is_sponge_asleep(0) {
        assert!(nodes(&world, 0) == before, "what sleeps moved");
        world.step().unwrap_or_else(|error| panic!("{error}"));
        assert!(world.clock().time < START + 1.0, "the ball must wake it");
    }
    let gap = distance(&world, 1);
    assert!(gap > 0.003 && gap < 0.04, "woken at {gap} m");
    // It continues with its former state: the first step after moves it by no more than before it slept.
    assert!(nodes(&world, 0) == before);
    let slow = fastest(&world);
    world.step().unwrap_or_else(|error| panic!("{error}"));
    assert!(distance(&world, 1) > 0.0 && fastest(&world) <= slow + 1e-4, "{} m/s", fastest(&world));
    // Contact is as for a sponge that never slept.
    let deepest = |world: &mut World| {
        let (mut deepest, mut lowest) = (f32::INFINITY, f32::INFINITY);
        while world.clock().time < START + 0.5 {
            frame(world);
            deepest = deepest.min(distance(world, 1));
            lowest = lowest.min(world.bodies()[1].state.position.y);
        }
        [deepest, lowest]
    };
    let (after_sleep, expected) = (deepest(&mut world), deepest(&mut awake));
    for (found, expected) in after_sleep.iter().zip(expected) {
        assert!((found - expected).abs() < 5e-4, "{after_sleep:?} m instead of {expected:?} m");
    }
    assert!(expected[1] < 0.041, "the ball must press the sponge: {} m", expected[1]);
}

#[test]
fn two_islands_that_a_body_falls_on_wake_both() {
    let bar = ShapeKind::Cuboid { half_extents: Vec3::new(0.06, 0.005, 0.01) };
    let bar = Body::dynamic("bar", bar, Vec3::new(0.0, 0.1601, 0.0), 300.0);
    let scene = Scene::new("bridge")
        .in_box(Vec3::new(-0.15, 0.0, -0.05), Vec3::new(0.2, 0.3, 0.3))
        .with_sponge(cube("left", Vec3::new(-0.06, 0.0, -0.015)))
        .with_sponge(cube("right", Vec3::new(0.03, 0.0, -0.015)))
        .with_sponge(cube("far", Vec3::new(0.15, 0.0, -0.015)))
        .with_body(plate(Vec3::new(0.0, 0.15, 0.0), Vec3::new(0.03, 0.005, 0.02)))
        .with_body(Body { friction: 0.0, ..bar });
    let mut world = world(&scene, 0.25);
    while world.clock().time < START - 1e-6 {
        frame(&mut world);
    }
    assert!(world.is_asleep());
    let far = nodes(&world, 2);
    while world.is_sponge_asleep(0) && world.is_sponge_asleep(1) {
        frame(&mut world);
        assert!(world.clock().time < START + 1.0, "the bar must wake them");
    }
    assert!(!world.is_sponge_asleep(0) && !world.is_sponge_asleep(1), "both at once");
    assert!(distance(&world, 1) > 0.0, "before it touches");
    // Negative control: the third is out of its reach.
    while world.clock().time < START + 0.5 {
        frame(&mut world);
        assert!(world.is_sponge_asleep(2) && nodes(&world, 2) == far);
    }
}

#[test]
fn copies_threads_and_vector_widths_sleep_alike() {
    let mut scene = over_a_sponge();
    scene.time.sleep_after = 0.25;
    let on = |threads, simd| {
        let options = Options { threads: Some(threads), simd, ..Options::default() };
        World::with_options(&scene, &options).unwrap_or_else(|error| panic!("{error}"))
    };
    let mut worlds = [on(2, None), on(1, None), on(3, Some(SimdLevel::Fallback))];
    // The ball falls, and the sponge sleeps.
    for world in &mut worlds {
        while world.clock().time < START + 0.1 {
            frame(world);
        }
        assert!(world.is_sponge_asleep(0) && !world.is_body_asleep(1));
    }
    let mut copy = worlds[0].clone();
    assert_eq!(copy.digest(), worlds[0].digest());
    for _ in 0..30 {
        for world in worlds.iter_mut().chain([&mut copy]) {
            frame(world);
        }
        let digests: Vec<_> = worlds.iter().map(World::digest).collect();
        assert_eq!(digests, [copy.digest(); 3]);
    }
    assert!(!copy.is_sponge_asleep(0), "it woke on the way");
}

#[test]
fn scenes_that_are_awake_do_not_care_whether_they_may_sleep() {
    let moves = |scene: &Scene, sleep_after| {
        let mut world = world(scene, sleep_after);
        for _ in 0..40 {
            frame(&mut world);
        }
        assert!(!world.is_fluid_asleep() && !world.is_sponge_asleep(0) && !world.is_body_asleep(1));
        world.state_digest()
    };
    let scene = common::busy::scene("ball_drop", 0.5);
    let never = moves(&scene, 0.0);
    assert_eq!(moves(&scene, 0.05), never, "it looks, and finds everything moving");
    assert_eq!(moves(&scene, 0.0), never);
}

/// Number of times that parts fall asleep or wake.
fn changes(scene: &Scene, seconds: f64) -> u32 {
    let mut world = world(scene, 0.2);
    let (mut before, mut count) = ([false; 3], 0);
    while world.clock().time < seconds {
        frame(&mut world);
        let now = [world.is_fluid_asleep(), world.is_sponge_asleep(0), world.is_sponge_asleep(1)];
        count += before.iter().zip(now).filter(|(before, now)| **before != *now).count() as u32;
        before = now;
    }
    count
}

#[test]
fn what_trembles_near_the_limit_does_not_fall_asleep_by_turns() {
    // Water that trembles at any multiple of the speed at which it may sleep.
    for speed in [1e-4, 3e-4, 1e-3, 3e-3] {
        let mut scene = basin(0.05);
        scene.time.sleep_speed = speed;
        let count = changes(&scene, 4.0);
        assert!(count <= 1, "{count} changes at {speed} m/s");
    }
    // A sponge beside a plate that moves back and forth: within its reach it stays awake, out of it it sleeps.
    let beside = |gap: f32| {
        let motion = |k: i32| {
            let velocity = Vec3::X * if k % 2 == 0 { 0.02 } else { -0.02 };
            Motion::Linear { velocity, start: 0.1 * k as f32, end: 0.1 * (k + 1) as f32, ease: 0.0 }
        };
        let shape = ShapeKind::Cuboid { half_extents: Vec3::new(0.005, 0.02, 0.02) };
        let place = Vec3::new(0.015 + gap + 0.005, 0.021, 0.0);
        Scene::new("beside")
            .in_box(Vec3::new(-0.05, 0.0, -0.05), Vec3::new(0.2, 0.3, 0.05))
            .with_sponge(cube("cube", Vec3::new(-0.015, 0.0, -0.015)))
            .with_body(Body::kinematic("plate", shape, place, (0..40).map(motion).collect()))
    };
    for gap in [0.004, 0.012, 0.018, 0.022, 0.026, 0.034, 0.08] {
        let count = changes(&beside(gap), 3.5);
        assert!(count <= 1, "{count} changes at a gap of {gap} m");
        assert_eq!(count == 1, gap > 0.03, "gap {gap} m");
    }
}

#[test]
fn what_swings_as_often_as_it_is_looked_at_does_not_fall_asleep() {
    // A soft post on a foot that holds it, with almost no damping.
    let foot = ShapeKind::Cuboid { half_extents: Vec3::new(0.05, 0.006, 0.05) };
    let post = Sponge {
        cells: [2, 6, 2].into(),
        velocity: Vec3::X * 0.08,
        damping: 0.0,
        ..cube("post", Vec3::ZERO)
    };
    let mut scene = Scene::new("post")
        .with_sponge(Sponge { young_modulus: 2e4, iterations: 16, ..post })
        .with_body(Body { grip: true, ..Body::fixed("foot", foot, Vec3::ZERO) });
    scene.gravity = Vec3::ZERO;
    scene.time.maximum_step = 0.0005;
    let speed = |world: &World| {
        let velocities = world.node_velocities();
        velocities.iter().map(|row| row[0]).sum::<f32>() / velocities.len() as f32
    };
    // Times at which it turns.
    let (mut swings, mut turns, mut left) = (world(&scene, 0.0), Vec::new(), 0.0_f32);
    while turns.len() < 9 {
        let before = speed(&swings);
        swings.step().unwrap_or_else(|error| panic!("{error}"));
        if (before > 0.0) != (speed(&swings) > 0.0) {
            turns.push(swings.clock().time);
            left = if turns.len() < 9 { 0.0 } else { left };
        }
        left = left.max(speed(&swings).abs());
        assert!(swings.clock().time < 5.0, "it must swing");
    }
    let period = (turns[8] - turns[0]) / 4.0;
    assert!(left > 0.005, "it must swing on: {left} m/s are left after {turns:?} s");
    let mut world = world(&scene, period as f32);
    while world.clock().time < turns[8] {
        world.step().unwrap_or_else(|error| panic!("{error}"));
        assert!(
            !world.is_sponge_asleep(0),
            "asleep after {} s at {} m/s",
            world.clock().time,
            fastest(&world)
        );
    }
}
