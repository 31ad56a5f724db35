//! Nodes as control particles: sorted by cell, with the neighbour lists in both directions. A node of a swollen sponge
//! counts with its swollen volume.

use crate::{
    column::{FAR_ROW, padded},
    columns::{Columns, lane},
    cpu::Cpu,
    grid::sort::permute,
    kernel::declare,
    params::Params,
};

declare! {
    needs: [Fluid, Sponge],
    reads: [FluidPosition, FluidCells, NodePosition, NodeVolume, NodeSponge, NodeWetting],
    writes: [ControlNode, ControlCells, ControlPosition, FluidControls, ControlFluid],
    oracle: crate::oracle::couple::controls,
    bound: 1e-6,
    // The longest list that does not fit.
    twin_writes: [FluidExtremes],
    twin: [
        pass("grid::count", Nodes).on(CONTROL_CELLS),
        pass("grid::scan_sums", ControlScan).on(CONTROL_CELLS),
        pass("grid::scan_pages", ControlPages).on(CONTROL_CELLS),
        pass("grid::scatter", Nodes).on(CONTROL_CELLS),
        pass(NAME, Nodes),
        pass("couple::near_fluid", Fluid).on(&[
            ("grid", "control_grid"),
            ("starts", "control_starts"),
            ("targets", "control_position"),
            ("list", "fluid_controls"),
        ]),
        pass("couple::near_controls", Controls).on(FLUID_CELLS),
        CHECK,
    ],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let particles = columns.rows.fluid;
    let radius = params.coupling.support_radius;
    sort(cpu, params, columns);
    let (fluid, nodes, controls) = (&mut columns.fluid, &columns.nodes, &mut columns.controls);
    let count = controls.node.len();
    controls.position.clear();
    controls.position.resize(padded(count), FAR_ROW);
    permute(cpu, &controls.node, &nodes.position, &mut controls.position);
    for (row, node) in controls.node.iter().enumerate() {
        controls.position[row][lane::controls::position::VOLUME] = nodes.volume[*node as usize];
    }
    if !nodes.wetting.is_empty() {
        for (row, node) in controls.node.iter().enumerate() {
            let node = *node as usize;
            let wetting = &params.sponges[nodes.sponge[node] as usize].wetting;
            let size = wetting.size(nodes.wetting[node][lane::nodes::wetting::WETNESS]);
            controls.position[row][lane::controls::position::VOLUME] *= size * size * size;
        }
    }
    let (particles, controls_rows) = ((&fluid.position[..], particles), (&controls.position[..], count));
    fluid.controls.build(cpu, particles, controls_rows, &controls.cells, (radius, None));
    controls.fluid.build(cpu, controls_rows, particles, &fluid.cells, (radius, None));
}

/// The awake nodes by cell; no fluid is near the others.
fn sort(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let (count, radius) = (columns.rows.nodes, params.coupling.support_radius);
    let (nodes, controls) = (&columns.nodes, &mut columns.controls);
    if params.asleep.is_empty() {
        controls.cells.build(cpu, &nodes.position[..count], radius, params.domain);
        controls.node.clone_from(&controls.cells.order);
        return;
    }
    let awake: Vec<u32> = params.asleep.others(count).flatten().map(|node| node as u32).collect();
    let points: Vec<[f32; 4]> = awake.iter().map(|node| nodes.position[*node as usize]).collect();
    controls.cells.build(cpu, &points, radius, params.domain);
    controls.node.clear();
    controls.node.extend(controls.cells.order.iter().map(|row| awake[*row as usize]));
}
