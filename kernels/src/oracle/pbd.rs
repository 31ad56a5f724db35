//! The sponge, constraint by constraint.

use glam::{DMat2, DVec2, DVec3};

use super::{keep, obstacles, row, shapes, vector};
use crate::{
    body::{Body, Wrench},
    columns::{Columns, lane},
    params::{Params, Solver, SpongeParams},
    pbd::lattice::COLORS,
    reduce::{Extreme, Extremes},
};

pub(crate) fn gravity(params: &Params, columns: &mut Columns) {
    let rows = columns.nodes.position.len();
    columns.nodes.acceleration = vec![row(params.gravity.as_dvec3(), 0.0); rows];
}

pub(crate) fn predict(params: &Params, columns: &mut Columns) {
    let nodes = &mut columns.nodes;
    let bodies = &columns.bodies.states.0;
    let h = f64::from(params.step);
    nodes.predicted.resize(nodes.position.len(), [0.0; 4]);
    for node in 0..columns.rows.nodes {
        let (x, v, a) = (nodes.position[node], nodes.velocity[node], nodes.acceleration[node]);
        let y = match bodies.get(nodes.grip[node] as usize) {
            Some(body) => {
                let place =
                    body.state.position.as_dvec3() + shapes::rotation(body) * vector(nodes.grip_offset[node]);
                place + h * shapes::velocity(body, place)
            }
            None => vector(x) + h * (vector(v) + h * vector(a)),
        };
        nodes.predicted[node] = keep(x, y);
    }
    columns.bodies.node_wrenches.0 = vec![Wrench::default(); bodies.len()];
}

/// How every vertex enters the columns of the deformation gradient, in the frame of the tet, times the edge.
pub(super) const SHAPE: [[f64; 3]; 4] =
    [[-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [0.0, 1.0, 1.0], [0.0, -1.0, 1.0]];

pub(crate) fn strain(params: &Params, columns: &mut Columns) {
    sweep(params, columns, Solver::Sbd, Tet::solve);
}

pub(crate) fn xpbd_neo_hookean(params: &Params, columns: &mut Columns) {
    sweep(params, columns, Solver::XpbdNeoHookean, Tet::solve_neo_hookean);
}

/// Solves the tets of the sponges of a solver, one after the other.
fn sweep(
    params: &Params,
    columns: &mut Columns,
    solver: Solver,
    solve: impl Fn(&mut Tet, &SpongeParams, f64),
) {
    let nodes = &mut columns.nodes;
    let mut predicted: Vec<DVec3> = nodes.predicted.iter().map(|row| vector(*row)).collect();
    for chunk in (0..COLORS).flat_map(|color| &nodes.topology.chunks[color]) {
        let sponge = &params.sponges[chunk.sponge as usize];
        if sponge.solver != solver {
            continue;
        }
        let own = chunk.tets.start as usize..chunk.tets.end as usize;
        for (tet, weight) in nodes.topology.tets[own.clone()].iter().zip(&nodes.topology.weights[own]) {
            let tet = tet.map(|node| node as usize);
            let mut state = Tet {
                p: tet.map(|node| predicted[node]),
                old: tet.map(|node| vector(nodes.position[node])),
                w: tet.map(|node| f64::from(nodes.predicted[node][lane::nodes::predicted::INVERSE_MASS])),
                weight: f64::from(*weight),
            };
            solve(&mut state, sponge, f64::from(params.step));
            (0..4).for_each(|vertex| predicted[tet[vertex]] = state.p[vertex]);
        }
    }
    for (node, y) in predicted.into_iter().enumerate().take(columns.rows.nodes) {
        nodes.predicted[node] = keep(nodes.predicted[node], y);
    }
}

struct Tet {
    p: [DVec3; 4],
    old: [DVec3; 4],
    w: [f64; 4],
    /// Weight of the tet; strain constraints use none.
    weight: f64,
}

impl Tet {
    fn solve(&mut self, sponge: &SpongeParams, h: f64) {
        let edge = f64::from(sponge.edge);
        let volume = edge.powi(3) / 12.0;
        let tau = f64::from(sponge.damping_time);
        // Iterations restart with zero multipliers: each has its share of the stiffness.
        let compliance = |modulus: f32| f64::from(sponge.iterations) / (f64::from(modulus) * volume * h * h);
        let settings = |modulus| (edge, compliance(modulus), tau / h);
        for k in 0..3 {
            let f = self.columns(edge)[k];
            let mut slope = [DVec3::ZERO; 3];
            slope[k] = f.normalize();
            self.correct(f.length() - 1.0, slope, settings(sponge.stretch_modulus));
        }
        for (k, l) in [(0, 1), (0, 2), (1, 2)] {
            let f = self.columns(edge);
            let mut slope = [DVec3::ZERO; 3];
            (slope[k], slope[l]) = (f[l], f[k]);
            self.correct(f[k].dot(f[l]), slope, settings(sponge.shear_modulus));
        }
        let (ratio, slope) = self.volume(edge);
        self.correct(ratio - 1.0, slope, settings(sponge.volume_modulus));
        let (ratio, slope) = self.volume(edge);
        let rigid = compliance(sponge.volume_modulus) * 1e-3;
        self.correct((ratio - 0.1).min(0.0), slope, (edge, rigid, 0.0));
    }

    /// Both constraints at once.
    fn solve_neo_hookean(&mut self, sponge: &SpongeParams, h: f64) {
        let [edge, mu, lambda, tau] = [sponge.edge, sponge.mu, sponge.lambda, sponge.damping].map(f64::from);
        let (f, volume) = (self.columns(edge), self.weight * edge.powi(3) / 12.0);
        let norm = f.iter().map(|f| f.length_squared()).sum::<f64>().sqrt();
        let (ratio, by_ratio) = self.volume(edge);
        let values = [norm, ratio - 1.0 - mu / lambda];
        let by_vertex = |slope: [DVec3; 3]| {
            [0, 1, 2, 3].map(|vertex| (0..3).map(|k| slope[k] * (SHAPE[vertex][k] / edge)).sum::<DVec3>())
        };
        let (by_norm, by_ratio) = (by_vertex(f.map(|f| f / norm)), by_vertex(by_ratio));
        let mut matrix = DMat2::from_diagonal(DVec2::new(1.0 / mu, 1.0 / lambda) / (volume * h * h));
        let mut right = -DVec2::from_array(values);
        for (vertex, (a, b)) in by_norm.iter().zip(&by_ratio).enumerate() {
            let way = self.p[vertex] - self.old[vertex];
            right -= tau / h * DVec2::new(a.dot(way), b.dot(way));
            let own = DMat2::from_cols(DVec2::new(a.dot(*a), a.dot(*b)), DVec2::new(a.dot(*b), b.dot(*b)));
            matrix += own * ((1.0 + tau / h) * self.w[vertex]);
        }
        let impulse = matrix.inverse() * right;
        for (vertex, (a, b)) in by_norm.iter().zip(&by_ratio).enumerate() {
            self.p[vertex] += self.w[vertex] * (impulse.x * *a + impulse.y * *b);
        }
    }

    /// Volume over volume at rest, and its derivatives by the columns.
    fn volume(&self, edge: f64) -> (f64, [DVec3; 3]) {
        let [d, e, f] = self.columns(edge);
        (d.dot(e.cross(f)), [e.cross(f), f.cross(d), d.cross(e)])
    }

    /// Columns of the deformation gradient.
    fn columns(&self, edge: f64) -> [DVec3; 3] {
        [0, 1, 2].map(|k| (0..4).map(|vertex| self.p[vertex] * (SHAPE[vertex][k] / edge)).sum())
    }

    /// One constraint, given by its value and its derivatives by the columns.
    fn correct(&mut self, value: f64, slope: [DVec3; 3], (edge, compliance, damping): (f64, f64, f64)) {
        let gradient: [DVec3; 4] =
            [0, 1, 2, 3].map(|vertex| (0..3).map(|k| slope[k] * (SHAPE[vertex][k] / edge)).sum());
        let sum = |term: &dyn Fn(usize) -> f64| (0..4).map(term).sum::<f64>();
        let weight = sum(&|vertex| self.w[vertex] * gradient[vertex].length_squared());
        let rate = sum(&|vertex| gradient[vertex].dot(self.p[vertex] - self.old[vertex]));
        let impulse = -(value + damping * rate) / ((1.0 + damping) * weight + compliance);
        (0..4).for_each(|vertex| self.p[vertex] += self.w[vertex] * impulse * gradient[vertex]);
    }
}

pub(crate) fn contact(params: &Params, columns: &mut Columns) {
    let (nodes, bodies) = (&mut columns.nodes, &columns.bodies.states.0);
    let pieces = obstacles::convex(bodies);
    let h = f64::from(params.step);
    // Wrenches of previous kernels, in one chunk.
    let mut wrenches = vec![Wrench::default(); bodies.len()];
    for chunk in columns.bodies.node_wrenches.0.chunks(bodies.len().max(1)) {
        for (wrench, part) in wrenches.iter_mut().zip(chunk) {
            wrench.impulse += part.impulse;
            wrench.angular_impulse += part.angular_impulse;
        }
    }
    for node in 0..columns.rows.nodes {
        let w = f64::from(nodes.predicted[node][lane::nodes::predicted::INVERSE_MASS]);
        if w <= 0.0 || params.sponges[nodes.sponge[node] as usize].solver == Solver::Vbd {
            continue;
        }
        let (mut point, old) = (vector(nodes.predicted[node]), vector(nodes.position[node]));
        if let Some((low, high)) = params.walls {
            let friction = f64::from(params.sponges[nodes.sponge[node] as usize].friction);
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                for (normal, wall) in [(axis, low), (-axis, high)] {
                    let depth = (wall.as_dvec3() - point).dot(normal);
                    point += resolve(depth, normal, point - old, friction);
                }
            }
        }
        for (index, piece) in pieces.iter().filter(|(_, piece)| piece.touches_nodes) {
            let (body, wrench) = (&bodies[*index], &mut wrenches[*index]);
            let clearance = 1e-3 * f64::from(params.sponges[nodes.sponge[node] as usize].edge);
            let change = touch((body, piece), clearance, [point, old], h);
            point += change;
            wrench.add(change / (-w * h), point - body.state.position.as_dvec3());
        }
        if let Some((low, high)) = params.walls {
            point = point.max(low.as_dvec3()).min(high.as_dvec3());
        }
        nodes.predicted[node] = row(point, w);
    }
    columns.bodies.node_wrenches.0 = wrenches;
}

/// Change of position by a piece of a body, at its place of the beginning of the step.
fn touch((body, piece): (&Body, &Body), clearance: f64, [point, old]: [DVec3; 2], h: f64) -> DVec3 {
    let drift = h * shapes::velocity(body, point);
    let (distance, beyond, normal) = obstacles::met(piece, clearance, old, point - drift);
    resolve(-(distance + beyond), normal, point - old - drift, f64::from(body.friction))
}

/// Out along the normal, and back along the surface as far as friction reaches.
fn resolve(depth: f64, normal: DVec3, slide: DVec3, friction: f64) -> DVec3 {
    if depth <= 0.0 {
        return DVec3::ZERO;
    }
    let tangent = slide - slide.dot(normal) * normal;
    depth * normal - tangent.clamp_length_max(friction * depth)
}

pub(crate) fn velocity(params: &Params, columns: &mut Columns) {
    let nodes = &mut columns.nodes;
    let mut extreme = Extreme::default();
    let mut largest = 0.0_f64;
    for node in 0..columns.rows.nodes {
        let y = nodes.predicted[node];
        let v = (vector(y) - vector(nodes.position[node])) / f64::from(params.step);
        largest = largest.max(v.length_squared());
        if !v.is_finite() && extreme.not_finite == 0 {
            extreme.not_finite = node as u32 + 1;
        }
        nodes.velocity[node] = keep(nodes.velocity[node], v);
        nodes.position[node] = y;
    }
    extreme.speed_squared = largest as f32;
    nodes.extremes = Extremes(vec![extreme]);
}
