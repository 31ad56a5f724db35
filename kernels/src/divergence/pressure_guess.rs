//! Before the implicit viscosity: the velocities by the pressure of the last step take part in it.
//!
//! ```text
//! d_i = w_i - v_i,   v_i <- w_i
//! ```
//!
//! with `w = v + h a` by that pressure (`divergence::acceleration`). Without it viscosity does not resist what the pressure
//! does after it in the same step: a column of paste falls too fast, in proportion to the step. `divergence::pressure_return`
//! takes d back. In scenes with sponges, whose material takes a part of the pressure, thick fluid would throw nodes.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    kernel::declare,
    params::Params,
};

declare! {
    needs: [Fluid, Divergence, ImplicitViscosity, NoSponges],
    reads: [FluidVelocity, FluidCorrection],
    writes: [FluidVelocity, FluidCorrection],
    oracle: crate::oracle::viscosity::pressure_guess,
    bound: 1e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, _params: &Params, columns: &mut Columns) {
    let count = columns.rows.fluid;
    let Fluid { velocity, correction, .. } = &mut columns.fluid;
    cpu.for_chunks((&mut velocity[..count], &mut correction[..count]), |_, (velocity, correction)| {
        for (velocity, correction) in velocity.iter_mut().zip(correction) {
            for axis in 0..3 {
                let pushed = correction[axis];
                correction[axis] = pushed - velocity[axis];
                velocity[axis] = pushed;
            }
        }
    });
}
