//! Periodic axes: what leaves the box on one side enters it on the other, and pairs interact across the sides.
//!
//! Particles stay in the box. Two of them are at most one period apart, and one shift leads to the nearest image. A particle
//! interacts with at most one image of another, because a period is longer than two support radii.

use glam::Vec3;

use crate::{
    lanes::{self, LANES, Simd, f32x8, select},
    vector::{Vec3x8, minus, plus, splat},
};

/// A box with periodic axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Periodic {
    low: Vec3,
    high: Vec3,
    axes: [bool; 3],
}

impl Periodic {
    /// A box from corner to corner \[m\] with the marked axes periodic; none if no axis is.
    #[must_use]
    pub fn new(low: Vec3, high: Vec3, axes: [bool; 3]) -> Option<Self> {
        axes.contains(&true).then_some(Self { low, high, axes })
    }

    /// Length of the box along its periodic axes, and zero along the others \[m\].
    #[must_use]
    pub fn periods(&self) -> Vec3 {
        Vec3::select(self.axes.into(), self.high - self.low, Vec3::ZERO)
    }

    /// Half of the periods; along the other axes larger than any distance.
    #[must_use]
    pub(crate) fn halves(&self) -> Vec3 {
        Vec3::select(self.axes.into(), 0.5 * (self.high - self.low), Vec3::MAX)
    }

    /// Corners of the box \[m\].
    #[must_use]
    pub fn corners(&self) -> (Vec3, Vec3) {
        (self.low, self.high)
    }

    /// A difference of two places in the box, with the nearest image of the second.
    #[must_use]
    pub(crate) fn nearest(&self, apart: Vec3) -> Vec3 {
        let periods = self.periods();
        let across = apart.abs().cmpgt(self.halves());
        Vec3::select(across, apart - periods * apart.signum(), apart)
    }

    /// `point` with the middle of the box along periodic axes.
    #[must_use]
    pub(crate) fn centred(&self, point: Vec3) -> Vec3 {
        Vec3::select(self.axes.into(), 0.5 * (self.low + self.high), point)
    }

    /// Wraps a point into the box along periodic axes; values that are not finite stay so.
    pub(crate) fn wrap(&self, point: &mut [f32; 4]) {
        for axis in (0..3).filter(|axis| self.axes[*axis]) {
            let (low, high) = (self.low[axis], self.high[axis]);
            if (low..high).contains(&point[axis]) {
                continue;
            }
            let period = high - low;
            let inside = point[axis] - period * ((point[axis] - low) / period).floor();
            point[axis] = inside.clamp(low, high);
        }
    }

    /// Replaces `shifts` by those of the images of the box that come within the radius of a box in it, without the box
    /// itself.
    pub(crate) fn shifts(&self, low: [f32; 3], high: [f32; 3], radius: f32, shifts: &mut Vec<[f32; 3]>) {
        shifts.clear();
        shifts.push([0.0; 3]);
        let periods = self.periods();
        for axis in (0..3).filter(|axis| self.axes[*axis]) {
            for at in 0..shifts.len() {
                for (touches, shift) in [
                    (low[axis] - radius <= self.low[axis], -periods[axis]),
                    (high[axis] + radius >= self.high[axis], periods[axis]),
                ] {
                    if touches {
                        let mut shifted = shifts[at];
                        shifted[axis] = shift;
                        shifts.push(shifted);
                    }
                }
            }
        }
        shifts.remove(0);
    }
}

/// Difference of positions: the only thing in which passes over neighbours differ with periodic axes. Space without them has
/// a type of its own, so that it pays nothing.
pub(crate) trait Space<S: Simd>: Copy {
    /// `a - b`, with the nearest image of b.
    fn apart(self, a: Vec3x8<S>, b: Vec3x8<S>) -> Vec3x8<S>;

    /// `point`, relative to a, for the image of a that is nearest to the rows `entry` of `positions`.
    fn seen_from(
        self,
        simd: S,
        a_and_point: (Vec3x8<S>, Vec3x8<S>),
        positions: &[[f32; 4]],
        entry: &[u32; LANES],
    ) -> Vec3x8<S>;
}

/// Space without periodic axes.
#[derive(Clone, Copy)]
pub(crate) struct Plain;

impl<S: Simd> Space<S> for Plain {
    #[inline(always)]
    fn apart(self, a: Vec3x8<S>, b: Vec3x8<S>) -> Vec3x8<S> {
        minus(a, b)
    }

    #[inline(always)]
    fn seen_from(
        self,
        _simd: S,
        (_, point): (Vec3x8<S>, Vec3x8<S>),
        _positions: &[[f32; 4]],
        _entry: &[u32; LANES],
    ) -> Vec3x8<S> {
        point
    }
}

/// Space with periodic axes.
#[derive(Clone, Copy)]
pub(crate) struct Repeated<S: Simd> {
    zero: f32x8<S>,
    periods: Vec3x8<S>,
    halves: Vec3x8<S>,
}

impl<S: Simd> Repeated<S> {
    #[inline(always)]
    pub(crate) fn new(simd: S, periodic: &Periodic) -> Self {
        let (periods, halves) = (periodic.periods().to_array(), periodic.halves().to_array());
        Self { zero: lanes::splat(simd, 0.0), periods: splat(simd, periods), halves: splat(simd, halves) }
    }

    /// Shift from the difference of two positions to that of the nearest image. Padding rows are farther away than any
    /// period: one shift leaves them there.
    #[inline(always)]
    fn shift(self, apart: Vec3x8<S>) -> Vec3x8<S> {
        [self.shift_along(apart[0], 0), self.shift_along(apart[1], 1), self.shift_along(apart[2], 2)]
    }

    #[inline(always)]
    fn shift_along(self, apart: f32x8<S>, axis: usize) -> f32x8<S> {
        let (period, half) = (self.periods[axis], self.halves[axis]);
        let up = select(apart.simd_lt(-half), period, self.zero);
        select(apart.simd_gt(half), -period, up)
    }
}

impl<S: Simd> Space<S> for Repeated<S> {
    #[inline(always)]
    fn apart(self, a: Vec3x8<S>, b: Vec3x8<S>) -> Vec3x8<S> {
        let apart = minus(a, b);
        plus(apart, self.shift(apart))
    }

    #[inline(always)]
    fn seen_from(
        self,
        simd: S,
        (a, point): (Vec3x8<S>, Vec3x8<S>),
        positions: &[[f32; 4]],
        entry: &[u32; LANES],
    ) -> Vec3x8<S> {
        let [x, y, z, _] = lanes::gather_rows(simd, positions, entry);
        plus(point, self.shift(minus(a, [x, y, z])))
    }
}

/// Runs an expression that is generic over the SIMD token and the space of `params` at the level of the CPU context.
macro_rules! with_space {
    ($cpu:expr, $params:expr, $simd:ident, $space:ident => $body:expr) => {
        match &$params.periodic {
            None => $crate::lanes::with_lanes!($cpu, $simd => {
                let $space = $crate::periodic::Plain;
                $body
            }),
            Some(periodic) => $crate::lanes::with_lanes!($cpu, $simd => {
                let $space = $crate::periodic::Repeated::new($simd, periodic);
                $body
            }),
        }
    };
}
pub(crate) use with_space;
