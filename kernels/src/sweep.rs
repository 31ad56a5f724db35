//! The way of particles through a step, stopped where it would lead into a body.
//!
//! In the frame of the body, which moves and turns itself, a point goes straight from p to q. It is followed by steps that
//! are safe \[H96\], and may not go deeper than the surface where it meets the body first:
//!
//! ```text
//! x = p + t (q - p),   t <- t + D(x) / |q - p|   until D(x) is nearly 0
//! q <- q - min(0, max(0, D(x)) + (q - x) . n) n
//! ```
//!
//! D is the distance from the surface less a margin, n the normal there. What begins below the margin goes no deeper. No
//! speed and no wall is too thin for this: shapes are convex, so that what is outside of the plane at x is outside of the
//! body.

use crate::{
    body::{Body, Placed},
    lanes::{self, Simd, f32x8, prelude::*, select},
    vector::{Vec3x8, dot, minus, plus, times},
};

/// Most steps along a way: one that passes a surface at a grazing angle ends as if it met it where they end.
pub(crate) const ADVANCES: usize = 12;
/// Distance that counts as nothing, over the length that points are apart.
pub(crate) const NEARLY: f32 = 1.0e-3;

/// A body before and after a step.
pub(crate) struct Swept<'a, S: Simd> {
    simd: S,
    before: Placed<'a, S>,
    after: Placed<'a, S>,
    margin: f32x8<S>,
    nearly: f32x8<S>,
}

impl<'a, S: Simd> Swept<'a, S> {
    /// Points are kept `margin` away from the surface \[m\]; they are about `spacing` apart \[m\].
    #[inline(always)]
    pub(crate) fn new(simd: S, [before, after]: [&'a Body; 2], margin: f32, spacing: f32) -> Self {
        Self {
            simd,
            before: Placed::new(simd, before),
            after: Placed::new(simd, after),
            margin: lanes::splat(simd, margin),
            nearly: lanes::splat(simd, NEARLY * spacing),
        }
    }

    /// What has to be added to the places `to` at the end of the step of points that begin it at `from`.
    #[inline(always)]
    pub(crate) fn correction(&self, from: Vec3x8<S>, to: Vec3x8<S>) -> Vec3x8<S> {
        let simd = self.simd;
        let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
        let (from, to) = (self.before.local(from), self.after.local(to));
        let way = minus(to, from);
        let length = dot(way, way).sqrt();
        let rate = one / select(length.simd_gt(zero), length, one);
        let (distance, mut normal) = self.before.local_distance(from);
        let mut distance = distance - self.margin;
        let (mut at, mut time) = (from, zero);
        for _ in 0..ADVANCES {
            let goes = distance.simd_gt(self.nearly) & time.simd_lt(one);
            if !goes.any_true() {
                break;
            }
            // Points that have arrived stay: the same place gives the same distance.
            let advanced = (time + distance * rate).min(one);
            time = select(goes, advanced, time);
            at = plus(from, times(way, time));
            let (next, next_normal) = self.before.local_distance(at);
            (distance, normal) = (next - self.margin, next_normal);
        }
        let beyond = lanes::positive(simd, distance) + dot(minus(to, at), normal);
        let beyond = select(beyond.simd_lt(zero), beyond, zero);
        self.after.turned(times(normal, -beyond))
    }
}
