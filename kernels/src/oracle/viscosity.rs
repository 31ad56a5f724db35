//! Implicit viscosity, pair by pair and surface by surface.

use glam::{DMat3, DVec3};

use super::{
    apart, closeness, gradient, keep,
    obstacles::{given, half_space},
    pi_power, row, shapes, vector, vectors,
};
use crate::{
    columns::{Columns, Fluid},
    params::{ImplicitViscosity, Params},
};

pub(crate) fn pressure_guess(_: &Params, columns: &mut Columns) {
    let fluid = &mut columns.fluid;
    for (velocity, correction) in
        fluid.velocity.iter_mut().zip(&mut fluid.correction).take(columns.rows.fluid)
    {
        let (old, new) = (vector(*velocity), vector(*correction));
        (*velocity, *correction) = (keep(*velocity, new), keep(*correction, new - old));
    }
}

pub(crate) fn pressure_return(_: &Params, columns: &mut Columns) {
    let fluid = &mut columns.fluid;
    for (velocity, correction) in fluid.velocity.iter_mut().zip(&fluid.correction).take(columns.rows.fluid) {
        *velocity = keep(*velocity, vector(*velocity) - vector(*correction));
    }
}

/// Deceleration of a particle by its neighbours at these velocities, or at another field in their place.
fn pairs(params: &Params, implicit: &ImplicitViscosity, fluid: &Fluid, field: &[DVec3]) -> Vec<DVec3> {
    let x = vectors(&fluid.position, field.len());
    let radius = params.fluid.smoothing.support_radius;
    let mass = f64::from(params.fluid.particle_mass);
    let one = |i: usize| {
        let mut sum = DVec3::ZERO;
        for j in 0..field.len() {
            let (offset, relative) = (apart(params, x[i], x[j]), field[i] - field[j]);
            let volumes = (mass / f64::from(params.fluid.rest_density)).powi(2);
            let laplacian = 45.0 / pi_power(radius, 5) * closeness(radius, offset.length());
            sum += f64::from(implicit.viscosity) * volumes / mass * laplacian * relative;
            let softened = offset.length_squared() + 0.0025 * f64::from(radius).powi(2);
            let central = -10.0 * relative.dot(offset) / softened * gradient(radius, offset);
            sum += f64::from(implicit.central_viscosity) * volumes / mass * central;
        }
        sum
    };
    (0..field.len()).map(one).collect()
}

/// What the rate of strain adds, from the place of the product.
fn strained(params: &Params, fluid: &Fluid, row: usize) -> DVec3 {
    if params.fluid.strain_viscosity > 0.0 { vector(fluid.viscosity_product[row]) } else { DVec3::ZERO }
}

/// Rate of deceleration by a surface at a distance.
fn rate(params: &Params, distance: f64) -> f64 {
    let radius = f64::from(params.fluid.smoothing.support_radius);
    let kinematic = f64::from(params.fluid.wall_viscosity) / f64::from(params.fluid.rest_density);
    if distance < radius { kinematic * half_space(radius, distance) } else { 0.0 }
}

/// Projection along a surface times the rate.
fn friction(rate: f64, normal: DVec3) -> DMat3 {
    let outer = DMat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z);
    (DMat3::IDENTITY - outer) * rate
}

pub(crate) fn begin(params: &Params, columns: &mut Columns) {
    let Some(implicit) = &params.fluid.implicit_viscosity else { return };
    let (fluid, count) = (&mut columns.fluid, columns.rows.fluid);
    let (v, h) = (vectors(&fluid.velocity, count), f64::from(params.step));
    let slowed = pairs(params, implicit, fluid, &v);
    let rows = fluid.position.len();
    for column in [
        &mut fluid.friction,
        &mut fluid.friction_between,
        &mut fluid.viscosity_residual,
        &mut fluid.viscosity_direction,
        &mut fluid.viscosity_change,
    ] {
        *column = vec![[0.0; 4]; rows];
    }
    for i in 0..count {
        let x = vector(fluid.position[i]);
        let (mut matrix, mut sum) = (DMat3::ZERO, slowed[i] + strained(params, fluid, i));
        if let Some((low, high)) = params.walls.filter(|_| params.no_slip) {
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let distances = [(x - low.as_dvec3()).dot(axis), (high.as_dvec3() - x).dot(axis)];
                for distance in distances {
                    matrix += friction(rate(params, distance), axis);
                }
            }
            sum += matrix * v[i];
        }
        for body in columns.bodies.states.0.iter().filter(|body| body.no_slip) {
            let (distance, normal) = shapes::distance(body, x);
            let own = friction(rate(params, distance), normal);
            matrix += own;
            sum += own * (v[i] - shapes::velocity(body, x));
        }
        fluid.friction[i] = row(DVec3::new(matrix.x_axis.x, matrix.y_axis.y, matrix.z_axis.z), 0.0);
        fluid.friction_between[i] = row(DVec3::new(matrix.y_axis.z, matrix.z_axis.x, matrix.x_axis.y), 0.0);
        fluid.viscosity_residual[i] = row(-h * sum, 0.0);
        fluid.viscosity_direction[i] = row(-h * sum, 0.0);
    }
    fluid.viscosity_solve.begin();
}

pub(crate) fn product(params: &Params, columns: &mut Columns) {
    let Some(implicit) = &params.fluid.implicit_viscosity else { return };
    let (fluid, count) = (&mut columns.fluid, columns.rows.fluid);
    let p = vectors(&fluid.viscosity_direction, count);
    let slowed = pairs(params, implicit, fluid, &p);
    let mut sums = [0.0; 4];
    fluid.viscosity_product.resize(fluid.position.len(), [0.0; 4]);
    for i in 0..count {
        let strained = strained(params, fluid, i);
        let (axes, between) = (vector(fluid.friction[i]), vector(fluid.friction_between[i]));
        let matrix = DMat3::from_cols(
            DVec3::new(axes.x, between.z, between.y),
            DVec3::new(between.z, axes.y, between.x),
            DVec3::new(between.y, between.x, axes.z),
        );
        let q = p[i] + f64::from(params.step) * (slowed[i] + strained + matrix * p[i]);
        let r = vector(fluid.viscosity_residual[i]);
        let own = [p[i].dot(q), r.dot(p[i]), r.dot(q), q.dot(q)];
        sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
        fluid.viscosity_product[i] = row(q, 0.0);
    }
    fluid.viscosity_solve.choose_with(sums);
}

pub(crate) fn update(params: &Params, columns: &mut Columns) {
    let Some(implicit) = &params.fluid.implicit_viscosity else { return };
    let (fluid, count) = (&mut columns.fluid, columns.rows.fluid);
    let solve = &fluid.viscosity_solve;
    let (length, share) = (f64::from(solve.length()), f64::from(solve.share()));
    let mut sums = [0.0; 2];
    for i in 0..count {
        let (p, q) = (vector(fluid.viscosity_direction[i]), vector(fluid.viscosity_product[i]));
        let r = vector(fluid.viscosity_residual[i]) - length * q;
        let y = vector(fluid.viscosity_change[i]) + length * p;
        sums[0] += r.length_squared();
        sums[1] += y.length_squared();
        fluid.viscosity_residual[i] = row(r, 0.0);
        fluid.viscosity_change[i] = row(y, 0.0);
        fluid.viscosity_direction[i] = keep(fluid.viscosity_direction[i], r + share * p);
    }
    fluid.viscosity_solve.finish_with(sums, count, implicit);
}

pub(crate) fn reaction(params: &Params, columns: &mut Columns) {
    let (fluid, bodies) = (&columns.fluid, &columns.bodies.states.0);
    let mut wrenches = given(&columns.bodies.fluid_wrenches.0, bodies.len());
    let scale = f64::from(params.fluid.particle_mass) * f64::from(params.step);
    for i in 0..columns.rows.fluid {
        let x = vector(fluid.position[i]);
        let v = vector(fluid.velocity[i]) + vector(fluid.viscosity_change[i]);
        for (body, wrench) in bodies.iter().zip(&mut wrenches).filter(|(body, _)| body.no_slip) {
            let (distance, normal) = shapes::distance(body, x);
            let slowed = friction(rate(params, distance), normal) * (v - shapes::velocity(body, x));
            wrench.add(slowed * scale, x - body.state.position.as_dvec3());
        }
    }
    columns.bodies.fluid_wrenches.0 = wrenches;
}

pub(crate) fn kick(_params: &Params, columns: &mut Columns) {
    let (fluid, count) = (&mut columns.fluid, columns.rows.fluid);
    let share = if fluid.viscosity_solve.is_solved() { 1.0 } else { 0.0 };
    for i in 0..count {
        let change = vector(fluid.viscosity_change[i]) + share * vector(fluid.viscosity_residual[i]);
        fluid.velocity[i] = keep(fluid.velocity[i], vector(fluid.velocity[i]) + change);
    }
}
