use super::*;
use crate::rigid::ScriptedEngine;
use std::f32::consts::{FRAC_PI_2, PI};

fn lift() -> Motion {
    Motion::Linear { velocity: Vec3::new(0.0, 0.2, 0.0), start: 0.5, end: 1.5, ease: 0.0 }
}

fn turn() -> Motion {
    Motion::Turn { axis: Vec3::Z * 3.0, pivot: Vec3::ZERO, rate: FRAC_PI_2, start: 1.0, end: 3.0, ease: 0.0 }
}

fn engine(bodies: &[BodySetup]) -> ScriptedEngine {
    ScriptedEngine::new(bodies).expect("the bodies are valid")
}

/// Pose and velocity of the first body at `time`, reached in one step.
fn state_at(bodies: &[BodySetup], time: f32) -> BodyState {
    let mut engine = engine(bodies);
    if time > 0.0 {
        step(&mut engine, time, 1);
    }
    engine.state(0)
}

#[test]
fn a_translation_starts_runs_and_stops() {
    let bodies = [plate(vec![lift()])];
    for (time, height, speed) in [
        (0.0, 0.1, 0.0),
        (0.25, 0.1, 0.0),
        (0.5, 0.1, 0.2),
        (1.0, 0.2, 0.2),
        (1.5, 0.3, 0.0),
        (9.0, 0.3, 0.0),
    ] {
        let state = state_at(&bodies, time);
        assert_close(state.position, Vec3::new(0.0, height, 0.0), 1e-7);
        assert_eq!(state.linear_velocity, Vec3::new(0.0, speed, 0.0), "at {time} s");
        assert_eq!(state.angular_velocity, Vec3::ZERO);
    }
}

#[test]
fn an_eased_motion_begins_and_ends_at_rest() {
    let lift =
        |speed: f32, ease: f32| Motion::Linear { velocity: Vec3::Y * speed, start: 0.5, end: 1.5, ease };
    let eased = [plate(vec![lift(0.25, 0.2)])];
    // The way is that of 0.2 m/s in one second.
    for (time, way, speed) in [
        (0.5, 0.0, 0.0),
        (0.6, 0.25 * 0.01875, 0.125),
        (1.0, 0.1, 0.25),
        (1.4, 0.2 - 0.25 * 0.01875, 0.125),
        (2.0, 0.2, 0.0),
    ] {
        let state = state_at(&eased, time);
        assert_close(state.position, Vec3::Y * (0.1 + way), 1e-7);
        assert_close(state.linear_velocity, Vec3::Y * speed, 1e-6);
    }
    let slope = |bodies: &[BodySetup], time: f32| {
        let (before, after) = (state_at(bodies, time - 1.0 / 256.0), state_at(bodies, time + 1.0 / 256.0));
        (after.position - before.position) * 128.0
    };
    for time in [0.55, 0.65, 1.2, 1.33, 1.47] {
        assert_close(slope(&eased, time), state_at(&eased, time).linear_velocity, 2e-3);
    }
    // The control: the motion without `ease` is elsewhere, and jumps to its full speed.
    let abrupt = [plate(vec![lift(0.2, 0.0)])];
    assert!(state_at(&abrupt, 0.6).position.distance(state_at(&eased, 0.6).position) > 0.01);
    assert!(state_at(&abrupt, 0.5).linear_velocity.y > 0.1);
    // All of it may be rise and fall; nothing ends that never stops.
    let swing = [plate(vec![lift(0.4, 0.5)])];
    assert_close(state_at(&swing, 1.0).linear_velocity, Vec3::Y * 0.4, 1e-6);
    assert_close(state_at(&swing, 1.5).position, Vec3::Y * 0.3, 1e-6);
    let forever = Motion::Linear { velocity: Vec3::Y, start: 0.0, end: f32::INFINITY, ease: 1.0 };
    assert_close(state_at(&[plate(vec![forever])], 3.0).position, Vec3::Y * 2.6, 1e-6);
}

#[test]
fn a_turn_swings_the_body_about_its_pivot() {
    let bodies = [plate(vec![turn()])];
    let halfway = state_at(&bodies, 2.0);
    assert_close(halfway.position, Vec3::new(-0.1, 0.0, 0.0), 1e-7);
    assert_close(halfway.linear_velocity, Vec3::new(0.0, -0.1 * FRAC_PI_2, 0.0), 1e-7);
    assert_eq!(halfway.angular_velocity, Vec3::Z * FRAC_PI_2);
    let after = state_at(&bodies, 4.0);
    assert_close(after.position, Vec3::new(0.0, -0.1, 0.0), 1e-7);
    assert_close(after.rotation * Vec3::X, Vec3::NEG_X, 1e-6);
    assert_eq!((after.linear_velocity, after.angular_velocity), (Vec3::ZERO, Vec3::ZERO));
}

#[test]
fn the_velocity_is_the_derivative_of_the_pose() {
    let tilt = Motion::Turn {
        axis: Vec3::new(1.0, 2.0, -0.5),
        pivot: Vec3::new(0.3, -0.1, 0.2),
        rate: -1.3,
        start: 0.0,
        end: f32::INFINITY,
        ease: 0.0,
    };
    let drift = Motion::Linear { velocity: Vec3::new(0.4, 0.1, -0.3), start: 0.0, end: 10.0, ease: 0.0 };
    let bodies = [plate(vec![drift, turn(), tilt, lift()])];
    let (time, step) = (1.25, 1.0 / 256.0);
    let (before, now, after) =
        (state_at(&bodies, time - step), state_at(&bodies, time), state_at(&bodies, time + step));
    let slope = (after.position - before.position) / (2.0 * step);
    assert_close(now.linear_velocity, slope, 1e-4);
    let turned = (after.rotation * before.rotation.inverse()).normalize();
    let spin = turned.xyz() * (2.0 / (2.0 * step));
    assert_close(now.angular_velocity, spin, 1e-3);
    // Negative control: the comparison notices a velocity that misses the last motion.
    assert!((now.linear_velocity - Vec3::Y * 0.2).distance(slope) > 0.1);
}

#[test]
fn motions_apply_in_the_order_of_the_list() {
    let along = Motion::Linear { velocity: Vec3::X, start: 0.0, end: 1.0, ease: 0.0 };
    let half = Motion::Turn { axis: Vec3::Y, pivot: Vec3::ZERO, rate: PI, start: 0.0, end: 1.0, ease: 0.0 };
    let shifted_then_turned = state_at(&[plate(vec![along, half])], 2.0);
    let turned_then_shifted = state_at(&[plate(vec![half, along])], 2.0);
    assert_close(shifted_then_turned.position, Vec3::new(-1.0, 0.1, 0.0), 1e-6);
    assert_close(turned_then_shifted.position, Vec3::new(1.0, 0.1, 0.0), 1e-6);
}

#[test]
fn rounded_steps_do_not_prolong_a_motion() {
    for (dt, count) in [(0.01_f32, 100), (0.001, 1000), (1.0 / 60.0, 60), (0.1, 10)] {
        let motion = Motion::Linear { velocity: Vec3::X, start: 0.0, end: 1.0, ease: 0.0 };
        let mut engine = engine(&[plate(vec![motion])]);
        step(&mut engine, dt, count - 1);
        assert_eq!(engine.state(0).linear_velocity, Vec3::X, "one step of {dt} s before the end");
        step(&mut engine, dt, 1);
        assert_eq!(engine.state(0).linear_velocity, Vec3::ZERO, "after {count} steps of {dt} s");
        assert_eq!(engine.state(0).position.x, 1.0);
    }
}

#[test]
fn fixed_bodies_stay_and_ignore_wrenches() {
    let bodies = [body("floor", BodyKind::Fixed, Shape::Plane, Vec3::Y), plate(vec![lift()])];
    let mut engine = engine(&bodies);
    engine.step(0.1, &[impulse(1.0, 2.0, 3.0), impulse(1.0, 0.0, 0.0)]).expect("the wrenches are finite");
    assert_eq!(engine.state(0), at_rest(Vec3::Y));
    assert_eq!(
        (engine.body_count(), engine.kind(0), engine.kind(1)),
        (2, BodyKind::Fixed, BodyKind::Kinematic)
    );
    assert_eq!((engine.inverse_mass(1), engine.inverse_inertia(1)), (0.0, glam::Mat3::ZERO));
    assert!((engine.time() - 0.1).abs() < 1e-8);
}

#[test]
fn a_boxed_copy_continues_with_the_same_bits() {
    let mut engine: Box<dyn RigidEngine> = Box::new(engine(&[plate(vec![lift(), turn()])]));
    step(&mut *engine, 0.013, 60);
    let mut copy = engine.clone();
    step(&mut *engine, 0.017, 60);
    assert_ne!(bits(&*copy), bits(&*engine), "the copy must not move along");
    step(&mut *copy, 0.017, 60);
    assert_eq!(bits(&*copy), bits(&*engine));
}
