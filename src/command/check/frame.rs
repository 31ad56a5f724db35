//! Checks of motions of the container and of gravity over time.

use super::Check;
use crate::scene::{GravityKey, Motion, container_problems};

impl Check<'_> {
    /// Keys from now on.
    pub(super) fn gravity_path(&mut self, path: &[GravityKey]) {
        self.problems.extend(GravityKey::problems(path, "gravity_path.path"));
        self.not_empty("gravity_path.path", path.len());
        if let Some(key) = path.first() {
            self.not_past("gravity_path.path[0].time", key.time);
        }
    }

    /// Motions that begin now or later, where they are possible.
    pub(super) fn container(&mut self, motions: &[Motion]) {
        let world = self.world;
        self.problems.extend(container_problems(motions, "container.motions", world.scene()));
        self.not_empty("container.motions", motions.len());
        for (index, motion) in motions.iter().enumerate() {
            self.not_past(&format!("container.motions[{index}].start"), motion.interval().0);
        }
    }

    pub(super) fn not_empty(&mut self, key: &str, count: usize) {
        if count == 0 {
            self.rule(key, "[]".to_owned(), "must not be empty".to_owned());
        }
    }

    /// A time from now on, but for the rounding of an `f32`. Commands of a saved state have waited.
    pub(super) fn not_past(&mut self, key: &str, time: f32) {
        let now = self.world.clock().time;
        if self.knows_flows && f64::from(time) < now * (1.0 - f64::from(f32::EPSILON)) {
            self.rule(key, time.to_string(), format!("must not be before the present time, {now} s"));
        }
    }
}
