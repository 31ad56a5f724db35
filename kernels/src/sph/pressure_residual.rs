//! Iteration of the pressure solve: the remaining compression, and the length of the next step along the gradient.
//!
//! ```text
//! r_i = r0_i + h^2 (sum_j c_ij a_j . x_ij - a_i . B_i + y_i) + b e sum_j c_ij (dP_j - dP_i)
//! ```
//!
//! with the compliance y of sponges, `couple::solid_yield`.
//!
//! The step length is that of Barzilai and Borwein \[BB88\] in the norm of the diagonal, see `pressure_solve`.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    grid::neighbors::ChunkLists,
    kernel::declare,
    lanes::{self, LANES, Simd},
    params::Params,
    periodic::{Space, with_space},
    vector::{self, dot, minus},
};

use super::pressure_solve::Sums;

declare! {
    needs: [Fluid, Incompressible],
    reads: [
        FluidPredicted, FluidCorrection, FluidNeighbors, FluidPairs, FluidFactors, FluidPressureRows,
        FluidSolidYield, FluidPressureSolve,
    ],
    writes: [FluidPressureRows, FluidPressureSolve],
    oracle: crate::oracle::incompressible::pressure_residual,
    bound: 1e-5,
    // The root mean square of the pressure, for the clock of the device.
    twin_writes: [FluidExtremes],
    twin: [pass(NAME, Fluid), pass("sph::solve_round", One)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(incompressible) = &params.fluid.incompressible else { return };
    let count = columns.rows.fluid;
    let Fluid {
        predicted,
        correction,
        neighbors,
        pairs,
        factors,
        pressure_rows,
        solid_yield,
        pressure_solve,
        ..
    } = &mut columns.fluid;
    let square = params.step * params.step;
    let rows = (&mut pressure_rows[..], pressure_solve.sums(predicted.len()));
    cpu.for_chunks(rows, |first, (rows, sums)| {
        let (lists, pairs) = (neighbors.chunk(first), pairs.chunk(first));
        let mut left = [0.0; crate::cpu::CHUNK];
        with_space!(cpu, params, simd, space =>
            chunk((simd, space), params, first, [predicted, correction, factors], lists, pairs, &mut left[..rows.len()]));
        if let Some(solid_yield) = solid_yield.get(first..first + rows.len()) {
            left.iter_mut().zip(solid_yield).for_each(|(left, yields)| *left += yields * square);
        }
        let used = count.saturating_sub(first).min(rows.len());
        sums.0[0] = Sums::of(&mut rows[..used], &left, &[1.0; crate::cpu::CHUNK]);
    });
    pressure_solve.finish_round(count, incompressible);
}

/// The remaining compression.
#[inline(always)]
fn chunk<S: Simd>(
    (simd, space): (S, impl Space<S>),
    params: &Params,
    first: usize,
    [predicted, correction, factors]: [&[[f32; 4]]; 3],
    lists: &ChunkLists,
    pairs: &[[f32; LANES]],
    left: &mut [f32],
) {
    let origin = vector::splat(simd, params.origin().to_array());
    let square = params.step * params.step;
    let roughness = params.fluid.prompt_roughness(params.step) / square;
    for row in (0..left.len()).step_by(LANES) {
        let [x, y, z, change] = lanes::load_rows(simd, predicted, first + row);
        let point = minus([x, y, z], origin);
        let [ax, ay, az, _] = lanes::load_rows(simd, correction, first + row);
        let [bx, by, bz, before] = lanes::load_rows(simd, factors, first + row);
        let (mut sum, mut pair_sum) = (lanes::splat(simd, 0.0), lanes::splat(simd, 0.0));
        for (entry, c) in lists.group(row).iter().zip(&pairs[lists.range(row)]) {
            let [axj, ayj, azj, product] = lanes::gather_rows(simd, correction, entry);
            // a_j . x_ij + e / h^2 dP_j, with one row of the neighbour instead of two.
            let c = lanes::load_array(simd, c);
            let point = space.seen_from(simd, ([x, y, z], point), predicted, entry);
            sum += c * (dot([axj, ayj, azj], point) - product);
            pair_sum += c;
        }
        let own = dot([ax, ay, az], [bx, by, bz]) + pair_sum * change * roughness;
        lanes::store(left, row, before + (sum - own) * square);
    }
}
