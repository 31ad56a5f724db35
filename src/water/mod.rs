//! Water that comes and goes: how much there was, and where there is room for more.

mod ranks;
mod room;

use serde::{Deserialize, Serialize};

pub(crate) use ranks::ranks;

/// Counts of particles since time zero. Saved once a command has changed any.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Water {
    /// Particles of the scene.
    pub(crate) seeded: u64,
    pub(crate) poured: u64,
    pub(crate) removed: u64,
    /// Places of pours in which there was no room.
    pub(crate) left_out: u64,
}

impl Water {
    /// Of a world that commands have not changed.
    pub(crate) fn of_scene(rows: usize) -> Self {
        Self { seeded: rows as u64, ..Self::default() }
    }

    /// Whether commands have changed anything.
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
        let Self { seeded, poured, removed, .. } = *self;
        let given = seeded.checked_add(poured).filter(|given| *given <= u64::from(u32::MAX));
        let Some(given) = given else { return Some(format!("{seeded} and {poured} particles")) };
        let present = given.checked_sub(removed);
        (present != Some(rows as u64)).then(|| format!("{given} particles, {removed} removed, {rows} there"))
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
    /// Those that were poured.
    pub poured: u64,
    /// Those that were removed.
    pub removed: u64,
    /// Those that are there.
    pub present: u64,
    /// Those of the present ones that sponges hold.
    pub absorbed: u64,
    /// Places of pours that were left out, because a body, a sponge, water or a wall was there. They never were particles.
    pub left_out: u64,
    /// `seeded + poured - removed - present`: always 0.
    pub lost: i64,
}
