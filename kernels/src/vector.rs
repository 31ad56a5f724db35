//! Vectors of eight points or directions.
//!
//! Plain functions that are always inlined. A closure passed to `array::map` may be compiled separately, without the instruction set of the
//! kernel around it. Every operation in it is then a call.

use crate::lanes::{self, Simd, f32x8, select};

/// Eight points or directions, by coordinate.
pub(crate) type Vec3x8<S> = [f32x8<S>; 3];

/// The same vector in all lanes.
#[inline(always)]
pub(crate) fn splat<S: Simd>(simd: S, [x, y, z]: [f32; 3]) -> Vec3x8<S> {
    [lanes::splat(simd, x), lanes::splat(simd, y), lanes::splat(simd, z)]
}

/// Sum.
#[inline(always)]
pub(crate) fn plus<S: Simd>(a: Vec3x8<S>, b: Vec3x8<S>) -> Vec3x8<S> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// Difference.
#[inline(always)]
pub(crate) fn minus<S: Simd>(a: Vec3x8<S>, b: Vec3x8<S>) -> Vec3x8<S> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Opposite.
#[inline(always)]
pub(crate) fn negative<S: Simd>(a: Vec3x8<S>) -> Vec3x8<S> {
    [-a[0], -a[1], -a[2]]
}

/// Product with a scalar per lane.
#[inline(always)]
pub(crate) fn times<S: Simd>(a: Vec3x8<S>, scale: f32x8<S>) -> Vec3x8<S> {
    [a[0] * scale, a[1] * scale, a[2] * scale]
}

/// Dot product.
#[inline(always)]
pub(crate) fn dot<S: Simd>(a: Vec3x8<S>, b: Vec3x8<S>) -> f32x8<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Cross product.
#[inline(always)]
pub(crate) fn cross<S: Simd>(a: Vec3x8<S>, b: Vec3x8<S>) -> Vec3x8<S> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Lanes where `condition` holds from `yes`, else from `no`.
#[inline(always)]
pub(crate) fn choose<S: Simd>(condition: lanes::mask32x8<S>, yes: Vec3x8<S>, no: Vec3x8<S>) -> Vec3x8<S> {
    [select(condition, yes[0], no[0]), select(condition, yes[1], no[1]), select(condition, yes[2], no[2])]
}
