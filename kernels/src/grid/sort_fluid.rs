//! Re-orders the particles by cell, so that neighbours in space are neighbours in memory.

use super::{cells::Cells, sort::permute};
use crate::{
    column::{FAR_ROW, padded},
    columns::{Columns, Fluid},
    cpu::Cpu,
    kernel::declare,
    params::Params,
};

declare! {
    needs: [Fluid],
    reads: [FluidPosition, FluidVelocity, FluidId],
    writes: [FluidCells, FluidPosition, FluidVelocity, FluidId],
    oracle: crate::oracle::grid::sort_fluid,
    bound: 0.0,
    twin: [
        pass("grid::count", Fluid).on(FLUID_CELLS),
        pass("grid::scan_sums", FluidScan).on(FLUID_CELLS),
        pass("grid::scan_pages", FluidPages).on(FLUID_CELLS),
        pass("grid::scatter", Fluid).on(FLUID_CELLS),
        pass(NAME, Fluid),
    ],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let count = columns.rows.fluid;
    let Fluid { position, velocity, id, cells, .. } = &mut columns.fluid;
    cells.build(cpu, &position[..count], params.fluid.smoothing.support_radius, params.domain);
    let Cells { order, spare: (rows, ids), .. } = cells;
    rows.resize(padded(count), FAR_ROW);
    permute(cpu, order, position, rows);
    rows[count..].fill(FAR_ROW);
    std::mem::swap(position, rows);
    permute(cpu, order, velocity, rows);
    rows[count..].fill([0.0; 4]);
    std::mem::swap(velocity, rows);
    ids.resize(id.len(), u32::MAX);
    permute(cpu, order, id, ids);
    std::mem::swap(id, ids);
}
