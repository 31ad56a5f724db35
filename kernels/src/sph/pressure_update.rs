//! Iteration of the pressure solve: a step along the projected gradient.
//!
//! ```text
//! P_i <- min(max(0, P_i + alpha r_i / M_i), c^2)
//! ```
//!
//! Enclosed water yields at a pressure of `rho_0 c^2`, with c ten times the fastest expected speed. The pressure that keeps
//! its density would be infinite.
//!
//! with `alpha` from `sph::pressure_residual`. Writes the change since the beginning of the step beside the predicted
//! position, where neighbours read it.

use crate::{
    columns::{Columns, Fluid, lane},
    cpu::Cpu,
    kernel::declare,
    params::Params,
};

use super::pressure_solve::SOUND_SPEED_RATIO;

declare! {
    needs: [Fluid, Incompressible],
    reads: [FluidPosition, FluidPredicted, FluidPressureRows, FluidPressureSolve],
    writes: [FluidPredicted, FluidPressureRows],
    oracle: crate::oracle::incompressible::pressure_update,
    bound: 4e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(solve) = &params.fluid.incompressible else { return };
    let maximum = SOUND_SPEED_RATIO * solve.correction_speed * (SOUND_SPEED_RATIO * solve.correction_speed);
    let count = columns.rows.fluid;
    let Fluid { position, predicted, pressure_rows, pressure_solve, .. } = &mut columns.fluid;
    let (length, density) = (pressure_solve.length(), params.fluid.rest_density);
    cpu.for_chunks((&mut predicted[..count], &mut pressure_rows[..count]), |first, (predicted, rows)| {
        for ((predicted, row), position) in predicted.iter_mut().zip(rows).zip(&position[first..]) {
            let [pressure, _, diagonal, compression] = *row;
            let next = pressure + length * compression / diagonal;
            let next = if next > 0.0 { next } else { 0.0 };
            let next = if next < maximum { next } else { maximum };
            row[lane::fluid::pressure_rows::PRESSURE] = next;
            row[lane::fluid::pressure_rows::CHANGE] = next - pressure;
            predicted[lane::fluid::predicted::PRESSURE_CHANGE] =
                next - density * position[lane::fluid::position::PRESSURE_OVER_SQUARED_DENSITY];
        }
    });
}
