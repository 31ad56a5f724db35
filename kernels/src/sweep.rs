//! Path of points through a step, and its first intersection with a body.
//!
//! In the frame of the body, which moves and rotates, a point moves on a straight line from p to q. Sphere tracing \[H96\]
//! follows it to the intersection x with the body:
//!
//! ```text
//! x = p,   x <- x + D(x) (q - p) / |q - p|   until D(x) is nearly 0, or more than what is left of the way
//! ```
//!
//! D is the distance from the surface less a margin, and n the normal there. The depth is that of q behind the tangent plane
//! at x, `D(x) + (q - x) . n`, not the distance of q, which may have passed the body. Pieces of bodies are convex, so that a point
//! outside of the plane is outside of the piece, at any speed and thickness.
//!
//! For particles the body is at its place of the end of the step, and a particle that begins below the margin goes no
//! deeper:
//!
//! ```text
//! q <- q - min(0, max(0, D(x)) + (q - x) . n) n
//! ```

use crate::{
    body::{Body, Piece, Placed},
    lanes::{self, Simd, f32x8, prelude::*, select},
    layout::constants,
    vector::{Vec3x8, dot, minus, plus, times},
};

constants! {
    /// Most steps along a way: one that passes a surface at a grazing angle ends as if it met it where they end.
    pub(crate) const ADVANCES: usize = 12;
    /// Distance that counts as nothing, over the length of the way.
    pub(crate) const SWEEP_TOLERANCE: f32 = 1.0e-3;
}

/// Intersections of paths with a body.
pub(crate) struct Met<S: Simd> {
    /// D(x) \[m\].
    pub(crate) distance: f32x8<S>,
    /// `(q - x) . n` \[m\].
    pub(crate) beyond: f32x8<S>,
    /// n, in the frame of the body.
    pub(crate) normal: Vec3x8<S>,
}

/// Follows paths from `from` to `to` in the frame of a body, to `margin` above its surface \[m\].
#[inline(always)]
pub(crate) fn met<S: Simd>(
    simd: S,
    body: &Placed<'_, S>,
    [from, to]: [Vec3x8<S>; 2],
    margin: f32x8<S>,
) -> Met<S> {
    let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
    let way = minus(to, from);
    let length = dot(way, way).sqrt();
    let direction = times(way, one / select(length.simd_gt(zero), length, one));
    let nearly = length * SWEEP_TOLERANCE;
    let (mut at, mut left) = (from, length);
    let (distance, mut normal) = body.local_distance(from);
    let mut distance = distance - margin;
    for _ in 0..ADVANCES {
        let goes = distance.simd_gt(nearly) & distance.simd_lt(left);
        if !goes.any_true() {
            break;
        }
        // Points that have arrived stay: the same position gives the same distance.
        let advance = select(goes, distance, zero);
        at = plus(at, times(direction, advance));
        left -= advance;
        let (next, next_normal) = body.local_distance(at);
        (distance, normal) = (next - margin, next_normal);
    }
    Met { distance, beyond: dot(minus(to, at), normal), normal }
}

/// A convex piece of a body before and after a step.
pub(crate) struct Swept<'a, S: Simd> {
    simd: S,
    before: Placed<'a, S>,
    after: Placed<'a, S>,
    margin: f32x8<S>,
}

impl<'a, S: Simd> Swept<'a, S> {
    /// Points keep a distance of `margin` from the surface \[m\].
    #[inline(always)]
    pub(crate) fn new(simd: S, [before, after]: [&Body; 2], piece: &'a Piece<'_>, margin: f32) -> Self {
        Self {
            simd,
            before: Placed::of_piece(simd, before, piece.geometry()),
            after: Placed::of_piece(simd, after, piece.geometry()),
            margin: lanes::splat(simd, margin + piece.radius),
        }
    }

    /// Correction of the positions `to` at the end of the step of points that begin it at `from`.
    #[inline(always)]
    pub(crate) fn correction(&self, from: Vec3x8<S>, to: Vec3x8<S>) -> Vec3x8<S> {
        let simd = self.simd;
        let zero = lanes::splat(simd, 0.0);
        let way = [self.before.local(from), self.after.local(to)];
        let Met { distance, beyond, normal } = met(simd, &self.before, way, self.margin);
        let beyond = lanes::positive(simd, distance) + beyond;
        let beyond = select(beyond.simd_lt(zero), beyond, zero);
        self.after.turned(times(normal, -beyond))
    }
}
