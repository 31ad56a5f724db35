//! Every error has a case, and names the body and the key.

use super::*;
use crate::rigid::{RigidError, ScriptedEngine};

/// Error of the engines for one body that must be refused.
fn refusal(setup: &BodySetup) -> RigidError {
    let error = if setup.kind == BodyKind::Dynamic {
        dynamic_refusal(setup)
    } else {
        ScriptedEngine::new(std::slice::from_ref(setup)).map(|_| ()).err()
    };
    error.expect("the body is refused")
}

#[cfg(feature = "rigid")]
fn dynamic_refusal(setup: &BodySetup) -> Option<RigidError> {
    crate::rigid::RapierEngine::new(GRAVITY, None, std::slice::from_ref(setup)).map(|_| ()).err()
}

#[cfg(not(feature = "rigid"))]
fn dynamic_refusal(setup: &BodySetup) -> Option<RigidError> {
    crate::rigid::setup::checked_state(setup).map(|_| ()).err()
}

pub(super) fn assert_value(setup: BodySetup, expected: &str) {
    match refusal(&setup) {
        RigidError::Value { body, key, .. } if body == setup.name => assert_eq!(key, expected),
        error => panic!("expected a bad `{expected}`, found: {error}"),
    }
}

fn assert_kind(setup: BodySetup, expected: &str) {
    match refusal(&setup) {
        RigidError::Kind { body, key, kind, .. } if body == setup.name && kind == setup.kind => {
            assert_eq!(key, expected);
        }
        error => panic!("expected a misplaced `{expected}`, found: {error}"),
    }
}

#[test]
fn bad_numbers_name_body_and_key() {
    let ball = || ball(Vec3::ZERO);
    assert_value(BodySetup { density: 0.0, ..ball() }, "density");
    assert_value(BodySetup { density: f32::NAN, ..ball() }, "density");
    assert_value(BodySetup { density: -1.0, kind: BodyKind::Fixed, ..ball() }, "density");
    assert_value(BodySetup { friction: -0.1, ..ball() }, "friction");
    assert_value(BodySetup { restitution: 1.1, ..ball() }, "restitution");
    assert_value(BodySetup { restitution: f32::NAN, ..ball() }, "restitution");
    let rest = at_rest(Vec3::ZERO);
    let with = |state| BodySetup { state, ..ball() };
    assert_value(with(at_rest(Vec3::X * f32::NAN)), "position");
    assert_value(with(BodyState { linear_velocity: Vec3::X * f32::INFINITY, ..rest }), "linear_velocity");
    assert_value(with(BodyState { angular_velocity: Vec3::Y * f32::NAN, ..rest }), "angular_velocity");
    assert_value(with(BodyState { rotation: Quat::from_xyzw(0.0, 0.0, 0.0, 0.0), ..rest }), "rotation");
    assert_value(with(BodyState { rotation: Quat::from_xyzw(0.0, 0.0, 0.0, f32::NAN), ..rest }), "rotation");
}

#[test]
fn bad_shapes_name_body_and_key() {
    let with = |shape| body("thing", BodyKind::Fixed, shape, Vec3::ZERO);
    assert_value(with(Shape::Sphere { radius: 0.0 }), "shape.radius");
    assert_value(with(Shape::Cuboid { half_extents: Vec3::new(1.0, -1.0, 1.0) }), "shape.half_extents.y");
    assert_value(with(Shape::Capsule { half_height: f32::NAN, radius: 1.0 }), "shape.half_height");
    assert_value(with(Shape::Capsule { half_height: 1.0, radius: f32::INFINITY }), "shape.radius");
    let hull = |normal, corner, triangle| Shape::Hull {
        planes: vec![(normal, 1.0)],
        vertices: vec![corner; 2],
        triangles: vec![triangle],
    };
    assert_value(with(hull(Vec3::X * 2.0, Vec3::ZERO, [0, 1, 0])), "shape.planes[0]");
    assert_value(with(hull(Vec3::X, Vec3::X * f32::NAN, [0, 1, 0])), "shape.vertices[0]");
    assert_value(with(hull(Vec3::X, Vec3::ZERO, [0, 1, 2])), "shape.triangles[0]");
}

#[test]
fn bad_motions_name_body_and_key() {
    let good = Motion::Linear { velocity: Vec3::X, start: 0.0, end: 1.0, ease: 0.0 };
    let linear = |velocity, start, end| plate(vec![good, Motion::Linear { velocity, start, end, ease: 0.0 }]);
    assert_value(linear(Vec3::X * f32::NAN, 0.0, 1.0), "motions[1].velocity");
    assert_value(linear(Vec3::X, -1.0, 1.0), "motions[1].start");
    assert_value(linear(Vec3::X, f32::INFINITY, f32::INFINITY), "motions[1].start");
    assert_value(linear(Vec3::X, 2.0, 1.0), "motions[1].end");
    assert_value(linear(Vec3::X, 2.0, f32::NAN), "motions[1].end");
    let eased = |ease| plate(vec![Motion::Linear { velocity: Vec3::X, start: 1.0, end: 3.0, ease }]);
    for ease in [-0.1, 1.1, f32::NAN, f32::INFINITY] {
        assert_value(eased(ease), "motions[0].ease");
    }
    assert!(ScriptedEngine::new(&[eased(1.0)]).is_ok(), "half of the motion");
    let turn =
        |axis, pivot, rate| plate(vec![Motion::Turn { axis, pivot, rate, start: 0.0, end: 1.0, ease: 0.0 }]);
    assert_value(turn(Vec3::ZERO, Vec3::ZERO, 1.0), "motions[0].axis");
    assert_value(turn(Vec3::NAN, Vec3::ZERO, 1.0), "motions[0].axis");
    assert_value(turn(Vec3::X, Vec3::NAN, 1.0), "motions[0].pivot");
    assert_value(turn(Vec3::X, Vec3::ZERO, f32::NAN), "motions[0].rate");
}

#[test]
fn what_does_not_fit_the_kind_is_refused() {
    let motion = Motion::Linear { velocity: Vec3::X, start: 0.0, end: 1.0, ease: 0.0 };
    assert_kind(BodySetup { motions: vec![motion], ..ball(Vec3::ZERO) }, "motions");
    assert_kind(BodySetup { kind: BodyKind::Fixed, ..plate(vec![motion]) }, "motions");
    assert_kind(body("ground", BodyKind::Dynamic, Shape::Plane, Vec3::ZERO), "shape");
    let mut moving = plate(Vec::new());
    moving.state.linear_velocity = Vec3::X;
    assert_kind(moving, "linear_velocity");
    let mut spinning = plate(Vec::new());
    spinning.state.angular_velocity = Vec3::X;
    assert_kind(spinning, "angular_velocity");
}

#[test]
fn the_scripted_engine_says_which_feature_a_dynamic_body_needs() {
    let error = ScriptedEngine::new(&[plate(Vec::new()), ball(Vec3::ZERO)]).expect_err("a ball is dynamic");
    assert_eq!(error, RigidError::DynamicUnsupported { body: "ball".to_owned() });
    let message = error.to_string();
    assert!(message.contains("`ball`") && message.contains("`rigid`"), "{message}");
}

/// Bad input of a step is refused before anything moves; the last body is called `plate`.
pub(super) fn assert_bad_steps(engine: &mut dyn RigidEngine) {
    let count = engine.body_count();
    let before = bits(engine);
    let good = vec![Wrench::default(); count];
    for dt in [0.0, -0.1, f32::NAN, f32::INFINITY] {
        assert!(matches!(engine.step(dt, &good), Err(RigidError::TimeStep { .. })));
    }
    let error = engine.step(0.1, &good[1..]).expect_err("a wrench is missing");
    assert_eq!(error, RigidError::WrenchCount { expected: count, found: count - 1 });
    for value in [f64::NAN, f64::INFINITY, 1e300] {
        for expected in ["impulse", "angular_impulse"] {
            let mut bad = good.clone();
            let last = &mut bad[count - 1];
            let part = if expected == "impulse" { &mut last.impulse } else { &mut last.angular_impulse };
            part.y = value;
            match engine.step(0.1, &bad) {
                Err(RigidError::Wrench { body, index, quantity, .. }) => {
                    assert_eq!((body.as_str(), index, quantity), ("plate", count - 1, expected));
                }
                other => panic!("expected a refused wrench, found {other:?}"),
            }
        }
    }
    assert_eq!(bits(engine), before, "a refused step must not move anything");
    engine.step(0.1, &good).expect("the engine still works");
    assert_ne!(bits(engine), before);
}

#[test]
fn bad_steps_move_nothing() {
    let lift = Motion::Linear { velocity: Vec3::Y, start: 0.0, end: 1.0, ease: 0.0 };
    let mut engine = ScriptedEngine::new(&[plate(vec![lift])]).expect("the plate is valid");
    assert_bad_steps(&mut engine);
}

#[test]
fn a_host_engine_reports_in_its_own_words() {
    let error = RigidError::Engine { message: "no island left".to_owned() };
    assert_eq!(error.to_string(), "rigid-body engine: no island left");
}
