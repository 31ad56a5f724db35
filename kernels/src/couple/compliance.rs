//! How much the material of a sponge gives way to the pressure; `solid_yield` has the derivation.

/// How far the material follows, over as much water, and the most that it does over the water beside it \[1\]. Sponges of a porosity of
/// 0.75 are calm with two thirds to twice of it (docs/porous.md).
const FOLLOWING: f32 = 0.7;
const MOST: f32 = 1.0;

/// Root of how much the material around a node gives way, over the water \[1\].
pub(crate) fn following(porosity: f32) -> f32 {
    (FOLLOWING * (1.0 - porosity) / porosity).min(MOST).sqrt()
}
