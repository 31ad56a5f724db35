//! Errors of the command, with their exit codes.

use std::{io, path::PathBuf};

use sorb::{ReplayError, StateError, StepError, WorldError, render::RenderError, scene::SceneError};

/// Error of the command.
#[derive(Debug, thiserror::Error)]
pub(crate) enum CliError {
    /// A scene that `sorb check` read is invalid, or a case of `sorb validate` is out of bounds.
    #[error("{0}")]
    CheckFailed(String),
    /// Arguments name something that does not exist.
    #[error("{0}")]
    Usage(String),
    /// A scene cannot be read or used.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A scene cannot be built, or the machine lacks a requested feature.
    #[error(transparent)]
    World(#[from] WorldError),
    /// A picture cannot be written.
    #[error(transparent)]
    Picture(#[from] RenderError),
    /// A diagram cannot be drawn.
    #[cfg(feature = "validation")]
    #[error("{0}")]
    Drawing(String),
    /// The water has no mesh.
    #[cfg(feature = "surface")]
    #[error("the surface of the water cannot be made: {0}")]
    Surface(String),
    /// A file or folder of the results cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
    /// A file cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
    /// A save or a recording is not usable, or cannot be written.
    #[error("{}: {source}", path.display())]
    State {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: Box<StateError>,
    },
    /// A recording cannot be played to its end.
    #[error("{}: {source}", path.display())]
    Replay {
        /// The file.
        path: PathBuf,
        /// Why.
        source: Box<ReplayError>,
    },
    /// Standard output cannot be written.
    #[error("cannot write to standard output: {0}")]
    Output(io::Error),
    /// The results cannot be written as JSON; never for finite or missing numbers.
    #[error("cannot write the summary: {0}")]
    Summary(#[from] serde_json::Error),
    /// The simulation diverged; everything before that has been written.
    #[error("the simulation diverged: {error}\nwhat it did until then is in {}", folder.display())]
    Diverged {
        /// Cause, place and time.
        error: StepError,
        /// The out folder.
        folder: PathBuf,
    },
    /// The simulation of a film diverged.
    #[error("the simulation diverged: {0}")]
    Step(StepError),
    /// The window cannot be shown, or what it shows failed.
    #[cfg(feature = "view")]
    #[error(transparent)]
    View(#[from] sorb_view::ViewError),
    /// The GPU failed; everything before that has been written.
    #[error("{error}\nwhat was done until then is in {}", folder.display())]
    Gpu {
        /// Cause.
        error: StepError,
        /// The out folder.
        folder: PathBuf,
    },
}

impl CliError {
    /// Adds the file to an error of the system.
    pub(crate) fn write(path: impl Into<PathBuf>) -> impl FnOnce(io::Error) -> Self {
        let path = path.into();
        |source| Self::Write { path, source }
    }

    /// Adds the file to an error of reading it.
    pub(crate) fn read(path: impl Into<PathBuf>) -> impl FnOnce(io::Error) -> Self {
        let path = path.into();
        |source| Self::Read { path, source }
    }

    /// Adds the file to an error of a save or a recording.
    pub(crate) fn state(path: impl Into<PathBuf>) -> impl FnOnce(StateError) -> Self {
        let path = path.into();
        |source| Self::State { path, source: Box::new(source) }
    }

    /// Adds the file to an error of playing it.
    pub(crate) fn replay(path: impl Into<PathBuf>) -> impl FnOnce(ReplayError) -> Self {
        let path = path.into();
        |source| Self::Replay { path, source: Box::new(source) }
    }

    /// Exit code of the command.
    pub(crate) fn code(&self) -> u8 {
        match self {
            Self::CheckFailed(_) => 1,
            Self::Replay { source, .. } if matches!(**source, ReplayError::Mismatch(_)) => 1,
            Self::Replay { source, .. } if matches!(**source, ReplayError::Step { .. }) => 3,
            Self::Diverged { .. } | Self::Step(_) => 3,
            _ => 2,
        }
    }
}
