//! Re-orders the particles by cell, so that neighbours in space are neighbours in memory.

use super::{cells::Cells, sort::permute};
use crate::{
    columns::{Column::*, Columns, FAR_ROW, Fluid, padded},
    cpu::Cpu,
    kernel::{Kernel, Need},
    params::Params,
};

/// `grid::sort_fluid`.
pub static KERNEL: Kernel = Kernel {
    name: "grid::sort_fluid",
    needs: &[Need::Fluid],
    reads: &[FluidPosition, FluidVelocity, FluidId],
    writes: &[FluidCells, FluidPosition, FluidVelocity, FluidId],
    cpu,
};

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
