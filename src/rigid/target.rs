//! A pose that a kinematic body goes to, in closed form of the time.

use glam::{DQuat, DVec3, Quat, Vec3};
use serde::{Deserialize, Serialize};

use super::{BodyState, script::axis_angle};

/// A motion of a kinematic body at constant velocity and constant rate, from a pose to a pose.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Target {
    /// Position at the start \[m\].
    pub from: Vec3,
    /// Rotation at the start, of unit length.
    pub from_rotation: Quat,
    /// Position at the end \[m\].
    pub position: Vec3,
    /// Rotation at the end, of unit length; taken the shorter way round.
    pub rotation: Quat,
    /// Time of the start \[s\].
    pub start: f64,
    /// Time of the end, after the start \[s\].
    pub end: f64,
}

impl Target {
    /// Velocity on the way \[m/s\].
    #[must_use]
    pub fn velocity(&self) -> DVec3 {
        (self.position.as_dvec3() - self.from.as_dvec3()) / (self.end - self.start)
    }

    /// Axis of unit length and angle of the turn \[rad\].
    fn turn(&self) -> (DVec3, f64) {
        let turn = self.rotation.as_dquat() * self.from_rotation.as_dquat().conjugate();
        let turn = if turn.w < 0.0 { -turn } else { turn };
        let axis = DVec3::new(turn.x, turn.y, turn.z);
        let sine = axis.length();
        if sine == 0.0 { (DVec3::X, 0.0) } else { (axis / sine, 2.0 * libm::atan2(sine, turn.w)) }
    }

    /// Angular velocity on the way \[rad/s\].
    #[must_use]
    pub fn angular_velocity(&self) -> DVec3 {
        let (axis, angle) = self.turn();
        axis * (angle / (self.end - self.start))
    }

    /// Pose at a time \[s\], and its derivative to the right of it.
    #[must_use]
    pub fn state(&self, time: f64) -> BodyState {
        let at_rest = |position, rotation| BodyState {
            position,
            rotation,
            linear_velocity: Vec3::ZERO,
            angular_velocity: Vec3::ZERO,
        };
        if time >= self.end {
            return at_rest(self.position, self.rotation);
        }
        if time < self.start {
            return at_rest(self.from, self.from_rotation);
        }
        let share = (time - self.start) / (self.end - self.start);
        let (axis, angle) = self.turn();
        let rotation: DQuat = axis_angle(axis, angle * share) * self.from_rotation.as_dquat();
        let from = self.from.as_dvec3();
        BodyState {
            position: (from + (self.position.as_dvec3() - from) * share).as_vec3(),
            rotation: rotation.normalize().as_quat(),
            linear_velocity: self.velocity().as_vec3(),
            angular_velocity: self.angular_velocity().as_vec3(),
        }
    }

    /// Whether a body can follow it.
    pub(crate) fn is_valid(&self) -> bool {
        let unit = |rotation: Quat| (rotation.length_squared() - 1.0).abs() < 1e-3;
        let is_finite = self.from.is_finite() && self.position.is_finite();
        is_finite && unit(self.rotation) && unit(self.from_rotation) && self.start < self.end
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_target_is_reached_exactly_and_its_velocity_is_the_derivative() {
        let target = Target {
            from: Vec3::new(0.1, 0.2, 0.3),
            from_rotation: Quat::from_rotation_x(0.3),
            position: Vec3::new(0.4, 0.1, 0.3),
            rotation: Quat::from_rotation_y(1.2),
            start: 2.0,
            end: 2.5,
        };
        let rest = target.state(2.5);
        assert_eq!((rest.position, rest.rotation), (target.position, target.rotation));
        assert_eq!((rest.linear_velocity, rest.angular_velocity), (Vec3::ZERO, Vec3::ZERO));
        assert_eq!(target.state(1.0).position, target.from);
        let (a, b, now) = (target.state(2.249), target.state(2.251), target.state(2.25));
        let linear = (b.position - a.position) / 0.002;
        assert!(linear.distance(now.linear_velocity) < 1e-3, "{linear} {}", now.linear_velocity);
        let turn = b.rotation * a.rotation.conjugate();
        let angular = 2.0 * Vec3::new(turn.x, turn.y, turn.z) / 0.002;
        assert!(angular.distance(now.angular_velocity) < 1e-2, "{angular} {}", now.angular_velocity);
        let near = target.state(2.5 - 1e-9);
        assert!(near.rotation.dot(target.rotation).abs() > 1.0 - 1e-6);
    }
}
