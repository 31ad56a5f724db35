//! Compliance of the material of a sponge to the pressure; `solid_yield` has the derivation.

use crate::{
    columns::{Nodes, lane},
    layout::constants,
    params::Params,
};

constants! {
    /// How far the material follows, over as much water \[1\]. Sponges of a porosity of 0.75 are calm with two thirds to twice of it
    /// (docs/porous.md).
    const FOLLOWING: f32 = 0.7;
    /// The most that it follows, over the water beside it \[1\].
    const MAXIMUM_FOLLOWING: f32 = 1.0;
    /// Part of the stiffness of a node against its neighbours at rest that holds it.
    const HELD_BY_NEIGHBORS: f32 = 0.25;
}

/// Root of the compliance of the material around a node, over that of the water \[1\].
pub(crate) fn following(porosity: f32) -> f32 {
    (FOLLOWING * (1.0 - porosity) / porosity).min(MAXIMUM_FOLLOWING).sqrt()
}

/// What a node of this volume responds to impulses with, where it moves that mass of water.
pub(crate) fn response(params: &Params, nodes: &Nodes, (node, volume): (usize, f32), drawn: f32) -> f32 {
    let inverse_mass = nodes.position[node][lane::nodes::position::INVERSE_MASS];
    let sponge = &params.sponges[nodes.sponge[node] as usize];
    let wetness = nodes.wetting.get(node).map_or(0.0, |row| row[lane::nodes::wetting::WETNESS]);
    let modulus = sponge.wetting.stiffness(wetness) * (sponge.mu + sponge.lambda / 3.0);
    let stiffness = 8.0 * volume / (sponge.edge * sponge.edge) * modulus;
    let elastic = HELD_BY_NEIGHBORS * params.step * (params.step + sponge.damping) * stiffness;
    if inverse_mass > 0.0 { 1.0 / (1.0 / inverse_mass + drawn + elastic) } else { 0.0 }
}
