//! Takes from the particles what the drag gave to the nodes.
//!
//! ```text
//! v_i -= J_i / m
//! ```

use crate::{
    columns::{Column::*, Columns},
    cpu::Cpu,
    kernel::{Kernel, Need},
    params::Params,
};

/// `couple::drag_kick`.
pub static KERNEL: Kernel = Kernel {
    name: "couple::drag_kick",
    needs: &[Need::Fluid, Need::Sponge, Need::Incompressible, Need::Porous],
    reads: &[FluidVelocity, FluidInterior, FluidDrag],
    writes: &[FluidVelocity],
    cpu,
};

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    super::exchange::kick(cpu, params, &mut columns.fluid);
}
