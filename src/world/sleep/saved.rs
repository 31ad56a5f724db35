//! What a saved state holds of sleep.

use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

use sorb_kernels::reduce::Wrenches;

use super::{Sleep, Way};
use crate::{clock::Dormant, world::World};

/// Sleeping parts and the data of the decision, without the positions of particles and nodes at the last check.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Saved {
    /// Of every part: whether it sleeps, time since which it is awake \[s\], and the corners of its box \[m\].
    pub(super) parts: Vec<(bool, f64, [Vec3; 2])>,
    pub(super) is_asleep: bool,
    /// Time of the last check \[s\], and the bodies at it.
    pub(super) before: Option<(f64, Vec<(Vec3, Quat)>)>,
    pub(super) between: Vec<Vec<Way>>,
    pub(super) gripped: Vec<usize>,
    pub(super) watched: f64,
    pub(super) ways: [f32; 2],
}

impl Sleep {
    /// What is saved.
    pub(crate) fn saved(&self) -> Saved {
        Saved {
            parts: self
                .parts
                .iter()
                .map(|part| (part.is_asleep, part.awake_since, part.bounds.corners()))
                .collect(),
            is_asleep: self.is_asleep,
            before: self.before.as_ref().map(|before| (before.time, before.bodies.clone())),
            between: self.between.clone(),
            gripped: self.gripped.clone(),
            watched: self.watched,
            ways: self.ways,
        }
    }

    /// Positions of particles, by identity, and of nodes at the last check; empty before it.
    pub(crate) fn places_before(&self) -> [&[Vec3]; 2] {
        self.before.as_ref().map_or([&[], &[]], |before| [&before.particles, &before.nodes])
    }

    /// Takes over the sleep of another world of the same scene, in the same memory.
    pub(crate) fn copy(&mut self, from: &Self) {
        self.motions.clone_from(&from.motions);
        self.carried.clone_from(&from.carried);
        self.parts.clone_from(&from.parts);
        self.is_asleep = from.is_asleep;
        match &from.before {
            Some(other) => {
                let mut own = self.before.take().unwrap_or_else(|| std::mem::take(&mut self.spare));
                own.copy(other);
                self.before = Some(own);
            }
            None => self.spare = self.before.take().unwrap_or_default(),
        }
        self.between.clone_from(&from.between);
        self.gripped.clone_from(&from.gripped);
        (self.watched, self.ways) = (from.watched, from.ways);
    }
}

impl World {
    /// Steps leave out parts: no wrenches of theirs are left, and a device knows them.
    pub(crate) fn leave_out(&mut self, dormant: &Dormant) {
        let are_sponges_asleep = dormant.sponges.len() == self.present_sponges().count();
        let store = &mut self.stores.host.bodies;
        // The wrenches of phases that are left out would not be renewed.
        if dormant.fluid {
            store.fluid_wrenches = Wrenches::default();
        }
        if are_sponges_asleep {
            store.node_wrenches = Wrenches::default();
        }
        let is_outside = are_sponges_asleep && !dormant.fluid;
        let awake = self.awake();
        if let Some(device) = &mut self.stores.device {
            device.set_asleep(awake, &self.params.asleep, &self.steps, is_outside);
        }
    }
}
