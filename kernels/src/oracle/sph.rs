//! The fluid, pair by pair.

use glam::DVec3;

use super::{apart, closeness, gradient, keep, pi_power, row, shapes, smoothing, vector, vectors};
use crate::{
    body::Wrench,
    columns::{Columns, lane},
    params::{EquationOfState, Params},
    reduce::{Extreme, Extremes},
};

pub(crate) fn density(params: &Params, columns: &mut Columns) {
    let fluid = &mut columns.fluid;
    let x = vectors(&fluid.position, columns.rows.fluid);
    let radius = params.fluid.smoothing.support_radius;
    let mass = f64::from(params.fluid.particle_mass);
    fluid.density.resize(fluid.position.len(), 0.0);
    for (x_i, density) in x.iter().zip(&mut fluid.density) {
        let sum: f64 = x.iter().map(|x_j| smoothing(radius, apart(params, *x_i, *x_j).length())).sum();
        *density = (mass * sum) as f32;
    }
}

pub(crate) fn pressure(params: &Params, columns: &mut Columns) {
    let fluid = &mut columns.fluid;
    let rest = f64::from(params.fluid.rest_density);
    let square = f64::from(params.fluid.sound_speed).powi(2);
    for row in 0..columns.rows.fluid {
        let density = f64::from(fluid.density[row]);
        let pressure = match params.fluid.equation_of_state {
            EquationOfState::Linear => square * (density - rest),
            EquationOfState::Tait => rest * square / 7.0 * ((density / rest).powi(7) - 1.0),
        };
        fluid.position[row][lane::fluid::position::PRESSURE_OVER_SQUARED_DENSITY] =
            (pressure.max(0.0) / density.powi(2)) as f32;
        fluid.velocity[row][lane::fluid::velocity::VOLUME] =
            (f64::from(params.fluid.particle_mass) / density) as f32;
    }
}

pub(crate) fn forces(params: &Params, columns: &mut Columns) {
    let (fluid, count) = (&mut columns.fluid, columns.rows.fluid);
    let (x, v) = (vectors(&fluid.position, count), vectors(&fluid.velocity, count));
    let radius = params.fluid.smoothing.support_radius;
    let (mass, rest) = (f64::from(params.fluid.particle_mass), f64::from(params.fluid.rest_density));
    let solves = params.fluid.incompressible.is_some();
    fluid.acceleration.resize(fluid.position.len(), [0.0; 4]);
    for i in 0..count {
        let (mut pressure, mut viscosity, mut central) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        let mut roughness = 0.0;
        for j in 0..count {
            let offset = apart(params, x[i], x[j]);
            let both = f64::from(fluid.position[i][lane::fluid::position::PRESSURE_OVER_SQUARED_DENSITY])
                + f64::from(fluid.position[j][lane::fluid::position::PRESSURE_OVER_SQUARED_DENSITY]);
            pressure -= mass * both * gradient(radius, offset);
            let laplacian = 45.0 / pi_power(radius, 5) * closeness(radius, offset.length());
            let volume = if solves {
                mass / rest
            } else {
                f64::from(fluid.velocity[j][lane::fluid::velocity::VOLUME])
            };
            viscosity += volume * laplacian * (v[j] - v[i]);
            let softened = offset.length_squared() + 0.0025 * f64::from(radius).powi(2);
            central -= 10.0 * volume * (v[j] - v[i]).dot(offset) / softened * gradient(radius, offset);
            let (own, other) = (
                f64::from(fluid.position[i][lane::fluid::position::PRESSURE_OVER_SQUARED_DENSITY]),
                f64::from(fluid.position[j][lane::fluid::position::PRESSURE_OVER_SQUARED_DENSITY]),
            );
            if own > 0.0 && other > 0.0 {
                let slope = 210.0 / pi_power(radius, 5) * closeness(radius, offset.length()).powi(3);
                let beyond = rest * (other - own) + params.gravity.as_dvec3().dot(offset);
                roughness += mass / rest * slope * beyond;
            }
        }
        // mu / rho_i, where the velocity row holds m / rho_i.
        let scale = if solves {
            1.0 / rest
        } else {
            f64::from(fluid.velocity[i][lane::fluid::velocity::VOLUME]) / mass
        };
        let viscosity = f64::from(params.fluid.viscosity) * viscosity;
        let central = f64::from(params.fluid.central_viscosity) * central;
        let sum = params.gravity.as_dvec3() + pressure + scale * (viscosity + central);
        fluid.acceleration[i] = row(sum, f64::from(params.fluid.roughness) * roughness);
    }
}

pub(crate) fn surface_tension(params: &Params, columns: &mut Columns) {
    let (fluid, count) = (&mut columns.fluid, columns.rows.fluid);
    let x = vectors(&fluid.position, count);
    let radius = params.fluid.smoothing.support_radius;
    let per_mass = f64::from(params.fluid.surface_tension) / f64::from(params.fluid.particle_mass);
    for i in 0..count {
        let (mut normal, mut laplacian) = (DVec3::ZERO, 0.0);
        for j in 0..count {
            let volume = f64::from(fluid.velocity[j][lane::fluid::velocity::VOLUME]);
            let offset = apart(params, x[i], x[j]);
            normal += volume * gradient(radius, offset);
            let u = closeness(radius, offset.length());
            laplacian -= volume * 630.0 / pi_power(radius, 5) * u * u * (2.0 * u - 1.0);
        }
        if normal.length() * f64::from(radius) > 1.0 {
            let strength = per_mass * f64::from(fluid.velocity[i][lane::fluid::velocity::VOLUME]) * laplacian;
            let change = strength * normal.normalize();
            let allowed = f64::from(fluid.acceleration[i][lane::fluid::acceleration::ALLOWED_COMPRESSION]);
            fluid.acceleration[i] = row(vector(fluid.acceleration[i]) - change, allowed);
        }
    }
}

pub(crate) fn repulsion(params: &Params, columns: &mut Columns) {
    let (fluid, bodies) = (&mut columns.fluid, &columns.bodies.states.0);
    let parameters = &params.fluid;
    let range = f64::from(parameters.repulsion_range);
    let push = |distance: f64, speed: f64| {
        let depth = range - distance;
        let force = f64::from(parameters.repulsion_stiffness) * depth
            - f64::from(parameters.repulsion_damping) * speed;
        if depth > 0.0 { force.max(0.0) } else { 0.0 }
    };
    let mut wrenches = vec![Wrench::default(); bodies.len()];
    for i in 0..columns.rows.fluid {
        let (x, v) = (vector(fluid.position[i]), vector(fluid.velocity[i]));
        let mut sum = vector(fluid.acceleration[i]);
        if let Some((low, high)) = params.walls {
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                sum += axis * push((x - low.as_dvec3()).dot(axis), v.dot(axis));
                sum -= axis * push((high.as_dvec3() - x).dot(axis), -v.dot(axis));
            }
        }
        for (body, wrench) in bodies.iter().zip(&mut wrenches) {
            let (distance, normal) = shapes::distance(body, x);
            let change = normal * push(distance, (v - shapes::velocity(body, x)).dot(normal));
            sum += change;
            let impulse = change * -f64::from(parameters.particle_mass) * f64::from(params.step);
            wrench.add(impulse, x - normal * distance - body.state.position.as_dvec3());
        }
        fluid.acceleration[i] = keep(fluid.acceleration[i], sum);
    }
    columns.bodies.fluid_wrenches.0 = wrenches;
}

pub(crate) fn kick(params: &Params, columns: &mut Columns) {
    let fluid = &mut columns.fluid;
    let mut largest = 0.0_f64;
    for i in 0..columns.rows.fluid {
        let a = vector(fluid.acceleration[i]);
        largest = largest.max(a.length_squared());
        let w = f64::from(fluid.velocity[i][lane::fluid::velocity::VOLUME]);
        fluid.velocity[i] = row(vector(fluid.velocity[i]) + f64::from(params.step) * a, w);
    }
    fluid.extremes = Extremes(vec![Extreme { acceleration_squared: largest as f32, ..Extreme::default() }]);
}

pub(crate) fn advect(params: &Params, columns: &mut Columns) {
    let fluid = &mut columns.fluid;
    let margin = DVec3::splat(f64::from(params.fluid.spacing) * 0.05);
    let mut extreme = fluid.extremes.total();
    let mut largest = 0.0_f64;
    for i in 0..columns.rows.fluid {
        let mut v = vector(fluid.velocity[i]);
        let mut x = vector(fluid.position[i]) + f64::from(params.step) * v;
        if let Some((low, high)) = params.walls {
            let inside = x.clamp(low.as_dvec3() + margin, high.as_dvec3() - margin);
            for axis in 0..3 {
                // Where the wall pushed the particle back, the velocity into the wall is zero.
                if (inside - x)[axis] * v[axis] < 0.0 {
                    v[axis] = 0.0;
                }
            }
            x = inside;
        }
        if let Some(periodic) = &params.periodic {
            let (periods, start) = (periodic.periods().as_dvec3(), periodic.corners().0.as_dvec3());
            for axis in (0..3).filter(|axis| periods[*axis] > 0.0) {
                x[axis] = start[axis] + (x[axis] - start[axis]).rem_euclid(periods[axis]);
            }
        }
        largest = largest.max(v.length_squared());
        if !(v.is_finite() && x.is_finite()) && extreme.not_finite == 0 {
            extreme.not_finite = i as u32 + 1;
        }
        fluid.position[i] = keep(fluid.position[i], x);
        fluid.velocity[i] = keep(fluid.velocity[i], v);
    }
    extreme.speed_squared = largest as f32;
    fluid.extremes = Extremes(vec![extreme]);
}
