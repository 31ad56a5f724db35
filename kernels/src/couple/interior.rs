//! Interior value of every particle in a sponge, and the drag rates there.
//!
//! ```text
//! iota_i = sum_a J_a V_a W_ia,    chi_i = sum_a V_a W_ia
//! beta_i = sum_a J_a V_a W_ia beta_a,    gamma_i = sum_a J_a V_a W_ia gamma_a
//! ```
//!
//! and `f_i = sum_a J_a V_a W_ia f_a` of `couple::solid_yield`. V are volumes at rest, J the present ones over them. The interior value
//! iota is 1 deep inside and 0 outside, also in a sponge that is squeezed, where nodes are closer. Means over nodes are divided by chi.
//! beta and gamma are those of `couple::pores`. In partly filled pores the permeability is less by the factor
//! `m_i = sum_a V_a W_ia m_a / chi_i` (`couple::wetting`). The rates are `beta_i / m_i` and `gamma_i / sqrt(m_i)`. The mean is that of
//! parallel conductors, so that dry pores ahead of a front do not hold the water behind it.

use super::compliance::following;
use crate::{
    column::{FAR_ROW, padded},
    columns::{Columns, Fluid, Nodes, lane},
    cpu::Cpu,
    grid::{cells::Cells, neighbors::Neighbors, sort::permute},
    kernel::declare,
    lanes::{self, LANES, select, with_lanes},
    params::Params,
    smoothing::Wendland,
};

declare! {
    needs: [Fluid, Sponge],
    reads: [FluidPosition, FluidControls, ControlPosition, ControlNode, NodePores, NodeWetting],
    writes: [FluidControlWeights, FluidInterior, FluidDragRate],
    oracle: crate::oracle::couple::interior,
    bound: 2e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Fluid { position, controls: lists, control_weights, interior, drag_rate, .. } = &mut columns.fluid;
    let controls = &columns.controls.position;
    // In the order of the controls; padding rows have zero weight.
    let mut traits = vec![[0.0; 4]; controls.len()];
    let mut volume_ratios = vec![0.0; controls.len()];
    for ((traits, ratio), node) in traits.iter_mut().zip(&mut volume_ratios).zip(&columns.controls.node) {
        *traits = traits_of(&columns.nodes, *node as usize);
        *ratio = columns.nodes.pores[*node as usize][lane::nodes::pores::VOLUME_RATIO];
    }
    let has_wetting = !columns.nodes.wetting.is_empty();
    interior.resize(position.len(), 0.0);
    drag_rate.resize(position.len(), [0.0; 4]);
    let rows = (&mut interior[..], &mut drag_rate[..], control_weights.match_lists(lists));
    cpu.for_chunks(rows, |first, (interior, drag_rate, weights)| {
        let (lists, weights) = (lists.chunk(first), &mut weights.0[0]);
        with_lanes!(cpu, simd => {
            let kernel = params.coupling.lanes(simd);
            for row in (0..interior.len()).step_by(LANES) {
                let [x, y, z, _] = lanes::load_rows(simd, position, first + row);
                let zero = lanes::splat(simd, 0.0);
                let (mut sum, mut linear, mut inertial, mut mobile) = (zero, zero, zero, zero);
                let (mut follows, mut filled) = (zero, zero);
                for (entry, stored) in lists.group(row).iter().zip(&mut weights[lists.range(row)]) {
                    let [xa, ya, za, volume] = lanes::gather_rows(simd, controls, entry);
                    let (dx, dy, dz) = (x - xa, y - ya, z - za);
                    let shape = kernel.shape(kernel.closeness(dx * dx + dy * dy + dz * dz));
                    let weight = volume * kernel.value_scale() * shape;
                    lanes::store(stored, 0, weight);
                    sum += weight;
                    filled += weight * lanes::gather(simd, &volume_ratios, entry);
                    let [following, drag_rate, inertial_drag_rate, mobility] =
                        lanes::gather_rows(simd, &traits, entry);
                    follows += weight * following;
                    linear += weight * drag_rate;
                    inertial += weight * inertial_drag_rate;
                    if has_wetting {
                        mobile += weight * mobility;
                    }
                }
                if has_wetting {
                    let one = lanes::splat(simd, 1.0);
                    let is_inside = sum.simd_gt(zero);
                    let slower = select(is_inside, sum, one) / select(is_inside, mobile, one);
                    linear *= slower;
                    inertial *= slower.sqrt();
                }
                lanes::store(interior, row, filled);
                lanes::store_rows(drag_rate, row, [linear, inertial, follows, sum]);
            }
        });
    });
}

/// What a control adds to means over controls: how far its material follows the water, both drag rates, and the mobility of the water.
fn traits_of(nodes: &Nodes, node: usize) -> [f32; 4] {
    let [volume_ratio, drag_rate, inertial_drag_rate, porosity] = nodes.pores[node];
    let mobility = nodes.wetting.get(node).map_or(1.0, |row| row[lane::nodes::wetting::MOBILITY]);
    [volume_ratio * following(porosity), drag_rate, inertial_drag_rate, mobility]
}

/// Sum of node volumes times W at every node, at the present positions; set-up calls it at rest.
#[must_use]
pub fn node_interior(cpu: &Cpu, params: &Params, columns: &Columns) -> Vec<f32> {
    let (nodes, count) = (&columns.nodes, columns.rows.nodes);
    let mut cells = Cells::default();
    cells.build(cpu, &nodes.position[..count], params.coupling.support_radius, params.domain);
    let mut sorted = vec![FAR_ROW; padded(count)];
    permute(cpu, &cells.order, &nodes.position, &mut sorted);
    for (row, node) in sorted.iter_mut().zip(&cells.order) {
        row[lane::controls::position::VOLUME] = nodes.volume[*node as usize];
    }
    let mut lists = Neighbors::default();
    lists.build(cpu, (&sorted, count), (&sorted, count), &cells, (params.coupling.support_radius, None));
    let radius = f64::from(params.coupling.support_radius);
    let mut interior = vec![0.0; nodes.position.len()];
    for (row, node) in cells.order.iter().enumerate() {
        let sum: f64 = lists
            .of(row, count)
            .map(|other| {
                let (a, b) = (sorted[row], sorted[other as usize]);
                let square: f64 = (0..3).map(|axis| f64::from(a[axis] - b[axis]).powi(2)).sum();
                f64::from(b[lane::controls::position::VOLUME]) * Wendland::value_f64(radius, square.sqrt())
            })
            .sum();
        interior[*node as usize] = sum as f32;
    }
    interior
}
