//! An absorbent sponge, the water it drinks and the bodies that squeeze it.

mod clock;
mod digest;
#[cfg(feature = "gpu")]
pub mod gpu;
#[cfg(not(feature = "gpu"))]
#[path = "no_gpu.rs"]
pub mod gpu;
mod measure;
#[cfg(feature = "render")]
pub mod render;
pub mod rigid;
pub mod scene;
pub mod schedule;
mod setup;
pub mod sponge;
mod stores;
mod world;

pub use clock::{Bound, Clock};
pub use measure::Measures;
pub use schedule::Offload;
pub use sorb_kernels::{KERNELS, SimdLevel, body, columns, cpu, kernel, kernel_named, need, params};
pub use world::{FrameReport, Options, StepError, StepReport, World, WorldError};

pub use glam;

/// The examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
#[derive(Debug)]
pub struct Readme;
