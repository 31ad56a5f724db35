//! Nodes as control particles: sorted by cell, and who is near whom. A node of a swollen sponge stands for more volume.

use crate::{
    columns::{Column::*, Columns, FAR_ROW, padded},
    cpu::Cpu,
    grid::sort::permute,
    kernel::{Kernel, Need},
    params::Params,
};

/// `couple::controls`.
pub static KERNEL: Kernel = Kernel {
    name: "couple::controls",
    needs: &[Need::Fluid, Need::Sponge],
    reads: &[FluidPosition, FluidCells, NodePosition, NodeVolume, NodeSponge, NodeWetting],
    writes: &[ControlNode, ControlCells, ControlPosition, FluidControls, ControlFluid],
    cpu,
};

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let (particles, count) = (columns.rows.fluid, columns.rows.nodes);
    let radius = params.coupling.support_radius;
    let (fluid, nodes, controls) = (&mut columns.fluid, &columns.nodes, &mut columns.controls);
    controls.cells.build(cpu, &nodes.position[..count], radius, params.domain);
    controls.node.clone_from(&controls.cells.order);
    controls.position.clear();
    controls.position.resize(padded(count), FAR_ROW);
    permute(cpu, &controls.node, &nodes.position, &mut controls.position);
    for (row, node) in controls.node.iter().enumerate() {
        controls.position[row][3] = nodes.volume[*node as usize];
    }
    if !nodes.wetting.is_empty() {
        for (row, node) in controls.node.iter().enumerate() {
            let node = *node as usize;
            let wetting = &params.sponges[nodes.sponge[node] as usize].wetting;
            let size = wetting.size(nodes.wetting[node][0]);
            controls.position[row][3] *= size * size * size;
        }
    }
    let (particles, controls_rows) = ((&fluid.position[..], particles), (&controls.position[..], count));
    fluid.controls.build(cpu, particles, controls_rows, &controls.cells, (radius, None));
    controls.fluid.build(cpu, controls_rows, particles, &fluid.cells, (radius, None));
}
