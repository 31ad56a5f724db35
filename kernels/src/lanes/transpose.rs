//! Transposes between rows in memory and vectors of one coordinate.
//!
//! Passes over neighbours are bound by these shuffles. Where the machine has 256-bit shuffles inside 128-bit blocks, half as
//! many suffice as with the portable operations. They only move bits, so that results agree.

use fearless_simd::{f32x4, prelude::*};

use super::{LANES, Simd, f32x8};

/// Transposes four rows of four.
#[inline(always)]
pub(super) fn four_by_four<S: Simd>([a, b, c, d]: [f32x4<S>; 4]) -> [f32x4<S>; 4] {
    let (ac_low, ac_high) = (a.zip_low(c), a.zip_high(c));
    let (bd_low, bd_high) = (b.zip_low(d), b.zip_high(d));
    [ac_low.zip_low(bd_low), ac_low.zip_high(bd_low), ac_high.zip_low(bd_high), ac_high.zip_high(bd_high)]
}

/// Transposes eight rows of four into four vectors.
#[inline(always)]
pub(super) fn eight_by_four<S: Simd>(simd: S, rows: [&[f32; 4]; LANES]) -> [f32x8<S>; 4] {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(avx2) = simd.level().as_avx2() {
        let [x, y, z, w] = wide::eight_by_four(avx2, rows);
        let vector = |lanes| f32x8::load_array(simd, lanes);
        return [vector(x), vector(y), vector(z), vector(w)];
    }
    let row = |lane: usize| f32x4::load_array_ref(simd, rows[lane]);
    let low = four_by_four([row(0), row(1), row(2), row(3)]);
    let high = four_by_four([row(4), row(5), row(6), row(7)]);
    [
        f32x8::combine(low[0], high[0]),
        f32x8::combine(low[1], high[1]),
        f32x8::combine(low[2], high[2]),
        f32x8::combine(low[3], high[3]),
    ]
}

/// Transposes eight rows of eight.
#[inline(always)]
pub(super) fn eight_by_eight<S: Simd>(simd: S, rows: [&[u32; LANES]; LANES]) -> [[u32; LANES]; LANES] {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(avx2) = simd.level().as_avx2() {
        return wide::eight_by_eight(avx2, rows);
    }
    let _ = simd;
    std::array::from_fn(|k| std::array::from_fn(|lane| rows[lane][k]))
}

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
mod wide {
    #[cfg(target_arch = "x86")]
    use std::arch::x86::*;
    #[cfg(target_arch = "x86_64")]
    use std::arch::x86_64::*;

    use fearless_simd::{f32x4, f32x8, kernel, prelude::*, u32x8};

    kernel!(
        #[inline]
        pub(super) fn eight_by_four(avx2: Avx2, rows: [&[f32; 4]; 8]) -> [[f32; 8]; 4] {
            let pair = |lane: usize| -> __m256 {
                f32x4::load_array_ref(avx2, rows[lane])
                    .combine(f32x4::load_array_ref(avx2, rows[lane + 4]))
                    .into()
            };
            let (a, b, c, d) = (pair(0), pair(1), pair(2), pair(3));
            let (ac_low, ac_high) = (_mm256_unpacklo_ps(a, c), _mm256_unpackhi_ps(a, c));
            let (bd_low, bd_high) = (_mm256_unpacklo_ps(b, d), _mm256_unpackhi_ps(b, d));
            let array = |vector: __m256| -> [f32; 8] { f32x8::simd_from(avx2, vector).into() };
            [
                array(_mm256_unpacklo_ps(ac_low, bd_low)),
                array(_mm256_unpackhi_ps(ac_low, bd_low)),
                array(_mm256_unpacklo_ps(ac_high, bd_high)),
                array(_mm256_unpackhi_ps(ac_high, bd_high)),
            ]
        }
    );

    kernel!(
        #[inline]
        pub(super) fn eight_by_eight(avx2: Avx2, rows: [&[u32; 8]; 8]) -> [[u32; 8]; 8] {
            // Rows k and k + 4 side by side: four vectors of left halves, four of right halves.
            let half = |lane: usize, first: usize| -> __m256i {
                let block = |lane: usize| {
                    let row = rows[lane];
                    [row[first], row[first + 1], row[first + 2], row[first + 3]]
                };
                let (low, high) = (block(lane), block(lane + 4));
                u32x8::simd_from(avx2, [low[0], low[1], low[2], low[3], high[0], high[1], high[2], high[3]])
                    .into()
            };
            let mut columns = [[0; 8]; 8];
            for first in [0, 4] {
                let (a, b, c, d) = (half(0, first), half(1, first), half(2, first), half(3, first));
                let (ac_low, ac_high) = (_mm256_unpacklo_epi32(a, c), _mm256_unpackhi_epi32(a, c));
                let (bd_low, bd_high) = (_mm256_unpacklo_epi32(b, d), _mm256_unpackhi_epi32(b, d));
                let array = |vector: __m256i| -> [u32; 8] { u32x8::simd_from(avx2, vector).into() };
                columns[first] = array(_mm256_unpacklo_epi32(ac_low, bd_low));
                columns[first + 1] = array(_mm256_unpackhi_epi32(ac_low, bd_low));
                columns[first + 2] = array(_mm256_unpacklo_epi32(ac_high, bd_high));
                columns[first + 3] = array(_mm256_unpackhi_epi32(ac_high, bd_high));
            }
            columns
        }
    );
}
