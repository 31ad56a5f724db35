//! Compliance of the material of a sponge to the pressure; `solid_yield` has the derivation.

use crate::layout::constants;

constants! {
    /// How far the material follows, over as much water \[1\]. Sponges of a porosity of 0.75 are calm with two thirds to twice of it
    /// (docs/porous.md).
    const FOLLOWING: f32 = 0.7;
    /// The most that it follows, over the water beside it \[1\].
    const MAXIMUM_FOLLOWING: f32 = 1.0;
}

/// Root of the compliance of the material around a node, over that of the water \[1\].
pub(crate) fn following(porosity: f32) -> f32 {
    (FOLLOWING * (1.0 - porosity) / porosity).min(MAXIMUM_FOLLOWING).sqrt()
}
