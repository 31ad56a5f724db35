//! Water that flows in and out: emitters and drains.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::{
    error::Problem,
    limits::{self, Limit, Row},
    number::{number_text, vector_text},
    validate::check,
};

/// Slowest stream \[m/s\]: its layers follow each other by a spacing.
const SLOWEST: f32 = 0.01;

/// Latest end \[s\].
const LATEST: f32 = 1e5;

/// A stream out of a disc across its velocity. It brings `pi radius^2 |velocity|` \[m^3/s\], as particles a spacing apart. Those of one
/// layer come one after the other: a stream that falls stays whole.
///
/// Particles are left out where there is no room: in bodies, sponges and water, and outside of the container.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "serde", derive(schemars::JsonSchema))]
pub struct Emitter {
    /// Centre of the disc. Range -1000 to 1000 m; default (0, 0, 0).
    #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
    pub position: Vec3,
    /// Velocity of the water, in all at least 0.01 m/s. Range -100 to 100 m/s; default (0, -0.5, 0).
    #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
    pub velocity: Vec3,
    /// Radius of the disc; with less than half of `fluid.spacing` single particles follow each other. Range 1e-4 to 10 m; default 0.01.
    pub radius: f32,
    /// Time at which the stream begins. Range 0 to 100000 s; default 0.
    pub start: f32,
    /// Time at which it ends, after `start`. Range 0 to 100000 s; default 100000.
    pub end: f32,
}

impl Default for Emitter {
    fn default() -> Self {
        let velocity = Vec3::new(0.0, -0.5, 0.0);
        Self { position: Vec3::ZERO, velocity, radius: 0.01, start: 0.0, end: LATEST }
    }
}

/// A box out of which water is taken, as fast as it comes or at a rate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "serde", derive(schemars::JsonSchema))]
pub struct Drain {
    /// Lowest corner. Range -1000 to 1000 m; default (0, 0, 0).
    #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
    pub minimum: Vec3,
    /// Highest corner, above the lowest along every axis. Range -1000 to 1000 m; default (0.01, 0.01, 0.01).
    #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
    pub maximum: Vec3,
    /// Mass that it takes at most. Range 1e-6 to 1e6 kg/s; default 1e6.
    pub rate: f32,
    /// Time at which it opens. Range 0 to 100000 s; default 0.
    pub start: f32,
    /// Time at which it closes, after `start`. Range 0 to 100000 s; default 100000.
    pub end: f32,
}

impl Default for Drain {
    fn default() -> Self {
        Self { minimum: Vec3::ZERO, maximum: Vec3::splat(0.01), rate: 1e6, start: 0.0, end: LATEST }
    }
}

pub(super) const EMITTER: &[Row<Emitter>] = limits::fields! { Emitter, "emitters[].";
    position: -1000.0 to 1000.0, "m";
    velocity: -100.0 to 100.0, "m/s";
    radius: 1e-4 to 10.0, "m";
    start: 0.0 to 1e5, "s";
    end: 0.0 to 1e5, "s";
};

pub(super) const DRAIN: &[Row<Drain>] = limits::fields! { Drain, "drains[].";
    minimum: -1000.0 to 1000.0, "m";
    maximum: -1000.0 to 1000.0, "m";
    rate: 1e-6 to 1e6, "kg/s";
    start: 0.0 to 1e5, "s";
    end: 0.0 to 1e5, "s";
};

fn interval(table: &str, start: f32, end: f32, problems: &mut Vec<Problem>) {
    if end <= start {
        let rule = format!("must be after `{table}start` = {}", number_text(start));
        problems.push(Problem::rule(format!("{table}end"), number_text(end), rule));
    }
}

impl Emitter {
    /// Its problems, with keys of a table such as `emitters[0].`.
    pub(crate) fn problems(&self, table: &str) -> Vec<Problem> {
        let mut problems = Vec::new();
        check(self, EMITTER, table, &mut problems);
        if !problems.is_empty() {
            return problems;
        }
        interval(table, self.start, self.end, &mut problems);
        if self.velocity.length() < SLOWEST {
            let rule = format!("must be at least {SLOWEST} m/s in all");
            problems.push(Problem::rule(format!("{table}velocity"), vector_text(self.velocity), rule));
        }
        problems
    }
}

impl Drain {
    /// Its problems, with keys of a table such as `drains[0].`.
    pub(crate) fn problems(&self, table: &str) -> Vec<Problem> {
        let mut problems = Vec::new();
        check(self, DRAIN, table, &mut problems);
        if !problems.is_empty() {
            return problems;
        }
        interval(table, self.start, self.end, &mut problems);
        if !self.minimum.cmplt(self.maximum).all() {
            let rule =
                format!("must be above `{table}minimum` = {} along every axis", vector_text(self.minimum));
            problems.push(Problem::rule(format!("{table}maximum"), vector_text(self.maximum), rule));
        }
        problems
    }
}
