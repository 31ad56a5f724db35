//! Vectors in rows that come from a device.

use glam::DVec3;

use super::layout::ROW;
use crate::body::Wrench;

/// The vector at the beginning of a row.
pub(super) fn vector(words: &[f32]) -> DVec3 {
    DVec3::new(f64::from(words[0]), f64::from(words[1]), f64::from(words[2]))
}

/// A wrench: impulse and angular impulse, a row each.
pub(super) fn wrench(words: &[f32]) -> Wrench {
    Wrench { impulse: vector(words), angular_impulse: vector(&words[ROW..]) }
}
