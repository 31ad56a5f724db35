//! Colours are linear light in `Vec3` (red, green, blue) until they are displayed.

use glam::Vec3;
use std::sync::LazyLock;

/// Whole part of a number that is not negative; anything else becomes 0.
#[expect(
    clippy::cast_possible_truncation,
    reason = "`as` saturates and sends NaN to 0; callers bound the index"
)]
pub(super) fn index(value: f32) -> usize {
    value as usize
}

/// Smooth step from 0 at `low` to 1 at `high`.
pub(super) fn smooth(low: f32, high: f32, value: f32) -> f32 {
    let t = ((value - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// A pseudo-random number in 0..1 from a key.
pub(super) fn unit(key: u32) -> f32 {
    let mut x = key.wrapping_mul(0x9E37_79B1) ^ 0x85EB_CA6B;
    x = (x ^ (x >> 16)).wrapping_mul(0x7FEB_352D);
    x = (x ^ (x >> 15)).wrapping_mul(0x846C_A68B);
    x ^= x >> 16;
    (x >> 8) as f32 / 16_777_216.0
}

/// Steps of the table of [`displayed`].
const TONES: usize = 4096;
/// Brightest light of the table.
const BRIGHTEST: f32 = 4.0;

/// The curve of [`displayed`], over the root of the light. Highlights are compressed as by a film (the fit of ACES by Narkowicz),
/// then encoded as sRGB.
static CURVE: LazyLock<Vec<f32>> = LazyLock::new(|| {
    let value = |step: usize| {
        let root = step as f32 / (TONES - 1) as f32;
        let x = 0.70 * root * root * BRIGHTEST;
        let y = ((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)).clamp(0.0, 1.0);
        if y <= 0.003_130_8 { 12.92 * y } else { 1.055 * libm::powf(y, 1.0 / 2.4) - 0.055 }
    };
    (0..TONES).map(value).collect()
});

/// Linear light as a display shows it, each channel 0 to 1.
pub(super) fn displayed(light: Vec3) -> Vec3 {
    let curve = &*CURVE;
    let channel = |light: f32| {
        let root = (light * (1.0 / BRIGHTEST)).clamp(0.0, 1.0).sqrt();
        curve[index(root * (TONES - 1) as f32 + 0.5).min(TONES - 1)]
    };
    Vec3::new(channel(light.x), channel(light.y), channel(light.z))
}

/// Colours of a map at 0, 1/8, ... 1, as displayed: viridis, which grows lighter evenly.
const MAP: [[f32; 3]; 9] = [
    [0.267, 0.005, 0.329],
    [0.279, 0.175, 0.483],
    [0.230, 0.322, 0.546],
    [0.173, 0.449, 0.558],
    [0.128, 0.567, 0.551],
    [0.158, 0.684, 0.502],
    [0.369, 0.789, 0.383],
    [0.678, 0.864, 0.190],
    [0.993, 0.906, 0.144],
];

#[cfg(feature = "gpu")]
shared_with_shaders!(COLOUR: BRIGHTEST, MAP);

/// Colour of a map at a place from 0 to 1, as displayed; places outside are at its ends.
pub(super) fn map_as_displayed(place: f32) -> Vec3 {
    let at = if place.is_finite() { place.clamp(0.0, 1.0) } else { 0.0 } * (MAP.len() - 1) as f32;
    let first = index(at).min(MAP.len() - 2);
    Vec3::from(MAP[first]).lerp(Vec3::from(MAP[first + 1]), at - first as f32)
}

/// Colour of a map in linear light.
pub(super) fn colour_map(place: f32) -> Vec3 {
    map_as_displayed(place).map(
        |v| {
            if v <= 0.04045 { v / 12.92 } else { libm::powf((v + 0.055) / 1.055, 2.4) }
        },
    )
}
