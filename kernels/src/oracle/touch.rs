//! Contact of sponges, over all pairs of nodes.

use glam::{DMat3, DVec3};

use super::{row, vector};
use crate::{
    columns::{Columns, Nodes, lane},
    grid::neighbors::Neighbors,
    params::{Params, Solver},
};

fn meet(params: &Params, a: usize, b: usize) -> bool {
    let [own, other] = [a, b].map(|index| &params.sponges[index]);
    let descend = own.solver == Solver::Vbd && other.solver == Solver::Vbd;
    descend && (a != b || own.self_contact)
}

/// Largest edge of two sponges, when fully swollen.
fn edge(params: &Params, sponges: [usize; 2]) -> f64 {
    let edge = |sponge: usize| {
        let sponge = &params.sponges[sponge];
        f64::from(sponge.edge) * (1.0 + f64::from(sponge.wetting.swelling))
    };
    edge(sponges[0]).max(edge(sponges[1]))
}

/// Weighted normal and area of every node, by the faces opposite to it.
fn normals(nodes: &Nodes, count: usize) -> Vec<(DVec3, f64)> {
    let mut sums = vec![DVec3::ZERO; count];
    for tet in &nodes.topology.tets {
        let x = tet.map(|node| vector(nodes.position[node as usize]));
        let whole = (x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0]);
        for slot in 0..4 {
            let [p, q, r] = [1, 2, 3].map(|k| x[(slot + k) % 4]);
            let face = (q - p).cross(r - p);
            // Away from the node, unless the tet is inverted.
            let sign = face.dot(p - x[slot]).signum() * whole.signum();
            sums[tet[slot] as usize] -= sign * face / 6.0;
        }
    }
    let weight = |node: usize| f64::from(nodes.rest[node][lane::nodes::rest::FLATNESS]);
    let weighted = |(node, sum): (usize, DVec3)| {
        let area = if weight(node) > 0.0 { sum.length() } else { 0.0 };
        (weight(node) * sum.normalize_or_zero(), area)
    };
    sums.into_iter().enumerate().map(weighted).collect()
}

/// Excess of the opposition of two weighted normals over the limit.
fn facing(n_a: DVec3, n_b: DVec3) -> f64 {
    -n_a.normalize().dot(n_b.normalize()) - 0.1 - 0.6 * (1.0 - n_a.length().max(n_b.length()))
}

pub(crate) fn pairs(params: &Params, columns: &mut Columns) {
    let count = columns.rows.nodes;
    let nodes = &mut columns.nodes;
    let normals = normals(nodes, count);
    let sponges: Vec<usize> = nodes.sponge.iter().map(|sponge| *sponge as usize).collect();
    let all = 0..params.sponges.len();
    let widest = all.clone().filter(|own| all.clone().any(|other| meet(params, *own, other)));
    let radius = widest.map(|own| edge(params, [own, own])).fold(0.0, f64::max) * 3.25_f64.sqrt();
    let is_near = |node: usize| {
        all.clone().any(|other| {
            let x = vector(nodes.position[node]);
            let of = |index: &usize| sponges[*index] == other;
            let places = || (0..count).filter(of).map(|index| vector(nodes.position[index]));
            let low = places().fold(DVec3::INFINITY, DVec3::min) - radius;
            let high = places().fold(DVec3::NEG_INFINITY, DVec3::max) + radius;
            let inside = (x.cmpge(low) & x.cmple(high)).all();
            meet(params, sponges[node], other) && (other == sponges[node] || inside)
        })
    };
    let mut normal = vec![[0.0; 4]; nodes.position.len()];
    for node in (0..count).filter(|node| is_near(*node)) {
        let (weighted, area) = normals[node];
        let own = f64::from(params.sponges[sponges[node]].edge);
        if area > 1e-3 * own * own {
            normal[node] = row(weighted, area);
        }
    }
    let touches = |a: usize, b: usize| {
        let edge = edge(params, [sponges[a], sponges[b]]);
        let rest = (vector(nodes.rest[a]) - vector(nodes.rest[b])).length();
        if !meet(params, sponges[a], sponges[b]) || sponges[a] == sponges[b] && rest < 4.0 * edge {
            return false;
        }
        let (n_a, n_b) = (vector(normal[a]), vector(normal[b]));
        if facing(n_a, n_b) <= 0.0 {
            return false;
        }
        let (n, apart) = ((n_b - n_a).normalize(), vector(nodes.position[a]) - vector(nodes.position[b]));
        let gap = n.dot(apart);
        gap > -edge && gap < 0.6 * edge && (apart - gap * n).length() < 1.5 * edge
    };
    let surface: Vec<usize> =
        (0..count).filter(|node| normal[*node][lane::nodes::normal::AREA] > 0.0).collect();
    let list = |a: usize| {
        let others = surface.iter().filter(|b| normal[a][lane::nodes::normal::AREA] > 0.0 && touches(a, **b));
        others.map(|b| *b as u32).collect()
    };
    let mut lists: Vec<Vec<u32>> = (0..count).map(list).collect();
    lists.resize_with(nodes.position.len(), Vec::new);
    nodes.normal = normal;
    nodes.pairs = Neighbors::from_lists(&lists, count as u32);
}

pub(crate) fn touch(params: &Params, columns: &mut Columns) {
    let count = columns.rows.nodes;
    let nodes = &mut columns.nodes;
    let rows = nodes.position.len();
    let sponges: Vec<usize> = nodes.sponge.iter().map(|sponge| *sponge as usize).collect();
    let none = vec![[0.0; 4]; rows];
    let [mut force, mut stiffness, mut between] = [none.clone(), none.clone(), none];
    for a in 0..count {
        let (mut sum, mut slope, mut others) = (DVec3::ZERO, DMat3::ZERO, Vec::new());
        for b in nodes.pairs.of(a, count).map(|b| b as usize) {
            let (n_a, n_b) = (vector(nodes.normal[a]), vector(nodes.normal[b]));
            let (n, facing) = ((n_b - n_a).normalize(), facing(n_a, n_b));
            let apart = vector(nodes.position[a]) - vector(nodes.position[b]);
            let depth = -n.dot(vector(nodes.predicted[a]) - vector(nodes.predicted[b]));
            if depth <= 0.0 {
                continue;
            }
            let pair = [sponges[a], sponges[b]];
            let (edge, [own, other]) = (edge(params, pair), pair.map(|sponge| &params.sponges[sponge]));
            let reach = 1.5 * edge;
            let aside = (apart - n.dot(apart) * n).length() / reach;
            let share = 3.0 / (std::f64::consts::PI * reach * reach) * (1.0 - aside * aside).max(0.0).powi(2);
            let [m_a, m_b] = [own, other].map(|sponge| f64::from(sponge.lambda) + f64::from(sponge.mu));
            let areas = f64::from(nodes.normal[a][lane::nodes::normal::AREA])
                * f64::from(nodes.normal[b][lane::nodes::normal::AREA]);
            let modulus = 2.0 / (1.0 / m_a + 1.0 / m_b);
            let k = 10.0 * modulus / edge * (facing / 0.4).min(1.0) * areas * share;
            let push = k * (depth + 4.0 * depth.powi(3) / (edge * edge));
            let moved = |node: usize| vector(nodes.predicted[node]) - vector(nodes.position[node]);
            let slip = (moved(a) - moved(b)).reject_from_normalized(n);
            let friction = 0.5 * (f64::from(own.friction) + f64::from(other.friction));
            let hold = friction * push / slip.length().max(2e-3 * f64::from(params.step));
            sum += push * n - hold * slip;
            let along = DMat3::from_cols(n * n.x, n * n.y, n * n.z);
            let tangent = k * (1.0 + 12.0 * (depth / edge).powi(2));
            slope += tangent * along + hold * (DMat3::IDENTITY - along);
            if pair[0] != pair[1] {
                others.push(pair[1]);
            }
        }
        let lowest = others.iter().min().unwrap_or(&sponges[a]);
        let highest = others.iter().max().unwrap_or(&sponges[a]);
        force[a] = row(sum, *lowest as f64);
        stiffness[a] = row(DVec3::new(slope.x_axis.x, slope.y_axis.y, slope.z_axis.z), *highest as f64);
        between[a] = row(DVec3::new(slope.x_axis.y, slope.x_axis.z, slope.y_axis.z), 0.0);
    }
    (nodes.touch, nodes.touch_stiffness, nodes.touch_between) = (force, stiffness, between);
}

/// How much of the face of a node others cover.
fn cover(params: &Params, nodes: &Nodes, a: usize, count: usize) -> f64 {
    let sponge = |node: usize| nodes.sponge[node] as usize;
    let of = |b: usize| {
        let (n_a, n_b) = (vector(nodes.normal[a]), vector(nodes.normal[b]));
        let (n, apart) = ((n_b - n_a).normalize(), vector(nodes.position[a]) - vector(nodes.position[b]));
        let (edge, gap) = (edge(params, [sponge(a), sponge(b)]), n.dot(apart));
        let reach = 1.5 * edge;
        let aside = (apart - gap * n).length() / reach;
        let share = 3.0 / (std::f64::consts::PI * reach * reach) * (1.0 - aside * aside).max(0.0).powi(2);
        let area = f64::from(nodes.normal[b][lane::nodes::normal::AREA]);
        area * share * (facing(n_a, n_b) / 0.4).min(1.0) * (1.0 - gap / (0.6 * edge)).clamp(0.0, 1.0)
    };
    nodes.pairs.of(a, count).map(|b| of(b as usize)).sum::<f64>().min(1.0)
}

pub(crate) fn contact_suction(params: &Params, columns: &mut Columns) {
    let count = columns.rows.nodes;
    let nodes = &columns.nodes;
    let covers: Vec<f64> = (0..count).map(|node| cover(params, nodes, node, count)).collect();
    for control in 0..count {
        let node = columns.controls.node[control] as usize;
        let sponge = &params.sponges[nodes.sponge[node] as usize];
        let row = nodes.wetting.get(node);
        let receding = row.map_or(0.0, |row| f64::from(row[lane::nodes::wetting::RECEDING_SHARE]));
        let pressure = f64::from(sponge.entry_pressure) + receding * f64::from(sponge.wetting.receding);
        let dry = (1.0 - f64::from(columns.controls.saturation[control])).max(0.0);
        let volume = f64::from(columns.controls.position[control][lane::controls::position::VOLUME]);
        let suction = -pressure * (1.0 + f64::from(sponge.saturation_gain) * dry) * covers[node] * volume;
        let own = &mut columns.controls.suction[control];
        *own = own.min(suction as f32);
    }
    let rows = columns.nodes.position.len();
    columns.nodes.cover = covers.into_iter().map(|cover| cover as f32).collect();
    columns.nodes.cover.resize(rows, 0.0);
}

/// Adds the contact of a node to its force and its stiffness, and returns whether there is any.
pub(super) fn add(nodes: &Nodes, node: usize, (force, stiffness): (&mut DVec3, &mut DMat3)) -> bool {
    let Some(own) = nodes.touch.get(node) else { return false };
    let (along, between) = (vector(nodes.touch_stiffness[node]), vector(nodes.touch_between[node]));
    *force += vector(*own);
    *stiffness += DMat3::from_cols(
        DVec3::new(along.x, between.x, between.y),
        DVec3::new(between.x, along.y, between.z),
        DVec3::new(between.y, between.z, along.z),
    );
    along != DVec3::ZERO
}

/// For every sponge, those in contact with it, directly or through others, and itself.
pub(super) fn joined(nodes: &Nodes, sponges: usize) -> Vec<Vec<usize>> {
    let mut groups: Vec<usize> = (0..sponges).collect();
    for column in [&nodes.touch, &nodes.touch_stiffness] {
        for (own, row) in nodes.sponge.iter().zip(column) {
            let (own, other) =
                (groups[*own as usize], groups[row[lane::nodes::touch::LOWEST_SPONGE] as usize]);
            groups.iter_mut().filter(|group| **group == other).for_each(|group| *group = own);
        }
    }
    let same = |own: &usize| (0..sponges).filter(|other| groups[*other] == *own).collect();
    groups.iter().map(same).collect()
}
