//! Oracle of `divergence::shift`.

use super::{divergence::is_sparse, images::seen, keep, obstacles::beside_parts, shapes::distance, vector};
use crate::{
    columns::{Columns, lane},
    params::Params,
};

pub(crate) fn shift(params: &Params, columns: &mut Columns) {
    let Some(divergence) = params.fluid.divergence() else { return };
    let (fluid, bodies) = (&mut columns.fluid, &columns.bodies.states.0);
    let (images, spacing) = (seen(&fluid.images), f64::from(params.fluid.spacing));
    for i in 0..columns.rows.fluid {
        if is_sparse(fluid, i) || fluid.moment[i][lane::fluid::moment::MATERIAL] > 0.02 {
            continue;
        }
        let (x, z) = (vector(fluid.position[i]), vector(fluid.moment[i]));
        let share = (1.0 - z.length() / (0.5 * f64::from(divergence.surface_moment))).max(0.0);
        let mut shift = -0.2 * spacing * spacing * share * z;
        for (index, body) in bodies.iter().enumerate() {
            let has_image = images.iter().any(|image| image.source == i && image.body == Some(index));
            let (distance, normal) = distance(body, x);
            if has_image && distance < 2.0 * spacing {
                shift -= shift.dot(normal) * normal;
            }
            if has_image {
                shift = beside_parts((bodies, index), x, shift, 0.3 * spacing);
            }
        }
        fluid.position[i] = keep(fluid.position[i], x + shift.clamp_length_max(0.1 * spacing));
    }
}
