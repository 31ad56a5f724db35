//! The window of sorb: a scene or a recording that runs, and that mouse and sliders act on.
//!
//! `docs/view.md` of the source has keys and mouse. Behind the window there are two threads. One steps the world ([`simulation`]), the
//! other one draws copies of it ([`drawing`]). The window itself, which only shows pictures, takes the feature `window`.

pub mod drawing;
mod error;
pub mod facts;
mod facts_builder;
#[cfg(feature = "gpu")]
pub mod gpu_renderer;
pub mod hand;
pub mod orbit;
pub mod parameters;
pub mod quality;
pub mod session;
pub mod simulation;
#[cfg(feature = "window")]
mod window;

use std::path::PathBuf;

use sorb::{Options, Recording, Save, render::View, scene::Scene};

pub use error::ViewError;
pub use facts::Report;
#[cfg(feature = "window")]
pub use window::run;

/// What a window shows.
#[derive(Debug)]
pub enum Source {
    /// A scene, which runs.
    Scene(Box<Scene>),
    /// A recording, which is played.
    Recording(PathBuf, Box<Recording>),
    /// A save, which runs on.
    Save(PathBuf, Box<Save>),
}

/// How a window begins.
#[derive(Debug)]
pub struct Setup {
    /// What it shows.
    pub source: Source,
    /// Threads, SIMD level and backend of the world.
    pub options: Options,
    /// Width and height of the window in pixels, panels included.
    pub size: (u32, u32),
    /// What is drawn at first.
    pub view: View,
    /// Whether it waits for a key instead of running at once.
    pub paused: bool,
    /// File of a recording of all that happens; none without one.
    pub record: Option<PathBuf>,
    /// Simulated frames after which the window closes; by default it stays open.
    pub frames: Option<u64>,
    /// File of a picture of the window as it closes.
    pub screenshot: Option<PathBuf>,
    /// Whether it is drawn without a GPU even where there is one.
    pub software: bool,
}
