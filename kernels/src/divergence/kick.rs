//! After the pressure solve: velocity by the pressure, and the pressure for the next step. Bodies receive its impulses.
//!
//! ```text
//! v_i = w_i
//! ```

use crate::{
    columns::{Columns, Fluid, lane},
    cpu::{Cpu, PerChunk},
    kernel::declare,
    params::Params,
    sph::obstacles::per_chunk,
};

declare! {
    needs: [Fluid, Divergence],
    reads: [FluidCorrection, FluidPressureRows, BodyFluidWrenches, BodyPressureWrenches],
    writes: [FluidVelocity, BodyFluidWrenches],
    oracle: crate::oracle::divergence::kick,
    bound: 1e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    if params.fluid.divergence().is_none() {
        return;
    }
    let count = columns.rows.fluid;
    let Fluid { velocity, correction, pressure_rows, .. } = &mut columns.fluid;
    let bodies = columns.bodies.states.0.len();
    let given = &columns.bodies.pressure_wrenches.0;
    let mut wrenches = per_chunk(&mut columns.bodies.fluid_wrenches.0, velocity.len(), bodies);
    cpu.for_chunks((&mut velocity[..], PerChunk(&mut wrenches)), |first, (velocity, wrenches)| {
        let used = count.saturating_sub(first).min(velocity.len());
        let solved = correction[first..].iter().zip(&pressure_rows[first..]);
        for (velocity, (w, pressure)) in velocity[..used].iter_mut().zip(solved) {
            *velocity = [w[0], w[1], w[2], pressure[lane::fluid::pressure_rows::PRESSURE]];
        }
        velocity[used..].fill([0.0; 4]);
        let chunk = first / crate::cpu::CHUNK * bodies;
        for (body, wrench) in wrenches.0[0].iter_mut().enumerate() {
            wrench.impulse += given[chunk + body].impulse;
            wrench.angular_impulse += given[chunk + body].angular_impulse;
        }
    });
}
