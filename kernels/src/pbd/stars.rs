//! The star of a node: the tets that meet in it and the nodes around it.
//!
//! On the lattice every inner node has the same star. It has six neighbours of its own sublattice, one edge away along the axes. Eight of
//! the other sublattice are at the corners of a cube around it. It has 24 tets. Around each of the six lie four tets, whose other two nodes
//! are consecutive corners of a ring of four. A node at the surface lacks some of them.
//!
//! Bits of a corner: x, y, z, set where it lies on the positive side. Directions: `2 axis + 1` for the positive one.
//! Tet `4 direction + k` has the corners `k` and `k + 1` of the [`RINGS`].

use std::ops::Range;

use crate::{
    column::ColumnData,
    lanes::LANES,
    layout::constants,
    pbd::lattice::{Topology, VERTEX_COLORS},
};

constants! {
    /// Directions of the neighbours of the same sublattice.
    pub const DIRECTIONS: usize = 6;
    /// Corners, where the neighbours of the other sublattice are.
    pub const CORNERS: usize = 8;
    /// Corners next to every direction, clockwise when looking along it.
    pub const RINGS: [[usize; 4]; DIRECTIONS] = rings();
}

/// Neighbours: first the corners, then the directions.
pub const NEIGHBORS: usize = CORNERS + DIRECTIONS;
/// Tets of a full star.
pub const TETS: usize = 4 * DIRECTIONS;
/// Nodes of a piece that is summed separately.
const PIECE: usize = 256;

const fn rings() -> [[usize; 4]; DIRECTIONS] {
    // Of the two other axes in the order that makes the three right-handed.
    let sides = [[1, 1], [1, 0], [0, 0], [0, 1]];
    let mut rings = [[0; 4]; DIRECTIONS];
    let mut direction = 0;
    while direction < DIRECTIONS {
        let (axis, positive) = (direction / 2, direction % 2);
        let mut k = 0;
        while k < 4 {
            // Seen from the opposite side the orientation is reversed.
            let [e, f] = sides[if positive == 1 { k } else { (4 - k) % 4 }];
            rings[direction][k] = positive << axis | e << ((axis + 1) % 3) | f << ((axis + 2) % 3);
            k += 1;
        }
        direction += 1;
    }
    rings
}

/// For every slot of a tet as the centre. These are the centre, its partner on the long edge, and the opposite edge in the order
/// that keeps the volume positive.
const ROLES: [[usize; 4]; 4] = [[0, 1, 2, 3], [1, 0, 3, 2], [2, 3, 0, 1], [3, 2, 1, 0]];

/// Eight nodes of one vertex colour.
#[derive(Clone, Debug)]
pub struct StarGroup {
    /// The nodes; a short last group repeats its last node.
    pub(crate) own: [u32; LANES],
    /// Neighbours, first the corners, then the directions; the node itself where there is none.
    pub(crate) neighbors: [[u32; LANES]; NEIGHBORS],
    /// [Weights](Topology::weights) of the tets, 0 for those that do not exist.
    pub(crate) tets: [[f32; LANES]; TETS],
    /// Sum of the weights of the tets that have a corner.
    pub(crate) shares: [[f32; LANES]; CORNERS],
}

/// Nodes of one sponge with consecutive rows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Piece {
    pub(crate) sponge: u32,
    pub(crate) rows: Range<u32>,
}

/// The stars of all nodes.
#[derive(Clone, Debug, Default)]
pub struct Stars {
    /// First node of every vertex colour, then the number of nodes.
    pub(crate) color_start: [u32; VERTEX_COLORS + 1],
    /// First group of every vertex colour, then the number of groups.
    pub(crate) group_start: [u32; VERTEX_COLORS + 1],
    pub(crate) groups: Vec<StarGroup>,
    pub(crate) shape: StarShape,
    /// All nodes, divided where the sponge or the vertex colour changes.
    pub(crate) pieces: Vec<Piece>,
}

/// The tets of a full star. The lists have lengths that the compiler does not know. It would unroll the passes over the 24
/// tets of eight nodes for every SIMD level.
#[derive(Clone, Debug)]
pub(crate) struct StarShape {
    /// Corners of every direction, [`RINGS`].
    pub(crate) rings: Vec<[usize; 4]>,
    /// Neighbours of every tet: partner, q and r.
    pub(crate) tets: Vec<[usize; 3]>,
    /// [`NEIGHBORS`].
    pub(crate) neighbors: usize,
}

impl Default for StarShape {
    fn default() -> Self {
        let tet = |tet: usize| {
            let ring = RINGS[tet / 4];
            [CORNERS + tet / 4, ring[(tet + 1) % 4], ring[tet % 4]]
        };
        Self { rings: RINGS.to_vec(), tets: (0..TETS).map(tet).collect(), neighbors: NEIGHBORS }
    }
}

/// One star before it is put into a group.
#[derive(Clone, Copy)]
struct Star {
    neighbors: [u32; NEIGHBORS],
    weights: [f32; TETS],
}

impl Stars {
    /// The stars of a lattice, from its tets and its nodes at rest.
    #[must_use]
    pub fn new(topology: &Topology, rest: &[[f32; 4]], sponge: &[u32]) -> Self {
        let starts = topology.vertex_color_start;
        let mut stars: Vec<Star> =
            (0..starts[4]).map(|node| Star { neighbors: [node; NEIGHBORS], weights: [0.0; TETS] }).collect();
        for (tet, weight) in topology.tets.iter().zip(&topology.weights) {
            for roles in ROLES {
                let [node, partner, q, r] = roles.map(|slot| tet[slot]);
                let side = |other: u32, axis: usize| {
                    let (other, own) = (rest[other as usize], rest[node as usize]);
                    other[axis] - own[axis]
                };
                let corner = |other: u32| {
                    (0..3).map(|axis| usize::from(side(other, axis) > 0.0) << axis).sum::<usize>()
                };
                let far = |a: &usize, b: &usize| side(partner, *a).abs().total_cmp(&side(partner, *b).abs());
                let axis = (0..3).max_by(far).unwrap_or(0);
                let direction = 2 * axis + usize::from(side(partner, axis) > 0.0);
                let star = &mut stars[node as usize];
                star.neighbors[corner(q)] = q;
                star.neighbors[corner(r)] = r;
                star.neighbors[CORNERS + direction] = partner;
                let place = RINGS[direction].iter().position(|corner_of| *corner_of == corner(r));
                star.weights[4 * direction + place.unwrap_or(0)] = *weight;
            }
        }
        let mut all = Self { color_start: starts, ..Self::default() };
        for color in 0..VERTEX_COLORS {
            let rows = starts[color]..starts[color + 1];
            for first in rows.clone().step_by(LANES) {
                let own = std::array::from_fn(|lane| (first + lane as u32).min(rows.end - 1));
                all.groups.push(group(own, &stars));
            }
            all.group_start[color + 1] = all.groups.len() as u32;
            all.add_pieces(rows, sponge);
        }
        all
    }

    fn add_pieces(&mut self, rows: Range<u32>, sponge: &[u32]) {
        let mut first = rows.start;
        for row in rows.clone() {
            let next = row + 1;
            let ends = next == rows.end || sponge[next as usize] != sponge[row as usize];
            if ends || (next - first) as usize == PIECE {
                self.pieces.push(Piece { sponge: sponge[row as usize], rows: first..next });
                first = next;
            }
        }
    }

    /// The nodes of a vertex colour.
    pub(crate) fn rows(&self, color: usize) -> Range<usize> {
        self.color_start[color] as usize..self.color_start[color + 1] as usize
    }

    /// The groups from a row of a vertex colour on.
    pub(crate) fn groups_from(&self, color: usize, first: usize) -> &[StarGroup] {
        &self.groups[self.group_start[color] as usize + first / LANES..]
    }

    /// The group that a node is in, and its place there.
    pub(crate) fn place(&self, node: usize) -> (&StarGroup, usize) {
        let starts = &self.color_start;
        let color = (0..VERTEX_COLORS).rev().find(|color| starts[*color] as usize <= node).unwrap_or(0);
        let place = node - starts[color] as usize;
        (&self.groups[self.group_start[color] as usize + place / LANES], place % LANES)
    }

    /// Every node with its neighbours and the weights of its tets, in the order of the rows.
    pub(crate) fn each(&self) -> impl Iterator<Item = (u32, [u32; NEIGHBORS], [f32; TETS])> {
        self.groups.iter().flat_map(|group| {
            let lanes = (0..LANES).filter(|lane| *lane == 0 || group.own[*lane] != group.own[lane - 1]);
            lanes.map(|lane| {
                (group.own[lane], group.neighbors.map(|rows| rows[lane]), group.tets.map(|row| row[lane]))
            })
        })
    }
}

fn group(own: [u32; LANES], stars: &[Star]) -> StarGroup {
    let star = |lane: usize| &stars[own[lane] as usize];
    let share = |corner: usize, lane: usize| {
        let has = |tet: &usize| {
            let ring = RINGS[tet / 4];
            ring[tet % 4] == corner || ring[(tet + 1) % 4] == corner
        };
        (0..TETS).filter(has).map(|tet| star(lane).weights[tet]).sum()
    };
    StarGroup {
        own,
        neighbors: std::array::from_fn(|k| std::array::from_fn(|lane| star(lane).neighbors[k])),
        tets: std::array::from_fn(|tet| std::array::from_fn(|lane| star(lane).weights[tet])),
        shares: std::array::from_fn(|corner| std::array::from_fn(|lane| share(corner, lane))),
    }
}

impl ColumnData for Stars {
    fn visit_words(&self, _rows: usize, visit: &mut dyn FnMut(u32)) {
        for (node, neighbors, weights) in self.each() {
            visit(node);
            neighbors.into_iter().for_each(&mut *visit);
            weights.into_iter().for_each(|weight| visit(weight.to_bits()));
        }
    }
    fn poison(&mut self) {
        self.groups.iter_mut().for_each(|group| {
            group.own = [u32::MAX; LANES];
            group.neighbors = [[u32::MAX; LANES]; NEIGHBORS];
        });
        self.pieces.iter_mut().for_each(|piece| piece.rows = u32::MAX - 1..u32::MAX);
    }
}
