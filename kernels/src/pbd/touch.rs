//! Contact of sponges with each other and with themselves, with friction.
//!
//! The pairs of `pairs.rs` have an energy where the tangent planes of their nodes have passed each other. The depth d is
//! along the normal n of the beginning of the step:
//!
//! ```text
//! d = -n . (y_a - y_b),   psi = k (d^2 / 2 + d^4 / e^2),   k = CONTACT_STIFFNESS M / e f A_a A_b w
//! w = 3 / (pi R^2) (1 - t^2 / R^2)^2,   f = min(c / FACING_RANGE, 1)
//! ```
//!
//! so that surfaces of many nodes, or of few large ones, feel the same pressure. M is the harmonic mean of the moduli
//! lambda + mu of both materials, e the larger edge. Where the pair slips by s along the surface in this step, friction acts against it. It
//! is at most mu times the normal force, and linear up to a speed `CREEP_SPEED`.
//!
//! ```text
//! F_a = n k d (1 + 4 d^2 / e^2) - k_t s,   H_a = k (1 + 12 d^2 / e^2) n n^T + k_t (1 - n n^T),   k_t = mu |F_n| / max(|s|, h CREEP_SPEED)
//! ```
//!
//! Both nodes receive the same with opposite sign. Vertex block descent adds force and stiffness to those of the material
//! (`vbd.rs`). They are of the positions before the sweep (Jacobi), because nodes of one vertex colour may touch each other.
//! Each of the two has the full stiffness, so that nodes that move at the same time do not overshoot.

use glam::{Mat3, Vec3};

use crate::{
    columns::{Columns, Nodes, lane},
    cpu::Cpu,
    kernel::declare,
    lanes::LANES,
    params::Params,
    pbd::meeting::{Pair, vector},
};

declare! {
    needs: [Sponge, Solver(Vbd), Touch],
    reads: [NodePosition, NodePredicted, NodeSponge, NodeNormal, NodePairs],
    writes: [NodeTouch, NodeTouchStiffness, NodeTouchBetween],
    oracle: crate::oracle::touch::touch,
    bound: 1e-4,
    twin: [pass(NAME, Nodes), pass("pbd::touching", Sponges), pass("pbd::joining", One)],
    constants: {
        /// Stiffness of a surface times the edge, over the modulus of the material \[1\].
        const CONTACT_STIFFNESS: f32 = 10.0;
        /// Speed at which what sticks may slip \[m/s\].
        const CREEP_SPEED: f32 = 2.0e-3;
    },
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let count = columns.rows.nodes;
    let Nodes { position, predicted, sponge, normal, pairs, touch, touch_stiffness, touch_between, .. } =
        &mut columns.nodes;
    for column in [&mut *touch, touch_stiffness, touch_between] {
        column.resize(position.len(), [0.0; 4]);
        column[count..].fill([0.0; 4]);
    }
    let rows = (&mut touch[..count], &mut touch_stiffness[..count], &mut touch_between[..count]);
    let task = Task { params, position, predicted, sponge, normal };
    cpu.for_chunks(rows, |first, (force, stiffness, between)| {
        let lists = pairs.chunk(first);
        if params.asleep.has_all(first..first + force.len()) {
            for (row, own) in sponge[first..first + force.len()].iter().enumerate() {
                let nothing = [0.0, 0.0, 0.0, *own as f32];
                (force[row], stiffness[row], between[row]) = (nothing, nothing, [0.0; 4]);
            }
            return;
        }
        for row in 0..force.len() {
            let node = first + row;
            let own = sponge[node];
            let mut sum = Sum { force: Vec3::ZERO, stiffness: Mat3::ZERO, others: [f32::MAX, -1.0] };
            for others in lists.group(row) {
                let other = others[row % LANES] as usize;
                if other < count {
                    task.add(node, other, &mut sum);
                }
            }
            let Sum { force: f, stiffness: h, others: [lowest, highest] } = sum;
            let [lowest, highest] = if highest < 0.0 { [own as f32; 2] } else { [lowest, highest] };
            force[row] = [f.x, f.y, f.z, lowest];
            stiffness[row] = [h.x_axis.x, h.y_axis.y, h.z_axis.z, highest];
            between[row] = [h.x_axis.y, h.x_axis.z, h.y_axis.z, 0.0];
        }
    });
}

/// Contact of a node.
struct Sum {
    force: Vec3,
    stiffness: Mat3,
    /// Lowest and highest index of the other sponges.
    others: [f32; 2],
}

struct Task<'a> {
    params: &'a Params,
    position: &'a [[f32; 4]],
    predicted: &'a [[f32; 4]],
    sponge: &'a [u32],
    normal: &'a [[f32; 4]],
}

impl Task<'_> {
    /// Adds the contact of one node with another.
    fn add(&self, a: usize, b: usize, sum: &mut Sum) {
        let normals = [self.normal[a], self.normal[b]];
        let [y_a, y_b] = [a, b].map(|node| vector(self.predicted[node]));
        // Most pairs do not touch.
        if (vector(normals[1]) - vector(normals[0])).dot(y_a - y_b) >= 0.0 {
            return;
        }
        let Some(pair) = Pair::new([self.position[a], self.position[b]], normals) else { return };
        let n = pair.normal;
        let depth = -n.dot(y_a - y_b);
        if depth <= 0.0 {
            return;
        }
        let (own, other) = (self.sponge[a], self.sponge[b]);
        let edge = self.params.pair_edge(own, other);
        let area = normals[0][lane::nodes::normal::AREA] * normals[1][lane::nodes::normal::AREA];
        let k = CONTACT_STIFFNESS * self.params.pair_modulus(own, other) / edge
            * pair.opposition()
            * (area * pair.share(edge));
        let square = 4.0 * depth * depth / (edge * edge);
        let push = k * depth * (1.0 + square);
        let slip = (y_a - vector(self.position[a])) - (y_b - vector(self.position[b]));
        let slip = slip - n * n.dot(slip);
        let slowest = CREEP_SPEED * self.params.step;
        let hold = push * self.params.pair_friction(own, other) / slip.dot(slip).sqrt().max(slowest);
        sum.force += n * push - slip * hold;
        let outer = Mat3::from_cols(n * n.x, n * n.y, n * n.z);
        sum.stiffness += outer * (k * (1.0 + 3.0 * square) - hold) + Mat3::from_diagonal(Vec3::splat(hold));
        if own != other {
            let [lowest, highest] = &mut sum.others;
            (*lowest, *highest) = (lowest.min(other as f32), highest.max(other as f32));
        }
    }
}
