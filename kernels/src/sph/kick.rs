//! First half of semi-implicit Euler: velocity by acceleration.
//!
//! ```text
//! v <- v + h a
//! ```

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    grid::sort::per_chunk,
    kernel::declare,
    params::Params,
};

declare! {
    needs: [Fluid],
    reads: [FluidVelocity, FluidAcceleration],
    writes: [FluidVelocity, FluidExtremes],
    oracle: crate::oracle::sph::kick,
    bound: 1e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let count = columns.rows.fluid;
    let Fluid { velocity, acceleration, extremes, .. } = &mut columns.fluid;
    let rows = (&mut velocity[..count], per_chunk(&mut extremes.0, count));
    cpu.for_chunks(rows, |first, (velocity, extreme)| {
        let mut largest = 0.0_f32;
        for (velocity, a) in velocity.iter_mut().zip(&acceleration[first..]) {
            let square = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
            largest = if square > largest { square } else { largest };
            (0..3).for_each(|axis| velocity[axis] += params.step * a[axis]);
        }
        extreme.0[0].acceleration_squared = largest;
    });
}
