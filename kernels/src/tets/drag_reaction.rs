//! Drag impulses on the nodes, their moments, and the mass of fluid that moves with a node. This is `couple::drag_reaction` over the
//! particles in the tets of the node.

use crate::{columns::Columns, cpu::Cpu, kernel::declare, params::Params};

declare! {
    needs: [Fluid, Sponge, Divergence, Porous, Barycentric],
    reads: [FluidPosition, FluidDrag, FluidShares, ControlNode, ControlPosition, ControlCorners],
    writes: [NodeDrag, NodeDragMoment],
    oracle: crate::oracle::tets::drag_reaction,
    bound: 2e-5,
    twin: [pass(NAME, Controls)],
}

fn cpu(cpu: &Cpu, _: &Params, columns: &mut Columns) {
    super::impulses::on_nodes(cpu, columns, true);
}
