//! Iteration of the pressure solve: a step along the projected gradient.
//!
//! ```text
//! P_i <- min(max(0, P_i + alpha r_i / A_i), c^2)
//! ```
//!
//! with `alpha` from `divergence::residual`. Images have the pressure of their particle. Enclosed water yields at a pressure of `rho_0
//! c^2`, with c ten times the fastest
//! expected speed. The pressure that keeps its volume would be infinite. The pressure is written beside the position, where
//! neighbours read both at once.

use super::image_rows::OfParticles;
use crate::{
    column::FAR_ROW,
    columns::{Columns, Fluid, lane},
    cpu::Cpu,
    kernel::declare,
    params::Params,
    sph::pressure_solve::SOUND_SPEED_RATIO,
};

declare! {
    needs: [Fluid, Divergence],
    reads: [FluidPosition, FluidPressureRows, FluidPressureSolve, FluidImages],
    writes: [FluidPredicted, FluidPressureRows, FluidImagePredicted],
    oracle: crate::oracle::divergence::update,
    bound: 4e-6,
    twin: [
        pass(NAME, Fluid),
    ],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(solve) = &params.fluid.incompressible else { return };
    let maximum = SOUND_SPEED_RATIO * solve.correction_speed * (SOUND_SPEED_RATIO * solve.correction_speed);
    let count = columns.rows.fluid;
    let Fluid { position, predicted, pressure_rows, pressure_solve, images, image_predicted, .. } =
        &mut columns.fluid;
    predicted.resize(position.len(), FAR_ROW);
    predicted[count..].fill(FAR_ROW);
    image_predicted.0.resize(images.position.len(), FAR_ROW);
    let used = images.count();
    image_predicted.0[used..].fill(FAR_ROW);
    let length = pressure_solve.length();
    let of_images = OfParticles::new(&mut image_predicted.0[..used], &images.first[..=count]);
    let rows = (&mut predicted[..count], &mut pressure_rows[..count], of_images);
    cpu.for_chunks(rows, |first, (predicted, rows, of_images)| {
        for ((predicted, row), position) in predicted.iter_mut().zip(rows).zip(&position[first..]) {
            let [pressure, _, diagonal, compression] = *row;
            let next = pressure + length * compression / diagonal;
            let next = if next > 0.0 { next } else { 0.0 };
            let next = if next < maximum { next } else { maximum };
            row[lane::fluid::pressure_rows::PRESSURE] = next;
            row[lane::fluid::pressure_rows::CHANGE] = next - pressure;
            *predicted = *position;
            predicted[lane::fluid::predicted::PRESSURE] = next;
        }
        let (start, of_images) = of_images.all();
        for (image, row) in (start..).zip(of_images) {
            let [x, y, z, _] = images.position[image];
            let source = images.source[image] as usize - first;
            *row = [x, y, z, predicted[source][lane::fluid::predicted::PRESSURE]];
        }
    });
}
