//! Checks of commands to sponges.

use glam::{Quat, Vec3};

use super::Check;
use crate::{
    handle::SpongeHandle,
    scene::{Material, Problem},
};

impl Check<'_> {
    /// A sponge that exists.
    pub(super) fn sponge(&mut self, key: &str, sponge: SpongeHandle) {
        let count = self.world.scene().sponges.len();
        if self.world.material(sponge).is_none() {
            let rule = format!("no such sponge; there are {count}, numbered from 0");
            self.rule(key, sponge.to_string(), rule);
        }
    }

    /// A place that is free.
    pub(super) fn place(&mut self, sponge: SpongeHandle, pose: (Vec3, Quat)) {
        if !self.problems.is_empty() || !self.knows_flows {
            return;
        }
        let placed = self.world.placed(sponge.index(), pose);
        if let Some(rule) = self.world.place_refusal(sponge.index(), &placed) {
            self.rule("place_sponge.position", pose.0.to_string(), rule);
        }
    }

    /// A material that the scene could have: its problems are those of the scene.
    pub(super) fn material(&mut self, sponge: usize, material: &Material) {
        if !self.problems.is_empty() {
            return;
        }
        let mut scene = self.world.scene().clone();
        material.put(&mut scene.sponges[sponge]);
        let table = format!("sponges[{sponge}].");
        let own = |problem: Problem| {
            let key = problem.key.strip_prefix(&table).map(|key| format!("material.{key}"));
            Problem { key: key.unwrap_or(problem.key), ..problem }
        };
        self.problems.extend(scene.problems().into_iter().map(own));
    }
}
