//! Drag impulses on the nodes, and their moments.
//!
//! ```text
//! D_a = sum_i w_ia J_i,   k_a = sum_i w_ia k_i,   M_a = sum_i w_ia (x_i - x_a) x J_i
//! ```
//!
//! After few sweeps a sponge has not yet received these impulses, and never their moments, because drag acts at the
//! particles. `pbd::momentum` adds the difference.

use crate::{columns::Columns, cpu::Cpu, kernel::declare, params::Params};

declare! {
    needs: [Fluid, Sponge, Incompressible, Porous, Smoothed],
    reads: [FluidPosition, FluidDrag, ControlNode, ControlPosition, ControlFluid, ControlFluidWeights],
    writes: [NodeDrag, NodeDragMoment],
    oracle: crate::oracle::porous::drag_reaction,
    bound: 2e-5,
    twin: [pass(NAME, Controls)],
}

fn cpu(cpu: &Cpu, _params: &Params, columns: &mut Columns) {
    super::impulses::on_nodes(cpu, columns, true);
}
