//! Velocity filter of the nodes: one Jacobi sweep of the drag solved for the nodes (the paper, section 3.3).
//!
//! ```text
//! u_a += (m_a (u0_a - u_a) + sum_i w_ia J_i) / (m_a + sum_i w_ia k_i),   w_ia = V_a W_ia / chi_i
//! ```
//!
//! with `J_i` and `k_i = dJ_i/dv_i` from `couple::drag`. A node weighs a fraction of the water around it: without
//! the implicit denominator it would be thrown back and forth.

use crate::{
    columns::{Column::*, Columns, Controls},
    cpu::Cpu,
    grid::neighbors::ChunkLists,
    kernel::{Kernel, Need},
    lanes::{self, LANES, Simd, f32x8, with_lanes},
    params::Params,
    vector::{minus, plus, times},
};

/// `couple::velocity_filter`.
pub static KERNEL: Kernel = Kernel {
    name: "couple::velocity_filter",
    needs: &[Need::Fluid, Need::Sponge],
    reads: &[FluidDrag, ControlVelocity, ControlUnfiltered, ControlFluid, ControlFluidWeights],
    writes: &[ControlVelocity],
    cpu,
};

fn cpu(cpu: &Cpu, _params: &Params, columns: &mut Columns) {
    let drag = &columns.fluid.drag;
    let Controls { velocity, unfiltered, fluid: lists, fluid_weights, .. } = &mut columns.controls;
    cpu.for_chunks(&mut velocity[..], |first, velocity| {
        let (lists, weights) = (lists.chunk(first), fluid_weights.chunk(first));
        with_lanes!(cpu, simd => {
            let one = lanes::splat(simd, 1.0);
            for row in (0..velocity.len()).step_by(LANES) {
                let [ux, uy, uz, w] = lanes::load_rows(simd, velocity, row);
                let [ox, oy, oz, _] = lanes::load_rows(simd, unfiltered, first + row);
                let (u, old) = ([ux, uy, uz], [ox, oy, oz]);
                let [jx, jy, jz, strength] = received(simd, drag, lists, weights, row);
                let lacking = plus(minus(old, u), times([jx, jy, jz], w));
                let new = plus(u, times(lacking, one / (one + w * strength)));
                lanes::store_rows(velocity, row, [new[0], new[1], new[2], w]);
            }
        });
    });
}

/// Sum over the particles of eight controls of `V_a W_ia` times the drag row.
#[inline(always)]
pub(super) fn received<S: Simd>(
    simd: S,
    drag: &[[f32; 4]],
    lists: &ChunkLists,
    weights: &[[f32; LANES]],
    row: usize,
) -> [f32x8<S>; 4] {
    let mut sum = [lanes::splat(simd, 0.0); 4];
    for (entry, weight) in lists.group(row).iter().zip(&weights[lists.range(row)]) {
        let drag = lanes::gather_rows(simd, drag, entry);
        let weight = lanes::load(simd, weight, 0);
        sum = [
            sum[0] + weight * drag[0],
            sum[1] + weight * drag[1],
            sum[2] + weight * drag[2],
            sum[3] + weight * drag[3],
        ];
    }
    sum
}
