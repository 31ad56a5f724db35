//! Divides the tets of a colour into chunks that share no nodes.

use std::ops::Range;

use super::class::{COLORS, VERTEX_COLOR_SLOT, VERTEX_COLORS};
use super::lattice::{Lattice, first_after};

/// Tets of one colour and one sponge that touch nodes of no other chunk of that colour.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TetChunk {
    /// The tets, never empty.
    pub tets: Range<u32>,
    /// Nodes from the first to the last that the chunk touches, for each vertex colour.
    pub nodes: [Range<u32>; VERTEX_COLORS],
    /// The sponge.
    pub sponge: u32,
}

/// Divides each colour into chunks: `chunks(..)[color]` are in the order of the tets and cover them.
///
/// A chunk ends with a slab (all cells of one lattice index k), as soon as it has `target_tets` tets or more. Only the last
/// one of a sponge may have fewer. Within a colour the node ranges of the chunks rise and are disjoint in each vertex
/// colour, so that `split_at_mut` can distribute rows of nodes. The division depends only on the lattice and `target_tets`
/// (0 counts as 1).
#[must_use]
pub fn chunks(lattice: &Lattice, target_tets: usize) -> [Vec<TetChunk>; COLORS] {
    std::array::from_fn(|color| {
        let end = lattice.color_start[color + 1];
        let mut cut = Vec::new();
        let mut start = lattice.color_start[color];
        while start < end {
            let stop = chunk_end(lattice, start, end, target_tets);
            cut.push(chunk(lattice, color, start..stop));
            start = stop;
        }
        cut
    })
}

/// End of the chunk that begins at `start` in a colour that ends at `end`.
fn chunk_end(lattice: &Lattice, start: u32, end: u32, target_tets: usize) -> u32 {
    let key = |tet: u32| (lattice.tet_sponge[tet as usize], lattice.tet_slab[tet as usize]);
    let (sponge, _) = key(start);
    let target = u32::try_from(target_tets.max(1)).unwrap_or(u32::MAX);
    let sponge_end = first_after(start..end, |tet| key(tet).0 <= sponge);
    let last = start.saturating_add(target - 1);
    if last >= sponge_end {
        return sponge_end;
    }
    let reached = key(last);
    first_after(last..sponge_end, |tet| key(tet) <= reached)
}

fn chunk(lattice: &Lattice, color: usize, tets: Range<u32>) -> TetChunk {
    let first = lattice.tets[tets.start as usize];
    let last = lattice.tets[tets.end as usize - 1];
    // Node indices rise from tet to tet in each slot, so the ends of the chunk bound its nodes.
    let nodes = VERTEX_COLOR_SLOT[color].map(|slot| first[slot as usize]..last[slot as usize] + 1);
    let sponge = lattice.tet_sponge[tets.start as usize];
    TetChunk { tets, nodes, sponge }
}
