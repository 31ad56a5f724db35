//! Whole scenes at rest cost nothing until something moves.

use sorb::{
    Bound, World,
    glam::Vec3,
    scene::{Body, Fluid, FluidBlock, FluidSolver, Motion, Scene, ShapeKind, Sponge, Time},
};

use crate::{
    common::{self, resting::positions},
    frame,
};

/// Time at which the plate begins to move \[s\].
const START: f32 = 6.0;

/// Shallow water with a sponge in it, and a plate beside that moves after six seconds.
fn pool(sleep_after: f32) -> World {
    let half = Vec3::new(0.06, 0.0, 0.03);
    let fluid = Fluid {
        spacing: 0.005,
        blocks: vec![FluidBlock::new(-half, half + Vec3::Y * 0.03)],
        // The default solver goes on moving by some millimetres a second.
        solver: Some(FluidSolver::Dfsph),
        ..Fluid::default()
    };
    let sponge =
        Sponge { cells: [3, 3, 3].into(), edge: 0.01, ..Sponge::new("sponge", Vec3::new(0.01, 0.0, -0.015)) };
    let shape = ShapeKind::Cuboid { half_extents: Vec3::new(0.005, 0.04, 0.04) };
    let motion = Motion::Linear { velocity: Vec3::X * 0.1, start: START, end: START + 0.2, ease: 0.0 };
    let plate = Body::kinematic("plate", shape, Vec3::new(-0.07, 0.04, 0.0), vec![motion]);
    let mut scene = Scene::new("pool")
        .in_box(-half - Vec3::X * 0.02, half + Vec3::new(0.02, 0.1, 0.0))
        .with_fluid(fluid)
        .with_sponge(sponge)
        .with_body(plate);
    scene.time = Time { sleep_after, ..scene.time };
    common::world(&scene)
}

fn largest_way(then: &[Vec3], world: &World) -> f32 {
    positions(world).iter().zip(then).map(|(now, then)| now.distance(*then)).fold(0.0, f32::max)
}

#[test]
fn a_pool_at_rest_sleeps_until_a_plate_moves() {
    let mut world = pool(0.5);
    while world.clock().time < f64::from(START) - 0.5 {
        frame(&mut world);
    }
    assert!(world.is_asleep(), "after {} s", world.clock().time);
    let absorbed = world.measures().absorbed_mass;
    assert!(absorbed > 1e-3, "what is in the sponge stays in it: {absorbed} kg");
    // Asleep it takes no steps, and nothing changes.
    let (before, places) = (world.clock().steps, positions(&world));
    let report = frame(&mut world);
    assert_eq!((report.steps, report.bound, world.clock().steps), (0, Bound::Asleep, before));
    assert_eq!(positions(&world), places);
    assert_eq!(report.shortest_step, f32::INFINITY);
    // It wakes when the plate moves, not a step later, and continues as it was.
    while world.clock().time < f64::from(START) - 1e-6 {
        frame(&mut world);
        assert_eq!(world.clock().steps, before);
    }
    let report = frame(&mut world);
    assert!(!world.is_asleep() && report.steps > 0 && report.bound != Bound::Asleep);
    assert!((world.bodies()[0].state.position.x - (-0.07 + 0.1 / 60.0)).abs() < 1e-5);
    // No jump: the plate has no more effect than in a scene that was awake all the time.
    let moved = largest_way(&places, &world);
    let mut awake = pool(0.0);
    while awake.clock().time < f64::from(START) - 1e-6 {
        frame(&mut awake);
    }
    let then = positions(&awake);
    frame(&mut awake);
    let expected = largest_way(&then, &awake);
    assert!(moved < 1.5 * expected && expected > 1e-3, "{moved} m instead of {expected} m");
    while world.clock().time < f64::from(START) + 0.2 {
        frame(&mut world);
    }
    let fastest = world.measures().maximum_speed;
    assert!(fastest > 0.05, "the plate moves the water: {fastest} m/s");
}

#[test]
fn single_steps_sleep_as_frames_do_and_copies_go_on_alike() {
    let mut world = pool(0.5);
    while !world.is_asleep() {
        frame(&mut world);
        assert!(world.clock().time < f64::from(START), "it must fall asleep");
    }
    let mut copy = world.clone();
    while copy.clock().time < f64::from(START) {
        copy.step().unwrap_or_else(|error| panic!("{error}"));
    }
    while world.clock().time < f64::from(START) {
        frame(&mut world);
    }
    assert_eq!(positions(&copy), positions(&world));
    assert!((copy.clock().time - world.clock().time).abs() < 0.005);
}

#[test]
fn a_scene_that_nobody_allows_to_sleep_stays_awake() {
    let mut world = pool(0.0);
    while world.clock().time < 2.0 {
        assert!(frame(&mut world).steps > 0);
    }
    assert!(!world.is_asleep());
    // Nor does one that falls.
    let cube = FluidBlock::new(Vec3::splat(-0.02), Vec3::splat(0.02));
    let mut scene = Scene::new("falls").with_fluid(Fluid { blocks: vec![cube], ..Fluid::default() });
    scene.time.sleep_after = 0.1;
    let mut falls = common::world(&scene);
    for _ in 0..60 {
        frame(&mut falls);
    }
    assert!(!falls.is_asleep());
}
