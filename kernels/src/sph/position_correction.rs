//! End of an iteration of position based fluids \[MM13\]: moves the particles towards rest density, and their velocities
//! accordingly.
//!
//! ```text
//! x*_i += h^2 a_i,   v_i += h a_i
//! ```
//!
//! with the displacement `h^2 a` of \[MM13, eq. 12\]: `a` comes from `sph::pressure_acceleration`, with the multipliers of a
//! single relaxed Jacobi step from zero (`sph::pressure_update`). The next iteration begins at the new positions, with a new
//! density. No linear system is solved, and no pressure is stored.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    kernel::declare,
    params::Params,
};

declare! {
    needs: [Fluid, Incompressible],
    reads: [FluidPredicted, FluidVelocity, FluidCorrection],
    writes: [FluidPredicted, FluidVelocity],
    oracle: crate::oracle::incompressible::position_correction,
    bound: 3e-5,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    if params.fluid.incompressible.is_none() {
        return;
    }
    let count = columns.rows.fluid;
    let Fluid { predicted, velocity, correction, .. } = &mut columns.fluid;
    let inside = super::container::inside(params);
    let step = params.step;
    cpu.for_chunks((&mut predicted[..count], &mut velocity[..count]), |first, (predicted, velocity)| {
        for ((x, v), a) in predicted.iter_mut().zip(velocity).zip(&correction[first..]) {
            for axis in 0..3 {
                let change = step * a[axis];
                let end = x[axis] + step * change;
                x[axis] = inside.map_or(end, |(low, high)| end.clamp(low[axis], high[axis]));
                v[axis] += change;
            }
        }
    });
}
