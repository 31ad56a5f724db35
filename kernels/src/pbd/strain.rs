//! Strain constraints of the tets, colour by colour \[MCKM14; the paper, section 3.2\].
//!
//! All tets have the same shape at rest, so the deformation gradient needs no matrix: in the frame of the tet
//! its columns are
//!
//! ```text
//! f_d = (p1 - p0) / a,   f_e = (p2 - p3) / a,   f_f = (p2 + p3 - p0 - p1) / a
//! ```
//!
//! and the frame itself does not matter to isotropic constraints. Per tet, one after the other:
//!
//! ```text
//! stretch  C = |f_k| - 1,   shear  C = f_k . f_l,   volume  C = f_d . (f_e x f_f) - 1
//! dl = -(C + (tau / h) grad C . (p - x)) / ((1 + tau / h) sum w |grad C|^2 + 1 / (M V h^2))
//! p += w dl grad C
//! ```
//!
//! and last, with hardly any compliance, that the volume is at least a tenth of that at rest: an inverted tet satisfies
//! the stretch and shear constraints, and would stay inverted.
//!
//! Differs from the paper: a constraint has a modulus M \[Pa\] and a damping time tau \[s\] instead of a stiffness
//! between 0 and 1 (compliance of \[MMC16\]), so that the sponge does not stiffen when the step shrinks.

use crate::{
    columns::{Column::*, Columns, Nodes},
    cpu::Cpu,
    kernel::{Kernel, Need},
    lanes::{self, LANES, Simd, f32x8, prelude::*, select, with_lanes},
    params::{Params, SpongeParams},
    pbd::lattice::{COLORS, TetChunk},
    vector::{Vec3x8, cross, dot, minus, negative, plus, times},
};

/// Smallest volume over volume at rest that a tet is pressed to.
const SMALLEST_RATIO: f32 = 0.1;

/// Compliance of that constraint over that of the volume; not zero, which would divide by zero for held nodes.
const RIGID: f32 = 1.0e-3;

/// `pbd::strain`: one sweep over all colours.
pub static KERNEL: Kernel = Kernel {
    name: "pbd::strain",
    needs: &[Need::Sponge],
    reads: &[NodePosition, NodePredicted, NodeTopology],
    writes: &[NodePredicted],
    cpu,
};

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Nodes { position, topology, predicted, .. } = &mut columns.nodes;
    for color in 0..COLORS {
        let task = Task {
            params,
            tets: &topology.tets,
            slots: topology.slot_vertex_color[color].map(usize::from),
            position,
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
    /// Cuts every vertex colour before the nodes of `chunk`.
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

struct Task<'a> {
    params: &'a Params,
    tets: &'a [[u32; 4]],
    /// Vertex colour of every slot.
    slots: [usize; 4],
    position: &'a [[f32; 4]],
}

impl Task<'_> {
    fn split(&self, cpu: &Cpu, parts: usize, chunks: &[TetChunk], mut nodes: NodeSlices<'_>) {
        if parts <= 1 || chunks.len() <= 1 {
            for chunk in chunks {
                let sponge = &self.params.sponges[chunk.sponge as usize];
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
        let [x, y, z, w] = lanes::gather_rows(simd, nodes.nodes[color], &rows[slot].map(|row| row - first));
        ([x, y, z], w)
    }

    #[inline(always)]
    #[expect(clippy::needless_range_loop, reason = "the slot is an index into several arrays")]
    fn chunk<S: Simd>(&self, simd: S, sponge: &SpongeParams, chunk: &TetChunk, nodes: &mut NodeSlices<'_>) {
        let solver = Solver::new(simd, sponge, self.params.step);
        let tets = &self.tets[chunk.tets.start as usize..chunk.tets.end as usize];
        for tets in tets.chunks(LANES) {
            // A short last group repeats its last tet, and stores it once.
            let tet = |lane: usize| &tets[lane.min(tets.len() - 1)];
            let row = |slot: usize| std::array::from_fn(|lane| tet(lane)[slot]);
            let rows: [[u32; LANES]; 4] = [row(0), row(1), row(2), row(3)];
            let (p0, w0) = self.gather(simd, nodes, &rows, 0);
            let (p1, w1) = self.gather(simd, nodes, &rows, 1);
            let (p2, w2) = self.gather(simd, nodes, &rows, 2);
            let (p3, w3) = self.gather(simd, nodes, &rows, 3);
            let old = |slot: usize| {
                let [x, y, z, _] = lanes::gather_rows(simd, self.position, &rows[slot]);
                [x, y, z]
            };
            let mut state =
                TetLanes { p: [p0, p1, p2, p3], old: [old(0), old(1), old(2), old(3)], w: [w0, w1, w2, w3] };
            solver.solve(&mut state);
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

/// Eight tets.
struct TetLanes<S: Simd> {
    /// Predicted positions.
    p: [Vec3x8<S>; 4],
    /// Positions at the beginning of the step.
    old: [Vec3x8<S>; 4],
    /// Inverse masses.
    w: [f32x8<S>; 4],
}

struct Solver<S: Simd> {
    simd: S,
    inverse_edge: f32x8<S>,
    /// 1 / (M V h^2) of stretch, shear and volume.
    compliance: [f32x8<S>; 3],
    /// tau / h.
    damping: f32x8<S>,
}

impl<S: Simd> Solver<S> {
    #[inline(always)]
    fn new(simd: S, sponge: &SpongeParams, step: f32) -> Self {
        let volume = sponge.edge * sponge.edge * sponge.edge / 12.0;
        // Iterations restart from no impulse: each takes its share of the stiffness.
        let share = sponge.iterations as f32;
        let compliance = |modulus: f32| lanes::splat(simd, share / (modulus * volume * step * step));
        Self {
            simd,
            inverse_edge: lanes::splat(simd, 1.0 / sponge.edge),
            compliance: [
                compliance(sponge.stretch_modulus),
                compliance(sponge.shear_modulus),
                compliance(sponge.volume_modulus),
            ],
            damping: lanes::splat(simd, sponge.damping_time / step),
        }
    }

    #[inline(always)]
    fn solve(&self, tet: &mut TetLanes<S>) {
        let [stretch, shear, volume] = self.compliance;
        let one = lanes::splat(self.simd, 1.0);
        let zero = [lanes::splat(self.simd, 0.0); 3];
        for column in 0..3 {
            let f = self.columns(tet)[column];
            let length = dot(f, f).sqrt();
            let is_long = length.simd_gt(lanes::splat(self.simd, 1.0e-6));
            let inverse = one / select(is_long, length, one);
            let n = times(f, inverse);
            let gradient = match column {
                0 => [negative(n), n, zero, zero],
                1 => [zero, zero, n, negative(n)],
                _ => [negative(n), negative(n), n, n],
            };
            self.correct(tet, length - one, gradient, stretch, self.damping);
        }
        for pair in [(0, 1), (0, 2), (1, 2)] {
            let f = self.columns(tet);
            let (k, l) = (f[pair.0], f[pair.1]);
            self.correct(tet, dot(k, l), self.shear_gradient(pair, f), shear, self.damping);
        }
        let (ratio, gradient) = self.volume_gradient(tet);
        self.correct(tet, ratio - one, gradient, volume, self.damping);
        let (ratio, gradient) = self.volume_gradient(tet);
        let lacking = ratio - SMALLEST_RATIO;
        let zero = lanes::splat(self.simd, 0.0);
        let inverted = select(lacking.simd_lt(zero), lacking, zero);
        self.correct(tet, inverted, gradient, volume * RIGID, zero);
    }

    /// Volume over volume at rest, and its gradients times the edge.
    #[inline(always)]
    fn volume_gradient(&self, tet: &TetLanes<S>) -> (f32x8<S>, [Vec3x8<S>; 4]) {
        let [d, e, f] = self.columns(tet);
        let (by_d, by_e, by_f) = (cross(e, f), cross(f, d), cross(d, e));
        let gradient = [negative(plus(by_d, by_f)), minus(by_d, by_f), plus(by_e, by_f), minus(by_f, by_e)];
        (dot(d, by_d), gradient)
    }

    /// Columns of the deformation gradient in the frame of the tet.
    #[inline(always)]
    fn columns(&self, tet: &TetLanes<S>) -> [Vec3x8<S>; 3] {
        let [p0, p1, p2, p3] = tet.p;
        [
            times(minus(p1, p0), self.inverse_edge),
            times(minus(p2, p3), self.inverse_edge),
            times(minus(plus(p2, p3), plus(p0, p1)), self.inverse_edge),
        ]
    }

    /// Gradients of `f_k . f_l`, times the edge.
    #[inline(always)]
    fn shear_gradient(&self, pair: (usize, usize), [d, e, f]: [Vec3x8<S>; 3]) -> [Vec3x8<S>; 4] {
        match pair {
            (0, 1) => [negative(e), e, d, negative(d)],
            (0, 2) => [negative(plus(f, d)), minus(f, d), d, d],
            _ => [negative(e), negative(e), plus(f, e), minus(e, f)],
        }
    }

    /// Moves the nodes along the gradient of one constraint; `gradient` is given times the edge.
    #[inline(always)]
    #[expect(clippy::needless_range_loop, reason = "the vertex is an index into several arrays")]
    fn correct(
        &self,
        tet: &mut TetLanes<S>,
        constraint: f32x8<S>,
        gradient: [Vec3x8<S>; 4],
        compliance: f32x8<S>,
        damping: f32x8<S>,
    ) {
        let scale = self.inverse_edge;
        let mut weight = lanes::splat(self.simd, 0.0);
        let mut rate = lanes::splat(self.simd, 0.0);
        for vertex in 0..4 {
            let g = gradient[vertex];
            weight += tet.w[vertex] * dot(g, g);
            rate += dot(g, minus(tet.p[vertex], tet.old[vertex]));
        }
        let one = lanes::splat(self.simd, 1.0);
        let numerator = constraint + damping * (rate * scale);
        let denominator = (one + damping) * (weight * (scale * scale)) + compliance;
        let impulse = -(numerator / denominator) * scale;
        for vertex in 0..4 {
            tet.p[vertex] = plus(tet.p[vertex], times(gradient[vertex], impulse * tet.w[vertex]));
        }
    }
}
