//! Water that comes and goes: how much there was, and where there is room for more.

mod flow;
mod ranks;
mod room;

use serde::{Deserialize, Serialize};

use crate::scene::Scene;

pub(crate) use flow::{Flow, FlowKind, layer};
pub(crate) use ranks::ranks;
pub(crate) use room::{APART, Points, Room};

/// Counts of particles since time zero. Saved once a command has changed any.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Water {
    /// Particles of the scene.
    pub(crate) seeded: u64,
    pub(crate) poured: u64,
    pub(crate) removed: u64,
    pub(crate) drained: u64,
    /// Places of pours in which there was no room.
    pub(crate) left_out: u64,
    /// Emitters and drains that have not ended.
    pub(crate) flows: Vec<Flow>,
    /// Number of the next one.
    pub(crate) next_flow: u32,
}

impl Clone for Water {
    fn clone(&self) -> Self {
        let mut copy = Self::default();
        copy.clone_from(self);
        copy
    }

    /// In the same memory.
    fn clone_from(&mut self, from: &Self) {
        let Self { seeded, poured, removed, drained, left_out, next_flow, flows: _ } = *from;
        let mut flows = std::mem::take(&mut self.flows);
        flows.clone_from(&from.flows);
        *self = Self { seeded, poured, removed, drained, left_out, flows, next_flow };
    }
}

impl Water {
    /// Of a world that commands and flows have not changed.
    pub(crate) fn of_scene(scene: &Scene, rows: usize) -> Self {
        let flows = flow::of_scene(scene);
        Self { seeded: rows as u64, next_flow: flows.len() as u32, flows, ..Self::default() }
    }

    /// Whether commands or flows have changed anything, or may.
    pub(crate) fn is_changed(&self) -> bool {
        *self != Self { seeded: self.seeded, ..Self::default() }
    }

    /// Identities that were given to particles: the next one.
    pub(crate) fn identities(&self) -> u64 {
        self.seeded + self.poured
    }

    /// What is impossible with as many particles, if anything is.
    #[cfg(feature = "serde")]
    pub(crate) fn defect(&self, rows: usize) -> Option<String> {
        let Self { seeded, poured, removed, drained, .. } = *self;
        let given = seeded.checked_add(poured).filter(|given| *given <= u64::from(u32::MAX));
        let Some(given) = given else { return Some(format!("{seeded} and {poured} particles")) };
        let numbers: Vec<u32> = self.flows.iter().map(|flow| flow.number).collect();
        let is_twice = numbers.windows(2).any(|pair| pair[0] >= pair[1]);
        if is_twice || numbers.last().is_some_and(|last| *last >= self.next_flow) {
            return Some(format!("flows are not of different numbers below {}", self.next_flow));
        }
        if let Some(defect) = self.flows.iter().find_map(Flow::defect) {
            return Some(defect);
        }
        let present = given.checked_sub(removed).and_then(|rest| rest.checked_sub(drained));
        (present != Some(rows as u64))
            .then(|| format!("{given} particles, {removed} removed, {drained} drained, {rows} there"))
    }
}

/// Where all water of a world came from and went, in particles ([`World::ledger`](crate::World::ledger)).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Ledger {
    /// Mass of a particle \[kg\]; 0 without fluid.
    pub particle_mass: f32,
    /// Those that the scene began with.
    pub seeded: u64,
    /// Those that were poured, by commands and by emitters.
    pub poured: u64,
    /// Those that were removed.
    pub removed: u64,
    /// Those that drains have taken.
    pub drained: u64,
    /// Those that are there.
    pub present: u64,
    /// Those of the present ones that sponges hold.
    pub absorbed: u64,
    /// Places of pours that were left out, because a body, a sponge, water or a wall was there. They never were particles.
    pub left_out: u64,
    /// `seeded + poured - removed - drained - present`: always 0.
    pub lost: i64,
}
