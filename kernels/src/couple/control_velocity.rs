//! Copies the velocities of the nodes, after their constraints, into the order of the controls, and starts the drag at zero
//! impulse.
//!
//! ```text
//! s_a = sum_i w_ia / m_a,   w_ia = V_a W_ia / chi_i
//! ```
//!
//! `s_a` is the number of particles that share a node, over its mass: `couple::drag` needs it for stability.

use crate::{
    column::padded,
    columns::{Columns, Controls},
    couple::impulses::weight_inside,
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
};

declare! {
    needs: [Fluid, Sponge],
    reads: [FluidDragRate, ControlNode, ControlFluid, ControlFluidWeights, NodePosition, NodeVelocity],
    writes: [ControlVelocity, ControlUnfiltered, FluidDrag],
    oracle: crate::oracle::couple::control_velocity,
    bound: 6e-6,
    // Weights are computed where they are needed.
    twin_reads: [FluidPosition, ControlPosition],
    twin: [pass("couple::begin_drag", FluidOrNodes), pass(NAME, Controls)],
}

fn cpu(cpu: &Cpu, _params: &Params, columns: &mut Columns) {
    let (fluid, controls, nodes) = (&mut columns.fluid, &mut columns.controls, &columns.nodes);
    let Controls { node, velocity, unfiltered, fluid: lists, fluid_weights, .. } = controls;
    unfiltered.clear();
    unfiltered.resize(padded(node.len()), [0.0; 4]);
    for (unfiltered, node) in unfiltered.iter_mut().zip(&*node) {
        let ([x, y, z, _], [_, _, _, w]) = (nodes.velocity[*node as usize], nodes.position[*node as usize]);
        *unfiltered = [x, y, z, w];
    }
    velocity.clone_from(unfiltered);
    let drag_rate = &fluid.drag_rate;
    fluid.drag.clear();
    fluid.drag.resize(drag_rate.len(), [0.0; 4]);
    cpu.for_chunks(&mut velocity[..], |first, velocity| {
        let (lists, weights) = (lists.chunk(first), fluid_weights.chunk(first));
        with_lanes!(cpu, simd => {
            for row in (0..velocity.len()).step_by(LANES) {
                let [ux, uy, uz, w] = lanes::load_rows(simd, velocity, row);
                let mut sum = lanes::splat(simd, 0.0);
                for (entry, weight) in lists.group(row).iter().zip(&weights[lists.range(row)]) {
                    let [_, _, _, chi] = lanes::gather_rows(simd, drag_rate, entry);
                    let inverse = weight_inside(simd, chi);
                    sum += lanes::load(simd, weight, 0) * inverse;
                }
                lanes::store_rows(velocity, row, [ux, uy, uz, sum * w]);
            }
        });
    });
}
