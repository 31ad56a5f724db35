//! After the pressure solve: velocity by the change of the pressure, and the pressure for the next step.
//!
//! ```text
//! v_i += h a_i
//! ```

use crate::{
    columns::{Columns, Fluid, lane},
    cpu::Cpu,
    kernel::declare,
    params::Params,
};

declare! {
    needs: [Fluid, Incompressible],
    reads: [FluidPosition, FluidVelocity, FluidCorrection, FluidPressureRows],
    writes: [FluidPosition, FluidVelocity],
    oracle: crate::oracle::incompressible::pressure_kick,
    bound: 4e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    if params.fluid.incompressible.is_none() {
        return;
    }
    let count = columns.rows.fluid;
    let Fluid { position, velocity, correction, pressure_rows, .. } = &mut columns.fluid;
    let density = params.fluid.rest_density;
    cpu.for_chunks((&mut position[..count], &mut velocity[..count]), |first, (position, velocity)| {
        let rows = position.iter_mut().zip(velocity).zip(&correction[first..]).zip(&pressure_rows[first..]);
        for (((position, velocity), a), pressure) in rows {
            (0..3).for_each(|axis| velocity[axis] += params.step * a[axis]);
            position[lane::fluid::position::PRESSURE_OVER_SQUARED_DENSITY] = pressure[0] / density;
        }
    });
}
