//! Why a window could not be shown, or what ended it.

use std::{io, path::PathBuf};

use sorb::{
    CommandError, ReplayError, StateError, StepError, WorldError, render::RenderError, scene::SceneError,
};

/// Why a window could not be shown, or what ended it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ViewError {
    /// There is nothing to show a window on.
    #[error("no display was found: {0}\nwithout one, `sorb render SCENE FILE.png` draws a picture")]
    NoDisplay(String),
    /// The system refuses the window.
    #[error("the window cannot be shown: {0}")]
    Window(String),
    /// A scene is invalid with its changes.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A scene cannot be built, or the machine lacks a requested feature.
    #[error(transparent)]
    World(#[from] WorldError),
    /// The world failed.
    #[error("the simulation diverged: {0}")]
    Step(#[from] StepError),
    /// A command was refused.
    #[error(transparent)]
    Command(#[from] CommandError),
    /// A recording cannot be played.
    #[error("{}: {source}", path.display())]
    Replay {
        /// The file.
        path: PathBuf,
        /// Why.
        source: Box<ReplayError>,
    },
    /// A save is not usable, or a recording cannot be made.
    #[error("{}: {source}", path.display())]
    State {
        /// The file.
        path: PathBuf,
        /// Why.
        source: Box<StateError>,
    },
    /// A recording plays, on which nothing acts.
    #[error("a recording plays: nothing acts on it")]
    Plays,
    /// A scene without `[fluid]` has nothing to pour.
    #[error("the scene has no `fluid`: there is nothing to pour")]
    NoWater,
    /// A picture of the window cannot be written.
    #[error(transparent)]
    Picture(#[from] RenderError),
    /// A recording cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
}
