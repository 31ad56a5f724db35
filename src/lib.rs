//! An absorbent sponge, the water it drinks and the bodies that squeeze it.
//!
//! Build a [`Scene`](scene::Scene), make a [`World`] of it, step that and look at it. [`World`] has the views that a host needs, with unit
//! and shape. How the state is kept and which kernels a step has is no part of this face.

mod clock;
mod command;
mod coupler;
mod digest;
#[cfg(feature = "gpu")]
pub mod gpu;
#[cfg(not(feature = "gpu"))]
#[path = "no_gpu.rs"]
pub mod gpu;
mod handle;
#[doc(hidden)]
pub mod internal;
mod measure;
pub mod mesh;
mod query;
#[cfg(feature = "render")]
pub mod render;
#[cfg(feature = "serde")]
mod replay;
pub mod rigid;
pub mod scene;
mod schedule;
mod setup;
pub mod sponge;
mod state;
mod stopwatch;
mod stores;
mod text;
mod watcher;
mod water;
mod world;

pub use clock::{Bound, Clock};
pub use command::{Command, CommandError, Nodes, Region};
pub use coupler::{Coupler, SubStep};
pub use handle::{BodyHandle, FlowHandle, SpongeHandle};
pub use measure::Measures;
pub use query::{Hit, Probe, QueryError, Ray, SpongeProbe, Surface, Targets};
#[cfg(feature = "serde")]
pub use replay::{Mismatch, Player, Recorder, Recording, ReplayError};
pub use schedule::{Offload, OffloadError, PhaseTime, PlaceError};
pub use sorb_kernels::{
    SimdLevel,
    cpu::{Cpu, CpuError},
};
#[cfg(feature = "serde")]
pub use state::{Difference, Save};
pub use state::{Snapshot, StateError};
pub use watcher::{Event, Part, Touched, Watcher};
pub use water::Ledger;
pub use world::{BodyLoads, FrameReport, Load, Options, StepError, StepReport, World, WorldError};

pub use glam;
/// Types through which vectors and rotations of other crates become those of [`glam`], and back.
///
/// ```
/// use sorb::{glam::{Quat, Vec3}, mint};
///
/// let other = mint::Vector3 { x: 1.0, y: 2.0, z: 3.0 };
/// assert_eq!(Vec3::from(other), Vec3::new(1.0, 2.0, 3.0));
/// let back: mint::Quaternion<f32> = Quat::IDENTITY.into();
/// assert_eq!(back.s, 1.0);
/// ```
#[cfg(feature = "mint")]
pub use mint;

/// The examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
#[derive(Debug)]
pub struct Readme;
