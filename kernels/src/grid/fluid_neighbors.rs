//! For every particle, the particles within the support radius, or whose images are.

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
    let reach = (params.fluid.list_radius(), params.periodic.as_ref());
    neighbors.build(cpu, particles, particles, cells, reach);
}
