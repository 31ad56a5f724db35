//! Eight lanes of f32, with the scalar level written out lane by lane.
//!
//! The scalar emulation of the SIMD library makes an operation on eight lanes from two on four, and copies arrays in loops
//! for that. Each sum has five loops. They vanish only after all of a kernel is inlined into one function. That took four
//! fifths of the time to build the kernels.

use std::ops::{Add, AddAssign, Div, Index, Mul, MulAssign, Neg, Sub, SubAssign};

use fearless_simd::{f32x4, f32x8 as Native, mask32x8, prelude::*};

use super::{LANES, Simd};

/// Eight lanes of f32.
#[expect(non_camel_case_types, reason = "named as the vectors of the SIMD library")]
#[derive(Clone, Copy, Debug)]
pub(crate) struct f32x8<S: Simd>(Native<S>);

/// An array with the value of an expression for `K` from 0 to 7.
macro_rules! by_lane {
    ($lane:ident => $value:expr) => {
        by_lane!($lane => $value; 0 1 2 3 4 5 6 7)
    };
    ($lane:ident => $value:expr; $($index:literal)*) => {
        [$({
            const $lane: usize = $index;
            $value
        }),*]
    };
}

impl<S: Simd> f32x8<S> {
    #[inline(always)]
    fn token(self) -> S {
        self.0.token()
    }

    #[inline(always)]
    pub(crate) fn splat(simd: S, value: f32) -> Self {
        if S::IS_SCALAR { Self::load_array(simd, [value; LANES]) } else { Self(Native::splat(simd, value)) }
    }

    #[inline(always)]
    pub(crate) fn from_slice(simd: S, values: &[f32]) -> Self {
        Self(Native::from_slice(simd, values))
    }

    #[inline(always)]
    pub(crate) fn load_array(simd: S, values: [f32; LANES]) -> Self {
        Self(Native::load_array(simd, values))
    }

    #[inline(always)]
    pub(crate) fn load_array_ref(simd: S, values: &[f32; LANES]) -> Self {
        Self(Native::load_array_ref(simd, values))
    }

    #[inline(always)]
    pub(crate) fn from_fn(simd: S, value: impl FnMut(usize) -> f32) -> Self {
        Self(Native::from_fn(simd, value))
    }

    /// The lanes that are marked, one after the other; what the others hold is not said.
    #[inline(always)]
    pub(crate) fn compress(self, marked: mask32x8<S>) -> Self {
        Self(self.token().compress_f32x8(self.0, marked))
    }

    /// Two times four lanes.
    #[inline(always)]
    pub(super) fn combine(low: f32x4<S>, high: f32x4<S>) -> Self {
        if S::IS_SCALAR {
            let (low_lanes, high_lanes) = (low.to_array(), high.to_array());
            let [[a, b, c, d], [e, f, g, h]] = [low_lanes, high_lanes];
            Self::load_array(low.token(), [a, b, c, d, e, f, g, h])
        } else {
            Self(low.combine(high))
        }
    }

    /// The lower and the upper four lanes.
    #[inline(always)]
    pub(super) fn split(self) -> (f32x4<S>, f32x4<S>) {
        if S::IS_SCALAR {
            let ([a, b, c, d, e, f, g, h], simd) = (self.to_array(), self.token());
            (f32x4::load_array(simd, [a, b, c, d]), f32x4::load_array(simd, [e, f, g, h]))
        } else {
            self.0.split()
        }
    }

    #[inline(always)]
    pub(crate) fn to_array(self) -> [f32; LANES] {
        self.0.to_array()
    }

    #[inline(always)]
    pub(crate) fn store_slice(self, values: &mut [f32]) {
        self.0.store_slice(values);
    }

    #[inline(always)]
    pub(crate) fn select(condition: mask32x8<S>, yes: Self, no: Self) -> Self {
        if S::IS_SCALAR {
            let condition: [i32; LANES] = condition.into();
            let (yes, no, simd) = (yes.to_array(), no.to_array(), yes.token());
            Self::load_array(simd, by_lane!(K => if condition[K] != 0 { yes[K] } else { no[K] }))
        } else {
            Self(condition.select(yes.0, no.0))
        }
    }
}

macro_rules! functions {
    ($($name:ident($($other:ident)?);)*) => {$(
        impl<S: Simd> f32x8<S> {
            #[inline(always)]
            pub(crate) fn $name(self $(, $other: Self)?) -> Self {
                if S::IS_SCALAR {
                    let a = self.to_array();
                    $(let $other = $other.to_array();)?
                    Self::load_array(self.token(), by_lane!(K => f32::$name(a[K] $(, $other[K])?)))
                } else {
                    Self(self.0.$name($($other.0)?))
                }
            }
        }
    )*};
}
functions! { abs(); sqrt(); floor(); min(other); max(other); }

macro_rules! comparisons {
    ($($name:ident $operator:tt)*) => {$(
        impl<S: Simd> f32x8<S> {
            #[inline(always)]
            pub(crate) fn $name(self, other: Self) -> mask32x8<S> {
                if S::IS_SCALAR {
                    let (a, b) = (self.to_array(), other.to_array());
                    mask32x8::simd_from(self.token(), by_lane!(K => -i32::from(a[K] $operator b[K])))
                } else {
                    self.0.$name(other.0)
                }
            }
        }
    )*};
}
comparisons! { simd_lt < simd_le <= simd_gt > simd_ge >= }

macro_rules! operators {
    ($($operator_trait:ident $name:ident $operator:tt)*) => {$(
        impl<S: Simd> $operator_trait for f32x8<S> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                if S::IS_SCALAR {
                    let (a, b) = (self.to_array(), other.to_array());
                    Self::load_array(self.token(), by_lane!(K => a[K] $operator b[K]))
                } else {
                    Self(self.0 $operator other.0)
                }
            }
        }

        impl<S: Simd> $operator_trait<f32> for f32x8<S> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: f32) -> Self {
                self $operator Self::splat(self.token(), other)
            }
        }

        impl<S: Simd> $operator_trait<f32x8<S>> for f32 {
            type Output = f32x8<S>;
            #[inline(always)]
            fn $name(self, other: f32x8<S>) -> f32x8<S> {
                f32x8::splat(other.token(), self) $operator other
            }
        }
    )*};
}
operators! { Add add + Sub sub - Mul mul * Div div / }

macro_rules! assignments {
    ($($operator_trait:ident $name:ident $operator:tt)*) => {$(
        impl<S: Simd> $operator_trait for f32x8<S> {
            #[inline(always)]
            fn $name(&mut self, other: Self) {
                *self = *self $operator other;
            }
        }
    )*};
}
assignments! { AddAssign add_assign + SubAssign sub_assign - MulAssign mul_assign * }

impl<S: Simd> Index<usize> for f32x8<S> {
    type Output = f32;
    #[inline(always)]
    fn index(&self, lane: usize) -> &f32 {
        &self.0[lane]
    }
}

impl<S: Simd> Neg for f32x8<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        if S::IS_SCALAR {
            let a = self.to_array();
            Self::load_array(self.token(), by_lane!(K => -a[K]))
        } else {
            Self(-self.0)
        }
    }
}
