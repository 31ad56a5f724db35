//! Connectivity: the pieces into which a mask has cut a sponge.

use super::class::VERTEX_COLORS;
use super::lattice::Lattice;

/// Connected components of the nodes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pieces {
    /// Piece of each node; pieces are numbered over all sponges by their first node.
    pub node_piece: Vec<u32>,
    /// Number of pieces of each sponge; 1 where the sponge is in one piece.
    pub piece_count: Vec<u32>,
}

/// Finds the pieces of all sponges: two tets are connected if they share a node.
///
/// Pieces of one sponge move independently of each other. A piece may still have parts that share only a node or an edge,
/// and rotate about it like a hinge.
#[must_use]
pub fn pieces(lattice: &Lattice) -> Pieces {
    let count = lattice.vertex_color_start[VERTEX_COLORS];
    let mut parent: Vec<u32> = (0..count).collect();
    for tet in &lattice.tets {
        for &node in &tet[1..] {
            join(&mut parent, tet[0], node);
        }
    }
    let mut found =
        Pieces { node_piece: Vec::with_capacity(parent.len()), piece_count: vec![0; lattice.sponges.len()] };
    let mut next = 0;
    for node in 0..count {
        let root = root(&mut parent, node);
        // The root is the lowest node of its piece, so its own number is known already.
        let piece = if root == node { next } else { found.node_piece[root as usize] };
        if root == node {
            found.piece_count[lattice.node_sponge[node as usize] as usize] += 1;
            next += 1;
        }
        found.node_piece.push(piece);
    }
    found
}

fn root(parent: &mut [u32], mut node: u32) -> u32 {
    while parent[node as usize] != node {
        let above = parent[parent[node as usize] as usize];
        parent[node as usize] = above;
        node = above;
    }
    node
}

fn join(parent: &mut [u32], first: u32, second: u32) {
    let [first, second] = [root(parent, first), root(parent, second)];
    parent[first.max(second) as usize] = first.min(second);
}
