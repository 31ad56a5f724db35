//! Scripted poses and velocities, in closed form of the time.

use super::{BodyState, Motion, Target};
use glam::{DQuat, DVec3};

/// Relative distance below which the time counts as having reached the end of a motion.
///
/// A time summed from `f32` steps carries their rounding: 100 steps of 0.01 s end 2e-8 s short of 1 s. A motion that ends at
/// 1 s must be over by then.
const TIME_TOLERANCE: f64 = 2.0 * (f32::EPSILON as f64);

/// The start pose of a body and its motions.
#[derive(Debug)]
pub(crate) struct Script {
    start: BodyState,
    motions: Vec<Motion>,
    /// In place of the motions, once there is one.
    pub(super) target: Option<Target>,
}

impl Clone for Script {
    fn clone(&self) -> Self {
        Self { start: self.start, motions: self.motions.clone(), target: self.target }
    }

    /// In the same memory.
    fn clone_from(&mut self, from: &Self) {
        (self.start, self.target) = (from.start, from.target);
        self.motions.clone_from(&from.motions);
    }
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
        let start = (self.start.position.as_dvec3(), self.start.rotation.as_dquat());
        let Moved { position, rotation, linear, angular } = moved(start, &self.motions, time);
        BodyState {
            position: position.as_vec3(),
            rotation: rotation.normalize().as_quat(),
            linear_velocity: linear.as_vec3(),
            angular_velocity: angular.as_vec3(),
        }
    }
}

/// A pose and its derivative to the right of a time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moved {
    /// Position \[m\].
    pub(crate) position: DVec3,
    /// Rotation, of unit length but for rounding.
    pub(crate) rotation: DQuat,
    /// Velocity \[m/s\].
    pub(crate) linear: DVec3,
    /// Angular velocity \[rad/s\].
    pub(crate) angular: DVec3,
}

/// What motions make of a pose by a time \[s\]: every motion acts on the result of the motions before it in the list.
pub(crate) fn moved((mut position, mut rotation): (DVec3, DQuat), motions: &[Motion], time: f64) -> Moved {
    let mut linear = DVec3::ZERO;
    let mut angular = DVec3::ZERO;
    for motion in motions {
        match *motion {
            Motion::Linear { velocity, start, end, ease } => {
                let (elapsed, speed) = elapsed(time, start, end, ease);
                position += velocity.as_dvec3() * elapsed;
                if speed > 0.0 {
                    linear += velocity.as_dvec3() * speed;
                }
            }
            Motion::Shake { amplitude, frequency, start, end, ease } => {
                let (way, speed) = shaken(time, frequency, (start, end, ease));
                position += amplitude.as_dvec3() * way;
                linear += amplitude.as_dvec3() * speed;
            }
            Motion::Turn { axis, pivot, rate, start, end, ease } => {
                let (elapsed, speed) = elapsed(time, start, end, ease);
                let axis = axis.as_dvec3().normalize();
                let turn = axis_angle(axis, f64::from(rate) * elapsed);
                let arm = turn * (position - pivot.as_dvec3());
                position = pivot.as_dvec3() + arm;
                rotation = turn * rotation;
                linear = turn * linear;
                angular = turn * angular;
                if speed > 0.0 {
                    let spin = axis * (f64::from(rate) * speed);
                    linear += spin.cross(arm);
                    angular += spin;
                }
            }
        }
    }
    Moved { position, rotation, linear, angular }
}

/// Displacement over the amplitude of a shake \[1\], and its derivative to the right of `time` \[1/s\].
///
/// The amplitude grows as `3 u^2 - 2 u^3` within the time `ease`, and fades as its mirror image.
fn shaken(time: f64, frequency: f32, (start, end, ease): (f32, f32, f32)) -> (f64, f64) {
    let (start, end, ease) = (f64::from(start), f64::from(end), f64::from(ease));
    let is_over = time >= end * (1.0 - TIME_TOLERANCE);
    let is_on = time >= start * (1.0 - TIME_TOLERANCE) && !is_over;
    let until = if is_over { end } else { time };
    let (spent, left) = ((until - start).max(0.0), end - until);
    let rate = 2.0 * std::f64::consts::PI * f64::from(frequency);
    let (sine, cosine) = libm::sincos(rate * spent);
    let share = |time: f64| if ease > 0.0 { (time / ease).min(1.0) } else { 1.0 };
    let height = |u: f64| u * u * (3.0 - 2.0 * u);
    let slope = |u: f64| if ease > 0.0 { 6.0 * u * (1.0 - u) / ease } else { 0.0 };
    let (risen, to_fall) = (share(spent), share(left));
    let size = height(risen) * height(to_fall);
    let growth = slope(risen) * height(to_fall) - height(risen) * slope(to_fall);
    let speed = if is_on { growth * sine + size * rate * cosine } else { 0.0 };
    (size * sine, speed)
}

/// Time spent in `[start, end]` by `time`, as if at full speed, and the share of the full speed to the right of `time`.
///
/// The share rises as `3 u^2 - 2 u^3` within the time `ease`, whose integral is `u^3 - u^4 / 2`, and falls as its mirror image.
fn elapsed(time: f64, start: f32, end: f32, ease: f32) -> (f64, f64) {
    let (start, end, ease) = (f64::from(start), f64::from(end), f64::from(ease));
    let begun = time >= start * (1.0 - TIME_TOLERANCE);
    let over = time >= end * (1.0 - TIME_TOLERANCE);
    let until = if over { end } else { time };
    let (spent, left) = ((until - start).max(0.0), end - until);
    let full = if begun && !over { 1.0 } else { 0.0 };
    if ease == 0.0 {
        return (spent, full);
    }
    let share = |time: f64| (time / ease).min(1.0);
    let lag = |u: f64| ease * (u - u * u * u * (1.0 - 0.5 * u));
    let speed = |u: f64| u * u * (3.0 - 2.0 * u);
    let (risen, to_fall) = (share(spent), share(left));
    let way = spent - lag(risen) - (lag(1.0) - lag(to_fall));
    (way, full * speed(risen) * speed(to_fall))
}

/// The rotation by `angle` \[rad\] about a unit axis, with the same bits on every platform.
pub(super) fn axis_angle(axis: DVec3, angle: f64) -> DQuat {
    let (sin, cos) = libm::sincos(0.5 * angle);
    DQuat::from_xyzw(axis.x * sin, axis.y * sin, axis.z * sin, cos)
}
