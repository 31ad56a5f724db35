//! The tets of all sponges, in the order in which they are solved.

use std::ops::Range;

use crate::{column::ColumnData, layout::constants};

/// Colours of tets: no two tets of a colour share a node.
pub const COLORS: usize = 24;

constants! {
    /// Colours of nodes: each tet has one node of each.
    pub const VERTEX_COLORS: usize = 4;
}

/// Tets of one colour and one sponge, and the nodes that they touch.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TetChunk {
    /// Tets.
    pub tets: Range<u32>,
    /// Nodes by vertex colour. Chunks of one colour touch disjoint ranges.
    pub nodes: [Range<u32>; VERTEX_COLORS],
    /// Index of the sponge.
    pub sponge: u32,
}

/// Tets, their colours, and the chunks that colours are solved in.
#[derive(Clone, Debug, Default)]
pub struct Topology {
    /// Nodes of every tet, ordered by colour.
    pub tets: Vec<[u32; 4]>,
    /// Volume that every tet stands for, over its own \[1\]: above 1 at pits.
    pub weights: Vec<f32>,
    /// Where the vertex colours begin.
    pub vertex_color_start: [u32; VERTEX_COLORS + 1],
    /// Vertex colour of every slot of the tets of a colour.
    pub slot_vertex_color: [[u8; 4]; COLORS],
    /// Chunks by colour.
    pub chunks: [Vec<TetChunk>; COLORS],
}

impl ColumnData for Topology {
    fn visit_words(&self, _rows: usize, visit: &mut dyn FnMut(u32)) {
        self.tets.iter().flatten().for_each(|node| visit(*node));
        self.weights.iter().for_each(|weight| visit(weight.to_bits()));
    }
    fn poison(&mut self) {
        self.tets.fill([u32::MAX; 4]);
        self.weights.fill(f32::NAN);
    }
}
