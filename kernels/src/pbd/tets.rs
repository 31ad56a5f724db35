//! Passes over the tets: colour by colour, eight tets of a colour at a time.
//!
//! A [`Law`] solves eight tets. All laws share the loads, the stores and the division among threads. Two tets of a colour
//! share no node, so that chunks of a colour can be solved at the same time.

use crate::{
    columns::Nodes,
    cpu::Cpu,
    lanes::{self, LANES, Simd, f32x8, with_lanes},
    params::{Params, Solver, SpongeParams},
    pbd::lattice::{COLORS, TetChunk},
    vector::{Vec3x8, minus, plus, times},
};

/// Eight tets.
pub(super) struct TetLanes<S: Simd> {
    /// Predicted positions.
    pub(super) p: [Vec3x8<S>; 4],
    /// Positions at the beginning of the step.
    pub(super) old: [Vec3x8<S>; 4],
    /// Inverse masses.
    pub(super) w: [f32x8<S>; 4],
    /// Weights of the tets: volumes that they stand for, over their own.
    pub(super) weight: f32x8<S>,
}

impl<S: Simd> TetLanes<S> {
    /// Columns of the deformation gradient in the frame of the tet.
    #[inline(always)]
    pub(super) fn columns(&self, inverse_edge: f32x8<S>) -> [Vec3x8<S>; 3] {
        let [p0, p1, p2, p3] = self.p;
        [
            times(minus(p1, p0), inverse_edge),
            times(minus(p2, p3), inverse_edge),
            times(minus(plus(p2, p3), plus(p0, p1)), inverse_edge),
        ]
    }
}

/// Correction of eight tets of a sponge.
pub(super) trait Law: Sync {
    /// The solver of the sponges that it applies to.
    const SOLVER: Solver;

    /// Moves the nodes of eight tets.
    fn solve<S: Simd>(simd: S, sponge: &SpongeParams, step: f32, tet: &mut TetLanes<S>);
}

/// One sweep over all tets of the sponges of a law.
pub(super) fn sweep<L: Law>(cpu: &Cpu, params: &Params, nodes: &mut Nodes) {
    let Nodes { position, topology, predicted, .. } = nodes;
    for color in 0..COLORS {
        let task = Task {
            params,
            tets: &topology.tets,
            weights: &topology.weights,
            slots: topology.slot_vertex_color[color].map(usize::from),
            position,
            law: std::marker::PhantomData::<L>,
        };
        let starts = topology.vertex_color_start.map(|start| start as usize);
        let (rest, d) = predicted.split_at_mut(starts[3]);
        let (rest, c) = rest.split_at_mut(starts[2]);
        let (a, b) = rest.split_at_mut(starts[1]);
        let nodes = NodeSlices { nodes: [a, b, c, d], first: [starts[0], starts[1], starts[2], starts[3]] };
        task.split(cpu, cpu.threads(), &topology.chunks[color], nodes);
    }
}
/// The nodes of each vertex colour that a task may touch, and the row of the first.
struct NodeSlices<'a> {
    nodes: [&'a mut [[f32; 4]]; 4],
    first: [usize; 4],
}

impl NodeSlices<'_> {
    /// Divides every vertex colour before the nodes of `chunk`.
    fn split(self, chunk: &TetChunk) -> (Self, Self) {
        let starts = std::array::from_fn::<_, 4, _>(|color| chunk.nodes[color].start as usize);
        let [a, b, c, d] = self.nodes;
        let (a_left, a_right) = a.split_at_mut(starts[0] - self.first[0]);
        let (b_left, b_right) = b.split_at_mut(starts[1] - self.first[1]);
        let (c_left, c_right) = c.split_at_mut(starts[2] - self.first[2]);
        let (d_left, d_right) = d.split_at_mut(starts[3] - self.first[3]);
        (
            Self { nodes: [a_left, b_left, c_left, d_left], first: self.first },
            Self { nodes: [a_right, b_right, c_right, d_right], first: starts },
        )
    }
}

struct Task<'a, L> {
    params: &'a Params,
    tets: &'a [[u32; 4]],
    weights: &'a [f32],
    /// Vertex colour of every slot.
    slots: [usize; 4],
    position: &'a [[f32; 4]],
    law: std::marker::PhantomData<L>,
}

impl<L: Law> Task<'_, L> {
    fn split(&self, cpu: &Cpu, parts: usize, chunks: &[TetChunk], mut nodes: NodeSlices<'_>) {
        if parts <= 1 || chunks.len() <= 1 {
            for chunk in chunks {
                let sponge = &self.params.sponges[chunk.sponge as usize];
                // All nodes of a tet belong to one sponge.
                let node = self.tets[chunk.tets.start as usize][0];
                if sponge.solver != L::SOLVER || self.params.asleep.has(node as usize) {
                    continue;
                }
                with_lanes!(cpu, simd => self.chunk(simd, sponge, chunk, &mut nodes));
            }
            return;
        }
        let middle = chunks.len() * (parts / 2) / parts;
        let (left, right) = nodes.split(&chunks[middle]);
        cpu.join(
            || self.split(cpu, parts / 2, &chunks[..middle], left),
            || self.split(cpu, parts - parts / 2, &chunks[middle..], right),
        );
    }

    /// Predicted positions and inverse masses of one slot of eight tets.
    #[inline(always)]
    fn gather<S: Simd>(
        &self,
        simd: S,
        nodes: &NodeSlices<'_>,
        rows: &[[u32; LANES]; 4],
        slot: usize,
    ) -> (Vec3x8<S>, f32x8<S>) {
        let color = self.slots[slot];
        let first = nodes.first[color] as u32;
        let mut own = rows[slot];
        for row in &mut own {
            *row -= first;
        }
        let [x, y, z, w] = lanes::gather_rows(simd, nodes.nodes[color], &own);
        ([x, y, z], w)
    }

    /// Positions of one slot of eight tets at the beginning of the step.
    #[inline(always)]
    fn old<S: Simd>(&self, simd: S, rows: &[u32; LANES]) -> Vec3x8<S> {
        let [x, y, z, _] = lanes::gather_rows(simd, self.position, rows);
        [x, y, z]
    }

    #[inline(always)]
    #[expect(clippy::needless_range_loop, reason = "the slot is an index into several arrays")]
    fn chunk<S: Simd>(&self, simd: S, sponge: &SpongeParams, chunk: &TetChunk, nodes: &mut NodeSlices<'_>) {
        let own = chunk.tets.start as usize..chunk.tets.end as usize;
        let (tets, weights) = (&self.tets[own.clone()], &self.weights[own]);
        for (tets, weights) in tets.chunks(LANES).zip(weights.chunks(LANES)) {
            // A short last group repeats its last tet, and stores it once.
            let (mut rows, mut weight) = ([[0; LANES]; 4], [0.0; LANES]);
            for lane in 0..LANES {
                let at = lane.min(tets.len() - 1);
                for slot in 0..4 {
                    rows[slot][lane] = tets[at][slot];
                }
                weight[lane] = weights[at];
            }
            let (p0, w0) = self.gather(simd, nodes, &rows, 0);
            let (p1, w1) = self.gather(simd, nodes, &rows, 1);
            let (p2, w2) = self.gather(simd, nodes, &rows, 2);
            let (p3, w3) = self.gather(simd, nodes, &rows, 3);
            let [first, second, third, fourth] = &rows;
            let mut state = TetLanes {
                p: [p0, p1, p2, p3],
                old: [
                    self.old(simd, first),
                    self.old(simd, second),
                    self.old(simd, third),
                    self.old(simd, fourth),
                ],
                w: [w0, w1, w2, w3],
                weight: lanes::load_array(simd, &weight),
            };
            L::solve(simd, sponge, self.params.step, &mut state);
            for slot in 0..4 {
                let [x, y, z] = state.p[slot];
                let mut stored = [[0.0; 4]; LANES];
                lanes::store_rows(&mut stored, 0, [x, y, z, state.w[slot]]);
                let color = self.slots[slot];
                for (row, stored) in rows[slot].iter().zip(&stored).take(tets.len()) {
                    nodes.nodes[color][*row as usize - nodes.first[color]] = *stored;
                }
            }
        }
    }
}
