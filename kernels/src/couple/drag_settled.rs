//! Drag impulses on the nodes, for the last time in a step: nodes no longer move fluid with them.
//!
//! ```text
//! D_a and M_a as in couple::drag_reaction,   k_a = 0
//! ```
//!
//! While the drag responds to the rigid motion of a sponge, `pbd::momentum` moves the mass of the fluid as well. The last
//! motion must leave the nodes with the impulses that the particles lose, to rounding. It therefore moves the sponge alone,
//! and the drag is not computed again.

use crate::{columns::Columns, cpu::Cpu, kernel::declare, params::Params};

declare! {
    needs: [Fluid, Solver(Vbd), Incompressible, Porous, Smoothed],
    reads: [FluidPosition, FluidDrag, ControlNode, ControlPosition, ControlFluid, ControlFluidWeights],
    writes: [NodeDrag, NodeDragMoment],
    oracle: crate::oracle::porous::drag_settled,
    bound: 2e-5,
    twin: [pass("couple::drag_reaction", Controls).from("settled")],
}

fn cpu(cpu: &Cpu, _params: &Params, columns: &mut Columns) {
    super::impulses::on_nodes(cpu, columns, false);
}
