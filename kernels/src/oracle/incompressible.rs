//! The pressure solve, pair by pair.

use glam::{DQuat, DVec3};

use super::{apart, closeness, keep, row, shapes, smoothing, vector, vectors};
use crate::{
    body::{Body, Wrench},
    columns::{Columns, Fluid, lane},
    params::Params,
};

/// `c_ij` at the predicted positions of all pairs that are neighbours at the beginning of the step.
fn pairs(params: &Params, fluid: &Fluid, count: usize) -> Vec<Vec<(usize, f64)>> {
    pairs_at(params, fluid, &vectors(&fluid.predicted, count))
}

/// The same at other positions.
pub(super) fn pairs_at(params: &Params, fluid: &Fluid, end: &[DVec3]) -> Vec<Vec<(usize, f64)>> {
    let (count, x) = (end.len(), vectors(&fluid.position, end.len()));
    let reach = f64::from(params.fluid.list_radius());
    let near = |i: usize, j: usize| apart(params, x[i], x[j]).length() < reach;
    let pair = |i: usize, j: usize| (j, factor(params, apart(params, end[i], end[j])));
    (0..count).map(|i| (0..count).filter(|j| near(i, *j)).map(|j| pair(i, j)).collect()).collect()
}

/// `c_ij` at an offset.
pub(super) fn factor(params: &Params, apart: DVec3) -> f64 {
    let radius = params.fluid.smoothing.support_radius;
    let volume = f64::from(params.fluid.particle_mass) / f64::from(params.fluid.rest_density);
    volume * 210.0 / super::pi_power(radius, 5) * closeness(radius, apart.length()).powi(3)
}

fn box_inside(params: &Params) -> Option<(DVec3, DVec3)> {
    let margin = DVec3::splat(f64::from(params.fluid.spacing) * 0.05);
    params.walls.map(|(low, high)| (low.as_dvec3() + margin, high.as_dvec3() - margin))
}

/// Stabilisation coefficient of a single step: with a delay of eight times its root, or a fifth of the square of the step.
fn prompt_roughness(params: &Params) -> f64 {
    let roughness = f64::from(params.fluid.roughness);
    let step = f64::from(params.step);
    let delayed = roughness / (1.0 + 8.0 * roughness.sqrt() / step);
    roughness.min(delayed.max(0.2 * step.powi(2)))
}

pub(crate) fn predict(params: &Params, columns: &mut Columns) {
    let fluid = &mut columns.fluid;
    fluid.predicted.resize(fluid.position.len(), [0.0; 4]);
    for i in 0..columns.rows.fluid {
        let end = vector(fluid.position[i]) + f64::from(params.step) * vector(fluid.velocity[i]);
        let end = box_inside(params).map_or(end, |(low, high)| end.clamp(low, high));
        fluid.predicted[i] = row(end, 0.0);
        let share = prompt_roughness(params) / f64::from(params.fluid.roughness);
        let [w, asked] = [
            fluid.velocity[i][lane::fluid::velocity::ALLOWED_COMPRESSION],
            fluid.acceleration[i][lane::fluid::acceleration::ALLOWED_COMPRESSION],
        ]
        .map(f64::from);
        let before = if w.abs() <= 1.0 { w } else { 0.0 };
        let allowed = (1.0 - share) * before + share * asked;
        fluid.velocity[i][lane::fluid::velocity::ALLOWED_COMPRESSION] = allowed as f32;
        fluid.acceleration[i][lane::fluid::acceleration::ALLOWED_COMPRESSION] =
            ((1.0 - share) * allowed + share * asked) as f32;
    }
}

/// Range and share at the surface of the volume fraction of walls and bodies: none without a pressure solve.
fn profile(params: &Params) -> [f64; 2] {
    let solve = params.fluid.incompressible.as_ref();
    solve.map_or([1.0, 0.0], |solve| [solve.boundary_range, solve.boundary_share].map(f64::from))
}

/// Slope of such a volume fraction into a surface at a distance, and the fraction.
fn at([range, share]: [f64; 2], distance: f64) -> (f64, f64) {
    let depth = (1.0 - distance / range).clamp(0.0, 1.25);
    (6.0 * share / range * depth.powi(5), share * depth.powi(6))
}

fn walls(params: &Params, profile: [f64; 2], x: DVec3) -> (DVec3, f64) {
    let (mut slope, mut share) = (DVec3::ZERO, 0.0);
    let Some((low, high)) = params.walls else { return (slope, share) };
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        let below = at(profile, (x - low.as_dvec3()).dot(axis));
        let above = at(profile, (high.as_dvec3() - x).dot(axis));
        slope += axis * (above.0 - below.0);
        share += below.1 + above.1;
    }
    (slope, share)
}

fn solid(body: &Body, profile: [f64; 2], x: DVec3) -> (DVec3, f64) {
    let (distance, normal) = shapes::distance(body, x);
    let (slope, share) = at(profile, distance);
    (normal * -slope, share)
}

fn at_end(params: &Params, columns: &Columns) -> Vec<Body> {
    let step = f64::from(params.step);
    let moved = |body: &Body| {
        let mut body = body.clone();
        let state = &mut body.state;
        state.position = (state.position.as_dvec3() + step * state.linear_velocity.as_dvec3()).as_vec3();
        let half = 0.5 * step * state.angular_velocity.as_dvec3();
        let turn = DQuat::from_xyzw(half.x, half.y, half.z, 1.0).normalize();
        state.rotation = (turn * state.rotation.as_dquat()).normalize().as_quat();
        body
    };
    columns.bodies.states.0.iter().map(moved).collect()
}

pub(crate) fn boundary(params: &Params, columns: &mut Columns) {
    let bodies = at_end(params, columns);
    let fluid = &mut columns.fluid;
    fluid.boundary.resize(fluid.position.len(), [0.0; 4]);
    for i in 0..columns.rows.fluid {
        let x = vector(fluid.predicted[i]);
        let (mut slope, mut share) = walls(params, profile(params), x);
        for body in &bodies {
            let own = solid(body, profile(params), x);
            (slope, share) = (slope + own.0, share + own.1);
        }
        fluid.boundary[i] = row(slope, share);
    }
}

pub(crate) fn boundary_pressure(params: &Params, columns: &mut Columns) {
    let (fluid, bodies) = (&mut columns.fluid, &columns.bodies.states.0);
    let mut wrenches = vec![Wrench::default(); bodies.len()];
    let momentum = f64::from(params.fluid.particle_mass) * f64::from(params.step);
    for i in 0..columns.rows.fluid {
        let x = vector(fluid.position[i]);
        let pressure = f64::from(fluid.position[i][lane::fluid::position::PRESSURE_OVER_SQUARED_DENSITY])
            * f64::from(params.fluid.rest_density);
        let mut slope = walls(params, profile(params), x).0;
        for (body, wrench) in bodies.iter().zip(&mut wrenches) {
            let own = solid(body, profile(params), x).0;
            slope += own;
            wrench.add(own * (pressure * momentum), x - body.state.position.as_dvec3());
        }
        let allowed = f64::from(fluid.acceleration[i][lane::fluid::acceleration::ALLOWED_COMPRESSION]);
        fluid.acceleration[i] = row(vector(fluid.acceleration[i]) - pressure * slope, allowed);
    }
    columns.bodies.fluid_wrenches.0 = wrenches;
}

pub(crate) fn boundary_reaction(params: &Params, columns: &mut Columns) {
    let bodies = at_end(params, columns);
    let momentum = f64::from(params.fluid.particle_mass) * f64::from(params.step);
    let fluid = &columns.fluid;
    let mut wrenches: Vec<Wrench> =
        (0..bodies.len()).map(|body| columns.bodies.fluid_wrenches.total(body, bodies.len())).collect();
    for i in 0..columns.rows.fluid {
        let x = vector(fluid.predicted[i]);
        let impulse = f64::from(fluid.predicted[i][lane::fluid::predicted::PRESSURE_CHANGE]) * momentum;
        for (body, wrench) in bodies.iter().zip(&mut wrenches) {
            wrench.add(solid(body, profile(params), x).0 * impulse, x - body.state.position.as_dvec3());
        }
    }
    columns.bodies.fluid_wrenches.0 = wrenches;
}

pub(crate) fn factors(params: &Params, columns: &mut Columns) {
    let (fluid, count) = (&mut columns.fluid, columns.rows.fluid);
    let Some(solve) = &params.fluid.incompressible else { return };
    let near = pairs(params, fluid, count);
    let (x, end) = (vectors(&fluid.position, count), vectors(&fluid.predicted, count));
    let (step, spacing) = (f64::from(params.step), f64::from(params.fluid.spacing));
    let density = f64::from(params.fluid.rest_density);
    let volume = f64::from(params.fluid.particle_mass) / density;
    fluid.solid_yield.clear();
    fluid.factors.resize(fluid.position.len(), [0.0; 4]);
    fluid.pressure_rows.resize(fluid.position.len(), [0.0; 4]);
    let mut squares = 0.0;
    for i in 0..count {
        let mut own = -vector(fluid.boundary[i]);
        let (mut others, mut share) = (0.0, f64::from(fluid.boundary[i][lane::fluid::boundary::SHARE]));
        let mut rough = 0.0;
        for (j, c) in &near[i] {
            let offset = apart(params, end[i], end[*j]);
            own += *c * offset;
            others += (*c * offset).length_squared();
            rough += if *j == i { 0.0 } else { *c * prompt_roughness(params) };
            share += volume * smoothing(params.fluid.smoothing.support_radius, offset.length());
        }
        let maximum = f64::from(solve.correction_speed) * step / spacing;
        let compression = (share - 1.0
            + f64::from(fluid.acceleration[i][lane::fluid::acceleration::ALLOWED_COMPRESSION]))
        .min(maximum);
        let wide = (own.length_squared() + others).max(f64::from(solve.lattice_diagonal) / 3.0);
        let diagonal = wide * step * step + rough;
        fluid.factors[i] = row(own, compression);
        let pressure =
            f64::from(fluid.position[i][lane::fluid::position::PRESSURE_OVER_SQUARED_DENSITY]) * density;
        fluid.pressure_rows[i] = [pressure as f32, 0.0, diagonal as f32, compression as f32];
        squares += end[i].distance_squared(x[i]);
    }
    write_pairs(fluid, &near);
    let displacement = (squares / count.max(1) as f64).sqrt() / spacing;
    fluid.pressure_solve.begin_with(displacement as f32, solve);
}

/// Keeps the lists, and sets the value of every entry.
pub(super) fn write_pairs(fluid: &mut Fluid, near: &[Vec<(usize, f64)>]) {
    let Fluid { neighbors, pairs, .. } = fluid;
    pairs.fill(neighbors, |query, target| {
        let found = near.get(query).and_then(|near| near.iter().find(|(j, _)| *j == target));
        found.map_or(0.0, |(_, c)| *c as f32)
    });
}

pub(crate) fn pressure_update(params: &Params, columns: &mut Columns) {
    let fluid = &mut columns.fluid;
    let Some(solve) = &params.fluid.incompressible else { return };
    let maximum = 100.0 * f64::from(solve.correction_speed).powi(2);
    let length = f64::from(fluid.pressure_solve.length());
    let density = f64::from(params.fluid.rest_density);
    for i in 0..columns.rows.fluid {
        let [pressure, _, diagonal, compression] = fluid.pressure_rows[i].map(f64::from);
        let next = (pressure + length * compression / diagonal).clamp(0.0, maximum);
        fluid.pressure_rows[i][lane::fluid::pressure_rows::PRESSURE] = next as f32;
        fluid.pressure_rows[i][lane::fluid::pressure_rows::CHANGE] = (next - pressure) as f32;
        fluid.predicted[i][lane::fluid::predicted::PRESSURE_CHANGE] = (next
            - density * f64::from(fluid.position[i][lane::fluid::position::PRESSURE_OVER_SQUARED_DENSITY]))
            as f32;
    }
}

pub(crate) fn pressure_acceleration(params: &Params, columns: &mut Columns) {
    let (fluid, count) = (&mut columns.fluid, columns.rows.fluid);
    let near = pairs(params, fluid, count);
    let end = vectors(&fluid.predicted, count);
    let origin = params.origin().as_dvec3();
    let roughness = prompt_roughness(params) / f64::from(params.step).powi(2);
    fluid.correction.resize(fluid.position.len(), [0.0; 4]);
    for i in 0..count {
        let mut sum =
            f64::from(fluid.predicted[i][lane::fluid::predicted::PRESSURE_CHANGE]) * vector(fluid.factors[i]);
        for (j, c) in &near[i] {
            sum += *c
                * f64::from(fluid.predicted[*j][lane::fluid::predicted::PRESSURE_CHANGE])
                * apart(params, end[i], end[*j]);
        }
        let allowed = f64::from(fluid.predicted[i][lane::fluid::predicted::PRESSURE_CHANGE]) * roughness;
        fluid.correction[i] = row(sum, sum.dot(end[i] - origin) - allowed);
    }
}

pub(crate) fn solid_yield(params: &Params, columns: &mut Columns) {
    let (fluid, count) = (&mut columns.fluid, columns.rows.fluid);
    let near = pairs(params, fluid, count);
    fluid.solid_yield.resize(fluid.position.len(), 0.0);
    let follows = |row: usize| f64::from(fluid.drag_rate[row][lane::fluid::drag_rate::COMPLIANCE]);
    let change = |row: usize| f64::from(fluid.predicted[row][lane::fluid::predicted::PRESSURE_CHANGE]);
    for (i, near) in near.iter().enumerate() {
        let sum: f64 = near.iter().map(|(j, c)| c * follows(*j) * (change(*j) - change(i))).sum();
        fluid.solid_yield[i] = (2.0 * follows(i) * sum) as f32;
    }
}

pub(crate) fn pressure_residual(params: &Params, columns: &mut Columns) {
    let (fluid, count) = (&mut columns.fluid, columns.rows.fluid);
    let Some(solve) = &params.fluid.incompressible else { return };
    let near = pairs(params, fluid, count);
    let (end, a) = (vectors(&fluid.predicted, count), vectors(&fluid.correction, count));
    let square = f64::from(params.step).powi(2);
    // The last is for the divergence.
    let mut sums = [0.0; 6];
    for i in 0..count {
        let mut change = -a[i].dot(vector(fluid.factors[i]));
        let mut smoother = 0.0;
        for (j, c) in &near[i] {
            change += *c * a[*j].dot(apart(params, end[i], end[*j]));
            smoother += *c
                * (f64::from(fluid.predicted[*j][lane::fluid::predicted::PRESSURE_CHANGE])
                    - f64::from(fluid.predicted[i][lane::fluid::predicted::PRESSURE_CHANGE]));
        }
        let allowed = prompt_roughness(params) * smoother;
        change += fluid.solid_yield.get(i).map_or(0.0, |yields| f64::from(*yields));
        let left = f64::from(fluid.factors[i][lane::fluid::factors::COMPRESSION]) + square * change + allowed;
        let [pressure, step, diagonal, before] = fluid.pressure_rows[i].map(f64::from);
        let response = before - left;
        sums[0] += if left > 0.0 { left } else { (-left).min(pressure * diagonal) };
        sums[1] += step * step * diagonal;
        sums[2] += step * response;
        sums[3] += response * response / diagonal;
        sums[4] += pressure * pressure;
        fluid.pressure_rows[i][lane::fluid::pressure_rows::COMPRESSION] = left as f32;
    }
    fluid.pressure_solve.finish_with(sums, count, solve);
}

pub(crate) fn pressure_kick(params: &Params, columns: &mut Columns) {
    let fluid = &mut columns.fluid;
    let density = f64::from(params.fluid.rest_density);
    for i in 0..columns.rows.fluid {
        let v = vector(fluid.velocity[i]) + f64::from(params.step) * vector(fluid.correction[i]);
        fluid.velocity[i] = keep(fluid.velocity[i], v);
        fluid.position[i][lane::fluid::position::PRESSURE_OVER_SQUARED_DENSITY] =
            (f64::from(fluid.pressure_rows[i][lane::fluid::pressure_rows::PRESSURE]) / density) as f32;
    }
}

pub(crate) fn position_correction(params: &Params, columns: &mut Columns) {
    let fluid = &mut columns.fluid;
    let step = f64::from(params.step);
    for i in 0..columns.rows.fluid {
        let change = step * vector(fluid.correction[i]);
        let end = vector(fluid.predicted[i]) + step * change;
        let end = box_inside(params).map_or(end, |(low, high)| end.clamp(low, high));
        fluid.predicted[i] = keep(fluid.predicted[i], end);
        fluid.velocity[i] = keep(fluid.velocity[i], vector(fluid.velocity[i]) + change);
    }
}
