//! Drag impulses on the nodes, and their moments.
//!
//! ```text
//! D_a = sum_i w_ia J_i,   k_a = sum_i w_ia k_i,   M_a = sum_i w_ia (x_i - x_a) x J_i
//! ```
//!
//! After few sweeps a sponge has not yet received these impulses, and never their moments, because drag acts at the
//! particles. `pbd::momentum` adds the difference.

use crate::{
    columns::{Columns, Controls},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
    vector::{cross, minus, plus, splat, times},
};

declare! {
    needs: [Fluid, Sponge, Incompressible, Porous],
    reads: [FluidPosition, FluidDrag, ControlNode, ControlPosition, ControlFluid, ControlFluidWeights],
    writes: [NodeDrag, NodeDragMoment],
    oracle: crate::oracle::porous::drag_reaction,
    bound: 2e-5,
    twin: [pass(NAME, Controls)],
}

fn cpu(cpu: &Cpu, _params: &Params, columns: &mut Columns) {
    let (particles, drag) = (&columns.fluid.position, &columns.fluid.drag);
    let Controls { node, position, fluid: lists, fluid_weights, .. } = &columns.controls;
    let nodes = &mut columns.nodes;
    let mut impulses = vec![[0.0_f32; 4]; position.len()];
    let mut moments = impulses.clone();
    cpu.for_chunks((&mut impulses[..], &mut moments[..]), |first, (impulses, moments)| {
        let (lists, weights) = (lists.chunk(first), fluid_weights.chunk(first));
        with_lanes!(cpu, simd => {
            let zero = lanes::splat(simd, 0.0);
            for row in (0..impulses.len()).step_by(LANES) {
                let [x, y, z, _] = lanes::load_rows(simd, position, first + row);
                let mut impulse = splat(simd, [0.0; 3]);
                let (mut moment, mut mass) = (impulse, zero);
                for (entry, weight) in lists.group(row).iter().zip(&weights[lists.range(row)]) {
                    let [xi, yi, zi, _] = lanes::gather_rows(simd, particles, entry);
                    let [jx, jy, jz, drawn] = lanes::gather_rows(simd, drag, entry);
                    let weight = lanes::load(simd, weight, 0);
                    let own = times([jx, jy, jz], weight);
                    mass += weight * drawn;
                    impulse = plus(impulse, own);
                    moment = plus(moment, cross(minus([xi, yi, zi], [x, y, z]), own));
                }
                lanes::store_rows(impulses, row, [impulse[0], impulse[1], impulse[2], mass]);
                lanes::store_rows(moments, row, [moment[0], moment[1], moment[2], zero]);
            }
        });
    });
    for (rows, sums) in [(&mut nodes.drag, &impulses), (&mut nodes.drag_moment, &moments)] {
        rows.clear();
        rows.resize(nodes.position.len(), [0.0; 4]);
        for (node, sum) in node.iter().zip(sums) {
            rows[*node as usize] = *sum;
        }
    }
}
