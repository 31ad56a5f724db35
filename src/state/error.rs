//! Errors of saved states.

use std::io;

use crate::{rigid::RigidError, world::StepError};

/// Why a state could not be saved, restored, compared or rolled back to.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StateError {
    /// The system refused to read or write.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// It is no file of the kind that was asked for.
    #[error("this is no {kind} of sorb: it begins with {found:?}")]
    Kind {
        /// `save` or `recording`.
        kind: &'static str,
        /// How it begins.
        found: String,
    },
    /// It has another version of the format.
    #[error("version {found} of the format of a {kind}; this library reads {supported}")]
    Version {
        /// `save` or `recording`.
        kind: &'static str,
        /// Its version.
        found: u32,
        /// The version that this library reads and writes.
        supported: u32,
    },
    /// It ends too early.
    #[error("truncated: {what} needs {needed} bytes, and {found} are left")]
    Truncated {
        /// What is not complete.
        what: &'static str,
        /// Its bytes.
        needed: u64,
        /// Those that are there.
        found: u64,
    },
    /// Its bytes are not those that were written.
    #[error("altered: its checksum is {found:016x} instead of {expected:016x}")]
    Altered {
        /// The checksum in it.
        expected: u64,
        /// That of its bytes.
        found: u64,
    },
    /// Its checksum is right, but what it says is impossible.
    #[error("not usable: {what}: {reason}")]
    Invalid {
        /// The part.
        what: String,
        /// What is wrong with it.
        reason: String,
    },
    /// It is of another scene than the world.
    #[error("it is a state of scene `{found}`, or of other keys, and the world is of scene `{expected}`")]
    Scene {
        /// Scene of the world.
        expected: String,
        /// Scene of the state.
        found: String,
    },
    /// The same scene has other parameters in the version of the library that wrote it.
    #[error("it was written by sorb {library}, which derives other parameters from the scene than {here}")]
    Parameters {
        /// Version that wrote it.
        library: String,
        /// This version.
        here: &'static str,
    },
    /// A world that has failed has no future.
    #[error("the world has failed and cannot be saved: {0}")]
    Failed(StepError),
    /// The engine of the bodies cannot be saved, or refused what was saved.
    #[error(transparent)]
    Engine(#[from] RigidError),
    /// The world of the scene cannot be built.
    #[error(transparent)]
    World(#[from] Box<crate::WorldError>),
    /// The scene in it cannot be read.
    #[cfg(feature = "serde")]
    #[error("scene: {0}")]
    Text(#[from] Box<crate::scene::SceneError>),
}
