//! Errors of building a world, and of steps.

use sorb_kernels::cpu::CpuError;

use crate::{clock::Bound, rigid::RigidError, scene::SceneError, schedule::PlanError, sponge::LatticeError};

/// Why a world could not be built.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WorldError {
    /// The scene has values that are out of range or contradict each other.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The lattice of a sponge cannot be made.
    #[error(transparent)]
    Lattice(#[from] LatticeError),
    /// The corners of a hull do not span a volume.
    #[cfg(feature = "rigid")]
    #[error("body `{body}`: {source}")]
    Hull {
        /// Name of the body.
        body: String,
        /// The defect.
        source: crate::rigid::HullError,
    },
    /// A mesh is of no use.
    #[error("{what}: {source}")]
    Mesh {
        /// Such as "body `cup`".
        what: String,
        /// The defect.
        source: crate::mesh::MeshError,
    },
    /// A body or a sponge needs rapier3d, or its parry3d.
    #[error("{what}: convex hulls, cups and meshes need the feature `rigid`")]
    NeedsRigid {
        /// Such as "body `cup`".
        what: String,
    },
    /// Sponges lie inside each other, which contact could not separate.
    #[error("sponges `{first}` and `{second}` overlap by more than half an edge: move one of them")]
    Overlap {
        /// Name of a sponge.
        first: String,
        /// Name of another.
        second: String,
    },
    /// A body has bad values.
    #[error(transparent)]
    Rigid(#[from] RigidError),
    /// A velocity that a host gives a particle is out of range.
    #[error(
        "particle {id}: velocity {velocity:?} m/s is out of range, -{maximum} to {maximum} m/s on every axis"
    )]
    Velocity {
        /// Identity of the particle.
        id: u32,
        /// The given velocity \[m/s\].
        velocity: [f32; 3],
        /// Largest component in range \[m/s\].
        maximum: f32,
    },
    /// A change that is possible before the first step only.
    #[error("velocities can be set before the first step only, and {steps} were taken")]
    Started {
        /// Steps taken.
        steps: u64,
    },
    /// Threads or SIMD level.
    #[error(transparent)]
    Cpu(#[from] CpuError),
    /// The step contradicts the declaration of a kernel.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// A GPU was requested, and the feature `gpu` is off.
    #[error("backend `{0}`: built without the feature `gpu`")]
    NeedsGpu(crate::schedule::Offload),
    /// Kernels are requested at places where they cannot run.
    #[error(transparent)]
    Place(#[from] crate::schedule::PlaceError),
    /// A GPU was requested, and no usable one exists.
    #[error(transparent)]
    Gpu(#[from] crate::gpu::GpuError),
}

/// Why a step failed. The world keeps the state after the step and takes no further steps.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StepError {
    /// A particle's position or velocity is not a finite number.
    #[error("step {step} at {time:.6} s: particle {id} is no longer finite after `sph::advect`")]
    Particle {
        /// Identity of the particle.
        id: u32,
        /// Steps taken.
        step: u64,
        /// Simulated time \[s\].
        time: f64,
    },
    /// A node's position is not a finite number.
    #[error("step {step} at {time:.6} s: node {node} is no longer finite after `pbd::velocity`")]
    Node {
        /// Row of the node.
        node: u32,
        /// Steps taken.
        step: u64,
        /// Simulated time \[s\].
        time: f64,
    },
    /// Stability requires a step below `time.minimum_step`.
    #[error(
        "step {step} at {time:.6} s: `{}` asks for a step of {needed:e} s, below time.minimum_step = {minimum:e} s",
        .bound.name()
    )]
    TooSmall {
        /// The bound that requires it.
        bound: Bound,
        /// The required step \[s\].
        needed: f32,
        /// `time.minimum_step` \[s\].
        minimum: f32,
        /// Steps taken.
        step: u64,
        /// Simulated time \[s\].
        time: f64,
    },
    /// The steps of a scene whose first water has come, or whose last has gone, cannot be placed where the options say.
    #[error("water that came or went: {0}")]
    Water(String),
    /// The steps of a scene that commands have changed cannot be planned or placed.
    #[error("the changed scene: {0}")]
    Scene(String),
    /// The engine of the bodies failed.
    #[error("rigid bodies: {0}")]
    Rigid(String),
    /// The GPU failed. [`crate::World::move_to`] continues from the state that was read back last. A clone that was made
    /// before continues as well: it uploads its state anew.
    #[error(transparent)]
    Gpu(#[from] crate::gpu::GpuError),
}
