//! After the last iteration of the implicit viscosity: the velocities.
//!
//! ```text
//! v = v* + y + r
//! ```
//!
//! `v* + y + r = v* - h D(v* + y)` is one step of Richardson's iteration. With it the particles lose exactly what other
//! particles and bodies receive (`sph::viscosity_reaction`), whatever the residual. It is left out where the solve did not
//! converge, because only a residual below the tolerance is known to be harmless.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    kernel::declare,
    params::Params,
};

declare! {
    needs: [Fluid, ImplicitViscosity],
    reads: [FluidVelocity, FluidViscosityResidual, FluidViscosityChange, FluidViscositySolve],
    writes: [FluidVelocity],
    oracle: crate::oracle::viscosity::kick,
    bound: 1e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, _params: &Params, columns: &mut Columns) {
    let count = columns.rows.fluid;
    let Fluid { velocity, viscosity_residual, viscosity_change, viscosity_solve, .. } = &mut columns.fluid;
    let share = if viscosity_solve.is_solved() { 1.0 } else { 0.0 };
    cpu.for_chunks(&mut velocity[..count], |first, velocity| {
        let found = viscosity_change[first..].iter().zip(&viscosity_residual[first..]);
        for (velocity, (change, residual)) in velocity.iter_mut().zip(found) {
            (0..3).for_each(|axis| velocity[axis] += change[axis] + share * residual[axis]);
        }
    });
}
