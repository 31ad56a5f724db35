//! For every particle, the particles within the support radius.

use crate::{
    columns::{Column::*, Columns, Fluid},
    cpu::Cpu,
    kernel::{Kernel, Need},
    params::Params,
};

/// `grid::fluid_neighbors`.
pub static KERNEL: Kernel = Kernel {
    name: "grid::fluid_neighbors",
    needs: &[Need::Fluid],
    reads: &[FluidPosition, FluidCells],
    writes: &[FluidNeighbors],
    cpu,
};

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let points = columns.rows.fluid;
    let Fluid { position, cells, neighbors, .. } = &mut columns.fluid;
    let particles = (&position[..], points);
    neighbors.build(cpu, particles, particles, cells, params.fluid.list_radius());
}
