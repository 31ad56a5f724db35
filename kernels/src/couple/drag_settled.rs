//! Fixes the drag of the step: nodes no longer move fluid with them.
//!
//! ```text
//! k_a = 0
//! ```
//!
//! While the drag responds to the rigid motion of a sponge, `pbd::momentum` moves the mass of the fluid as well. The last
//! motion must leave the nodes with the impulses that the particles lose, to rounding. It therefore moves the sponge alone,
//! and the drag is not computed again.

use crate::{
    columns::{Columns, lane},
    cpu::Cpu,
    kernel::declare,
    params::Params,
};

declare! {
    needs: [Fluid, Solver(Vbd), Incompressible, Porous],
    reads: [NodeDrag],
    writes: [NodeDrag],
    oracle: crate::oracle::porous::drag_settled,
    bound: 1e-12,
    twin: [pass(NAME, Nodes)],
}

fn cpu(cpu: &Cpu, _params: &Params, columns: &mut Columns) {
    cpu.for_chunks(&mut columns.nodes.drag[..], |_, drag| {
        drag.iter_mut().for_each(|row| row[lane::nodes::drag::MASS] = 0.0)
    });
}
