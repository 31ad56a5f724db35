//! Questions and answers in the buffers of a device.

use crate::layout::{constants, layout};

constants! {
    /// Particles near one ray that there is room for.
    pub(super) const NEAR_RAY: u32 = 4096;
    /// Lane of the length of a ray, beside its origin.
    const RAY_LENGTH: usize = 3;
    /// How far outside of a tet a point may lie to count as in it, over its size.
    const IN_TET: f32 = 1e-5;
    /// What stands for a coordinate of an image that there is not.
    const NO_IMAGE: f32 = 1.0e18;
    /// Share of the space around a point that is water at the surface.
    pub const SURFACE_SHARE: f32 = 0.5;
}

layout! {
    /// What all answers need.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub(super) struct Question {
        /// Points or rays.
        pub(super) count: u32,
        /// The first of this dispatch.
        pub(super) first: u32,
        /// How far away particles count.
        pub(super) radius: f32,
        /// Share of the space that a particle fills at its place, over the smoothing function there.
        pub(super) scale: f32,
        /// Way along a ray between two looks.
        pub(super) step: f32,
    }
}

layout! {
    /// An answer; what the lanes are is said where they are made.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub(super) struct QueryAnswer {
        pub(super) a: [f32; 4],
        pub(super) b: [f32; 4],
    }
}
