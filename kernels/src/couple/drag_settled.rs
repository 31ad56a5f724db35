//! From here on the drag of the step is what it is: nodes no longer take fluid along.
//!
//! ```text
//! k_a = 0
//! ```
//!
//! While drag answers to the motion that a sponge is given, `pbd::momentum` moves the mass of the fluid as well. The last motion must leave
//! the nodes with the impulses that the particles lose, to rounding: it moves the sponge alone, and nothing asks for the drag again.

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
