//! Friction at a no-slip surface; `wall_friction` has the derivation.

use crate::{
    lanes::{self, Simd, f32x8},
    layout::constants,
    params::FluidParams,
    vector::{Vec3x8, dot, minus, times},
};

constants! {
    /// Least distance over H.
    const MINIMUM_FRICTION_DISTANCE: f32 = 0.125;
}

/// f(y) \[1/s\], without the limit by the step; by rounding it may be slightly below zero at the end of its range.
#[inline(always)]
pub(super) fn friction_rate<S: Simd>(simd: S, fluid: &FluidParams, distance: f32x8<S>) -> f32x8<S> {
    let radius = fluid.smoothing.support_radius;
    let kinematic = 90.0 * fluid.wall_viscosity / (fluid.rest_density * radius * radius);
    let q = distance * (1.0 / radius);
    let q = q.max(lanes::splat(simd, MINIMUM_FRICTION_DISTANCE)).min(lanes::splat(simd, 1.0));
    let square = q * q;
    let fourth = square * square;
    let integral =
        lanes::splat(simd, 0.025) - square * (1.0 / 12.0) + fourth * 0.125 - fourth * q * (1.0 / 15.0);
    integral * kinematic / q
}

/// Components of vectors along a surface.
#[inline(always)]
pub(crate) fn along<S: Simd>(vector: Vec3x8<S>, normal: Vec3x8<S>) -> Vec3x8<S> {
    minus(vector, times(normal, dot(vector, normal)))
}
