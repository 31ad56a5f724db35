//! Pressure by an equation of state, at least zero \[MCG03, eq. 12; M94\].
//!
//! ```text
//! linear:  p = c^2 (rho - rho_0)
//! Tait:    p = rho_0 c^2 / 7 ((rho / rho_0)^7 - 1)
//! ```
//!
//! Negative pressure at a free surface would make particles clump. The density there is low only because half of the
//! neighbours are missing.
//!
//! Writes p / rho^2 beside the position and m / rho beside the velocity, where neighbours read them.

use crate::{
    columns::{Columns, Fluid, lane},
    cpu::Cpu,
    kernel::declare,
    params::{EquationOfState, FluidParams, Params},
};

declare! {
    needs: [Fluid, EquationOfState],
    reads: [FluidPosition, FluidVelocity, FluidDensity],
    writes: [FluidPosition, FluidVelocity],
    oracle: crate::oracle::sph::pressure,
    bound: 4e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let count = columns.rows.fluid;
    let Fluid { position, velocity, density, .. } = &mut columns.fluid;
    let fluid = &params.fluid;
    // Padding rows keep a pressure and a volume of zero.
    cpu.for_chunks((&mut position[..count], &mut velocity[..count]), |first, (position, velocity)| {
        let rows = position.iter_mut().zip(velocity).zip(&density[first..]);
        for ((position, velocity), density) in rows {
            position[lane::fluid::position::PRESSURE_OVER_SQUARED_DENSITY] =
                pressure(fluid, *density) / (density * density);
            velocity[lane::fluid::velocity::VOLUME] = fluid.particle_mass / density;
        }
    });
}

/// Pressure at a density \[Pa\].
#[must_use]
pub fn pressure(fluid: &FluidParams, density: f32) -> f32 {
    let square = fluid.sound_speed * fluid.sound_speed;
    let pressure = match fluid.equation_of_state {
        EquationOfState::Linear => square * (density - fluid.rest_density),
        EquationOfState::Tait => {
            let ratio = density / fluid.rest_density;
            let cube = ratio * ratio * ratio;
            fluid.rest_density * square * (1.0 / 7.0) * (cube * cube * ratio - 1.0)
        }
    };
    if pressure > 0.0 { pressure } else { 0.0 }
}
