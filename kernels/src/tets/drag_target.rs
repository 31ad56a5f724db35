//! Targets of the nodes by the drag of the fluid, for a sweep of vertex block descent. This is `couple::drag_target` over the particles in
//! the tets of the node.

use crate::{
    columns::Columns,
    couple::drag_model::{displacement, settle},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
};

declare! {
    needs: [Fluid, Solver(Vbd), Divergence, Porous, Barycentric],
    reads: [FluidDrag, FluidShares, ControlNode, ControlPosition, ControlVelocity, ControlCorners, NodeFree],
    writes: [NodeTarget],
    oracle: crate::oracle::tets::drag_target,
    // Few particles hardly move the target of a node.
    bound: 1.5e-4,
    twin: [pass(NAME, Controls)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let (drag, shares, controls) = (&columns.fluid.drag, &columns.fluid.shares, &columns.controls);
    // Displacement of each node, and its mass.
    let mut moved = vec![[0.0_f32; 4]; controls.velocity.len()];
    cpu.for_chunks(&mut moved[..], |first, moved| {
        let lists = controls.corners.chunk(first);
        with_lanes!(cpu, simd => {
            for row in (0..moved.len()).step_by(LANES) {
                let mut sum = [lanes::splat(simd, 0.0); 4];
                for entry in lists.group(row) {
                    let [.., weight] = lanes::gather_rows(simd, shares.0.as_flattened(), entry);
                    let drag = lanes::gather_rows(simd, drag, &entry.map(|place| place / 4));
                    (0..4).for_each(|k| sum[k] += weight * drag[k]);
                }
                let velocity = lanes::load_rows(simd, &controls.velocity, first + row);
                lanes::store_rows(moved, row, displacement(simd, params.step, velocity, sum));
            }
        });
    });
    settle(&moved, controls, &mut columns.nodes);
}
