//! Suction of faces of sponges that other faces cover.
//!
//! Nodes of the outermost layer have no suction, so that no layer of water forms around a sponge. Between two sponges that touch they
//! would be a barrier: water passes it against the capillary pressure alone. Where faces touch, the material goes on:
//!
//! ```text
//! c_a = min(sum_b A_b w_ab f_ab max(1 - max(g_ab, 0) / (PAIR_GAP e), 0), 1)
//! p_a V_a <- min(p_a V_a, c_a p(S_a) V_a)
//! ```
//!
//! over the pairs of `pbd::pairs`, with area A, weight w and facing f as in `pbd::touch`, and the gap g. The cover c is 1 where two
//! faces touch, and 0 from the largest gap of a pair on, without a jump between. It is of the positions at the beginning of the step.

use crate::{
    columns::{Columns, Nodes, lane},
    cpu::Cpu,
    kernel::declare,
    lanes::LANES,
    params::Params,
    pbd::meeting::Pair,
};

declare! {
    needs: [Fluid, Sponge, Porous, Solver(Vbd), Touch],
    reads: [
        NodePosition, NodeNormal, NodePairs, NodeSponge, NodeWetting, ControlNode, ControlPosition, ControlSaturation,
        ControlSuction,
    ],
    writes: [NodeCover, ControlSuction],
    oracle: crate::oracle::touch::contact_suction,
    bound: 1e-5,
    twin: [pass("couple::cover", Nodes), pass(NAME, Nodes)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let count = columns.rows.nodes;
    let mut cover = std::mem::take(&mut columns.nodes.cover);
    let nodes = &columns.nodes;
    cover.clear();
    cover.resize(nodes.position.len(), 0.0);
    cpu.for_chunks(&mut cover[..count], |first, cover| {
        let lists = nodes.pairs.chunk(first);
        for (row, cover) in cover.iter_mut().enumerate() {
            let others = lists.group(row).iter().map(|others| others[row % LANES] as usize);
            let sum: f32 = others
                .filter(|other| *other < count)
                .map(|other| covers(params, nodes, first + row, other))
                .sum();
            *cover = sum.min(1.0);
        }
    });
    let controls = &mut columns.controls;
    let (order, position, saturation) = (&controls.node, &controls.position, &controls.saturation);
    cpu.for_chunks(&mut controls.suction[..count], |first, suction| {
        for (row, node) in order[first..].iter().take(suction.len()).enumerate() {
            let node = *node as usize;
            if cover[node] <= 0.0 {
                continue;
            }
            let sponge = &params.sponges[nodes.sponge[node] as usize];
            let receding =
                nodes.wetting.get(node).map_or(0.0, |row| row[lane::nodes::wetting::RECEDING_SHARE]);
            let pressure = sponge.control_pressure(saturation[first + row], receding);
            let volume = position[first + row][lane::controls::position::VOLUME];
            suction[row] = suction[row].min(pressure * cover[node] * volume);
        }
    });
    columns.nodes.cover = cover;
}

/// How much of the face of a node another covers.
fn covers(params: &Params, nodes: &Nodes, a: usize, b: usize) -> f32 {
    let rows = |column: &[[f32; 4]]| [column[a], column[b]];
    let edge = params.pair_edge(nodes.sponge[a], nodes.sponge[b]);
    let area = nodes.normal[b][lane::nodes::normal::AREA];
    Pair::new(rows(&nodes.position), rows(&nodes.normal)).map_or(0.0, |pair| pair.cover(edge, area))
}
