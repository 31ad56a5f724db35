//! Colours are linear light in `Vec3` (red, green, blue) until they are encoded as bytes.

use glam::Vec3;
use std::sync::LazyLock;

/// Steps of the table from linear light to sRGB; fine enough for the darkest bytes.
const STEPS: usize = 8192;

/// Table from linear light to bytes.
pub(super) struct Encoder {
    table: Vec<u8>,
}

impl Encoder {
    pub(super) fn new() -> Self {
        let table = (0..=STEPS)
            .map(|step| {
                let x = step as f32 / STEPS as f32;
                let value = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
                byte(value * 255.0 + 0.5)
            })
            .collect();
        Self { table }
    }

    /// Bytes of a colour; channels are cut to 0..=1.
    pub(super) fn encode(&self, colour: Vec3) -> [u8; 3] {
        let scaled = colour.clamp(Vec3::ZERO, Vec3::ONE) * STEPS as f32 + 0.5;
        scaled.to_array().map(|channel| self.table[index(channel).min(STEPS)])
    }
}

#[expect(clippy::cast_possible_truncation, reason = "`as` saturates, which is what a channel should do")]
fn byte(value: f32) -> u8 {
    value as u8
}

/// Whole part of a number that is not negative; anything else becomes 0.
#[expect(
    clippy::cast_possible_truncation,
    reason = "`as` saturates and sends NaN to 0; callers bound the index"
)]
pub(super) fn index(value: f32) -> usize {
    value as usize
}

/// Largest whole number not above `value`, clamped to the range of `i32`.
#[expect(clippy::cast_possible_truncation, reason = "`as` saturates; callers clip to the picture")]
pub(super) fn floor(value: f32) -> i32 {
    value.floor() as i32
}

/// Compresses highlights so that they keep their colour; identity in the dark, 1 at about 2.5.
pub(super) fn tone(colour: Vec3) -> Vec3 {
    const WHITE: f32 = 2.5;
    const KNEE: f32 = 0.6;
    let peak = colour.max_element();
    if peak <= KNEE || peak.is_nan() {
        return colour;
    }
    let x = ((peak - KNEE) / (WHITE - KNEE)).min(1.0);
    // Slope (WHITE - KNEE) / (1 - KNEE) at the knee keeps the curve smooth there.
    let slope = (WHITE - KNEE) / (1.0 - KNEE);
    let mapped = KNEE + (1.0 - KNEE) * (slope * x / (1.0 + (slope - 1.0) * x));
    let scaled = colour * (mapped / peak);
    // Very bright light turns white, as on film.
    scaled.lerp(Vec3::splat(mapped), 0.35 * x)
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
    Vec3::from(light.to_array().map(channel))
}
