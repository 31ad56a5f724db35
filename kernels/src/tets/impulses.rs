//! Impulses of the drag on nodes, by the particles in their tets.

use crate::{
    columns::{Columns, Controls},
    couple::impulses::by_node,
    cpu::Cpu,
    lanes::{self, LANES, with_lanes},
    vector::{cross, minus, plus, splat, times},
};

/// Drag impulses on the nodes and their moments, and the mass of fluid that moves with a node. There is no mass if the drag no longer
/// responds to the nodes.
pub(super) fn on_nodes(cpu: &Cpu, columns: &mut Columns, responds: bool) {
    let (particles, drag, shares) = (&columns.fluid.position, &columns.fluid.drag, &columns.fluid.shares);
    let Controls { node, position, corners: lists, .. } = &columns.controls;
    let nodes = &mut columns.nodes;
    let mut impulses = vec![[0.0_f32; 4]; position.len()];
    let mut moments = impulses.clone();
    cpu.for_chunks((&mut impulses[..], &mut moments[..]), |first, (impulses, moments)| {
        let lists = lists.chunk(first);
        with_lanes!(cpu, simd => {
            let zero = lanes::splat(simd, 0.0);
            for row in (0..impulses.len()).step_by(LANES) {
                let [x, y, z, _] = lanes::load_rows(simd, position, first + row);
                let mut impulse = splat(simd, [0.0; 3]);
                let (mut moment, mut mass) = (impulse, zero);
                for entry in lists.group(row) {
                    let particle = entry.map(|place| place / 4);
                    let [.., weight] = lanes::gather_rows(simd, shares.0.as_flattened(), entry);
                    let [xi, yi, zi, _] = lanes::gather_rows(simd, particles, &particle);
                    let [jx, jy, jz, drawn] = lanes::gather_rows(simd, drag, &particle);
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
