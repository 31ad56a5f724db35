//! The pressure solve for the divergence, pair by pair.

use glam::{DMat3, DVec3};

use super::{
    apart,
    images::{Seen, Twist, reflected, seen, store_images},
    incompressible::{factor, pairs_at, write_pairs},
    keep, row, smoothing, vector, vectors,
};
pub(crate) use super::{
    images::images,
    noise::{approach, damping},
    shift::shift,
};
use crate::{
    body::{Body, Wrench},
    columns::{BodyStore, Columns, Fluid, lane},
    params::Params,
};

/// A particle or an image within the support radius of another: offset from it, `c_ij`, and which.
pub(super) enum Other {
    Particle(usize),
    Image(usize),
}

/// All pairs of a particle, from offsets `x_i - x_j`.
pub(super) fn pairs_of(params: &Params, x: &[DVec3], images: &[Seen], i: usize) -> Vec<(DVec3, f64, Other)> {
    let particles = (0..x.len()).map(|j| (apart(params, x[i], x[j]), 1.0, Other::Particle(j)));
    let images = images.iter().enumerate();
    let images =
        images.map(|(j, image)| (apart(params, x[i], image.position), image.volume, Other::Image(j)));
    let reach = f64::from(params.fluid.smoothing.support_radius);
    let near = particles.chain(images).filter(|(offset, ..)| offset.length() < reach);
    near.map(|(offset, volume, other)| (offset, volume * factor(params, offset), other)).collect()
}

fn volume(params: &Params) -> f64 {
    f64::from(params.fluid.particle_mass) / f64::from(params.fluid.rest_density)
}

pub(super) fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// Inverse of the second moment over that of a lattice, as far as it is near enough.
fn inverse(second: DMat3, moment: f64) -> DMat3 {
    let deviation = second * (1.0 / moment) - DMat3::IDENTITY;
    let norm = deviation.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt();
    let part = if norm > 0.7 { 0.7 / norm } else { 1.0 };
    (DMat3::IDENTITY + deviation * part).inverse() * (1.0 / moment)
}

pub(crate) fn moments(params: &Params, columns: &mut Columns) {
    let (fluid, count) = (&mut columns.fluid, columns.rows.fluid);
    let Some(divergence) = params.fluid.divergence() else { return };
    let x = vectors(&fluid.position, count);
    let images = seen(&fluid.images);
    let near = pairs_at(params, fluid, &x);
    write_pairs(fluid, &near);
    let rows = fluid.position.len();
    for column in [
        &mut fluid.renormalisation,
        &mut fluid.renormalisation_between,
        &mut fluid.moment,
        &mut fluid.factors,
        &mut fluid.pressure_rows,
    ] {
        column.resize(rows, [0.0; 4]);
    }
    let mut sums = [0.0; 4];
    for i in 0..count {
        // Beginning with the material of sponges.
        let (mut first, mut second) = (vector(fluid.moment[i]), renormalisation(fluid, i));
        let material = f64::from(fluid.moment[i][lane::fluid::moment::MATERIAL]);
        let mut density = material;
        let pairs = pairs_of(params, &x, &images, i);
        for (offset, c, other) in &pairs {
            let ratio = if let Other::Image(image) = other { images[*image].volume } else { 1.0 };
            first -= *c * *offset;
            second += outer(*offset, *offset) * *c;
            density +=
                ratio * volume(params) * smoothing(params.fluid.smoothing.support_radius, offset.length());
        }
        let inverse = inverse(second, f64::from(divergence.lattice_moment));
        let (mut own, mut squares) = (-(inverse * first), 0.0);
        for (offset, c, other) in &pairs {
            let push = inverse * (-*offset * *c);
            match other {
                Other::Image(image) if images[*image].source == i => {
                    own += images[*image].map.transpose() * push
                }
                _ => squares += push.length_squared(),
            }
        }
        let spacing = f64::from(params.fluid.spacing);
        let diagonal = (own.length_squared() + squares).max(1e-3 / (spacing * spacing));
        let share = (first.length() / f64::from(divergence.surface_moment) - 0.25) / 0.75;
        let error = density + share.max(0.0) * f64::from(divergence.surface_lack) - 1.0;
        let slow = (f64::from(params.step) / 0.02).min(0.2);
        let (dead_zone, part) = if material > 0.02 { (5e-3, slow) } else { (1e-3, 0.2) };
        let target = error.signum() * (error.abs() - dead_zone).clamp(0.0, 0.25) * part;
        let diagonals = DVec3::new(inverse.x_axis.x, inverse.y_axis.y, inverse.z_axis.z);
        fluid.renormalisation[i] = row(diagonals, density);
        fluid.renormalisation_between[i] =
            row(DVec3::new(inverse.y_axis.z, inverse.z_axis.x, inverse.x_axis.y), 0.0);
        fluid.moment[i] = row(first, material);
        fluid.factors[i] = row(-(inverse * first), target);
        let before = fluid.velocity[i][lane::fluid::velocity::PRESSURE];
        let before = if density < 0.75 { 0.0 } else { before };
        fluid.pressure_rows[i] = [before, 0.0, (diagonal * f64::from(params.step).powi(2)) as f32, 0.0];
        sums[0] += vector(fluid.velocity[i]).length_squared();
        let is_open = density < 0.75 || first.length() > 0.5 * f64::from(divergence.surface_moment);
        sums[3] += f64::from(u8::from(is_open));
        if material <= 0.02 {
            sums[1] += f64::from(fluid.velocity[i][lane::fluid::velocity::PRESSURE]).powi(2);
            sums[2] += target;
        }
    }
    fluid.pressure_solve.begin_divergence_with(sums, count, params);
    let mirrored = |image: &Seen| {
        let q = DMat3::from_diagonal(image.signs);
        let s = q * renormalisation(fluid, image.source) * q;
        let s = if image.body.is_some() { DMat3::ZERO } else { s };
        let along = DVec3::new(s.x_axis.x, s.y_axis.y, s.z_axis.z);
        (along, DVec3::new(s.y_axis.z, s.z_axis.x, s.x_axis.y))
    };
    let (along, between): (Vec<_>, Vec<_>) = images.iter().map(mirrored).unzip();
    let padded = fluid.images.position.len();
    store_images(&mut fluid.image_renormalisation.0, padded, &along);
    store_images(&mut fluid.image_renormalisation_between.0, padded, &between);
}

/// Renormalisation of a particle.
pub(super) fn renormalisation(fluid: &Fluid, i: usize) -> DMat3 {
    let [along, between] = [fluid.renormalisation[i], fluid.renormalisation_between[i]].map(vector);
    DMat3::from_cols(
        DVec3::new(along.x, between.z, between.y),
        DVec3::new(between.z, along.y, between.x),
        DVec3::new(between.y, between.x, along.z),
    )
}

/// The transpose of the divergence, without the mirrored pressures: every image receives a force and hands it on. Accelerations of the
/// particles, and what bodies receive over the mass of a particle.
fn transposed(
    params: &Params,
    fluid: &Fluid,
    bodies: &[Body],
    (images, count): (&[Seen], usize),
    pair: impl Fn(usize, Option<usize>) -> f64,
) -> (Vec<DVec3>, Vec<Wrench>) {
    let x = vectors(&fluid.position, count);
    let mut a = vec![DVec3::ZERO; count];
    let mut on_images = vec![DVec3::ZERO; images.len()];
    for i in 0..count {
        let own = renormalisation(fluid, i);
        for (offset, c, other) in pairs_of(params, &x, images, i) {
            // What i pushes its neighbours with, and itself by.
            match other {
                Other::Particle(j) => {
                    let push = own * offset * (c * pair(i, None));
                    a[j] -= push;
                    a[i] += push;
                }
                Other::Image(g) => {
                    let push = own * offset * (c * pair(i, Some(g)));
                    on_images[g] -= push;
                    a[i] += push;
                }
            }
        }
    }
    let mut wrenches = vec![Wrench::default(); bodies.len()];
    for (image, force) in images.iter().zip(on_images) {
        let back = image.map.transpose() * force;
        a[image.source] += back;
        if let Some(body) = image.body {
            let centre = bodies[body].state.position.as_dvec3();
            wrenches[body].add(image.signs * force, image.foot - centre);
            wrenches[body].add(-back, x[image.source] - centre);
        }
    }
    (a, wrenches)
}

fn scaled(wrenches: &[Wrench], scale: f64) -> Vec<Wrench> {
    let one = |wrench: &Wrench| Wrench {
        impulse: wrench.impulse * scale,
        angular_impulse: wrench.angular_impulse * scale,
    };
    wrenches.iter().map(one).collect()
}

pub(crate) fn hydrostatic(params: &Params, columns: &mut Columns) {
    if params.fluid.divergence().is_none() {
        return;
    }
    let (fluid, count, bodies) = (&mut columns.fluid, columns.rows.fluid, &columns.bodies.states.0);
    let periods = params.periodic.map_or(DVec3::ZERO, |periodic| periodic.periods().as_dvec3());
    let gravity = DVec3::select(periods.cmpgt(DVec3::ZERO), DVec3::ZERO, params.gravity.as_dvec3());
    let (images, x) = (seen(&fluid.images), vectors(&fluid.position, count));
    let higher = |image: &Seen| 0.5 * gravity.dot(image.position - x[image.source]);
    let pair = |_: usize, image: Option<usize>| image.map_or(0.0, |image| higher(&images[image]));
    let (a, wrenches) = transposed(params, fluid, bodies, (&images, count), pair);
    let momentum = f64::from(params.fluid.particle_mass) * f64::from(params.step);
    for (own, a) in fluid.acceleration.iter_mut().zip(a) {
        *own = keep(*own, vector(*own) + a);
    }
    columns.bodies.fluid_wrenches.0 = scaled(&wrenches, momentum);
    let forces = forces(params, fluid, (&images, count), |_, image| higher(image));
    store_images(&mut fluid.image_force.0, fluid.images.position.len(), &forces);
}

pub(crate) fn expect(params: &Params, columns: &mut Columns) {
    let store = &mut columns.bodies;
    let count = store.states.0.len();
    let found = store.states.0.iter().enumerate().map(|(index, body)| {
        let received = store.fluid_wrenches.total(index, count);
        let is_free = body.inverse_mass > 0.0;
        let weight = if is_free { params.gravity.as_dvec3() * f64::from(params.step) } else { DVec3::ZERO };
        let linear = received.impulse * f64::from(body.inverse_mass) + weight;
        let angular = body.inverse_inertia.as_dmat3() * received.angular_impulse;
        let state = &body.state;
        (state.linear_velocity.as_dvec3() + linear, state.angular_velocity.as_dvec3() + angular)
    });
    let found: Vec<Twist> = found.collect();
    (store.expected, store.expected_spin) = rows_of(&found);
}

fn rows_of(twists: &[Twist]) -> (Vec<[f32; 4]>, Vec<[f32; 4]>) {
    twists.iter().map(|(linear, angular)| (row(*linear, 0.0), row(*angular, 0.0))).unzip()
}

fn twists_of(linear: &[[f32; 4]], angular: &[[f32; 4]]) -> Vec<Twist> {
    linear.iter().zip(angular).map(|(linear, angular)| (vector(*linear), vector(*angular))).collect()
}

/// The opposite of the divergence.
fn rate(params: &Params, fluid: &Fluid, images: &[Seen], (v, of_images): (&[DVec3], &[DVec3])) -> Vec<f64> {
    let x = vectors(&fluid.position, v.len());
    let one = |i: usize| -> f64 {
        let own = renormalisation(fluid, i);
        let value = |other: &Other| match other {
            Other::Particle(j) => v[*j],
            Other::Image(j) => of_images[*j],
        };
        let pairs = pairs_of(params, &x, images, i);
        pairs.iter().map(|(offset, c, other)| c * (value(other) - v[i]).dot(own * *offset)).sum()
    };
    (0..v.len()).map(one).collect()
}

pub(super) fn is_sparse(fluid: &Fluid, i: usize) -> bool {
    fluid.renormalisation[i][lane::fluid::renormalisation::DENSITY] < 0.75
}

pub(crate) fn update(params: &Params, columns: &mut Columns) {
    let fluid = &mut columns.fluid;
    let Some(solve) = &params.fluid.incompressible else { return };
    let maximum = 100.0 * f64::from(solve.correction_speed).powi(2);
    let length = f64::from(fluid.pressure_solve.length());
    fluid.predicted.resize(fluid.position.len(), [0.0; 4]);
    for i in 0..columns.rows.fluid {
        let [pressure, _, diagonal, compression] = fluid.pressure_rows[i].map(f64::from);
        let next = (pressure + length * compression / diagonal).clamp(0.0, maximum);
        fluid.pressure_rows[i][lane::fluid::pressure_rows::PRESSURE] = next as f32;
        fluid.pressure_rows[i][lane::fluid::pressure_rows::CHANGE] = (next - pressure) as f32;
        fluid.predicted[i] = fluid.position[i];
        fluid.predicted[i][lane::fluid::predicted::PRESSURE] = next as f32;
    }
    let beside = |(image, source): (usize, &u32)| {
        let pressure = fluid.predicted[*source as usize][lane::fluid::predicted::PRESSURE];
        row(vector(fluid.images.position[image]), f64::from(pressure))
    };
    fluid.image_predicted.0 = fluid.images.source.iter().enumerate().map(beside).collect();
    fluid.image_predicted.0.resize(fluid.images.position.len(), crate::column::FAR_ROW);
}

pub(crate) fn acceleration(params: &Params, columns: &mut Columns) {
    if params.fluid.divergence().is_none() {
        return;
    }
    let count = columns.rows.fluid;
    let of_material = super::solid::first_moments(params, columns);
    let (fluid, store) = (&mut columns.fluid, &mut columns.bodies);
    let images = seen(&fluid.images);
    let pressure = |i: usize| f64::from(fluid.predicted[i][lane::fluid::predicted::PRESSURE]);
    let (mut a, wrenches) = transposed(params, fluid, &store.states.0, (&images, count), |i, _| pressure(i));
    for (i, a) in a.iter_mut().enumerate() {
        *a -= renormalisation(fluid, i) * of_material[i] * pressure(i);
    }
    let forces = forces(params, fluid, (&images, count), |j, _| pressure(j));
    let step = f64::from(params.step);
    let moved = |(a, v): (&DVec3, &[f32; 4])| row(vector(*v) + step * *a, 0.0);
    let velocities = a.iter().zip(&fluid.velocity).map(moved).collect();
    fluid.correction = velocities;
    fluid.correction.resize(fluid.position.len(), [0.0; 4]);
    store_images(&mut fluid.image_force.0, fluid.images.position.len(), &forces);
    let momentum = f64::from(params.fluid.particle_mass) * step;
    store.pressure_wrenches.0 = scaled(&wrenches, momentum);
    let expected = twists_of(&store.expected, &store.expected_spin);
    let pushed = |(index, body): (usize, &Body)| {
        let received = &store.pressure_wrenches.0[index];
        let linear = received.impulse * f64::from(body.inverse_mass);
        let angular = body.inverse_inertia.as_dmat3() * received.angular_impulse;
        (expected[index].0 + linear, expected[index].1 + angular)
    };
    let found: Vec<Twist> = store.states.0.iter().enumerate().map(pushed).collect();
    let BodyStore { solved, solved_spin, .. } = store;
    (*solved, *solved_spin) = rows_of(&found);
}

/// What images in bodies receive from particles that push as much as `pair` says; none in walls alone.
fn forces(
    params: &Params,
    fluid: &Fluid,
    (images, count): (&[Seen], usize),
    pair: impl Fn(usize, &Seen) -> f64,
) -> Vec<DVec3> {
    let x = vectors(&fluid.position, count);
    let one = |image: &Seen| {
        let push = |j: usize| {
            let offset = apart(params, image.position, x[j]);
            renormalisation(fluid, j) * offset * (image.volume * factor(params, offset) * pair(j, image))
        };
        if image.body.is_some() { (0..count).map(push).sum() } else { DVec3::ZERO }
    };
    images.iter().map(one).collect()
}

pub(crate) fn residual(params: &Params, columns: &mut Columns) {
    let (fluid, count, bodies) = (&mut columns.fluid, columns.rows.fluid, &columns.bodies.states.0);
    let Some(solve) = &params.fluid.incompressible else { return };
    let twists = twists_of(&columns.bodies.solved, &columns.bodies.solved_spin);
    let (images, a) = (seen(&fluid.images), vectors(&fluid.correction, count));
    let of_images = reflected(fluid, &images, &a, bodies, &twists);
    let rates = rate(params, fluid, &images, (&a, &of_images));
    let (h, scale) = (f64::from(params.step), f64::from(fluid.pressure_solve.target_scale()));
    let mut sums = [0.0; 6];
    for (i, rate) in rates.into_iter().enumerate() {
        let of_solid = f64::from(fluid.correction[i][lane::fluid::correction::COMPRESSION_RATE]);
        let is_in_pores = fluid.moment[i][lane::fluid::moment::MATERIAL] > 0.02;
        let target = f64::from(fluid.factors[i][lane::fluid::factors::TARGET]);
        let left = if is_in_pores { target } else { target * scale } + h * (rate + of_solid);
        let left = if is_sparse(fluid, i) { 0.0 } else { left };
        let [pressure, step, diagonal, before] = fluid.pressure_rows[i].map(f64::from);
        let response = before - left;
        let error = if left > 0.0 { left } else { (-left).min(pressure * diagonal) };
        sums[0] += error;
        sums[1] += step * step * diagonal;
        sums[2] += step * response;
        sums[3] += response * response / diagonal;
        let weight = if is_in_pores { 4.0 / 9.0 } else { 1.0 };
        sums[4] += (weight * pressure).powi(2);
        sums[5] += error.powi(4);
        fluid.pressure_rows[i][lane::fluid::pressure_rows::COMPRESSION] = left as f32;
    }
    fluid.pressure_solve.finish_with(sums, count, solve);
    store_images(&mut fluid.image_vectors.0, fluid.images.position.len(), &of_images);
}

pub(crate) fn kick(params: &Params, columns: &mut Columns) {
    if params.fluid.divergence().is_none() {
        return;
    }
    let fluid = &mut columns.fluid;
    for i in 0..columns.rows.fluid {
        let w = vector(fluid.correction[i]);
        fluid.velocity[i] = row(w, f64::from(fluid.pressure_rows[i][lane::fluid::pressure_rows::PRESSURE]));
    }
    let store = &mut columns.bodies;
    let count = store.states.0.len();
    let sums = (0..count).map(|body| {
        let (mut own, given) =
            (store.fluid_wrenches.total(body, count), store.pressure_wrenches.total(body, count));
        own.impulse += given.impulse;
        own.angular_impulse += given.angular_impulse;
        own
    });
    store.fluid_wrenches.0 = sums.collect();
}
