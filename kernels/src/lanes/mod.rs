//! Eight lanes of f32 on every machine: the only use of the SIMD library.
//!
//! A vector always has eight lanes, whatever the machine, and only operations that IEEE 754 rounds exactly are used. The
//! bits of a result therefore do not depend on the level. Fused multiply-add, approximate reciprocals and horizontal
//! reductions are not used, because they differ between machines.

mod floats;
mod transpose;

use std::fmt;

use fearless_simd::Level;
pub(crate) use fearless_simd::{mask32x8, prelude, u32x8};
pub(crate) use floats::f32x8;
use prelude::*;

/// Number of lanes of a vector.
pub const LANES: usize = 8;

/// An instruction set that the CPU bodies can run on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SimdLevel {
    /// Scalar code, eight lanes emulated.
    Fallback,
    /// x86-64-v2. What is older, without SSE4.2, takes scalar code.
    Sse42,
    /// x86-64-v3.
    Avx2,
    /// Ice Lake class AVX-512.
    Avx512,
    /// 64-bit ARM.
    Neon,
    /// WebAssembly with `simd128`; the code must have been built with it.
    Simd128,
}

impl SimdLevel {
    /// Every level, worst first.
    pub const ALL: [Self; 6] =
        [Self::Fallback, Self::Sse42, Self::Avx2, Self::Avx512, Self::Neon, Self::Simd128];

    /// The best level of this machine.
    #[must_use]
    pub fn best() -> Self {
        [Self::Avx512, Self::Avx2, Self::Neon, Self::Simd128, Self::Sse42]
            .into_iter()
            .find(|level| level.is_supported())
            .unwrap_or(Self::Fallback)
    }

    /// The levels of this machine, worst first.
    pub fn supported() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|level| level.is_supported())
    }

    /// Whether this machine has the level.
    #[must_use]
    pub fn is_supported(self) -> bool {
        self.token().is_some()
    }

    /// Name as used on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Fallback => "fallback",
            Self::Sse42 => "sse4.2",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
            Self::Neon => "neon",
            Self::Simd128 => "simd128",
        }
    }

    /// The level of that name, if there is one.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|level| level.name() == name)
    }

    /// Proof that the machine has the level.
    pub(crate) fn token(self) -> Option<Level> {
        let best = Level::new();
        match self {
            // A module with simd128 does not load without it: there a second version of all kernels would only be downloaded.
            #[cfg(not(all(target_arch = "wasm32", target_feature = "simd128")))]
            Self::Fallback => Some(Level::fallback()),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Self::Sse42 => best.as_sse4_2().map(Level::Sse4_2),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Self::Avx2 => best.as_avx2().map(Level::Avx2),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Self::Avx512 => best.as_avx512().map(Level::Avx512),
            #[cfg(target_arch = "aarch64")]
            Self::Neon => best.as_neon().map(Level::Neon),
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            Self::Simd128 => best.as_wasm_simd128().map(Level::WasmSimd128),
            #[allow(unreachable_patterns, reason = "which levels remain depends on the target")]
            _ => {
                let _ = best;
                None
            }
        }
    }
}

impl fmt::Display for SimdLevel {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

/// Proof that the machine has a level, as a type: code for vectors is generic over it.
pub(crate) trait Simd: fearless_simd::Simd {
    /// Whether the level has no vectors.
    const IS_SCALAR: bool = false;
}

impl Simd for fearless_simd::Fallback {
    const IS_SCALAR: bool = true;
}

/// Implements [`Simd`] for the levels of a target, and declares how an expression that is generic over the level is run at
/// one of them.
macro_rules! levels {
    ($(#[cfg($target:meta)] $($module:ident::$level:ident)*;)*) => {
        levels! { @dispatch ($) $($(#[cfg($target)] $module::$level;)*)* }
        $($(
            #[cfg($target)]
            impl Simd for fearless_simd::$module::$level {}
        )*)*
    };
    (@dispatch ($dollar:tt) $(#[cfg($target:meta)] $module:ident::$level:ident;)*) => {
        /// Runs an expression that is generic over the SIMD token at a level.
        macro_rules! dispatch {
            ($dollar level:expr, $dollar simd:pat => $dollar body:expr) => {
                match $dollar level {
                    $(
                        #[cfg($target)]
                        fearless_simd::Level::$level(token) => {
                            $crate::lanes::dispatch!(@at token, $dollar simd => $dollar body)
                        }
                    )*
                    #[cfg(not(all(target_arch = "wasm32", target_feature = "simd128")))]
                    fearless_simd::Level::Fallback(token) => {
                        $crate::lanes::dispatch!(@at token, $dollar simd => $dollar body)
                    }
                    _ => unreachable!("a level that has no name here"),
                }
            };
            (@at $dollar token:ident, $dollar simd:pat => $dollar body:expr) => {{
                let $dollar simd = $crate::lanes::generic($dollar token);
                fearless_simd::Simd::vectorize($dollar token, #[inline(always)] || $dollar body)
            }};
        }
        pub(crate) use dispatch;
    };
}
levels! {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))] x86::Sse4_2 x86::Avx2 x86::Avx512;
    #[cfg(target_arch = "aarch64")] aarch64::Neon;
    #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))] wasm32::WasmSimd128;
}

/// The level that every machine of the target has. On x86 that is scalar code, which takes the vectors of the code around it.
pub(crate) fn baseline() -> Level {
    if cfg!(any(target_arch = "x86", target_arch = "x86_64")) { Level::fallback() } else { Level::baseline() }
}

/// Hides which level a token is of, so that code that is not generic does not compile.
#[inline(always)]
pub(crate) fn generic<S: Simd>(token: S) -> impl Simd {
    token
}

/// A vector with the same value in every lane.
#[inline(always)]
pub(crate) fn splat<S: Simd>(simd: S, value: f32) -> f32x8<S> {
    f32x8::splat(simd, value)
}

/// Eight consecutive values from `start`.
#[inline(always)]
pub(crate) fn load<S: Simd>(simd: S, values: &[f32], start: usize) -> f32x8<S> {
    f32x8::from_slice(simd, &values[start..start + LANES])
}

/// Eight values.
#[inline(always)]
pub(crate) fn load_array<S: Simd>(simd: S, values: &[f32; LANES]) -> f32x8<S> {
    f32x8::load_array_ref(simd, values)
}

/// Stores eight consecutive values from `start`.
#[inline(always)]
pub(crate) fn store<S: Simd>(values: &mut [f32], start: usize, lanes: f32x8<S>) {
    lanes.store_slice(&mut values[start..start + LANES]);
}

/// The larger of the lane and zero; `+0` for `-0` and NaN on every machine.
#[inline(always)]
pub(crate) fn positive<S: Simd>(simd: S, lanes: f32x8<S>) -> f32x8<S> {
    let zero = splat(simd, 0.0);
    select(lanes.simd_gt(zero), lanes, zero)
}

/// Lanes where `condition` holds from `yes`, else from `no`.
#[inline(always)]
pub(crate) fn select<S: Simd>(condition: mask32x8<S>, yes: f32x8<S>, no: f32x8<S>) -> f32x8<S> {
    f32x8::select(condition, yes, no)
}

/// Rows `start..start + 8` as vectors of x, y, z and w.
#[inline(always)]
pub(crate) fn load_rows<S: Simd>(simd: S, rows: &[[f32; 4]], start: usize) -> [f32x8<S>; 4] {
    let rows: &[[f32; 4]; LANES] = rows[start..start + LANES].try_into().expect("the slice has eight rows");
    transpose::eight_by_four(simd, rows.each_ref())
}

/// Stores vectors of x, y, z and w to rows `start..start + 8`.
#[inline(always)]
pub(crate) fn store_rows<S: Simd>(rows: &mut [[f32; 4]], start: usize, vectors: [f32x8<S>; 4]) {
    let ([x, y, z, w], [x_high, y_high, z_high, w_high]) = {
        let [x, y, z, w] = vectors;
        let ((x, x_high), (y, y_high), (z, z_high), (w, w_high)) =
            (x.split(), y.split(), z.split(), w.split());
        ([x, y, z, w], [x_high, y_high, z_high, w_high])
    };
    let low = transpose::four_by_four([x, y, z, w]);
    let high = transpose::four_by_four([x_high, y_high, z_high, w_high]);
    let rows = &mut rows[start..start + LANES];
    for lane in 0..4 {
        low[lane].store_slice(&mut rows[lane]);
        high[lane].store_slice(&mut rows[lane + 4]);
    }
}

/// Eight rows by index as vectors of x, y, z and w.
#[inline(always)]
pub(crate) fn gather_rows<S: Simd>(simd: S, rows: &[[f32; 4]], index: &[u32; LANES]) -> [f32x8<S>; 4] {
    let row = |lane: usize| &rows[index[lane] as usize];
    transpose::eight_by_four(simd, [row(0), row(1), row(2), row(3), row(4), row(5), row(6), row(7)])
}

/// The eight columns of eight rows.
#[inline(always)]
pub(crate) fn transpose_rows<S: Simd>(simd: S, rows: [&[u32; LANES]; LANES]) -> [[u32; LANES]; LANES] {
    transpose::eight_by_eight(simd, rows)
}

/// Eight values by index.
#[inline(always)]
pub(crate) fn gather<S: Simd>(simd: S, values: &[f32], index: &[u32; LANES]) -> f32x8<S> {
    let value = |lane: usize| values[index[lane] as usize];
    f32x8::load_array(simd, [value(0), value(1), value(2), value(3), value(4), value(5), value(6), value(7)])
}

/// Runs an expression that is generic over the SIMD token at the level of the CPU context.
macro_rules! with_lanes {
    ($cpu:expr, $simd:pat => $body:expr) => {
        $crate::lanes::dispatch!($cpu.level(), $simd => $body)
    };
}
pub(crate) use with_lanes;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_round_trip_and_one_level_is_always_there() {
        for level in SimdLevel::ALL {
            assert_eq!(SimdLevel::from_name(level.name()), Some(level));
        }
        assert_eq!(SimdLevel::from_name("avx"), None);
        assert!(SimdLevel::Fallback.is_supported());
        assert!(SimdLevel::best().is_supported());
    }

    #[test]
    fn gathered_rows_are_transposed_on_every_level() {
        let rows: Vec<[f32; 4]> =
            (0..20).map(|i| [i as f32, i as f32 + 0.25, i as f32 + 0.5, -(i as f32)]).collect();
        let index = [3, 19, 0, 7, 7, 12, 1, 5];
        for level in SimdLevel::ALL {
            let Some(token) = level.token() else { continue };
            let (x, w) = dispatch!(token, simd => {
                let [x, _, _, w] = gather_rows(simd, &rows, &index);
                (x.to_array(), w.to_array())
            });
            for lane in 0..LANES {
                assert_eq!((x[lane], w[lane]), (index[lane] as f32, -(index[lane] as f32)), "{level}");
            }
        }
    }
}
