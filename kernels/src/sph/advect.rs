//! Second half of semi-implicit Euler: position by velocity, kept inside the walls.
//!
//! ```text
//! x <- x + h v
//! ```
//!
//! The repulsion is elastic and a fast particle can pass it; the clamp holds at any speed. A clamped particle loses its
//! velocity component into the wall. Periodic axes have no walls: a particle that leaves the box enters it on the other
//! side.

use crate::{
    columns::{Columns, Fluid},
    cpu::{Cpu, PerChunk},
    kernel::declare,
    params::Params,
};

use super::container::inside;

declare! {
    needs: [Fluid],
    reads: [FluidPosition, FluidVelocity, FluidExtremes],
    writes: [FluidPosition, FluidVelocity, FluidExtremes],
    oracle: crate::oracle::sph::advect,
    bound: 1e-5,
    // What is sorted comes back to where the next step finds it.
    twin_writes: [FluidId],
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let count = columns.rows.fluid;
    let Fluid { position, velocity, extremes, .. } = &mut columns.fluid;
    let box_inside = inside(params);
    let rows = (&mut position[..count], &mut velocity[..count], PerChunk(&mut extremes.0));
    cpu.for_chunks(rows, |first, (position, velocity, extreme)| {
        let extreme = &mut extreme.0[0];
        let mut largest = 0.0_f32;
        for (row, (x, v)) in position.iter_mut().zip(velocity).enumerate() {
            (0..3).for_each(|axis| x[axis] += params.step * v[axis]);
            if let Some((low, high)) = box_inside {
                clamp(x, v, low, high);
            }
            if let Some(periodic) = &params.periodic {
                periodic.wrap(x);
            }
            let square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
            largest = if square > largest { square } else { largest };
            let finite = square.is_finite() && (x[0] + x[1] + x[2]).is_finite();
            if !finite && extreme.not_finite == 0 {
                extreme.not_finite = (first + row + 1) as u32;
            }
        }
        extreme.speed_squared = largest;
    });
}

fn clamp(x: &mut [f32; 4], v: &mut [f32; 4], low: [f32; 3], high: [f32; 3]) {
    for axis in 0..3 {
        if x[axis] < low[axis] {
            x[axis] = low[axis];
            v[axis] = if v[axis] > 0.0 { v[axis] } else { 0.0 };
        } else if x[axis] > high[axis] {
            x[axis] = high[axis];
            v[axis] = if v[axis] < 0.0 { v[axis] } else { 0.0 };
        }
    }
}
