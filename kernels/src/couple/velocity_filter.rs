//! Velocity filter of the nodes: their velocities under the drag (the paper, section 3.3).
//!
//! ```text
//! u_a = u0_a + sum_i w_ia J_i / m_a,   w_ia = V_a W_ia / chi_i
//! ```
//!
//! with the present impulses `J_i` of `couple::drag`.

use crate::{
    columns::{Columns, Controls},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
    vector::{plus, times},
};

use super::impulses::received;

declare! {
    needs: [Fluid, Sponge],
    reads: [FluidDrag, ControlVelocity, ControlUnfiltered, ControlFluid, ControlFluidWeights],
    writes: [ControlVelocity],
    oracle: crate::oracle::couple::velocity_filter,
    bound: 2e-6,
    twin_bound: 5e-6,
    // Weights are computed where they are needed.
    twin_reads: [FluidPosition, ControlPosition],
    twin: [pass(NAME, Controls)],
}

fn cpu(cpu: &Cpu, _params: &Params, columns: &mut Columns) {
    let drag = &columns.fluid.drag;
    let Controls { velocity, unfiltered, fluid: lists, fluid_weights, .. } = &mut columns.controls;
    cpu.for_chunks(&mut velocity[..], |first, velocity| {
        let (lists, weights) = (lists.chunk(first), fluid_weights.chunk(first));
        with_lanes!(cpu, simd => {
            for row in (0..velocity.len()).step_by(LANES) {
                let [_, _, _, shared] = lanes::load_rows(simd, velocity, row);
                let [ox, oy, oz, w] = lanes::load_rows(simd, unfiltered, first + row);
                let received = received(simd, drag, lists, weights, row);
                let new = plus([ox, oy, oz], times(received, w));
                lanes::store_rows(velocity, row, [new[0], new[1], new[2], shared]);
            }
        });
    });
}
