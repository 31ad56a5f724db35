//! How far inside a sponge every particle is, and how fast drag acts there.
//!
//! ```text
//! chi_i = sum_a V_a W_ia,    beta_i = sum_a V_a W_ia mu phi_a / (rho K_a)
//! ```
//!
//! chi is 1 deep inside and 0 outside.

use crate::{
    columns::{Column::*, Columns, FAR_ROW, Fluid, padded},
    cpu::Cpu,
    grid::{cells::Cells, neighbors::Neighbors, sort::permute},
    kernel::{Kernel, Need},
    lanes::{self, LANES, with_lanes},
    params::Params,
    smoothing::Wendland,
};

/// `couple::interior`.
pub static KERNEL: Kernel = Kernel {
    name: "couple::interior",
    needs: &[Need::Fluid, Need::Sponge],
    reads: &[FluidPosition, FluidControls, ControlPosition, ControlNode, NodeSponge],
    writes: &[FluidControlWeights, FluidInterior, FluidDragRate],
    cpu,
};

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Fluid { position, controls: lists, control_weights, interior, drag_rate, .. } = &mut columns.fluid;
    let controls = &columns.controls.position;
    // One rate per control row; padding rows weigh nothing.
    let mut rate = vec![0.0; controls.len()];
    for (rate, node) in rate.iter_mut().zip(&columns.controls.node) {
        *rate = params.sponges[columns.nodes.sponge[*node as usize] as usize].drag_rate;
    }
    interior.resize(position.len(), 0.0);
    drag_rate.resize(position.len(), 0.0);
    let rows = (&mut interior[..], &mut drag_rate[..], control_weights.match_lists(lists));
    cpu.for_chunks(rows, |first, (interior, drag_rate, weights)| {
        let (lists, weights) = (lists.chunk(first), &mut weights.0[0]);
        with_lanes!(cpu, simd => {
            let kernel = params.coupling.lanes(simd);
            for row in (0..interior.len()).step_by(LANES) {
                let [x, y, z, _] = lanes::load_rows(simd, position, first + row);
                let mut sum = lanes::splat(simd, 0.0);
                let mut drag = lanes::splat(simd, 0.0);
                for (entry, stored) in lists.group(row).iter().zip(&mut weights[lists.range(row)]) {
                    let [xa, ya, za, volume] = lanes::gather_rows(simd, controls, entry);
                    let (dx, dy, dz) = (x - xa, y - ya, z - za);
                    let shape = kernel.shape(kernel.closeness(dx * dx + dy * dy + dz * dz));
                    let weight = volume * kernel.value_scale() * shape;
                    lanes::store(stored, 0, weight);
                    sum += weight;
                    drag += weight * lanes::gather(simd, &rate, entry);
                }
                lanes::store(interior, row, sum);
                lanes::store(drag_rate, row, drag);
            }
        });
    });
}

/// Kernel sum of node volumes at every node, as the nodes lie now; set-up calls it at rest.
#[must_use]
pub fn node_interior(cpu: &Cpu, params: &Params, columns: &Columns) -> Vec<f32> {
    let (nodes, count) = (&columns.nodes, columns.rows.nodes);
    let mut cells = Cells::default();
    cells.build(cpu, &nodes.position[..count], params.coupling.support_radius, params.domain);
    let mut sorted = vec![FAR_ROW; padded(count)];
    permute(cpu, &cells.order, &nodes.position, &mut sorted);
    for (row, node) in sorted.iter_mut().zip(&cells.order) {
        row[3] = nodes.volume[*node as usize];
    }
    let mut lists = Neighbors::default();
    lists.build(cpu, (&sorted, count), (&sorted, count), &cells, params.coupling.support_radius);
    let radius = f64::from(params.coupling.support_radius);
    let mut interior = vec![0.0; nodes.position.len()];
    for (row, node) in cells.order.iter().enumerate() {
        let sum: f64 = lists
            .of(row, count)
            .map(|other| {
                let (a, b) = (sorted[row], sorted[other as usize]);
                let square: f64 = (0..3).map(|axis| f64::from(a[axis] - b[axis]).powi(2)).sum();
                f64::from(b[3]) * Wendland::value_f64(radius, square.sqrt())
            })
            .sum();
        interior[*node as usize] = sum as f32;
    }
    interior
}
