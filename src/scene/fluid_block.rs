//! Blocks of water at time zero.

use glam::Vec3;

use super::error::Problem;
use super::number::number_text;
use super::{BlockShape, Domain, Scene};

/// Tolerance of the length of a row of particles that fills a periodic axis, over that length.
const SEAM: f32 = 1e-3;

/// Block of water along the axes at time zero, or a shape cut out of one.
///
/// Particles are at `minimum + (i + 1/2) * spacing`. A block that fills a periodic axis must be a whole number of spacings
/// long there, within a thousandth. Particles that would start inside a sponge or a body are left out: `saturation` is the
/// water of a sponge.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct FluidBlock {
    /// Lowest corner. Range -1000 to 1000 m. Required in files.
    #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
    pub minimum: Vec3,
    /// Highest corner, above `minimum` on every axis. Range -1000 to 1000 m. Required in files.
    #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
    pub maximum: Vec3,
    /// Velocity at time zero. Range -100 to 100 m/s; default (0, 0, 0).
    #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
    pub velocity: Vec3,
    /// Shape that is cut out of the block; default all of it. The boxes of two blocks must not overlap whatever their shapes.
    pub shape: BlockShape,
}

impl FluidBlock {
    /// Block at rest, from corner to corner \[m\].
    #[must_use]
    pub fn new(minimum: Vec3, maximum: Vec3) -> Self {
        Self { minimum, maximum, ..Self::default() }
    }

    /// Number of particles along each axis at a spacing \[m\]; 0 for a block thinner than the spacing.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the cast saturates, and validation bounds the count"
    )]
    #[expect(clippy::cast_sign_loss, reason = "negative sizes are clamped to zero first")]
    pub fn counts(&self, spacing: f32) -> [u32; 3] {
        // A hundredth of a particle covers rounding in f32 of sizes that are multiples of the spacing.
        let count = |size: f32| (size / spacing + 0.01).floor().max(0.0) as u32;
        (self.maximum - self.minimum).to_array().map(count)
    }

    /// Whether the block fills a periodic axis.
    fn fills(&self, scene: &Scene, axis: usize, spacing: f32) -> bool {
        let Domain::Box { minimum, maximum, periodic } = scene.domain else { return false };
        let gap = (maximum - minimum)[axis] - (self.maximum - self.minimum)[axis];
        periodic[axis] && gap < 0.5 * spacing
    }

    /// Number of particles along each axis, and their distance there \[m\]. A row that fills a periodic axis has the same
    /// distance across the sides.
    pub(crate) fn lattice(&self, scene: &Scene, spacing: f32) -> ([u32; 3], [f32; 3]) {
        let (mut counts, mut pitch) = (self.counts(spacing), [spacing; 3]);
        for axis in (0..3).filter(|axis| self.fills(scene, *axis, spacing)) {
            let (minimum, maximum) = scene.bounds();
            let period = (maximum - minimum)[axis];
            counts[axis] = whole_rows(period, spacing);
            pitch[axis] = period / counts[axis] as f32;
        }
        (counts, pitch)
    }

    /// Adds the problems of a block on a periodic axis.
    pub(super) fn seam_rules(&self, key: &str, spacing: f32, scene: &Scene, problems: &mut Vec<Problem>) {
        for axis in (0..3).filter(|axis| self.fills(scene, *axis, spacing)) {
            let (minimum, maximum) = scene.bounds();
            let period = (maximum - minimum)[axis];
            let rows = whole_rows(period, spacing);
            if (rows as f32 * spacing / period - 1.0).abs() > SEAM {
                let (name, spacing) = (["x", "y", "z"][axis], number_text(spacing));
                let (wanted, exact) = (rows as f32, number_text(period / rows as f32));
                let value = format!("({} m along {name})", number_text(period));
                let rule = format!(
                    "fills a periodic axis, which must be a whole number of \
                     `fluid.spacing` = {spacing} long; {wanted} of {exact} fit"
                );
                problems.push(Problem::rule(key, value, rule));
            }
        }
    }
}

/// Length over spacing, rounded to a whole number of at least one.
#[expect(clippy::cast_possible_truncation, reason = "the cast saturates, and validation bounds the count")]
#[expect(clippy::cast_sign_loss, reason = "at least 1")]
fn whole_rows(length: f32, spacing: f32) -> u32 {
    (length / spacing).round().max(1.0) as u32
}
