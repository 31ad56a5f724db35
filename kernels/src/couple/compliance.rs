//! Compliance of the material of a sponge to the pressure; `solid_yield` has the derivation.

/// Response of the material over that of the same volume of water, and its maximum over the water beside it \[1\]. Sponges
/// of a porosity of 0.75 come to rest with two thirds to twice of it (docs/porous.md).
const FOLLOWING: f32 = 0.7;
const MOST: f32 = 1.0;

/// Root of the compliance of the material around a node, over that of the water \[1\].
pub(crate) fn following(porosity: f32) -> f32 {
    (FOLLOWING * (1.0 - porosity) / porosity).min(MOST).sqrt()
}
