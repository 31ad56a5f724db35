//! The container in motion, and gravity over time.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::error::Problem;
use super::limits::{self, Limit, MOTION, Row};
use super::number::number_text;
use super::validate::check;
use super::{Motion, Scene};

/// The motion of the container: of its walls, and of everything that is at rest in it.
///
/// Positions and velocities are those in the container. What is felt there of the motion are a gravity that turns, and the accelerations
/// of a frame that is not inertial. Fixed bodies move with the container, the motions of kinematic ones are relative to it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "serde", derive(schemars::JsonSchema))]
pub struct Container {
    /// Its motions, as of kinematic bodies, in the frame in which the container is at rest at time zero; default none. They need an
    /// `ease` above 0: the acceleration is finite then.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub motions: Vec<Motion>,
}

impl Container {
    /// Whether it stays where it is.
    #[must_use]
    pub fn is_still(&self) -> bool {
        self.motions.is_empty()
    }
}

/// Gravity at a time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "serde", derive(schemars::JsonSchema))]
pub struct GravityKey {
    /// When. Range 0 to 100000 s.
    pub time: f32,
    /// Acceleration of gravity then. Range -100 to 100 m/s^2.
    #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
    pub gravity: Vec3,
}

pub(super) const GRAVITY_KEY: &[Row<GravityKey>] = limits::fields! { GravityKey, "gravity_path[].";
    time: 0.0 to 1e5, "s";
    gravity: -100.0 to 100.0, "m/s^2";
};

impl GravityKey {
    /// The problems of a path, with keys such as `gravity_path[0].time`.
    pub(crate) fn problems(path: &[Self], table: &str) -> Vec<Problem> {
        let mut problems = Vec::new();
        for (index, key) in path.iter().enumerate() {
            check(key, GRAVITY_KEY, &format!("{table}[{index}]."), &mut problems);
        }
        if !problems.is_empty() {
            return problems;
        }
        for (index, pair) in (1..).zip(path.windows(2)) {
            if pair[1].time <= pair[0].time {
                let rule =
                    format!("must be after `{table}[{}].time` = {}", index - 1, number_text(pair[0].time));
                let key = format!("{table}[{index}].time");
                problems.push(Problem::rule(key, number_text(pair[1].time), rule));
            }
        }
        problems
    }
}

/// The problems of motions of the container, with keys such as `container.motions[0].ease`.
pub(crate) fn container_problems(motions: &[Motion], table: &str, scene: &Scene) -> Vec<Problem> {
    let mut problems = Vec::new();
    for (index, motion) in motions.iter().enumerate() {
        check(motion, MOTION, &format!("{table}[{index}]."), &mut problems);
    }
    if !problems.is_empty() {
        return problems;
    }
    for (index, motion) in motions.iter().enumerate() {
        let table = format!("{table}[{index}]");
        motion.rules(&table, &mut problems);
        if motion.ease() == 0.0 {
            let rule =
                "must be above 0: a container that is at full speed at once has no finite acceleration";
            problems.push(Problem::rule(format!("{table}.ease"), "0", rule));
        }
        if matches!(motion, Motion::Turn { .. }) && scene.periodic().contains(&true) {
            let rule = "a container with periodic axes cannot turn: its images would have other places";
            problems.push(Problem::rule(format!("{table}.kind"), "\"turn\"", rule));
        }
    }
    problems
}
