//! Stars of nodes, and ranges of sponges, as shaders have them.

use super::pack::SPONGES;
use crate::{
    columns::{Columns, Nodes, lane},
    layout::constants,
    params::Params,
    pbd::{
        lattice::VERTEX_COLORS,
        momentum::joined,
        stars::{CORNERS, NEIGHBORS, TETS},
    },
};

constants! {
    /// Where the neighbours along the axes begin among the words of a star, behind those at the corners.
    const STAR_DIRECTIONS: usize = CORNERS;
    /// A bit for every tet that there is.
    const STAR_TETS: usize = NEIGHBORS;
    /// The sponge of the node.
    const STAR_SPONGE: usize = STAR_TETS + 1;
    /// Bits of the wetness: no constant, but passes that need it have no binding left.
    const STAR_WETNESS: usize = STAR_TETS + 2;
    /// Where the weights of the tets are; 0 if all are 1.
    const STAR_WEIGHTS: usize = STAR_TETS + 3;
    /// Words of a star.
    const STAR_WORDS: usize = STAR_TETS + 4;
    /// Words of what touches a node, behind the stars of all nodes for the same reason: force and stiffness.
    const TOUCH_WORDS: usize = 9;
    /// Pairs of words of a sponge: ranges of nodes by vertex colour, and a bit for every sponge.
    pub(super) const RANGES: usize = VERTEX_COLORS + SPONGES / 64;
}

/// Words of every node; those of weights are behind all that, and most nodes have none.
fn row_words(has_touch: bool) -> usize {
    STAR_WORDS + if has_touch { TOUCH_WORDS } else { 0 }
}

/// Number of words of [`stars`].
pub(super) fn star_words(nodes: &Nodes, rows: usize, has_touch: bool) -> usize {
    let weighted = nodes.stars.each().filter(|(_, _, weights)| is_weighted(weights)).count();
    row_words(has_touch) * rows + weighted * TETS
}

/// Whether a tet stands for more or less than its own volume.
fn is_weighted(weights: &[f32; TETS]) -> bool {
    weights.iter().any(|weight| *weight != 0.0 && *weight != 1.0)
}

/// The stars of all nodes, a row each, what touches the nodes, if anything does, and weights.
pub(super) fn stars(nodes: &Nodes, rows: usize, has_touch: bool) -> Vec<u32> {
    let mut words = vec![0; rows * STAR_WORDS];
    for ((force, along), between) in
        nodes.touch.iter().zip(&nodes.touch_stiffness).zip(&nodes.touch_between).take(rows)
    {
        words.extend(
            [force, along, between].iter().flat_map(|row| row[..3].iter().map(|value| value.to_bits())),
        );
    }
    words.resize(row_words(has_touch) * rows, 0);
    for (node, neighbors, weights) in nodes.stars.each() {
        let wetness = nodes.wetting.get(node as usize).map_or(0.0, |row| row[lane::nodes::wetting::WETNESS]);
        let tets = (0..TETS).map(|tet| u32::from(weights[tet] > 0.0) << tet).sum();
        let table = if is_weighted(&weights) { words.len() as u32 } else { 0 };
        let star = &mut words[node as usize * STAR_WORDS..][..STAR_WORDS];
        star[..NEIGHBORS].copy_from_slice(&neighbors);
        star[STAR_TETS] = tets;
        star[STAR_SPONGE] = nodes.sponge[node as usize];
        star[STAR_WETNESS] = wetness.to_bits();
        star[STAR_WEIGHTS] = table;
        if table != 0 {
            words.extend(weights.map(f32::to_bits));
        }
    }
    words
}

/// First node and end of the nodes of every sponge in each vertex colour. Behind them is which others it touches, directly or through
/// others, a bit each.
pub(super) fn sponge_ranges(nodes: &Nodes, sponges: usize) -> Vec<[u32; 2]> {
    let mut ranges = vec![[0, 0]; sponges * RANGES];
    let stars = &nodes.stars;
    for piece in &stars.pieces {
        let color =
            (0..VERTEX_COLORS).find(|color| piece.rows.start < stars.color_start[color + 1]).unwrap_or(0);
        let range = &mut ranges[piece.sponge as usize * RANGES + color];
        if range[1] == 0 {
            range[0] = piece.rows.start;
        }
        range[1] = piece.rows.end;
    }
    let first = joined(&nodes.sponge, [&nodes.touch, &nodes.touch_stiffness], sponges);
    for (own, group) in first.iter().enumerate() {
        for other in (0..sponges).filter(|other| first[*other] == *group) {
            ranges[own * RANGES + VERTEX_COLORS + other / 64][other / 32 % 2] |= 1 << (other % 32);
        }
    }
    ranges
}

/// The first node of every sponge; beyond all nodes for one without any.
pub(super) fn first_nodes(columns: &Columns, params: &Params) -> Vec<usize> {
    let sponges = &columns.nodes.sponge[..columns.rows.nodes];
    let first = |sponge| sponges.iter().position(|own| *own as usize == sponge).unwrap_or(sponges.len());
    (0..params.sponges.len()).map(first).collect()
}
