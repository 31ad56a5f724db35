//! After the implicit viscosity: the velocities lose what the pressure of the last step gave them (`divergence::pressure_guess`).
//!
//! ```text
//! v_i <- v_i - d_i
//! ```
//!
//! The solve for the pressure then finds all of it.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    kernel::declare,
    params::Params,
};

declare! {
    needs: [Fluid, Divergence, ImplicitViscosity, NoSponges],
    reads: [FluidVelocity, FluidCorrection],
    writes: [FluidVelocity],
    oracle: crate::oracle::viscosity::pressure_return,
    bound: 1e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, _params: &Params, columns: &mut Columns) {
    let count = columns.rows.fluid;
    let Fluid { velocity, correction, .. } = &mut columns.fluid;
    cpu.for_chunks(&mut velocity[..count], |first, velocity| {
        for (velocity, correction) in velocity.iter_mut().zip(&correction[first..]) {
            (0..3).for_each(|axis| velocity[axis] -= correction[axis]);
        }
    });
}
