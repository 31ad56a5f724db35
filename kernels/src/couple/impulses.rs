//! Impulses of the drag between particles and nodes.

use crate::{
    columns::{Columns, Controls, Nodes},
    cpu::Cpu,
    grid::neighbors::ChunkLists,
    lanes::{self, LANES, Simd, f32x8, select, with_lanes},
    layout::constants,
    vector::{Vec3x8, cross, minus, plus, splat, times},
};

constants! {
    /// Interior value below which a particle feels no drag.
    const MINIMUM_INTERIOR: f32 = 1.0e-3;
}

/// 1 / chi, or 0 where there is no drag.
#[inline(always)]
pub(crate) fn weight_inside<S: Simd>(simd: S, chi: f32x8<S>) -> f32x8<S> {
    let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
    let inside = chi.simd_gt(lanes::splat(simd, MINIMUM_INTERIOR));
    select(inside, one / select(inside, chi, one), zero)
}

/// Sum over the controls of eight particles of `V_a W_ia` times a row of each.
#[inline(always)]
pub(super) fn weighted<S: Simd>(
    simd: S,
    rows: &[[f32; 4]],
    group: &[[u32; LANES]],
    weights: &[[f32; LANES]],
) -> [f32x8<S>; 4] {
    let mut sum = [lanes::splat(simd, 0.0); 4];
    for (entry, weight) in group.iter().zip(weights) {
        let [x, y, z, w] = lanes::gather_rows(simd, rows, entry);
        let weight = lanes::load(simd, weight, 0);
        sum = [sum[0] + weight * x, sum[1] + weight * y, sum[2] + weight * z, sum[3] + weight * w];
    }
    sum
}

/// Mean of a row of the controls of eight particles, weighed with `V_a W_ia`, and 1 / chi; both are zero where there is no drag.
#[inline(always)]
pub(super) fn mean_inside<S: Simd>(
    simd: S,
    rows: &[[f32; 4]],
    group: &[[u32; LANES]],
    weights: &[[f32; LANES]],
) -> (Vec3x8<S>, f32x8<S>) {
    let (mut sum, mut chi) = (splat(simd, [0.0; 3]), lanes::splat(simd, 0.0));
    for (entry, weight) in group.iter().zip(weights) {
        let [x, y, z, _] = lanes::gather_rows(simd, rows, entry);
        let weight = lanes::load(simd, weight, 0);
        sum = plus(sum, times([x, y, z], weight));
        chi += weight;
    }
    let inverse = weight_inside(simd, chi);
    (times(sum, inverse), inverse)
}

/// Sum over the particles of eight controls of `V_a W_ia` times the drag row.
#[inline(always)]
pub(super) fn received<S: Simd>(
    simd: S,
    drag: &[[f32; 4]],
    lists: &ChunkLists,
    weights: &[[f32; LANES]],
    row: usize,
) -> Vec3x8<S> {
    let mut sum = splat(simd, [0.0; 3]);
    for (entry, weight) in lists.group(row).iter().zip(&weights[lists.range(row)]) {
        let [jx, jy, jz, _] = lanes::gather_rows(simd, drag, entry);
        sum = plus(sum, times([jx, jy, jz], lanes::load(simd, weight, 0)));
    }
    sum
}

/// Drag impulses on the nodes and their moments, and the mass of fluid that moves with a node. There is no mass if the drag no longer
/// responds to the nodes.
pub(super) fn on_nodes(cpu: &Cpu, columns: &mut Columns, responds: bool) {
    let (particles, drag) = (&columns.fluid.position, &columns.fluid.drag);
    let Controls { node, position, fluid: lists, fluid_weights, .. } = &columns.controls;
    let nodes = &mut columns.nodes;
    let mut impulses = vec![[0.0_f32; 4]; position.len()];
    let mut moments = impulses.clone();
    cpu.for_chunks((&mut impulses[..], &mut moments[..]), |first, (impulses, moments)| {
        let (lists, weights) = (lists.chunk(first), fluid_weights.chunk(first));
        with_lanes!(cpu, simd => {
            let zero = lanes::splat(simd, 0.0);
            for row in (0..impulses.len()).step_by(LANES) {
                let [x, y, z, _] = lanes::load_rows(simd, position, first + row);
                let mut impulse = splat(simd, [0.0; 3]);
                let (mut moment, mut mass) = (impulse, zero);
                for (entry, weight) in lists.group(row).iter().zip(&weights[lists.range(row)]) {
                    let [xi, yi, zi, _] = lanes::gather_rows(simd, particles, entry);
                    let [jx, jy, jz, drawn] = lanes::gather_rows(simd, drag, entry);
                    let weight = lanes::load(simd, weight, 0);
                    let own = times([jx, jy, jz], weight);
                    mass += weight * drawn;
                    impulse = plus(impulse, own);
                    moment = plus(moment, cross(minus([xi, yi, zi], [x, y, z]), own));
                }
                let mass = if responds { mass } else { zero };
                lanes::store_rows(impulses, row, [impulse[0], impulse[1], impulse[2], mass]);
                lanes::store_rows(moments, row, [moment[0], moment[1], moment[2], zero]);
            }
        });
    });
    by_node(nodes, node, &impulses, &moments);
}

/// Writes impulses and moments in the order of the controls to the rows of their nodes.
pub(crate) fn by_node(nodes: &mut Nodes, order: &[u32], impulses: &[[f32; 4]], moments: &[[f32; 4]]) {
    for (rows, sums) in [(&mut nodes.drag, impulses), (&mut nodes.drag_moment, moments)] {
        rows.clear();
        rows.resize(nodes.position.len(), [0.0; 4]);
        for (node, sum) in order.iter().zip(sums) {
            rows[*node as usize] = *sum;
        }
    }
}
