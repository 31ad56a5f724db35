//! Viscosity by the rate of strain, pair by pair, of the velocities and of the direction of an implicit solve.

use glam::{DMat3, DVec3};

use super::{apart, closeness, keep, pi_power, row, vector, vectors};
use crate::{
    columns::{Columns, Fluid},
    params::Params,
    sph::strain::REGULAR,
};

/// The rotation that fits the vectors of the neighbours best, by the normal equations of the fit.
fn spins(params: &Params, fluid: &Fluid, vectors_of: &[[f32; 4]], count: usize) -> Vec<[f32; 4]> {
    let (x, v) = (vectors(&fluid.position, count), vectors(vectors_of, count));
    let one = |i: usize| {
        let (mut inertia, mut moment) = (DMat3::ZERO, DVec3::ZERO);
        for j in 0..count {
            let arm = apart(params, x[j], x[i]);
            let u = closeness(params.fluid.smoothing.support_radius, arm.length());
            let square = DMat3::from_cols(arm * arm.x, arm * arm.y, arm * arm.z);
            inertia += u * (DMat3::from_diagonal(DVec3::splat(arm.length_squared())) - square);
            moment += u * arm.cross(v[j] - v[i]);
        }
        let trace = inertia.x_axis.x + inertia.y_axis.y + inertia.z_axis.z;
        let regular = DMat3::from_diagonal(DVec3::splat(f64::from(REGULAR) * trace));
        row(if trace > 0.0 { (inertia + regular).inverse() * moment } else { DVec3::ZERO }, 0.0)
    };
    let mut spin: Vec<_> = (0..count).map(one).collect();
    spin.resize(fluid.position.len(), [0.0; 4]);
    spin
}

/// Accelerations by the strains of these vectors.
fn accelerations(params: &Params, fluid: &Fluid, vectors_of: &[[f32; 4]], count: usize) -> Vec<DVec3> {
    let (x, v) = (vectors(&fluid.position, count), vectors(vectors_of, count));
    let spin = vectors(&fluid.spin, count);
    let radius = params.fluid.smoothing.support_radius;
    let rest = f64::from(params.fluid.rest_density);
    let volume = f64::from(params.fluid.particle_mass) / rest;
    let scale = 2.0 * f64::from(params.fluid.strain_viscosity) * volume / rest;
    let one = |i: usize| {
        let mut sum = DVec3::ZERO;
        for j in 0..count {
            let arm = apart(params, x[j], x[i]);
            let laplacian = 45.0 / pi_power(radius, 5) * closeness(radius, arm.length());
            let turned = (0.5 * (spin[i] + spin[j])).cross(arm);
            sum += laplacian * (v[j] - v[i] - turned);
        }
        scale * sum
    };
    (0..count).map(one).collect()
}

pub(crate) fn spin(params: &Params, columns: &mut Columns) {
    let fluid = &columns.fluid;
    columns.fluid.spin = spins(params, fluid, &fluid.velocity, columns.rows.fluid);
}

pub(crate) fn strain_rate(params: &Params, columns: &mut Columns) {
    let accelerations = accelerations(params, &columns.fluid, &columns.fluid.velocity, columns.rows.fluid);
    for (own, acceleration) in columns.fluid.acceleration.iter_mut().zip(accelerations) {
        *own = keep(*own, vector(*own) + acceleration);
    }
}

pub(crate) fn viscosity_start(_: &Params, columns: &mut Columns) {
    let rows = columns.fluid.position.len();
    let velocities = vectors(&columns.fluid.velocity, columns.rows.fluid);
    let direction = &mut columns.fluid.viscosity_direction;
    *direction = velocities.into_iter().map(|velocity| row(velocity, 0.0)).collect();
    direction.resize(rows, [0.0; 4]);
    columns.fluid.viscosity_product = vec![[0.0; 4]; rows];
}

pub(crate) fn viscosity_spin(params: &Params, columns: &mut Columns) {
    let fluid = &columns.fluid;
    columns.fluid.spin = spins(params, fluid, &fluid.viscosity_direction, columns.rows.fluid);
}

pub(crate) fn viscosity_strain(params: &Params, columns: &mut Columns) {
    let fluid = &columns.fluid;
    let accelerations = accelerations(params, fluid, &fluid.viscosity_direction, columns.rows.fluid);
    let rows = fluid.position.len();
    let product = &mut columns.fluid.viscosity_product;
    *product = accelerations.into_iter().map(|acceleration| row(-acceleration, 0.0)).collect();
    product.resize(rows, [0.0; 4]);
}
