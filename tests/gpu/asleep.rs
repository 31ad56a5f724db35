//! Parts of scenes that sleep on a device while others move.

use sorb::{Offload, World, glam::Vec3, scene::Scene};

use super::{
    common::{
        self, frame,
        resting::{
            START, basin, cube, distance, fastest, nodes, one_lies_one_flies, over_a_sponge, plate,
            positions, vector,
        },
    },
    world,
};

fn on(offload: Offload, scene: &Scene, sleep_after: f32) -> World {
    let mut scene = scene.clone();
    scene.time.sleep_after = sleep_after;
    world(&scene, offload)
}

fn until(world: &mut World, time: f64) {
    while world.clock().time < time - 1e-6 {
        frame(world);
    }
}

/// Mean distance of two sets of places \[m\].
fn mean_distance(a: &[Vec3], b: &[Vec3]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).sum::<f32>() / a.len() as f32
}

#[test]
fn a_sponge_sleeps_beside_water_that_moves() {
    let scene = basin(0.3).with_sponge(cube("cube", Vec3::new(0.1, 0.0, -0.015)));
    let (mut sleeps, mut awake) = (on(Offload::Gpu, &scene, 0.2), on(Offload::Gpu, &scene, 0.0));
    let mut before = None;
    while sleeps.clock().time < 0.7 {
        frame(&mut sleeps);
        frame(&mut awake);
        assert!(!sleeps.is_fluid_asleep() && !sleeps.is_asleep());
        let apart = mean_distance(&positions(&sleeps), &positions(&awake));
        assert!(apart < 1e-4, "{apart} m after {} s", sleeps.clock().time);
        if !sleeps.is_sponge_asleep(0) {
            assert!(before.is_none(), "it must sleep on");
            continue;
        }
        let now = nodes(&sleeps, 0);
        assert!(*before.get_or_insert_with(|| now.clone()) == now, "a sponge that sleeps moved");
    }
    assert!(before.is_some(), "it must fall asleep");
    let plan = sleeps.step_plan().to_string();
    assert!(plan.contains("skip  pbd::velocity") && plan.contains("gpu   sph::sweep"), "{plan}");
    // A copy uploads the sleeping parts, and continues with the same bits; elsewhere the world continues awake.
    let mut copy = sleeps.clone();
    let mut moved = sleeps.clone();
    moved.move_to(None).unwrap_or_else(|error| panic!("{error}"));
    assert!(!moved.is_sponge_asleep(0) && nodes(&moved, 0) == nodes(&sleeps, 0));
    for _ in 0..3 {
        [&mut sleeps, &mut copy, &mut moved].into_iter().for_each(frame);
        assert_eq!(copy.digest(), sleeps.digest());
    }
    assert!(mean_distance(&positions(&moved), &positions(&sleeps)) < 1e-4);
}

#[test]
fn one_of_two_sponges_sleeps() {
    let scene = one_lies_one_flies();
    let mut both = [Offload::Gpu, Offload::Cpu].map(|offload| on(offload, &scene, 0.1));
    let height = |world: &World| nodes(world, 1).iter().map(|(row, _)| row[1]).fold(0.0, f32::max);
    let (mut slept, mut highest) = (0, 0.0_f32);
    while both[0].clock().time < 0.35 {
        both.iter_mut().for_each(frame);
        let [on_gpu, on_cpu] = &both;
        let is_asleep = on_gpu.is_sponge_asleep(0);
        assert!(!on_gpu.is_sponge_asleep(1) && !on_gpu.is_fluid_asleep());
        slept += u32::from(is_asleep && on_cpu.is_sponge_asleep(0));
        highest = highest.max(height(on_gpu));
        for sponge in 0..2 {
            let places = |world| nodes(world, sponge).iter().map(|(row, _)| vector(row)).collect::<Vec<_>>();
            let apart = mean_distance(&places(on_gpu), &places(on_cpu));
            assert!(apart < 1e-4, "sponge {sponge}: {apart} m after {} s", on_gpu.clock().time);
        }
    }
    assert!(slept >= 10, "asleep on both for {slept} frames");
    assert!(highest > 0.1, "the other flies: {highest} m");
}

#[test]
fn a_pool_sleeps_while_a_sponge_falls_and_wakes_before_it_is_touched() {
    let scene = basin(0.0)
        .with_sponge(cube("cube", Vec3::new(0.04, 0.111, -0.015)))
        .with_body(plate(Vec3::new(0.055, 0.105, 0.0), Vec3::new(0.03, 0.005, 0.02)));
    let mut world = on(Offload::Gpu, &scene, 0.25);
    until(&mut world, START);
    assert!(world.is_asleep() && world.is_fluid_asleep() && world.is_sponge_asleep(0));
    let (water, mut highest) = (positions(&world), 0.0_f32);
    while world.clock().time < START + 0.5 {
        let report = world.advance_frame().unwrap_or_else(|error| panic!("{error}"));
        highest = highest.max(report.maximum_speed);
        assert!(world.is_fluid_asleep() && positions(&world) == water, "after {} s", report.time);
        assert!(world.step_plan().to_string().contains("sph::density: no fluid"));
    }
    assert!(highest > 1.0 && !world.is_sponge_asleep(0), "it must fall: {highest} m/s");
    assert!(nodes(&world, 0).iter().all(|(row, _)| row[1] < 0.05), "it lies on the floor");
    // One that falls into the pool wakes it.
    let mut scene = scene;
    scene.sponges[0].position.x = -0.09;
    scene.bodies[1].position.x = -0.075;
    let mut wet = on(Offload::Gpu, &scene, 0.25);
    until(&mut wet, START);
    assert!(wet.is_asleep());
    let top = positions(&wet).iter().map(|place| place.y).fold(0.0, f32::max);
    let (mut woke, mut gap) = (false, 0.0);
    while wet.clock().time < START + 0.6 && !woke {
        common::steps(&mut wet, 1);
        woke = !wet.is_fluid_asleep();
        gap = nodes(&wet, 0).iter().map(|(row, _)| row[1]).fold(1.0, f32::min) - top;
    }
    assert!(woke && gap > 0.01, "it must wake before it is touched: {gap} m");
    let then = positions(&wet);
    common::steps(&mut wet, 1);
    let jump = positions(&wet).iter().zip(&then).map(|(now, then)| now.distance(*then)).fold(0.0, f32::max);
    assert!(jump < 1e-4, "a jump of {jump} m");
}

#[test]
fn a_copy_knows_what_a_sponge_that_sleeps_holds() {
    let scene = basin(0.0)
        .with_sponge(cube("dry", Vec3::new(0.04, 0.111, -0.015)))
        .with_sponge(cube("wet", Vec3::new(-0.095, 0.0, -0.015)))
        .with_body(plate(Vec3::new(0.055, 0.105, 0.0), Vec3::new(0.03, 0.005, 0.02)));
    let mut world = on(Offload::Gpu, &scene, 0.25);
    until(&mut world, START + 0.1);
    assert!(world.is_fluid_asleep() && world.is_sponge_asleep(1) && !world.is_sponge_asleep(0));
    let mut copy = world.clone();
    [&mut world, &mut copy].into_iter().for_each(frame);
    let [own, of_copy] = [&world, &copy].map(|world| world.measures().absorbed_mass);
    assert!(own > 1e-3 && of_copy == own, "{of_copy} and not {own} kg");
}

#[test]
fn a_ball_wakes_a_sponge_before_it_touches() {
    let mut both = [Offload::Gpu, Offload::Cpu].map(|offload| on(offload, &over_a_sponge(), 0.25));
    for world in &mut both {
        until(world, START);
        assert!(world.is_asleep() && world.is_body_asleep(1) && world.is_sponge_asleep(0));
        let before = nodes(world, 0);
        while world.is_sponge_asleep(0) {
            assert!(nodes(world, 0) == before, "what sleeps moved");
            frame(world);
            assert!(world.clock().time < START + 1.0, "the ball must wake it");
        }
        assert!(distance(world, 1) > 0.0, "woken too late");
    }
    assert!(
        both.iter().all(|world| world.clock().time > START + 0.05),
        "the ball falls, and the sponge sleeps"
    );
    let deepest = |world: &mut World| {
        let mut lowest = f32::INFINITY;
        while world.clock().time < START + 0.4 {
            frame(world);
            lowest = lowest.min(world.bodies()[1].state.position.y);
        }
        lowest
    };
    let [found, expected] = both.each_mut().map(deepest);
    assert!((found - expected).abs() < 5e-4 && expected < 0.041, "{found} m instead of {expected} m");
    assert!(fastest(&both[0]) < 1.0);
}
