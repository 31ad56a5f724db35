//! Exchange of momentum between particles in sponges and the corners of their tets.

use glam::DVec3;

use super::{
    couple::Pairs,
    divergence::renormalisation,
    keep, porous, row,
    solid::{self, around},
    vector,
};
use crate::{
    columns::{Columns, lane},
    grid::neighbors::Neighbors,
    params::Params,
    tets::rows::CORNER_WEIGHT,
};

/// For every slot of a tet as the nearest node: that node, its partner on the long edge, and the other two.
const ROLES: [[usize; 4]; 4] = [[0, 1, 2, 3], [1, 0, 3, 2], [2, 3, 0, 1], [3, 2, 1, 0]];

/// The tet of a point among those of a node: its nodes, the weights there and their gradients.
fn tet_of(columns: &Columns, node: u32, point: DVec3, edge: f64) -> ([u32; 4], [f64; 4], [DVec3; 4]) {
    let nodes = &columns.nodes;
    let mut best = ([node; 4], [1.0, 0.0, 0.0, 0.0], [DVec3::ZERO; 4]);
    let mut least = f64::NEG_INFINITY;
    for tet in &nodes.topology.tets {
        let Some(slot) = tet.iter().position(|corner| *corner == node) else { continue };
        let corners = ROLES[slot].map(|slot| tet[slot]);
        let [x, p, q, r] = corners.map(|corner| vector(nodes.position[corner as usize]));
        let (p, q, r) = (p - x, q - x, r - x);
        let six = p.dot(q.cross(r));
        let smallest = 0.1 * 0.5 * edge.powi(3);
        let six = if six.abs() < smallest { smallest } else { six };
        let gradients = [q.cross(r) / six, r.cross(p) / six, p.cross(q) / six];
        let [u, v, w] = gradients.map(|gradient| gradient.dot(point - x));
        let weights = [1.0 - u - v - w, u, v, w];
        let lowest = weights.into_iter().fold(f64::INFINITY, f64::min);
        if lowest > least {
            least = lowest;
            let [a, b, c] = gradients;
            let all = [-a - b - c, a, b, c];
            let steepest = all.iter().map(|gradient| gradient.length()).fold(3.0 / edge, f64::max);
            best = (corners, weights, all.map(|gradient| gradient * (3.0 / edge / steepest)));
        }
    }
    best
}

pub(crate) fn corners(params: &Params, columns: &mut Columns) {
    let (particles, controls) = (columns.rows.fluid, columns.rows.nodes);
    let pairs = Pairs::new(params, columns);
    let rows = columns.fluid.position.len();
    columns.fluid.corners.0 = vec![[controls as u32; 4]; rows];
    columns.fluid.shares.0 = vec![[[0.0; 4]; 4]; rows];
    let mut lists = vec![Vec::new(); columns.nodes.position.len()];
    for particle in 0..particles {
        let distance = |control: &usize| pairs.particles[particle].distance(pairs.controls[*control]);
        let near = (0..controls).filter(|control| pairs.are_near(particle, *control));
        let Some(nearest) = near.min_by(|a, b| distance(a).total_cmp(&distance(b))) else { continue };
        let node = columns.controls.node[nearest];
        let edge = f64::from(params.sponges[columns.nodes.sponge[node as usize] as usize].edge);
        let (nodes, weights, gradients) = tet_of(columns, node, pairs.particles[particle], edge);
        let weights = weights.map(|weight| weight.clamp(-1.0, 2.0));
        let missing = (1.0 - weights.iter().sum::<f64>()) / 4.0;
        for corner in 0..4 {
            let control =
                columns.controls.node.iter().position(|node| *node == nodes[corner]).unwrap_or(controls);
            columns.fluid.corners.0[particle][corner] = control as u32;
            columns.fluid.shares.0[particle][corner] = row(gradients[corner], weights[corner] + missing);
            lists[control].push(4 * particle as u32 + corner as u32);
        }
    }
    columns.controls.corners = Neighbors::from_lists(&lists, 4 * particles as u32);
}

pub(crate) fn moments(params: &Params, columns: &mut Columns) {
    let none = vec![[0.0; 4]; columns.fluid.position.len()];
    let pairs = Pairs::new(params, columns);
    let fluid = &mut columns.fluid;
    for column in [&mut fluid.moment, &mut fluid.renormalisation, &mut fluid.renormalisation_between] {
        column.clone_from(&none);
    }
    for particle in 0..columns.rows.fluid {
        solid::material_moments(params, columns, &pairs, particle);
    }
}

/// The corners of the tet of a particle: control rows, vectors, and weights.
fn of(columns: &Columns, particle: usize) -> Vec<(usize, DVec3, f64)> {
    let corners = columns.fluid.corners.0[particle].iter().zip(&columns.fluid.shares.0[particle]);
    let inside = corners.filter(|(control, _)| (**control as usize) < columns.rows.nodes);
    inside
        .map(|(control, share)| (*control as usize, vector(*share), f64::from(share[CORNER_WEIGHT])))
        .collect()
}

/// Particles in the tets of a control: their rows, vectors, and weights.
fn beside(columns: &Columns, control: usize) -> Vec<(usize, DVec3, f64)> {
    let all = (0..columns.rows.fluid).flat_map(|particle| {
        of(columns, particle).into_iter().map(move |(own, share, weight)| (own, (particle, share, weight)))
    });
    all.filter(|(own, _)| *own == control).map(|(_, entry)| entry).collect()
}

pub(crate) fn flux(params: &Params, columns: &mut Columns) {
    let pairs = Pairs::new(params, columns);
    columns.fluid.pushed = vec![[0.0; 4]; columns.fluid.position.len()];
    for particle in 0..columns.rows.fluid {
        let inverse = renormalisation(&columns.fluid, particle);
        let corners = of(columns, particle);
        let (mut pushed, mut shares) = (DVec3::ZERO, [DVec3::ZERO; 4]);
        for (control, offset, c, signs, _) in around(params, columns, &pairs, particle) {
            pushed += c * (inverse * offset);
            // The velocity is linear in the tet, and so at the node.
            let from = pairs.controls[control] - pairs.particles[particle];
            for (share, (_, gradient, weight)) in shares.iter_mut().zip(&corners) {
                *share += signs * (inverse * offset) * (c * (weight + gradient.dot(from)));
            }
        }
        columns.fluid.pushed[particle] = row(pushed, 0.0);
        let sum: f64 = corners.iter().map(|(_, _, weight)| weight.max(0.0)).sum();
        for (corner, (_, _, weight)) in corners.iter().enumerate() {
            columns.fluid.shares.0[particle][corner] = row(shares[corner], weight.max(0.0) / sum);
        }
    }
}

fn mobility_of(columns: &Columns, particle: usize) -> f64 {
    f64::from(columns.fluid.pushed[particle][lane::fluid::pushed::MOBILITY])
}

/// Mean of a row of the controls.
fn mean(columns: &Columns, particle: usize, rows: &[[f32; 4]]) -> DVec3 {
    of(columns, particle).into_iter().map(|(control, _, weight)| weight * vector(rows[control])).sum()
}

pub(crate) fn mobility(params: &Params, columns: &mut Columns) {
    let (h, mass) = (f64::from(params.step), f64::from(params.fluid.particle_mass));
    for particle in 0..columns.rows.fluid {
        let u = mean(columns, particle, &columns.controls.material);
        let [linear, inertial, ..] = columns.fluid.drag_rate[particle].map(f64::from);
        let speed = (vector(columns.fluid.velocity[particle]) - u).length();
        let rate = h * (linear + inertial * speed);
        let pushed = vector(columns.fluid.pushed[particle]);
        columns.fluid.pushed[particle] = row(pushed, 1.0 / (1.0 + rate));
    }
    columns.controls.compliance = vec![[0.0; 4]; columns.nodes.position.len()];
    for control in 0..columns.rows.nodes {
        let held = |(particle, _, weight): (usize, DVec3, f64)| {
            mass * weight * (1.0 - mobility_of(columns, particle))
        };
        let drawn: f64 = beside(columns, control).into_iter().map(held).sum();
        let response = solid::response_of(params, columns, control, drawn);
        let solid = columns.controls.material[control][lane::controls::material::VOLUME];
        columns.controls.compliance[control] =
            row(DVec3::new(response, drawn * response, 0.0), f64::from(solid));
    }
    for particle in 0..columns.rows.fluid {
        let (mut follows, mut direct) = (0.0, 0.0);
        for (control, share, weight) in of(columns, particle) {
            let [compliance, drawn, ..] = columns.controls.compliance[control].map(f64::from);
            follows += weight * drawn;
            direct += share.length_squared() * compliance;
        }
        let own = mobility_of(columns, particle);
        let diagonal = &mut columns.fluid.pressure_rows[particle][lane::fluid::pressure_rows::DIAGONAL];
        *diagonal = ((own + (1.0 - own) * follows) * f64::from(*diagonal) + h * h * mass * direct) as f32;
    }
}

pub(crate) fn response(params: &Params, columns: &mut Columns) {
    let (h, mass) = (f64::from(params.step), f64::from(params.fluid.particle_mass));
    let fluid = &mut columns.fluid;
    fluid.undragged.clone_from(&fluid.correction);
    fluid.carried = vec![[0.0; 4]; fluid.position.len()];
    for particle in 0..columns.rows.fluid {
        let fluid = &columns.fluid;
        let change = vector(fluid.correction[particle]) - vector(fluid.velocity[particle]);
        let pressure = f64::from(fluid.predicted[particle][lane::fluid::predicted::PRESSURE]);
        columns.fluid.carried[particle] =
            row(mass * (1.0 - mobility_of(columns, particle)) * change, mass * pressure);
    }
    let rows = columns.nodes.position.len();
    for column in [&mut columns.controls.force, &mut columns.controls.impulse, &mut columns.controls.solved] {
        column.resize(rows, [0.0; 4]);
    }
    for control in 0..columns.rows.nodes {
        let (mut force, mut held) = (DVec3::ZERO, DVec3::ZERO);
        for (particle, share, weight) in beside(columns, control) {
            let carried = columns.fluid.carried[particle];
            force += share * f64::from(carried[lane::fluid::carried::ENERGY]);
            held += weight * vector(carried);
        }
        let controls = &mut columns.controls;
        let received = h * force + held;
        let [compliance, _, _, volume] = controls.compliance[control].map(f64::from);
        let all = received + vector(controls.expected[control]);
        controls.force[control] = row(force, 0.0);
        controls.impulse[control] = row(received, 0.0);
        controls.solved[control] = row(vector(controls.material[control]) + compliance * all, volume);
    }
}

pub(crate) fn velocity(_: &Params, columns: &mut Columns) {
    for particle in 0..columns.rows.fluid {
        let own = mobility_of(columns, particle);
        let u = mean(columns, particle, &columns.controls.solved);
        let w = own * vector(columns.fluid.correction[particle]) + (1.0 - own) * u;
        let corners = of(columns, particle);
        let w = if corners.is_empty() { vector(columns.fluid.correction[particle]) } else { w };
        let of_corner = |(control, share, _): &(usize, DVec3, f64)| {
            -vector(columns.controls.solved[*control]).dot(*share)
        };
        let rate = corners.iter().map(of_corner).sum::<f64>() + w.dot(vector(columns.fluid.pushed[particle]));
        columns.fluid.correction[particle] = row(w, rate);
    }
}

pub(crate) fn drag_impulse(params: &Params, columns: &mut Columns) {
    porous::node_velocities(params, columns);
    columns.fluid.drag = vec![[0.0; 4]; columns.fluid.position.len()];
    for particle in 0..columns.rows.fluid {
        let apart =
            vector(columns.fluid.velocity[particle]) - mean(columns, particle, &columns.controls.velocity);
        let mass = porous::drag_mass(params, columns, particle, apart.length());
        columns.fluid.drag[particle] = row(mass * apart, mass);
    }
}

pub(crate) fn drag_target(params: &Params, columns: &mut Columns) {
    for control in 0..columns.rows.nodes {
        let (mut impulse, mut mass) = (DVec3::ZERO, 0.0);
        for (particle, _, weight) in beside(columns, control) {
            impulse += weight * vector(columns.fluid.drag[particle]);
            mass += weight * f64::from(columns.fluid.drag[particle][lane::fluid::drag::MASS]);
        }
        porous::target_of(params, columns, control, (impulse, mass));
    }
}

pub(crate) fn drag_reaction(_: &Params, columns: &mut Columns) {
    let none = vec![[0.0; 4]; columns.nodes.position.len()];
    (columns.nodes.drag, columns.nodes.drag_moment) = (none.clone(), none);
    for control in 0..columns.rows.nodes {
        let (mut impulse, mut moment, mut mass) = (DVec3::ZERO, DVec3::ZERO, 0.0);
        for (particle, _, weight) in beside(columns, control) {
            mass += weight * f64::from(columns.fluid.drag[particle][lane::fluid::drag::MASS]);
            let own = weight * vector(columns.fluid.drag[particle]);
            let arm = vector(columns.fluid.position[particle]) - vector(columns.controls.position[control]);
            impulse += own;
            moment += arm.cross(own);
        }
        let node = columns.controls.node[control] as usize;
        columns.nodes.drag[node] = row(impulse, mass);
        columns.nodes.drag_moment[node] = row(moment, 0.0);
    }
}

pub(crate) fn drag_settled(params: &Params, columns: &mut Columns) {
    drag_reaction(params, columns);
    for drag in &mut columns.nodes.drag {
        drag[lane::nodes::drag::MASS] = 0.0;
    }
}

pub(crate) fn drag_kick(params: &Params, columns: &mut Columns) {
    for particle in 0..columns.rows.fluid {
        let old = columns.fluid.velocity[particle];
        let lost = vector(columns.fluid.drag[particle]) / f64::from(params.fluid.particle_mass);
        columns.fluid.velocity[particle] = keep(old, vector(old) - lost);
    }
}
