//! After a pressure solve: velocity by the change of the pressure, and the pressure for the next step.
//!
//! ```text
//! v_i += h a_i
//! ```

use crate::{
    columns::{Column::*, Columns, Fluid},
    cpu::Cpu,
    kernel::{Kernel, Need},
    params::Params,
};

/// `sph::pressure_kick`.
pub static KERNEL: Kernel = Kernel {
    name: "sph::pressure_kick",
    needs: &[Need::Fluid, Need::Incompressible],
    reads: &[FluidPosition, FluidVelocity, FluidCorrection, FluidPressureRows],
    writes: &[FluidPosition, FluidVelocity],
    cpu,
};

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
            position[3] = pressure[0] / density;
        }
    });
}
