use glam::Vec3;
use std::f32::consts::PI;

use super::super::*;

fn close(a: Vec3, b: Vec3) -> bool {
    (a - b).length() < 1e-5
}

fn scripted(motions: Vec<Motion>) -> Body {
    Body::kinematic("plate", ShapeKind::Sphere { radius: 0.01 }, Vec3::new(1.0, 0.0, 0.0), motions)
}

#[test]
fn a_linear_motion_acts_between_start_and_end_only() {
    let body = scripted(vec![Motion::Linear {
        velocity: Vec3::new(0.0, 2.0, 0.0),
        start: 1.0,
        end: 2.0,
        ease: 0.0,
    }]);
    for (time, height, speed) in
        [(0.0, 0.0, 0.0), (1.0, 0.0, 2.0), (1.5, 1.0, 2.0), (2.0, 2.0, 0.0), (9.0, 2.0, 0.0)]
    {
        let state = body.state_at(time);
        assert!(close(state.position, Vec3::new(1.0, height, 0.0)), "{time}: {state:?}");
        assert!(close(state.linear_velocity, Vec3::new(0.0, speed, 0.0)), "{time}: {state:?}");
    }
}

#[test]
fn a_turn_moves_and_turns_the_body() {
    let quarter = Motion::Turn {
        axis: 2.0 * Vec3::Y,
        pivot: Vec3::ZERO,
        rate: 0.5 * PI,
        start: 0.0,
        end: 1.0,
        ease: 0.0,
    };
    let body = scripted(vec![quarter]);
    let start = body.state_at(0.0);
    assert!(close(start.angular_velocity, Vec3::new(0.0, 0.5 * PI, 0.0)));
    assert!(close(start.linear_velocity, Vec3::new(0.0, 0.0, -0.5 * PI)));
    let end = body.state_at(1.0);
    assert!(close(end.position, Vec3::new(0.0, 0.0, -1.0)), "{end:?}");
    assert!(close(end.rotation * Vec3::X, Vec3::new(0.0, 0.0, -1.0)));
    assert_eq!(end.linear_velocity, Vec3::ZERO);
}

#[test]
fn velocities_are_the_derivatives_of_the_pose() {
    let body = scripted(vec![
        Motion::Linear { velocity: Vec3::new(0.3, 0.1, 0.0), start: 0.2, end: 5.0, ease: 0.0 },
        Motion::Turn {
            axis: Vec3::new(1.0, 2.0, 0.5),
            pivot: Vec3::Y,
            rate: 1.5,
            start: 0.1,
            end: 5.0,
            ease: 0.0,
        },
        Motion::Turn { axis: Vec3::Z, pivot: Vec3::X, rate: -0.7, start: 0.3, end: 5.0, ease: 0.0 },
    ]);
    let (time, step) = (1.3, 1e-3);
    let (before, now, after) = (body.state_at(time - step), body.state_at(time), body.state_at(time + step));
    let slope = (after.position - before.position) / 2e-3;
    assert!((slope - now.linear_velocity).length() < 1e-3, "{slope} {now:?}");
    let turned = (after.rotation * before.rotation.inverse()).to_scaled_axis() / 2e-3;
    assert!((turned - now.angular_velocity).length() < 2e-3, "{turned} {now:?}");
    // The same comparison notices a motion that is missing.
    let other = scripted(body.motions[..2].to_vec()).state_at(time);
    assert!((slope - other.linear_velocity).length() > 0.1);
}

#[test]
fn a_body_without_motions_stays() {
    let body = Body::fixed("wall", ShapeKind::Plane, Vec3::X);
    assert_eq!(body.state_at(0.0), body.state_at(1e4));
}

#[test]
fn rotations_turn_counter_clockwise_in_degrees() {
    let quaternion = Rotation::new(Vec3::new(0.0, 0.0, 5.0), 90.0).quaternion();
    assert!(close(quaternion * Vec3::X, Vec3::Y));
    assert!(quaternion.is_normalized());
    assert_eq!(Rotation::new(Vec3::ZERO, 90.0).quaternion(), glam::Quat::IDENTITY);
}

#[test]
fn an_invalid_script_does_not_panic() {
    let body = scripted(vec![Motion::Linear { velocity: Vec3::X, start: 2.0, end: 1.0, ease: 0.0 }]);
    assert_eq!(body.state_at(1.5).position, Vec3::X);
}
