//! The box that holds the particles.

use crate::{layout::constants, params::Params};

constants! {
    /// Distance from the walls at which a particle is stopped, over the spacing.
    pub(super) const WALL_MARGIN: f32 = 0.05;
}

/// Corners of the box that holds the particles, out of reach along axes without walls.
pub(super) fn inside(params: &Params) -> Option<([f32; 3], [f32; 3])> {
    let margin = params.fluid.spacing * WALL_MARGIN;
    params.walls.map(|(low, high)| ((low + margin).to_array(), (high - margin).to_array()))
}
