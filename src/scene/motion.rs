//! Scripted motions of kinematic bodies.

use glam::Vec3;

use super::error::Problem;
use super::number::{number_text, vector_text};
use super::{Body, BodyState};
use crate::rigid::Script;

/// Whether a motion has its full speed from `start` to `end`.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands a reference")]
fn is_abrupt(ease: &f32) -> bool {
    *ease == 0.0
}

/// One scripted motion, active from `start` to `end`.
///
/// Motions may overlap. Each acts, in the order of the list, on the result of the previous ones. With `ease` the speed rises
/// from zero and falls to zero without a jump of the acceleration, and the way is `velocity * (end - start - ease)`.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "serde", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum Motion {
    /// Straight motion at constant velocity.
    Linear {
        /// Velocity, between rise and fall. Range -100 to 100 m/s.
        #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
        velocity: Vec3,
        /// Time at which the motion begins. Range 0 to 100000 s.
        start: f32,
        /// Time at which it ends, after `start`. Range 0 to 100000 s.
        end: f32,
        /// How long the speed rises after `start`, and falls before `end`: at most half of the motion. Range 0 to 100000 s;
        /// default 0.
        #[serde(default, skip_serializing_if = "is_abrupt")]
        ease: f32,
    },
    /// Rotation at constant rate about an axis in the world.
    Turn {
        /// Axis of rotation, of any length but zero. Range -1000 to 1000.
        #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
        axis: Vec3,
        /// A point on the axis. Range -1000 to 1000 m.
        #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
        pivot: Vec3,
        /// Rate, between rise and fall, counter-clockwise seen from the tip of the axis. Range -1000 to 1000 rad/s.
        rate: f32,
        /// Time at which the motion begins. Range 0 to 100000 s.
        start: f32,
        /// Time at which it ends, after `start`. Range 0 to 100000 s.
        end: f32,
        /// How long the speed rises after `start`, and falls before `end`: at most half of the motion. Range 0 to 100000 s;
        /// default 0.
        #[serde(default, skip_serializing_if = "is_abrupt")]
        ease: f32,
    },
    /// To and fro along a line: `amplitude * sin(2 pi frequency (time - start))`, which grows within `ease` and fades before the end.
    Shake {
        /// Largest displacement. Range -10 to 10 m.
        #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
        amplitude: Vec3,
        /// How often it goes to and fro. Range 0.001 to 1000 1/s.
        frequency: f32,
        /// Time at which the motion begins. Range 0 to 100000 s.
        start: f32,
        /// Time at which it ends, after `start`. Range 0 to 100000 s.
        end: f32,
        /// How long it grows after `start`, and fades before `end`: at most half of the motion. Range 0 to 100000 s;
        /// default 0.
        #[serde(default, skip_serializing_if = "is_abrupt")]
        ease: f32,
    },
}

impl Motion {
    /// Begin and end \[s\].
    #[must_use]
    pub fn interval(&self) -> (f32, f32) {
        match *self {
            Self::Linear { start, end, .. }
            | Self::Turn { start, end, .. }
            | Self::Shake { start, end, .. } => (start, end),
        }
    }

    /// How long the speed rises and falls \[s\].
    #[must_use]
    pub fn ease(&self) -> f32 {
        match *self {
            Self::Linear { ease, .. } | Self::Turn { ease, .. } | Self::Shake { ease, .. } => ease,
        }
    }

    /// Adds what is wrong with a motion whose numbers are in their ranges; `table` is such as `bodies[0].motions[1]`.
    pub(crate) fn rules(&self, table: &str, problems: &mut Vec<Problem>) {
        let mut broken = |field: &str, value: String, rule: String| {
            problems.push(Problem::rule(format!("{table}.{field}"), value, rule));
        };
        let (start, end) = self.interval();
        if start >= end {
            let rule = format!("must be before `end` = {}", number_text(end));
            broken("start", number_text(start), rule);
        } else if self.ease() > 0.5 * (end - start) {
            let half = number_text(0.5 * (end - start));
            let rule = format!("at most half of the time from `start` to `end`: {half}");
            broken("ease", number_text(self.ease()), rule);
        }
        if let Self::Turn { axis, .. } = self
            && axis.length_squared() < 1e-12
        {
            broken("axis", vector_text(*axis), "must not be zero".to_owned());
        }
    }
}

impl Body {
    /// Pose and velocity of the script at a time \[s\]; without motions the pose at time zero.
    ///
    /// Exact for every time: nothing accumulates from step to step.
    #[must_use]
    pub fn state_at(&self, time: f64) -> BodyState {
        Script::new(self.start(), &self.motions).state(time)
    }

    /// Pose and velocity at time zero, before any motion.
    #[must_use]
    pub fn start(&self) -> BodyState {
        BodyState {
            position: self.position,
            rotation: self.rotation.quaternion(),
            linear_velocity: self.linear_velocity,
            angular_velocity: self.angular_velocity,
        }
    }
}
