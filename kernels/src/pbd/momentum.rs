//! Restores the momentum of sponges after few sweeps of vertex block descent.
//!
//! Elastic forces change neither the linear nor the angular momentum of a sponge, but those of an unconverged solution do.
//! Every sponge receives the rigid motion that compensates:
//!
//! ```text
//! dP = sum (J + D) - sum m (v' - v*),   v' = (y - x) / h,   v* = (z - x) / h
//! dL = the same of the moments x x (J + D) + M and x x m (v' - v*)
//! y += h (u + w x (x - c)),   u = dP / M,   w = I^-1 (dL - c x dP)
//! ```
//!
//! with the external impulses J and the drag impulses D, whose moments about the nodes are M. Moments are taken at the positions x of the
//! beginning of the step. There `sum x x m v` is the angular momentum of the new velocities for any new positions. Nodes in contact and
//! held nodes stay in place. M, I and the centre c count them with the mass `h^2 k`, by their stiffness k. A sponge that stands on
//! something is then not shaken. What they touch receives their part of the momentum:
//!
//! ```text
//! J -= h^2 k (u + w x (x - c))
//! ```
//!
//! The nearest body receives the opposite, if it is as near as a contact. Free nodes move with the mass of the fluid that
//! the drag moves with them. Sponges and bodies conserve both momenta to rounding. No node is moved through a wall of the
//! container.
//!
//! Sponges in contact (`touch.rs`) are corrected together: contact forces between them are internal, like those between the
//! nodes of one sponge. Both momenta of all of them are conserved.
//!
//! The share of the external acceleration that a node followed is stored for the next `pbd::guess`.

use glam::{DMat3, DVec3, Vec3};

use crate::{
    body::{Body, BodyState, Wrench, by_chunk},
    columns::{Columns, Nodes, lane},
    cpu::{CHUNK, Cpu, PerChunk},
    kernel::declare,
    params::{Params, Solver},
    pbd::{obstacles::OBSTACLE_MARGIN, stars::Piece},
};

declare! {
    needs: [Sponge, Solver(Vbd)],
    reads: [
        NodePosition, NodeVelocity, NodeStars, NodeSponge, NodeFree, NodeReaction, NodePredicted,
        NodeAcceleration, NodeDrag, NodeDragMoment, NodeTouch, NodeTouchStiffness, BodyStates,
        BodyNodeWrenches,
    ],
    writes: [NodeVelocity, NodePredicted, NodeReaction, BodyNodeWrenches],
    oracle: crate::oracle::descent::momentum,
    bound: 5e-4,
    twin: [
        pass("pbd::momentum_sums", SpongeParts),
        pass("pbd::momentum_motions", DividedSponges),
        pass(NAME, Nodes),
        pass("pbd::momentum_bodies", Nodes),
    ],
    constants: {
        /// Determinant of the inertia over the cube of its trace below which a sponge cannot be turned about some axis.
        const MINIMUM_DETERMINANT: f64 = 1.0e-12;
    },
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Nodes {
        position,
        velocity,
        acceleration,
        stars,
        sponge,
        free,
        reaction,
        predicted,
        drag,
        drag_moment,
        touch,
        touch_stiffness,
        ..
    } = &mut columns.nodes;
    let rate = 1.0 / f64::from(params.step);
    let mut sums: Vec<Sums> = vec![Sums::default(); stars.pieces.len()];
    let rows = Rows { position, predicted, free, reaction, drag, drag_moment };
    cpu.for_chunks_of(1, &mut sums[..], |first, sums| {
        for (sum, Piece { sponge, rows: range }) in sums.iter_mut().zip(&stars.pieces[first..]) {
            let is_asleep = params.asleep.has(range.start as usize);
            if params.solver(*sponge) == Some(Solver::Vbd) && !is_asleep {
                range.clone().for_each(|node| sum.add(&rows, node as usize, rate));
            }
        }
    });
    let mut totals = vec![Sums::default(); params.sponges.len()];
    for (sum, piece) in sums.iter().zip(&stars.pieces) {
        totals[piece.sponge as usize].join(sum);
    }
    let motions = motions(&totals, &joined(sponge, [touch, touch_stiffness], totals.len()));
    let bodies = &columns.bodies.states.0;
    let task = Task { params, bodies, position, acceleration, sponge, motions: &motions };
    let chunks = predicted.len().div_ceil(CHUNK);
    let mut wrenches = by_chunk(&mut columns.bodies.node_wrenches.0, chunks, bodies.len());
    let rows = (&mut predicted[..], &mut velocity[..], &mut reaction[..], PerChunk(&mut wrenches));
    cpu.for_chunks(rows, |first, (predicted, velocity, reaction, wrenches)| {
        if params.asleep.has_all(first..first + predicted.len()) {
            return;
        }
        let rows = predicted.iter_mut().zip(velocity).zip(reaction);
        for (row, ((y, v), reaction)) in rows.enumerate() {
            task.node(first + row, y, v, reaction, wrenches.0[0]);
        }
    });
}

struct Task<'a> {
    params: &'a Params,
    bodies: &'a [Body],
    position: &'a [[f32; 4]],
    acceleration: &'a [[f32; 4]],
    sponge: &'a [u32],
    motions: &'a [Motion],
}

impl Task<'_> {
    /// Adds to a node, or to what it touches, its part of the motion.
    fn node(
        &self,
        node: usize,
        y: &mut [f32; 4],
        v: &mut [f32; 4],
        reaction: &mut [f32; 4],
        wrenches: &mut [Wrench],
    ) {
        let (x, step) = (self.position[node], self.params.step);
        // Padding rows belong to no sponge.
        let Some(own) = self.sponge.get(node).copied() else { return };
        if self.params.solver(own) != Some(Solver::Vbd) {
            return;
        }
        let mass = reaction[lane::nodes::reaction::MASS];
        if mass != 0.0 {
            let change = self.motions[own as usize].at(x);
            if mass < 0.0 {
                (0..3).for_each(|axis| reaction[axis] += mass * change[axis]);
                if y[lane::nodes::predicted::INVERSE_MASS] > 0.0 {
                    self.give(node, y, change, mass, wrenches);
                }
            } else {
                (0..3).for_each(|axis| y[axis] += step * change[axis]);
                if let Some((low, high)) = self.params.walls {
                    (0..3).for_each(|axis| y[axis] = inside(y[axis], [low[axis], high[axis]]));
                }
            }
        }
        if y[lane::nodes::predicted::INVERSE_MASS] > 0.0 {
            v[lane::nodes::velocity::FOLLOWED_SHARE] = followed(x, *y, *v, self.acceleration[node], step);
        }
    }

    /// Gives the body in contact with a node the part of the momentum of that node.
    fn give(&self, node: usize, y: &[f32; 4], change: [f32; 3], mass: f32, wrenches: &mut [Wrench]) {
        let vector = |row: &[f32]| Vec3::new(row[0], row[1], row[2]);
        let edge = self.params.sponges[self.sponge[node] as usize].edge;
        if let Some(body) = self.touched(vector(y), OBSTACLE_MARGIN * edge) {
            let arm = vector(&self.position[node]).as_dvec3() - self.bodies[body].state.position.as_dvec3();
            wrenches[body].add(Vec3::from(change).as_dvec3() * -f64::from(mass), arm);
        }
    }

    /// The nearest body at the end of the step, if it is that near.
    fn touched(&self, point: Vec3, margin: f32) -> Option<usize> {
        let mut found = (None, margin);
        for (index, body) in self.bodies.iter().enumerate().filter(|(_, body)| body.touches_nodes) {
            let BodyState { position, linear_velocity, angular_velocity, .. } = body.state;
            let velocity = linear_velocity + angular_velocity.cross(point - position);
            // The body is at its place of the beginning of the step, and so is the point in the body's frame.
            let distance = body.distance(point - velocity * self.params.step);
            if distance < found.1 {
                found = (Some(index), distance);
            }
        }
        found.0
    }
}

/// For every sponge, the first of those in contact with it, directly or through others, or itself.
pub(crate) fn joined(sponge: &[u32], touches: [&[[f32; 4]]; 2], sponges: usize) -> Vec<usize> {
    let mut first: Vec<usize> = (0..sponges).collect();
    for column in touches {
        for (own, row) in sponge.iter().zip(column) {
            let [mut a, mut b] = [*own as usize, row[lane::nodes::touch::LOWEST_SPONGE] as usize];
            if a == b {
                continue;
            }
            // As long as the chain: there are few sponges.
            while first[a] != a {
                a = first[a];
            }
            while first[b] != b {
                b = first[b];
            }
            first[a.max(b)] = a.min(b);
        }
    }
    // The first of a chain comes before all others of it.
    for index in 0..sponges {
        first[index] = first[first[index]];
    }
    first
}

/// The motion of every sponge: sponges in contact have one motion together.
fn motions(totals: &[Sums], first: &[usize]) -> Vec<Motion> {
    let mut joined = totals.to_vec();
    for (index, total) in totals.iter().enumerate().filter(|(index, _)| first[*index] != *index) {
        joined[first[index]].join(total);
    }
    first.iter().map(|first| joined[*first].motion()).collect()
}

/// A coordinate clamped between two walls; NaN stays NaN.
fn inside(value: f32, [low, high]: [f32; 2]) -> f32 {
    if value < low {
        low
    } else if value > high {
        high
    } else {
        value
    }
}

/// Share of the external acceleration that a node followed.
fn followed(x: [f32; 4], y: [f32; 4], v: [f32; 4], a: [f32; 4], step: f32) -> f32 {
    let (mut along, mut square) = (0.0, 0.0);
    for axis in 0..3 {
        along += ((y[axis] - x[axis]) / step - v[axis]) * a[axis];
        square += a[axis] * a[axis];
    }
    let share = along / (step * square);
    // NaN without acceleration, where the share does not matter.
    if share >= 1.0 {
        1.0
    } else if share > 0.0 {
        share
    } else {
        0.0
    }
}

struct Rows<'a> {
    position: &'a [[f32; 4]],
    predicted: &'a [[f32; 4]],
    free: &'a [[f32; 4]],
    reaction: &'a [[f32; 4]],
    drag: &'a [[f32; 4]],
    drag_moment: &'a [[f32; 4]],
}

/// Sums over nodes.
#[derive(Clone, Copy, Debug)]
struct Sums {
    /// Mass, of free nodes and in all.
    mass: [f64; 2],
    /// First moment of mass \[kg m\].
    first: DVec3,
    /// Second moment of mass: columns of `sum m x x^T` \[kg m^2\].
    second: DMat3,
    momentum: DVec3,
    angular_momentum: DVec3,
}

impl Default for Sums {
    fn default() -> Self {
        let none = DVec3::ZERO;
        // The default of a matrix is the identity.
        Self { mass: [0.0; 2], first: none, second: DMat3::ZERO, momentum: none, angular_momentum: none }
    }
}

impl Sums {
    fn add(&mut self, rows: &Rows<'_>, node: usize, rate: f64) {
        let vector = |row: [f32; 4]| DVec3::new(f64::from(row[0]), f64::from(row[1]), f64::from(row[2]));
        let x = vector(rows.position[node]);
        let mut weight = f64::from(rows.reaction[node][lane::nodes::reaction::MASS]);
        if weight > 0.0 {
            weight += f64::from(rows.drag[node][lane::nodes::drag::MASS]);
        }
        let mass = weight.abs();
        self.mass[0] += weight.max(0.0);
        self.mass[1] += mass;
        self.first += x * mass;
        self.second += DMat3::from_cols(x * (x.x * mass), x * (x.y * mass), x * (x.z * mass));
        let inverse = f64::from(rows.predicted[node][lane::nodes::predicted::INVERSE_MASS]);
        let own = if inverse > 0.0 { rate / inverse } else { 0.0 };
        let gained = (vector(rows.predicted[node]) - vector(rows.free[node])) * own;
        let mut lacking = vector(rows.reaction[node]) - gained;
        // Impulses of the fluid on a held node go to its body.
        if inverse > 0.0 {
            lacking += vector(rows.drag[node]);
            self.angular_momentum += vector(rows.drag_moment[node]);
        }
        self.momentum += lacking;
        self.angular_momentum += x.cross(lacking);
    }

    fn join(&mut self, other: &Self) {
        self.mass[0] += other.mass[0];
        self.mass[1] += other.mass[1];
        self.first += other.first;
        self.second += other.second;
        self.momentum += other.momentum;
        self.angular_momentum += other.angular_momentum;
    }

    /// The rigid motion that restores the momentum.
    fn motion(&self) -> Motion {
        let [free, mass] = self.mass;
        if free <= 0.0 {
            return Motion::default();
        }
        let centre = self.first / mass;
        let second = self.second
            - DMat3::from_cols(self.first * centre.x, self.first * centre.y, self.first * centre.z);
        let trace = second.x_axis.x + second.y_axis.y + second.z_axis.z;
        let inertia = DMat3::from_diagonal(DVec3::splat(trace)) - second;
        let angular = self.angular_momentum - centre.cross(self.momentum);
        let determinant = inertia.determinant();
        // A sponge of nodes in one line cannot be turned about it.
        let turns = determinant > MINIMUM_DETERMINANT * trace.powi(3);
        let angular_velocity = if turns { inertia.inverse() * angular } else { DVec3::ZERO };
        Motion { centre, velocity: self.momentum / mass, angular_velocity }
    }
}

/// A rigid motion.
#[derive(Clone, Copy, Debug, Default)]
struct Motion {
    centre: DVec3,
    velocity: DVec3,
    angular_velocity: DVec3,
}

impl Motion {
    /// Velocity at a position.
    fn at(&self, [x, y, z, _]: [f32; 4]) -> [f32; 3] {
        let arm = DVec3::new(f64::from(x), f64::from(y), f64::from(z)) - self.centre;
        (self.velocity + self.angular_velocity.cross(arm)).as_vec3().to_array()
    }
}
