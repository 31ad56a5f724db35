//! The whole state of a world: as bytes for digests and files, and as a copy to roll back to.
//!
//! The state is everything that decides the future and does not follow from the scene. It consists of the columns of the lives that are
//! saved ([`Life::is_saved`](sorb_kernels::column::Life::is_saved)), the engine of the bodies, the clock, sleep and commands. It is a list
//! of sections. Each has a name and bytes, so that two states are compared section by section.

mod body;
mod columns;
mod error;
#[cfg(feature = "serde")]
mod file;
#[cfg(feature = "serde")]
mod filter;
#[cfg(feature = "serde")]
mod header;
mod rest;
#[cfg(feature = "serde")]
mod save;
mod section;
mod snapshot;
#[cfg(feature = "serde")]
mod take;

pub(crate) use body::saved_columns;
pub(crate) use columns::take_column;
pub use error::StateError;
#[cfg(feature = "serde")]
pub(crate) use file::{Kind, read, write};
#[cfg(feature = "serde")]
pub(crate) use header::{Identity, scene_of};
#[cfg(feature = "serde")]
pub use save::{Difference, Save};
pub(crate) use section::append_column;
pub use snapshot::Snapshot;
#[cfg(feature = "serde")]
pub(crate) use take::invalid;

use sorb_kernels::{column::Life, columns::Column};
use xxhash_rust::xxh3::Xxh3;

use crate::{rigid::RigidError, world::World};

impl World {
    /// Digest of everything that decides the future. Equal digests mean equal bits, now and after every further step, on any
    /// machine, with any threads and SIMD level. On a GPU the state is read back.
    ///
    /// A rigid-body engine of a host that cannot be saved is left out; [`World::try_digest`] refuses it.
    #[must_use]
    pub fn digest(&self) -> u64 {
        self.digest_with(&mut Vec::new()).0
    }

    /// [`World::digest`], unless the engine cannot be saved.
    ///
    /// # Errors
    /// The engine of the bodies cannot be saved.
    pub fn try_digest(&self) -> Result<u64, StateError> {
        let (digest, engine) = self.digest_with(&mut Vec::new());
        engine?;
        Ok(digest)
    }

    /// The digest, in some memory. That of the engine is left out if it cannot be saved.
    pub(crate) fn digest_with(&self, bytes: &mut Vec<u8>) -> (u64, Result<(), RigidError>) {
        bytes.clear();
        let (sections, engine) = self.write_state(bytes);
        (digest_of(sections.iter().copied(), bytes), engine)
    }
}

/// Digest of a state with these sections. Columns that are kept for whoever looks at them decide nothing.
fn digest_of<'a>(sections: impl Iterator<Item = (&'a str, u64)>, bytes: &[u8]) -> u64 {
    let mut hasher = Xxh3::new();
    let mut rest = bytes;
    for (name, size) in sections {
        let (own, after) = rest.split_at(rest.len().min(size as usize));
        let is_kept = |column: Column| column.name() == name && column.life() == Life::Kept;
        if name != body::LOADS && !saved_columns().any(is_kept) {
            hasher.update(own);
        }
        rest = after;
    }
    hasher.digest()
}
