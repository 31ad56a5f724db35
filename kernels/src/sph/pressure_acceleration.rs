//! Iteration of the pressure solve: acceleration by the change of the pressure since the beginning of the step.
//!
//! ```text
//! a_i = dP_i B_i + sum_j c_ij dP_j x_ij
//! ```
//!
//! and, for the residual, `w_i = a_i . x_i - b e / h^2 dP_i`. Equal and opposite for the two particles of a pair, after any
//! number of iterations.

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

declare! {
    needs: [Fluid, Incompressible],
    reads: [FluidPredicted, FluidNeighbors, FluidPairs, FluidFactors],
    writes: [FluidCorrection],
    oracle: crate::oracle::incompressible::pressure_acceleration,
    bound: 4e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    if params.fluid.incompressible.is_none() {
        return;
    }
    let Fluid { predicted, neighbors, pairs, factors, correction, .. } = &mut columns.fluid;
    correction.resize(predicted.len(), [0.0; 4]);
    cpu.for_chunks(&mut correction[..], |first, correction| {
        let (lists, pairs) = (neighbors.chunk(first), pairs.chunk(first));
        with_space!(cpu, params, simd, space =>
            chunk((simd, space), params, first, (predicted, factors), lists, pairs, correction));
    });
}

#[inline(always)]
fn chunk<S: Simd>(
    (simd, space): (S, impl Space<S>),
    params: &Params,
    first: usize,
    (predicted, factors): (&[[f32; 4]], &[[f32; 4]]),
    lists: &ChunkLists,
    pairs: &[[f32; LANES]],
    correction: &mut [[f32; 4]],
) {
    let roughness = params.fluid.prompt_roughness(params.step) / (params.step * params.step);
    let origin = vector::splat(simd, params.origin().to_array());
    for row in (0..correction.len()).step_by(LANES) {
        let [x, y, z, change] = lanes::load_rows(simd, predicted, first + row);
        let [bx, by, bz, _] = lanes::load_rows(simd, factors, first + row);
        let mut sum = [change * bx, change * by, change * bz];
        for (entry, c) in lists.group(row).iter().zip(&pairs[lists.range(row)]) {
            let [xj, yj, zj, change_j] = lanes::gather_rows(simd, predicted, entry);
            let push = lanes::load_array(simd, c) * change_j;
            let [dx, dy, dz] = space.apart([x, y, z], [xj, yj, zj]);
            sum = [sum[0] + push * dx, sum[1] + push * dy, sum[2] + push * dz];
        }
        let product = dot(sum, minus([x, y, z], origin));
        lanes::store_rows(correction, row, [sum[0], sum[1], sum[2], product - change * roughness]);
    }
}
