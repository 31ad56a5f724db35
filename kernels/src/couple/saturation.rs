//! Saturation of every node, and the control pressure that follows from it (the paper, section 3.3).
//!
//! ```text
//! S_a = sum_i V_0 W_ia / (phi chi_a)        p_a = -p_e (1 + g max(1 - S_a, 0)),  0 at surface nodes
//! ```
//!
//! with `chi_a` the sum of node volumes times W at the node, at rest. A saturated sponge keeps the entry pressure `p_e` and
//! so holds its water. A dry one has more suction, by the gain g.

use crate::{
    columns::{Columns, Controls, lane},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
};

declare! {
    needs: [Fluid, Sponge],
    reads: [FluidPosition, ControlNode, ControlPosition, ControlFluid, NodeSponge, NodeSuction, NodeInterior],
    writes: [ControlFluidWeights, ControlSaturation, ControlSuction, NodeSaturation],
    oracle: crate::oracle::couple::saturation,
    bound: 3e-6,
    twin_bound: 1e-5,
    twin: [pass(NAME, Controls)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let particles = &columns.fluid.position;
    let nodes = &mut columns.nodes;
    let Controls { node, position, fluid: lists, fluid_weights, saturation, suction, .. } =
        &mut columns.controls;
    let volume = params.fluid.particle_mass / params.fluid.rest_density;
    saturation.clear();
    saturation.resize(position.len(), 0.0);
    suction.clear();
    suction.resize(position.len(), 0.0);
    let rows = (&mut saturation[..], &mut suction[..], fluid_weights.match_lists(lists));
    cpu.for_chunks(rows, |first, (saturation, suction, weights)| {
        let (lists, weights) = (lists.chunk(first), &mut weights.0[0]);
        with_lanes!(cpu, simd => {
            let kernel = params.coupling.lanes(simd);
            for row in (0..saturation.len()).step_by(LANES) {
                let [x, y, z, node_volume] = lanes::load_rows(simd, position, first + row);
                let scale = node_volume * kernel.value_scale();
                let mut sum = lanes::splat(simd, 0.0);
                for (entry, stored) in lists.group(row).iter().zip(&mut weights[lists.range(row)]) {
                    let [xi, yi, zi, _] = lanes::gather_rows(simd, particles, entry);
                    let (dx, dy, dz) = (x - xi, y - yi, z - zi);
                    let shape = kernel.shape(kernel.closeness(dx * dx + dy * dy + dz * dz));
                    lanes::store(stored, 0, scale * shape);
                    sum += shape;
                }
                lanes::store(saturation, row, sum * kernel.value_scale() * volume);
            }
        });
        for (row, node) in node[first.min(node.len())..].iter().take(saturation.len()).enumerate() {
            let node = *node as usize;
            let sponge = &params.sponges[nodes.sponge[node] as usize];
            saturation[row] /= sponge.porosity * nodes.interior[node];
            let pressure = sponge.control_pressure(saturation[row], 0.0);
            suction[row] =
                pressure * nodes.suction[node] * position[first + row][lane::controls::position::VOLUME];
        }
    });
    nodes.saturation.clear();
    nodes.saturation.resize(nodes.position.len(), 0.0);
    for (node, saturation) in node.iter().zip(&*saturation) {
        nodes.saturation[*node as usize] = *saturation;
    }
}
