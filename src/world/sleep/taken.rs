//! Sleep that is taken over from a saved state.

use glam::Vec3;
use sorb_kernels::{asleep::Asleep, clock::Bound, columns::RowCounts};

use super::{Bounds, Places, Saved, Sleep, Way};
use crate::{
    clock::{Dormant, Steps},
    rigid::Target,
    world::World,
};

impl World {
    /// Sleep as it was saved in a world of the same scene with such rows, with positions at the last check and targets of bodies.
    ///
    /// # Errors
    /// What is saved does not belong to this scene: the reason.
    pub(crate) fn sleep_from(
        &self,
        saved: Saved,
        rows: RowCounts,
        places: [Vec<Vec3>; 2],
        targets: &[Option<Target>],
    ) -> Result<Sleep, String> {
        let mut parts = if saved.before.is_some() { self.parts_of(rows.fluid > 0) } else { Vec::new() };
        if saved.parts.len() != parts.len() {
            return Err(format!("{} parts that may sleep, and there are {}", saved.parts.len(), parts.len()));
        }
        let is_other = |ways: &Vec<Way>| ways.len() != parts.len();
        if saved.between.iter().any(is_other) || saved.between.len() > super::BETWEEN.len() {
            return Err("ways of other parts".to_owned());
        }
        if saved.gripped.iter().any(|sponge| *sponge >= self.scene.sponges.len()) {
            return Err("a sponge that does not exist is held".to_owned());
        }
        let [particles, nodes] = places;
        let before = match saved.before {
            None => None,
            Some((_, bodies)) if bodies.len() != rows.bodies => {
                return Err(format!("{} bodies, and there are {}", bodies.len(), rows.bodies));
            }
            Some(_) if (particles.len(), nodes.len()) != (rows.fluid, rows.nodes) => {
                return Err(format!("places of {} particles and {} nodes", particles.len(), nodes.len()));
            }
            Some((time, bodies)) => Some(Places { time, particles, nodes, bodies }),
        };
        for (part, (is_asleep, awake_since, corners)) in parts.iter_mut().zip(saved.parts) {
            (part.is_asleep, part.awake_since, part.bounds) = (is_asleep, awake_since, Bounds::new(corners));
        }
        let mut sleep = Sleep::new(&self.scene, &self.params);
        for (body, target) in targets.iter().enumerate() {
            target.iter().for_each(|target| sleep.follow(body, target));
        }
        (sleep.parts, sleep.is_asleep, sleep.before) = (parts, saved.is_asleep, before);
        (sleep.between, sleep.gripped) = (saved.between, saved.gripped);
        (sleep.watched, sleep.ways) = (saved.watched, saved.ways);
        Ok(sleep)
    }

    /// Applies the sleep of a state that was taken over. Unlike falling asleep and waking it changes no state.
    pub(crate) fn resume_sleep(&mut self, (constant, bound): (f32, u8)) {
        let dormant = self.sleep.dormant();
        let as_a_whole = self.sleeps_as_a_whole();
        let left_out = if as_a_whole { Dormant::default() } else { dormant };
        let rows = left_out.sponges.iter().flat_map(|sponge| self.node_rows(*sponge));
        self.params.asleep = Asleep::new(rows.collect());
        let bodies = &self.stores.host.bodies.states.0;
        self.steps = Steps::new(&self.scene, &self.params, bodies, &*self.engine, &left_out);
        if let Some(bound) = Bound::ALL.get(usize::from(bound)) {
            self.steps = self.steps.clone().with_constant(constant, *bound);
        }
        self.leave_out(&left_out);
    }
}
