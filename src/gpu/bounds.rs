//! Bounds of a step on a device.

use sorb_kernels::gpu::StepLimits;

use crate::clock::{Bound, PRESSURE_COURANT, Steps};

impl Bound {
    /// All bounds, in the order of their numbers in shaders.
    const ALL: [Self; 11] = [
        Self::Maximum,
        Self::Frame,
        Self::Courant,
        Self::Acceleration,
        Self::Viscosity,
        Self::SurfaceTension,
        Self::Suction,
        Self::Elasticity,
        Self::SpongeSpeed,
        Self::Pressure,
        Self::BodySpeed,
    ];

    /// The bound of a number; the first for unknown numbers.
    pub(super) fn from_index(index: u32) -> Self {
        Self::ALL.get(index as usize).copied().unwrap_or(Self::Maximum)
    }
}

impl Steps {
    /// Limits with which a device chooses steps itself.
    pub(super) fn limits(&self) -> StepLimits {
        StepLimits {
            courant: self.time.courant,
            pressure_courant: PRESSURE_COURANT,
            edge: self.edge,
            has_fluid: self.has_fluid,
            minimum: self.time.minimum_step,
            constant: self.constant.0,
            constant_bound: Bound::ALL.iter().position(|bound| *bound == self.constant.1).unwrap_or(0) as u32,
        }
    }
}
