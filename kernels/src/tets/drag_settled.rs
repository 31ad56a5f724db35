//! Drag impulses on the nodes, for the last time in a step: nodes no longer move fluid with them. `couple::drag_settled` has the reason.

use crate::{columns::Columns, cpu::Cpu, kernel::declare, params::Params};

declare! {
    needs: [Fluid, Solver(Vbd), Divergence, Porous, Barycentric],
    reads: [FluidPosition, FluidDrag, FluidShares, ControlNode, ControlPosition, ControlCorners],
    writes: [NodeDrag, NodeDragMoment],
    oracle: crate::oracle::tets::drag_settled,
    bound: 2e-5,
    twin: [pass("tets::drag_reaction", Controls).from("settled")],
}

fn cpu(cpu: &Cpu, _: &Params, columns: &mut Columns) {
    super::impulses::on_nodes(cpu, columns, false);
}
