//! Surface tension from a surface energy, pair by pair.

use std::f64::consts::TAU;

use glam::DVec3;

use super::{apart, gradient, obstacles::given, row, shapes, smoothing, vector, vectors};
use crate::{
    body::Body,
    columns::{Columns, lane},
    params::Params,
};

pub(crate) fn deficit(params: &Params, columns: &mut Columns) {
    let Some(cohesion) = &params.fluid.cohesion else { return };
    let (fluid, count) = (&mut columns.fluid, columns.rows.fluid);
    let x = vectors(&fluid.position, count);
    let (radius, volume) = (cohesion.smoothing.support_radius, f64::from(cohesion.volume));
    fluid.deficit.resize(fluid.position.len(), 0.0);
    fluid.adhesion.resize(fluid.position.len(), 0.0);
    for i in 0..count {
        let volume_at = |other: &DVec3| volume * smoothing(radius, apart(params, x[i], *other).length());
        let there: f64 = x.iter().map(volume_at).sum();
        let open =
            beyond(params, &columns.bodies.states.0, x[i]).iter().map(|beyond| beyond.1).product::<f64>();
        let filled = (0.05 + there) / open;
        let lacks = weight((1.03 - filled).max(0.0));
        fluid.deficit[i] = (lacks / open) as f32;
        fluid.adhesion[i] = (lacks * filled) as f32;
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

/// Of the walls, and of every body: the slope of the logarithm of what they leave of the smoothing function, and what they leave.
fn beyond(params: &Params, bodies: &[Body], x: DVec3) -> Vec<(DVec3, f64)> {
    let radius = params.fluid.cohesion.as_ref().map_or(1.0, |cohesion| cohesion.smoothing.support_radius);
    let at = |distance: f64, into: DVec3| {
        let (slope, part) = half_space(radius, distance);
        (into * slope / (1.0 - part), 1.0 - part)
    };
    let mut all = vec![(DVec3::ZERO, 1.0)];
    if let Some((low, high)) = params.walls {
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            let below = at((x - low.as_dvec3()).dot(axis), -axis);
            let above = at((high.as_dvec3() - x).dot(axis), axis);
            all[0] = (all[0].0 + below.0 + above.0, all[0].1 * below.1 * above.1);
        }
    }
    all.extend(bodies.iter().map(|body| {
        let (distance, normal) = shapes::distance(body, x);
        at(distance, -normal)
    }));
    all
}

/// Slope and part of a smoothing function beyond a plane, by slices of it.
fn half_space(radius: f32, distance: f64) -> (f64, f64) {
    const SLICES: usize = 2000;
    let end = f64::from(radius);
    let from = distance.clamp(0.0, end);
    let width = (end - from) / SLICES as f64;
    // From the outside: a plane at z holds 2 pi int r W dr from z to H.
    let (mut plane, mut part) = (0.0, 0.0);
    for k in (0..SLICES).rev() {
        let r = from + (k as f64 + 0.5) * width;
        let ring = TAU * r * smoothing(radius, r) * width;
        part += (plane + 0.5 * ring) * width;
        plane += ring;
    }
    (plane, part)
}

pub(crate) fn adhesion(params: &Params, columns: &mut Columns) {
    let Some(cohesion) = &params.fluid.cohesion else { return };
    let (fluid, bodies) = (&mut columns.fluid, &columns.bodies.states.0);
    let mut wrenches = given(&columns.bodies.fluid_wrenches.0, bodies.len());
    let mass = f64::from(params.fluid.particle_mass);
    let stiffness = f64::from(cohesion.stiffness) * f64::from(cohesion.volume) / mass;
    for i in 0..columns.rows.fluid {
        let x = vector(fluid.position[i]);
        let pull = stiffness * f64::from(fluid.adhesion[i]);
        let slopes = beyond(params, bodies, x);
        for ((slope, _), (body, wrench)) in slopes[1..].iter().zip(bodies.iter().zip(&mut wrenches)) {
            let impulse = -pull * mass * f64::from(params.step) * *slope;
            wrench.add(impulse, x - body.state.position.as_dvec3());
        }
        let sum: DVec3 = slopes.iter().map(|(slope, _)| *slope).sum();
        let allowed = f64::from(fluid.acceleration[i][lane::fluid::acceleration::ALLOWED_COMPRESSION]);
        fluid.acceleration[i] = row(vector(fluid.acceleration[i]) + pull * sum, allowed);
    }
    columns.bodies.fluid_wrenches.0 = wrenches;
}
