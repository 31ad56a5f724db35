//! Subtracts from the particles the drag impulses that the nodes received.
//!
//! ```text
//! v_i -= J_i / m
//! ```

use crate::{columns::Columns, cpu::Cpu, kernel::declare, params::Params};

declare! {
    needs: [Fluid, Sponge, Incompressible, Porous],
    reads: [FluidVelocity, FluidInterior, FluidDrag],
    writes: [FluidVelocity],
    oracle: crate::oracle::porous::drag_kick,
    bound: 4e-6,
    twin: [pass("couple::exchange_fluid", Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    super::impulses::kick(cpu, params, &mut columns.fluid);
}
