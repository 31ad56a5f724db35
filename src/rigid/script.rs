//! Scripted poses and velocities, in closed form of the time.

use super::{BodyState, Motion, Target};
use glam::{DQuat, DVec3};

/// Relative distance below which the time counts as having reached the end of a motion.
///
/// A time summed from `f32` steps carries their rounding: 100 steps of 0.01 s end 2e-8 s short of 1 s. A motion that ends at
/// 1 s must be over by then.
const TIME_TOLERANCE: f64 = 2.0 * (f32::EPSILON as f64);

/// The start pose of a body and its motions.
#[derive(Clone, Debug)]
pub(crate) struct Script {
    start: BodyState,
    motions: Vec<Motion>,
    /// In place of the motions, once there is one.
    pub(super) target: Option<Target>,
}

impl Script {
    /// The motions must be valid and the rotation of unit length.
    pub(crate) fn new(start: BodyState, motions: &[Motion]) -> Self {
        Self { start, motions: motions.to_vec(), target: None }
    }

    /// Pose at `time` \[s\] and the exact derivative of the pose to the right of it.
    ///
    /// Every motion acts on the result of the motions before it in the list.
    pub(crate) fn state(&self, time: f64) -> BodyState {
        if let Some(target) = &self.target {
            return target.state(time);
        }
        if self.motions.is_empty() {
            return self.start;
        }
        let mut position = self.start.position.as_dvec3();
        let mut rotation = self.start.rotation.as_dquat();
        let mut linear = DVec3::ZERO;
        let mut angular = DVec3::ZERO;
        for motion in &self.motions {
            match *motion {
                Motion::Linear { velocity, start, end } => {
                    let (elapsed, active) = elapsed(time, start, end);
                    position += velocity.as_dvec3() * elapsed;
                    if active {
                        linear += velocity.as_dvec3();
                    }
                }
                Motion::Turn { axis, pivot, rate, start, end } => {
                    let (elapsed, active) = elapsed(time, start, end);
                    let axis = axis.as_dvec3().normalize();
                    let turn = axis_angle(axis, f64::from(rate) * elapsed);
                    let arm = turn * (position - pivot.as_dvec3());
                    position = pivot.as_dvec3() + arm;
                    rotation = turn * rotation;
                    linear = turn * linear;
                    angular = turn * angular;
                    if active {
                        let spin = axis * f64::from(rate);
                        linear += spin.cross(arm);
                        angular += spin;
                    }
                }
            }
        }
        BodyState {
            position: position.as_vec3(),
            rotation: rotation.normalize().as_quat(),
            linear_velocity: linear.as_vec3(),
            angular_velocity: angular.as_vec3(),
        }
    }
}

/// Time spent in `[start, end]` by `time`, and whether the motion continues after `time`.
fn elapsed(time: f64, start: f32, end: f32) -> (f64, bool) {
    let (start, end) = (f64::from(start), f64::from(end));
    let begun = time >= start * (1.0 - TIME_TOLERANCE);
    let over = time >= end * (1.0 - TIME_TOLERANCE);
    let until = if over { end } else { time };
    ((until - start).max(0.0), begun && !over)
}

/// The rotation by `angle` \[rad\] about a unit axis, with the same bits on every platform.
pub(super) fn axis_angle(axis: DVec3, angle: f64) -> DQuat {
    let (sin, cos) = libm::sincos(0.5 * angle);
    DQuat::from_xyzw(axis.x * sin, axis.y * sin, axis.z * sin, cos)
}
