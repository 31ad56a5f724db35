//! For every particle, the particles within the support radius, periodic images included.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    kernel::declare,
    params::Params,
};

declare! {
    needs: [Fluid],
    reads: [FluidPosition, FluidCells],
    writes: [FluidNeighbors],
    oracle: crate::oracle::grid::fluid_neighbors,
    bound: 0.0,
    // The search has every pair at hand, and notes the longest list that does not fit.
    twin_writes: [FluidDensity, FluidExtremes],
    twin: [pass(NAME, Fluid).on(FLUID_CELLS), CHECK],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let points = columns.rows.fluid;
    let Fluid { position, cells, neighbors, .. } = &mut columns.fluid;
    let particles = (&position[..], points);
    let reach = (params.fluid.list_radius(), params.periodic.as_ref());
    neighbors.build(cpu, particles, particles, cells, reach);
}
