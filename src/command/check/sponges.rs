//! Checks of commands to sponges.

use glam::{Quat, Vec3};

use super::Check;
use crate::{
    handle::SpongeHandle,
    scene::{Material, Problem, REMOVED, Scene, Sponge},
};

impl Check<'_> {
    /// A sponge that is there, now and once the commands that wait are carried out.
    pub(super) fn sponge(&mut self, key: &str, sponge: SpongeHandle) {
        if !self.knows_flows {
            return;
        }
        let slots = self.world.sponge_slots_after_commands();
        let will_be = slots.of(sponge.index(), sponge.generation()).is_some();
        let rule = if !will_be {
            let count = slots.count();
            format!("no such sponge; there are {count}, numbered from 0, and one that was removed is gone")
        } else if !self.world.has_sponge(sponge) {
            "a command that waits adds it; take a step first".to_owned()
        } else {
            return;
        };
        self.rule(key, sponge.to_string(), rule);
    }

    /// A sponge that the scene could have, with the next handle, where nothing is.
    pub(super) fn add_sponge(&mut self, sponge: SpongeHandle, description: &Sponge) {
        let world = self.world;
        if self.knows_flows {
            let next = world.next_sponge();
            if sponge != next {
                let rule = format!("no handle is used twice; the next one is {next}");
                self.rule("add_sponge.sponge", sponge.to_string(), rule);
                return;
            }
        }
        if description.name.starts_with(REMOVED) {
            let rule = format!("names of sponges that were removed begin with `{REMOVED}`");
            self.rule("add_sponge.description.name", format!("{:?}", description.name), rule);
        }
        let index = sponge.index().min(world.scene().sponges.len());
        #[cfg(feature = "gpu")]
        if world.stores.device.is_some() && index >= sorb_kernels::gpu::MAXIMUM_SPONGES {
            let rule = format!("a GPU takes at most {} sponges", sorb_kernels::gpu::MAXIMUM_SPONGES);
            self.rule("add_sponge.sponge", sponge.to_string(), rule);
        }
        let scene = world.scene_with_sponge(index, description.clone());
        self.as_of_scene(&scene, index, "add_sponge.description");
        let now = world.scene();
        let is_coupled = !now.sponges.is_empty() && scene.coupling() != now.coupling();
        if is_coupled || scene.fluid_solver() != now.fluid_solver() {
            let rule = "with this sponge the water would be solved or coupled in another way".to_owned();
            self.rule("add_sponge.description.solver", format!("{:?}", description.solver), rule);
        }
        if !self.problems.is_empty() || !self.knows_flows {
            return;
        }
        if let Some(rule) = world.sponge_refusal(description) {
            self.rule("add_sponge.description.position", description.position.to_string(), rule);
        }
    }

    /// Problems of a scene, of which those of a sponge have keys of another table.
    fn as_of_scene(&mut self, scene: &Scene, index: usize, table: &str) {
        let own = format!("sponges[{index}]");
        let named = |problem: Problem| {
            let key = problem.key.strip_prefix(&own).map(|key| format!("{table}{key}"));
            Problem { key: key.unwrap_or(problem.key), ..problem }
        };
        self.problems.extend(scene.problems().into_iter().map(named));
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
    pub(super) fn material(&mut self, sponge: SpongeHandle, material: &Material) {
        if !self.problems.is_empty() || !self.world.has_sponge(sponge) {
            return;
        }
        let mut scene = self.world.scene().clone();
        material.put(&mut scene.sponges[sponge.index()]);
        self.as_of_scene(&scene, sponge.index(), "material");
    }
}
