//! Where particles would be at the end of the step without a change of their pressure.
//!
//! ```text
//! x*_i = x_i + h v_i, kept inside the walls
//! ```

use crate::{
    columns::{Column::*, Columns, FAR_ROW, Fluid},
    cpu::Cpu,
    kernel::{Kernel, Need},
    params::Params,
};

/// `sph::predict`.
pub static KERNEL: Kernel = Kernel {
    name: "sph::predict",
    needs: &[Need::Fluid, Need::Incompressible],
    reads: &[FluidPosition, FluidVelocity],
    writes: &[FluidPredicted],
    cpu,
};

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    if params.fluid.incompressible.is_none() {
        return;
    }
    let count = columns.rows.fluid;
    let Fluid { position, velocity, predicted, .. } = &mut columns.fluid;
    predicted.resize(position.len(), FAR_ROW);
    predicted[count..].fill(FAR_ROW);
    let inside = super::advect::inside(params);
    cpu.for_chunks(&mut predicted[..count], |first, predicted| {
        let rows = position[first..].iter().zip(&velocity[first..]);
        for (predicted, (x, v)) in predicted.iter_mut().zip(rows) {
            for axis in 0..3 {
                let end = x[axis] + params.step * v[axis];
                predicted[axis] = inside.map_or(end, |(low, high)| end.clamp(low[axis], high[axis]));
            }
            predicted[3] = 0.0;
        }
    });
}
