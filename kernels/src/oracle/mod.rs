//! Oracles: every kernel as a plain loop in f64 over all pairs.
//!
//! An oracle is written from the formula in the documentation of its kernel, without lists, cells, lanes or threads. It
//! writes to the same columns, rounded at the end. Rows in use are right; padding rows are not meant to be read. Where a
//! kernel may choose an order (of rows or of a list), the oracle keeps the present order. Compare by identity (`fluid.id`,
//! `controls.node`), not by row.

use glam::DVec3;

use crate::params::Params;

pub(crate) mod couple;
pub(crate) mod descent;
pub(crate) mod divergence;
pub(crate) mod grid;
mod images;
pub(crate) mod incompressible;
mod noise;
pub(crate) mod obstacles;
pub(crate) mod pbd;
pub(crate) mod porous;
mod shapes;
mod shift;
pub(crate) mod solid;
pub(crate) mod sph;
pub(crate) mod strain;
pub(crate) mod surface;
pub(crate) mod tets;
pub(crate) mod touch;
pub(crate) mod viscosity;
pub(crate) mod wetting;

/// The first three floats of a row.
fn vector(row: [f32; 4]) -> DVec3 {
    DVec3::new(f64::from(row[0]), f64::from(row[1]), f64::from(row[2]))
}

/// The first `count` rows as vectors.
fn vectors(rows: &[[f32; 4]], count: usize) -> Vec<DVec3> {
    rows[..count].iter().map(|row| vector(*row)).collect()
}

/// `a - b`, with the nearest image of b along periodic axes.
pub(crate) fn apart(params: &Params, a: DVec3, b: DVec3) -> DVec3 {
    let raw = a - b;
    let periods = params.periodic.map_or(DVec3::ZERO, |periodic| periodic.periods().as_dvec3());
    DVec3::select(periods.cmpgt(DVec3::ZERO), raw - periods * (raw / periods).round(), raw)
}

/// A row of a vector and a scalar.
fn row(vector: DVec3, w: f64) -> [f32; 4] {
    [vector.x as f32, vector.y as f32, vector.z as f32, w as f32]
}

/// A row with another vector and the scalar that it has.
fn keep(old: [f32; 4], vector: DVec3) -> [f32; 4] {
    row(vector, f64::from(old[3]))
}

/// 1 - r / H, at least zero.
fn closeness(support_radius: f32, distance: f64) -> f64 {
    (1.0 - distance / f64::from(support_radius)).max(0.0)
}

/// pi H^n.
fn pi_power(support_radius: f32, exponent: i32) -> f64 {
    std::f64::consts::PI * f64::from(support_radius).powi(exponent)
}

/// Wendland's function, 21 / (2 pi H^3) (1 - q)^4 (4 q + 1).
fn smoothing(support_radius: f32, distance: f64) -> f64 {
    let (u, q) = (closeness(support_radius, distance), distance / f64::from(support_radius));
    21.0 / (2.0 * pi_power(support_radius, 3)) * u.powi(4) * (4.0 * q + 1.0)
}

/// Its gradient at `offset`.
fn gradient(support_radius: f32, offset: DVec3) -> DVec3 {
    offset * (-210.0 / pi_power(support_radius, 5) * closeness(support_radius, offset.length()).powi(3))
}
