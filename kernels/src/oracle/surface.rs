//! Surface tension from a surface energy, pair by pair.

use glam::DVec3;

use super::{apart, gradient, incompressible, row, smoothing, vector, vectors};
use crate::{
    columns::{Columns, lane},
    params::Params,
};

pub(crate) fn deficit(params: &Params, columns: &mut Columns) {
    let Some(cohesion) = &params.fluid.cohesion else { return };
    let (fluid, count) = (&mut columns.fluid, columns.rows.fluid);
    let x = vectors(&fluid.position, count);
    let (radius, volume) = (cohesion.smoothing.support_radius, f64::from(cohesion.volume));
    let profile = [cohesion.boundary_range, cohesion.boundary_share].map(f64::from);
    fluid.deficit.resize(fluid.position.len(), 0.0);
    for i in 0..count {
        let volume_at = |other: &DVec3| volume * smoothing(radius, apart(params, x[i], *other).length());
        let there: f64 = x.iter().map(volume_at).sum();
        let share = incompressible::share(params, &columns.bodies.states.0, profile, x[i]);
        fluid.deficit[i] = weight((0.98 - there - share).max(0.0)) as f32;
    }
}

/// Weight of a deficit e: e (1 - 5/2 e), from its summit at e = 1/5 on at least a hundredth.
fn weight(deficit: f64) -> f64 {
    let falling = deficit - 2.5 * deficit.powi(2);
    if deficit <= 0.2 { falling } else { falling.max(0.01) }
}

pub(crate) fn cohesion(params: &Params, columns: &mut Columns) {
    let Some(cohesion) = &params.fluid.cohesion else { return };
    let (fluid, count) = (&mut columns.fluid, columns.rows.fluid);
    let x = vectors(&fluid.position, count);
    let weight = |row: usize| f64::from(fluid.deficit[row]);
    let (volume, mass) = (f64::from(cohesion.volume), f64::from(params.fluid.particle_mass));
    let factor = f64::from(cohesion.stiffness) * volume * volume / mass;
    for i in 0..count {
        let radius = cohesion.smoothing.support_radius;
        let pull = |j: usize| (weight(i) + weight(j)) * gradient(radius, apart(params, x[i], x[j]));
        let sum: DVec3 = (0..count).map(pull).sum();
        let allowed = f64::from(fluid.acceleration[i][lane::fluid::acceleration::ALLOWED_COMPRESSION]);
        fluid.acceleration[i] = row(vector(fluid.acceleration[i]) + factor * sum, allowed);
    }
}
