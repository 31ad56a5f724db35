//! Iteration of the pressure solve: remaining compression, and length of the next iteration.
//!
//! ```text
//! r_i = h t_i - h div w_i
//! ```
//!
//! with the velocities w by the pressure of the round, and their images in bodies that move with it. The material of sponges has its part
//! beside w (`couple::solid_velocity`). Outside of pores the target t is scaled (`pressure_solve`). A particle with less than three
//! quarters of a neighbourhood has no pressure, and nothing remains. The length is that of Barzilai and Borwein \[BB88\] in the
//! norm of the diagonal, see `pressure_solve`.

use crate::{
    columns::{Columns, lane},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, select},
    params::Params,
    periodic::with_space,
    sph::pressure_solve::{PRESSURE_IN_PORES, Sums},
};

use super::{
    rate::{Field, MINIMUM_MATERIAL, SPARSE},
    reflect::{reflect, twists},
};

declare! {
    needs: [Fluid, Divergence],
    reads: [
        FluidPosition, FluidCorrection, FluidNeighbors, FluidPairs, FluidFactors, FluidRenormalisation,
        FluidRenormalisationBetween, FluidPressureRows, FluidPressureSolve, FluidMoment, FluidImages, BodyStates, BodySolved,
        BodySolvedSpin,
    ],
    writes: [FluidPressureRows, FluidPressureSolve, FluidImageVectors],
    oracle: crate::oracle::divergence::residual,
    bound: 1e-5,
    twin_writes: [FluidExtremes],
    twin: [
        pass("divergence::reflect", Images).on(&[
            ("values", "fluid_correction"),
            ("linear", "body_solved"),
            ("angular", "body_solved_spin"),
        ]),
        pass("divergence::rate", Fluid),
        pass("divergence::rate_images", Fluid),
        pass(NAME, Fluid),
        pass("sph::solve_round", One),
    ],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(incompressible) = &params.fluid.incompressible else { return };
    let count = columns.rows.fluid;
    let (fluid, store) = (&mut columns.fluid, &columns.bodies);
    let bodies = &store.states.0;
    let mut vectors = std::mem::take(&mut fluid.image_vectors);
    let mut pressure_rows = std::mem::take(&mut fluid.pressure_rows);
    let mut pressure_solve = std::mem::take(&mut fluid.pressure_solve);
    let twists = twists(&store.solved, &store.solved_spin);
    reflect(cpu, &fluid.images, (&fluid.position, &fluid.correction), (bodies, &twists), &mut vectors);
    let field = Field { fluid, values: &fluid.correction, images: &vectors };
    let scale = pressure_solve.target_scale();
    let rows = (&mut pressure_rows[..], pressure_solve.sums(fluid.position.len()));
    cpu.for_chunks(rows, |first, (rows, sums)| {
        let (mut left, mut weights) = ([0.0; crate::cpu::CHUNK], [0.0; crate::cpu::CHUNK]);
        with_space!(cpu, params, simd, space => {
            for row in (0..rows.len()).step_by(LANES) {
                let rate = field.rate((simd, space), (first, row));
                let [_, _, _, of_solid] = lanes::load_rows(simd, &fluid.correction, first + row);
                let [_, _, _, target] = lanes::load_rows(simd, &fluid.factors, first + row);
                let [_, _, _, material] = lanes::load_rows(simd, &fluid.moment, first + row);
                let is_in_pores = material.simd_gt(lanes::splat(simd, MINIMUM_MATERIAL));
                let target = select(is_in_pores, target, target * scale);
                lanes::store(&mut left, row, target + (rate + of_solid) * params.step);
                let weight = select(is_in_pores, lanes::splat(simd, PRESSURE_IN_PORES), lanes::splat(simd, 1.0));
                lanes::store(&mut weights, row, weight);
            }
        });
        let used = count.saturating_sub(first).min(rows.len());
        for (left, row) in left.iter_mut().zip(&fluid.renormalisation[first..]) {
            if row[lane::fluid::renormalisation::DENSITY] < SPARSE {
                *left = 0.0;
            }
        }
        sums.0[0] = Sums::of(&mut rows[..used], &left, &weights);
    });
    pressure_solve.finish_round(count, incompressible);
    (fluid.image_vectors, fluid.pressure_rows, fluid.pressure_solve) =
        (vectors, pressure_rows, pressure_solve);
}
