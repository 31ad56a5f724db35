//! Contacts of bodies: walls, plates, piles, and the same bits every time.

use super::*;
use crate::rigid::{RapierEngine, convex_hull};

const DT: f32 = 1.0 / 120.0;

fn container() -> (Vec3, Vec3) {
    (Vec3::new(-0.2, 0.0, -0.2), Vec3::new(0.2, 0.5, 0.2))
}

fn boxed(bodies: &[BodySetup]) -> RapierEngine {
    RapierEngine::new(GRAVITY, Some(container()), bodies).expect("the bodies are valid")
}

#[test]
fn a_ball_comes_to_rest_on_the_floor() {
    let mut engine = boxed(&[ball(Vec3::new(0.05, 0.3, 0.0))]);
    step(&mut engine, DT, 240);
    let state = engine.state(0);
    assert_close(state.position, Vec3::new(0.05, 0.02, 0.0), 2e-4);
    assert!(state.linear_velocity.length() < 1e-3, "still moving: {}", state.linear_velocity);
}

#[test]
fn an_open_side_lets_bodies_out() {
    let (low, high) = container();
    let open = Some((Vec3::new(low.x, f32::NEG_INFINITY, low.z), high));
    let mut engine =
        RapierEngine::new(GRAVITY, open, &[ball(Vec3::Y * 0.3)]).expect("an infinite bound is open");
    step(&mut engine, DT, 240);
    assert!(engine.state(0).position.y < -5.0);
}

#[test]
fn the_floor_of_a_container_that_is_open_at_its_sides_holds() {
    let (low, high) = container();
    let far = Vec3::new(f32::INFINITY, 0.0, f32::INFINITY);
    let mut rolling = ball(Vec3::new(0.1, 0.02, 0.0));
    rolling.state.linear_velocity = Vec3::X;
    let mut engine =
        RapierEngine::new(GRAVITY, Some((low - far, high + far)), &[rolling]).expect("open sides");
    step(&mut engine, DT, 240);
    let place = engine.state(0).position;
    // It rolls at 1 m/s, and sinks in by half a millimetre.
    assert!((place.y - 0.02).abs() < 1e-3 && place.x > 0.3, "{place}");
}

#[test]
fn fast_bodies_stay_inside() {
    let half_extents = Vec3::new(0.01, 0.02, 0.03);
    for (direction, shape) in [
        (Vec3::new(1.0, 0.3, -0.7), Shape::Sphere { radius: 0.02 }),
        (Vec3::new(-0.2, 1.0, 0.9), Shape::Cuboid { half_extents }),
        (Vec3::new(0.1, -0.9, 0.8), Shape::Capsule { half_height: 0.02, radius: 0.01 }),
        (Vec3::new(0.5, -1.0, 0.5), splinter_shape()),
    ] {
        let mut setup = body("bullet", BodyKind::Dynamic, shape, Vec3::Y * 0.25);
        setup.state.linear_velocity = direction * 60.0;
        setup.state.angular_velocity = Vec3::new(20.0, 0.0, -10.0);
        setup.restitution = 0.9;
        let mut engine = boxed(&[setup]);
        let (low, high) = container();
        for _ in 0..240 {
            step(&mut engine, DT, 1);
            let position = engine.state(0).position;
            assert!((position.cmpge(low) & position.cmple(high)).all(), "left the box: {position}");
        }
    }
}

fn splinter_shape() -> Shape {
    let points =
        [Vec3::ZERO, Vec3::new(0.05, 0.0, 0.01), Vec3::new(0.0, 0.03, 0.02), Vec3::new(0.01, 0.01, 0.04)];
    convex_hull(&points).expect("the points span a solid").shape
}

#[test]
fn a_kinematic_plate_carries_a_ball_up() {
    let motion = Motion::Linear { velocity: Vec3::Y * 0.1, start: 0.5, end: 1.5, ease: 0.0 };
    let mut engine = boxed(&[plate(vec![motion]), ball(Vec3::Y * 0.14)]);
    step(&mut engine, DT, 60);
    assert_close(engine.state(1).position, Vec3::Y * 0.13, 5e-5);
    assert_eq!(engine.state(0).linear_velocity, Vec3::Y * 0.1);
    step(&mut engine, DT, 60);
    assert_close(engine.state(0).position, Vec3::Y * 0.15, 1e-6);
    assert_close(engine.state(1).position, Vec3::Y * 0.18, 1e-4);
    assert_close(engine.state(1).linear_velocity, Vec3::Y * 0.1, 1e-3);
    step(&mut engine, DT, 120);
    assert_eq!(engine.state(0).linear_velocity, Vec3::ZERO);
    assert_close(engine.state(0).position, Vec3::Y * 0.2, 1e-6);
    assert_close(engine.state(1).position, Vec3::Y * 0.23, 1e-4);
    assert_eq!((engine.inverse_mass(0), engine.kind(0)), (0.0, BodyKind::Kinematic));
}

#[test]
fn a_stack_of_boxes_stands() {
    let half_extents = Vec3::new(0.02, 0.015, 0.02);
    let heights = [0.015, 0.045, 0.075, 0.105, 0.135, 0.165];
    let bodies = heights
        .map(|y| body("box", BodyKind::Dynamic, Shape::Cuboid { half_extents }, Vec3::new(0.0, y, 0.0)));
    let mut engine = boxed(&bodies);
    step(&mut engine, DT, 480);
    for (index, y) in heights.into_iter().enumerate() {
        assert_close(engine.state(index).position, Vec3::Y * y, 1e-3);
    }
}

#[test]
fn a_bouncing_ball_gains_no_energy() {
    let mut setup = ball(Vec3::Y * 0.03);
    setup.state.linear_velocity = Vec3::NEG_Y * 3.0;
    setup.restitution = 0.9;
    let mut engine = RapierEngine::new(Vec3::ZERO, Some(container()), &[setup]).expect("the ball is valid");
    step(&mut engine, DT, 2);
    assert_close(engine.state(0).linear_velocity, Vec3::Y * 2.7, 1e-3);
}

#[test]
fn a_turning_plate_drags_a_ball_along() {
    let motion =
        Motion::Turn { axis: Vec3::Y, pivot: Vec3::ZERO, rate: 1.0, start: 0.0, end: 10.0, ease: 0.0 };
    let mut engine = boxed(&[plate(vec![motion]), ball(Vec3::new(0.05, 0.131, 0.0))]);
    step(&mut engine, DT, 60);
    let state = engine.state(1);
    assert!(state.linear_velocity.z < -1e-3, "friction did not move the ball: {}", state.linear_velocity);
    assert_eq!(engine.state(0).angular_velocity, Vec3::Y);
}

/// Enough bodies to exercise the tree, the islands and the warm start.
fn pile() -> RapierEngine {
    let half_extents = Vec3::new(0.02, 0.01, 0.015);
    let shapes = [
        Shape::Sphere { radius: 0.015 },
        Shape::Cuboid { half_extents },
        Shape::Capsule { half_height: 0.015, radius: 0.01 },
        splinter_shape(),
    ];
    let spin = Motion::Turn {
        axis: Vec3::new(0.2, 1.0, 0.0),
        pivot: Vec3::ZERO,
        rate: 4.0,
        start: 0.2,
        end: 1.0,
        ease: 0.0,
    };
    let mut bodies = vec![plate(vec![spin])];
    for index in 0..24_u8 {
        let (column, layer) = (f32::from(index % 4), f32::from(index / 4));
        let position = Vec3::new(0.05 * column - 0.07 + 0.003 * layer, 0.15 + 0.05 * layer, 0.004 * column);
        let shape = shapes[usize::from(index % 3 + index / 12)].clone();
        bodies.push(BodySetup { restitution: 0.3, ..body("piece", BodyKind::Dynamic, shape, position) });
    }
    boxed(&bodies)
}

/// A varying step and varying wrenches, as the coupled solver makes them.
fn shake(engine: &mut dyn RigidEngine, from: u16, to: u16) {
    for n in from..to {
        let mut wrenches = vec![Wrench::default(); engine.body_count()];
        let body = usize::from(n) % wrenches.len();
        wrenches[body] = impulse(0.002, 0.003, -0.001);
        wrenches[body].angular_impulse = DVec3::new(1e-6, -2e-6, 3e-6);
        engine.step(DT / f32::from(1 + n % 3), &wrenches).expect("the wrenches are finite");
    }
}

#[test]
fn two_runs_give_the_same_bits() {
    let (mut first, mut second) = (pile(), pile());
    shake(&mut first, 0, 200);
    shake(&mut second, 0, 200);
    assert_eq!(bits(&first), bits(&second));
    let mut nudged = pile();
    let mut wrenches = vec![Wrench::default(); nudged.body_count()];
    wrenches[5] = impulse(1e-9, 0.0, 0.0);
    nudged.step(DT, &wrenches).expect("the wrenches are finite");
    shake(&mut nudged, 1, 200);
    assert_ne!(bits(&first), bits(&nudged), "a nudge must show");
}

#[test]
fn a_copy_continues_with_the_same_bits() {
    let mut engine = pile();
    shake(&mut engine, 0, 40);
    let mut copies = Vec::new();
    for n in 40..100 {
        if n % 7 == 0 {
            copies.push((n, engine.boxed_clone()));
        }
        shake(&mut engine, n, n + 1);
    }
    shake(&mut engine, 100, 200);
    for (n, mut copy) in copies {
        shake(&mut *copy, n, 200);
        assert_eq!(bits(&*copy), bits(&engine), "the copy of step {n} took another way");
    }
}

#[test]
fn a_body_that_is_held_stays_and_goes_on_with_what_it_had() {
    // The lower one lies on the floor, the other falls on it and is stopped on the way.
    let mut engine = boxed(&[ball(Vec3::Y * 0.02), ball(Vec3::new(0.001, 0.3, 0.0))]);
    step(&mut engine, DT, 12);
    let (before, mass) = (engine.state(1), (engine.inverse_mass(1), engine.inverse_inertia(1)));
    assert!(before.linear_velocity.y < -0.9);
    (0..2).for_each(|index| engine.hold(index, true));
    let held = engine.state(1);
    assert_eq!((held.position, held.linear_velocity), (before.position, Vec3::ZERO));
    assert_eq!((engine.inverse_mass(1), engine.inverse_inertia(1)), mass);
    let mut copy = engine.clone();
    step(&mut engine, DT, 100);
    assert_eq!((engine.state(1), engine.inverse_mass(1)), (held, mass.0));
    (0..2).for_each(|index| engine.hold(index, false));
    assert_eq!(engine.state(1), before);
    // Negative control: it falls again, and comes to rest like one that was released at once.
    step(&mut engine, DT, 1);
    assert!(engine.state(1).position.y < before.position.y - 0.008);
    step(&mut engine, DT, 300);
    (0..2).for_each(|index| copy.hold(index, false));
    step(&mut copy, DT, 301);
    for index in 0..2 {
        assert_close(engine.state(index).position, copy.state(index).position, 1e-3);
    }
}
