//! Applies the drag to the nodes: they gain what `couple::drag_kick` takes from the particles.
//!
//! ```text
//! u_a = u0_a + sum_i w_ia J_i / m_a
//! ```
//!
//! Both use the same `J_i`, so that momentum is kept at any number of sweeps of the filter.

use crate::{
    columns::Columns,
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
};

use super::impulses::received;

declare! {
    needs: [Fluid, Sponge],
    reads: [FluidDrag, ControlNode, ControlUnfiltered, ControlFluid, ControlFluidWeights, NodeVelocity],
    writes: [ControlVelocity, NodeVelocity],
    oracle: crate::oracle::couple::exchange,
    bound: 2e-6,
    twin_bound: 5e-6,
    // Weights are computed where they are needed.
    twin_reads: [FluidPosition, ControlPosition],
    twin: [pass(NAME, Controls)],
}

fn cpu(cpu: &Cpu, _params: &Params, columns: &mut Columns) {
    let (fluid, controls, nodes) = (&columns.fluid, &mut columns.controls, &mut columns.nodes);
    let (unfiltered, drag) = (&controls.unfiltered, &fluid.drag);
    cpu.for_chunks(&mut controls.velocity[..], |first, velocity| {
        let (lists, weights) = (controls.fluid.chunk(first), controls.fluid_weights.chunk(first));
        with_lanes!(cpu, simd => {
            for row in (0..velocity.len()).step_by(LANES) {
                let [ox, oy, oz, w] = lanes::load_rows(simd, unfiltered, first + row);
                let [jx, jy, jz] = received(simd, drag, lists, weights, row);
                lanes::store_rows(velocity, row, [ox + w * jx, oy + w * jy, oz + w * jz, w]);
            }
        });
    });
    for (node, velocity) in controls.node.iter().zip(&controls.velocity) {
        let v = &mut nodes.velocity[*node as usize];
        (v[0], v[1], v[2]) = (velocity[0], velocity[1], velocity[2]);
    }
}
