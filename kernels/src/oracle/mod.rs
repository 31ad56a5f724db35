//! Oracles: every kernel once more, as a plain loop in f64 over all pairs.
//!
//! An oracle is written from the formula in the documentation of its kernel, knows no lists, cells, lanes or
//! threads, and writes to the same columns, rounded at the end. Rows in use are right; padding rows are not
//! meant to be read. Where a kernel may choose an order (of rows or of a list), the oracle keeps the order it
//! finds: compare by identity (`fluid.id`, `controls.node`), not by row.

use glam::DVec3;

use crate::{columns::Columns, params::Params};

mod couple;
mod descent;
mod grid;
mod incompressible;
mod obstacles;
mod pbd;
mod porous;
mod shapes;
mod sph;
mod surface;
mod touch;
mod viscosity;
mod wetting;

/// A kernel as a plain loop in f64.
pub type Oracle = fn(&Params, &mut Columns);

/// The oracle of the kernel of that name.
#[must_use]
pub fn oracle(name: &str) -> Option<Oracle> {
    let found: Oracle = match name {
        "grid::sort_fluid" => grid::sort_fluid,
        "grid::fluid_neighbors" => grid::fluid_neighbors,
        "sph::density" => sph::density,
        "sph::pressure" => sph::pressure,
        "sph::forces" => sph::forces,
        "sph::surface_tension" => sph::surface_tension,
        "sph::deficit" => surface::deficit,
        "sph::cohesion" => surface::cohesion,
        "sph::repulsion" => sph::repulsion,
        "sph::boundary_pressure" => incompressible::boundary_pressure,
        "sph::wall_friction" => obstacles::wall_friction,
        "sph::kick" => sph::kick,
        "sph::viscosity_begin" => viscosity::begin,
        "sph::viscosity_product" => viscosity::product,
        "sph::viscosity_update" => viscosity::update,
        "sph::viscosity_reaction" => viscosity::reaction,
        "sph::viscosity_kick" => viscosity::kick,
        "sph::predict" => incompressible::predict,
        "sph::boundary" => incompressible::boundary,
        "sph::factors" => incompressible::factors,
        "sph::pressure_update" => incompressible::pressure_update,
        "sph::pressure_acceleration" => incompressible::pressure_acceleration,
        "sph::pressure_residual" => incompressible::pressure_residual,
        "sph::pressure_kick" => incompressible::pressure_kick,
        "sph::position_correction" => incompressible::position_correction,
        "sph::boundary_reaction" => incompressible::boundary_reaction,
        "sph::sweep" => obstacles::sweep_fluid,
        "sph::advect" => sph::advect,
        "pbd::gravity" => pbd::gravity,
        "pbd::predict" => pbd::predict,
        "pbd::guess" => descent::guess,
        "pbd::pairs" => touch::pairs,
        "pbd::touch" => touch::touch,
        "pbd::strain" => pbd::strain,
        "pbd::xpbd_neo_hookean" => pbd::xpbd_neo_hookean,
        "pbd::vbd" => descent::vbd,
        "pbd::reaction" => descent::reaction,
        "pbd::momentum" => descent::momentum,
        "pbd::contact" => pbd::contact,
        "pbd::velocity" => pbd::velocity,
        "couple::controls" => couple::controls,
        "couple::saturation" => couple::saturation,
        "couple::wetting" => wetting::wetting,
        "couple::interior" => couple::interior,
        "couple::suction" => couple::suction,
        "couple::zero_distance" => couple::zero_distance,
        "couple::control_velocity" => couple::control_velocity,
        "couple::drag" => couple::drag,
        "couple::velocity_filter" => couple::velocity_filter,
        "couple::exchange" => couple::exchange,
        "couple::pores" => porous::pores,
        "couple::solid_pressure" => porous::solid_pressure,
        "couple::solid_share" => porous::solid_share,
        "couple::solid_yield" => incompressible::solid_yield,
        "couple::solid_reaction" => porous::solid_reaction,
        "couple::node_velocity" => porous::node_velocity,
        "couple::drag_impulse" => porous::drag_impulse,
        "couple::drag_target" => porous::drag_target,
        "couple::drag_reaction" => porous::drag_reaction,
        "couple::drag_settled" => porous::drag_settled,
        "couple::drag_kick" => porous::drag_kick,
        _ => return None,
    };
    Some(found)
}

/// The first three floats of a row.
fn vector(row: [f32; 4]) -> DVec3 {
    DVec3::new(f64::from(row[0]), f64::from(row[1]), f64::from(row[2]))
}

/// The first `count` rows as vectors.
fn vectors(rows: &[[f32; 4]], count: usize) -> Vec<DVec3> {
    rows[..count].iter().map(|row| vector(*row)).collect()
}

/// `a - b`, with the image of b that is nearest to a where space repeats.
pub(crate) fn apart(params: &Params, a: DVec3, b: DVec3) -> DVec3 {
    let raw = a - b;
    let periods = params.periodic.map_or(DVec3::ZERO, |periodic| periodic.periods().as_dvec3());
    DVec3::select(periods.cmpgt(DVec3::ZERO), raw - periods * (raw / periods).round(), raw)
}

/// A row of a vector and a scalar.
fn row(vector: DVec3, w: f64) -> [f32; 4] {
    [vector.x as f32, vector.y as f32, vector.z as f32, w as f32]
}

/// 1 - r / H, not below zero.
fn closeness(support_radius: f32, distance: f64) -> f64 {
    (1.0 - distance / f64::from(support_radius)).max(0.0)
}

/// pi H^n.
fn pi_power(support_radius: f32, exponent: i32) -> f64 {
    std::f64::consts::PI * f64::from(support_radius).powi(exponent)
}

/// Wendland's kernel, 21 / (2 pi H^3) (1 - q)^4 (4 q + 1).
fn smoothing(support_radius: f32, distance: f64) -> f64 {
    let (u, q) = (closeness(support_radius, distance), distance / f64::from(support_radius));
    21.0 / (2.0 * pi_power(support_radius, 3)) * u.powi(4) * (4.0 * q + 1.0)
}

/// Its gradient at `offset`.
fn gradient(support_radius: f32, offset: DVec3) -> DVec3 {
    offset * (-210.0 / pi_power(support_radius, 5) * closeness(support_radius, offset.length()).powi(3))
}
