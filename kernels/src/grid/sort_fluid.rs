//! Re-orders the particles by cell, so that neighbours in space are neighbours in memory.

use super::sort::permute;
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
    let mut rows = vec![FAR_ROW; padded(count)];
    permute(cpu, &cells.order, position, &mut rows);
    std::mem::swap(position, &mut rows);
    rows.resize(padded(count), [0.0; 4]);
    permute(cpu, &cells.order, velocity, &mut rows);
    rows[count..].fill([0.0; 4]);
    std::mem::swap(velocity, &mut rows);
    let mut ids = vec![u32::MAX; id.len()];
    permute(cpu, &cells.order, id, &mut ids);
    *id = ids;
}
