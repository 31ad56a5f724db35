//! The box that holds the particles.

use crate::params::Params;

/// Distance from the walls at which a particle stops, over the spacing.
pub(super) const STOP: f32 = 0.05;

/// Corners of the box that holds the particles, out of reach along axes without walls.
pub(super) fn inside(params: &Params) -> Option<([f32; 3], [f32; 3])> {
    let margin = params.fluid.spacing * STOP;
    params.walls.map(|(low, high)| ((low + margin).to_array(), (high - margin).to_array()))
}
