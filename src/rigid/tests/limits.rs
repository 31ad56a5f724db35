//! Errors that only an engine with dynamic bodies has.

use super::errors::{assert_bad_steps, assert_value};
use super::*;
use crate::rigid::{RapierEngine, RigidError};

#[test]
fn bad_steps_move_nothing() {
    let lift = Motion::Linear { velocity: Vec3::Y, start: 0.0, end: 1.0, ease: 0.0 };
    let bodies = [ball(Vec3::Y), plate(vec![lift])];
    assert_bad_steps(&mut RapierEngine::new(GRAVITY, None, &bodies).expect("the bodies are valid"));
}

#[test]
fn a_wrench_beyond_the_range_of_the_velocity_is_refused() {
    let mut engine = RapierEngine::new(GRAVITY, None, &[ball(Vec3::Y)]).expect("the ball is valid");
    let error = engine.step(0.01, &[impulse(0.0, 3e38, 0.0)]).expect_err("the velocity would overflow");
    assert!(matches!(error, RigidError::Wrench { index: 0, quantity: "impulse", .. }), "{error}");
    let wrench = Wrench { angular_impulse: DVec3::X * 1e36, ..Wrench::default() };
    let error = engine.step(0.01, &[wrench]).expect_err("the spin would overflow");
    assert!(matches!(error, RigidError::Wrench { quantity: "angular_impulse", .. }), "{error}");
}

#[test]
fn a_body_that_leaves_all_bounds_is_named() {
    let bodies = [plate(Vec::new()), BodySetup { name: "comet".to_owned(), ..ball(Vec3::Y) }];
    let mut engine = RapierEngine::new(GRAVITY, None, &bodies).expect("the bodies are valid");
    let mut wrenches = [Wrench::default(), impulse(0.0, 2e36, 0.0)];
    let mut outcome = Ok(());
    for _ in 0..100 {
        outcome = engine.step(10.0, &wrenches);
        wrenches[1] = Wrench::default();
        if outcome.is_err() {
            break;
        }
    }
    match outcome {
        Err(RigidError::Diverged { body, index, time }) => {
            assert_eq!((body.as_str(), index, time), ("comet", 1, engine.time()));
        }
        other => panic!("expected a divergence, found {other:?}"),
    }
}

#[test]
fn gravity_container_and_mass_are_checked() {
    let new =
        |gravity, container, position| RapierEngine::new(gravity, container, &[ball(position)]).map(|_| ());
    let inside = Some((Vec3::ZERO, Vec3::ONE));
    let centre = Vec3::splat(0.5);
    assert_eq!(new(GRAVITY, inside, centre), Ok(()));
    assert!(matches!(new(Vec3::NAN, inside, centre), Err(RigidError::Gravity { .. })));
    for high in [Vec3::new(1.0, 0.0, 1.0), Vec3::new(1.0, -1.0, 1.0), Vec3::new(1.0, f32::NAN, 1.0)] {
        let container = Some((Vec3::ZERO, high));
        assert!(matches!(new(GRAVITY, container, centre), Err(RigidError::Container { .. })));
    }
    let outside = new(GRAVITY, inside, Vec3::new(0.5, 1.5, 0.5)).expect_err("the ball is above the lid");
    assert!(matches!(&outside, RigidError::OutsideContainer { body, .. } if body == "ball"), "{outside}");
    for (radius, density) in [(1e-9, 1000.0), (1e15, 1000.0), (1e-4, 1e-30)] {
        let shape = Shape::Sphere { radius };
        assert_value(BodySetup { density, ..body("mote", BodyKind::Dynamic, shape, Vec3::ZERO) }, "mass");
    }
}
