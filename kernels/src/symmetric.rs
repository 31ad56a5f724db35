//! Symmetric matrices of eight particles.

use crate::{
    lanes::{self, Simd, f32x8},
    vector::{Vec3x8, dot},
};

/// Eight symmetric matrices of three rows.
#[derive(Clone, Copy)]
pub(crate) struct Symmetric<S: Simd> {
    /// xx, yy, zz
    pub(crate) along: Vec3x8<S>,
    /// yz, zx, xy
    pub(crate) between: Vec3x8<S>,
}

impl<S: Simd> Symmetric<S> {
    /// The same number everywhere.
    #[inline(always)]
    pub(crate) fn splat(simd: S, value: f32) -> Self {
        let value = lanes::splat(simd, value);
        Self { along: [value; 3], between: [value; 3] }
    }

    /// Adds `a b^T` of parallel vectors.
    #[inline(always)]
    pub(crate) fn add_square(&mut self, a: Vec3x8<S>, b: Vec3x8<S>) {
        self.along[0] += a[0] * b[0];
        self.along[1] += a[1] * b[1];
        self.along[2] += a[2] * b[2];
        self.between[0] += a[1] * b[2];
        self.between[1] += a[2] * b[0];
        self.between[2] += a[0] * b[1];
    }

    /// Adds `a b^T`, with both elements between two axes in one.
    #[inline(always)]
    pub(crate) fn add_twice(&mut self, a: Vec3x8<S>, b: Vec3x8<S>) {
        self.along[0] += a[0] * b[0];
        self.along[1] += a[1] * b[1];
        self.along[2] += a[2] * b[2];
        self.between[0] += a[1] * b[2] + a[2] * b[1];
        self.between[1] += a[2] * b[0] + a[0] * b[2];
        self.between[2] += a[0] * b[1] + a[1] * b[0];
    }

    /// Product with a number.
    #[inline(always)]
    pub(crate) fn scaled(self, scale: f32x8<S>) -> Self {
        let ([a, b, c], [d, e, f]) = (self.along, self.between);
        Self { along: [a * scale, b * scale, c * scale], between: [d * scale, e * scale, f * scale] }
    }

    /// The product with itself.
    #[inline(always)]
    pub(crate) fn squared(self) -> Self {
        let ([xx, yy, zz], [yz, zx, xy]) = (self.along, self.between);
        let (x, y, z) = ([xx, xy, zx], [xy, yy, yz], [zx, yz, zz]);
        Self { along: [dot(x, x), dot(y, y), dot(z, z)], between: [dot(y, z), dot(z, x), dot(x, y)] }
    }

    /// Product with a vector.
    #[inline(always)]
    pub(crate) fn times(self, v: Vec3x8<S>) -> Vec3x8<S> {
        let ([xx, yy, zz], [yz, zx, xy]) = (self.along, self.between);
        [dot([xx, xy, zx], v), dot([xy, yy, yz], v), dot([zx, yz, zz], v)]
    }

    /// Sum of the products of all elements.
    #[inline(always)]
    pub(crate) fn contracted(self, other: Self) -> f32x8<S> {
        let between = dot(self.between, other.between);
        dot(self.along, other.along) + between + between
    }

    /// The inverse.
    #[inline(always)]
    pub(crate) fn inverse(self, simd: S) -> Self {
        let ([xx, yy, zz], [yz, zx, xy]) = (self.along, self.between);
        let along = [yy * zz - yz * yz, zz * xx - zx * zx, xx * yy - xy * xy];
        let between = [zx * xy - xx * yz, xy * yz - yy * zx, yz * zx - zz * xy];
        let determinant = xx * along[0] + xy * between[2] + zx * between[1];
        Self { along, between }.scaled(lanes::splat(simd, 1.0) / determinant)
    }
}
