//! Pairs of surface nodes of sponges that may touch in this step.
//!
//! A surface node a has an outward normal and an area, the derivative of the volume of its sponge by its position:
//!
//! ```text
//! A n_a = -sum over tets of (q - u) x (r - u) / 6
//! ```
//!
//! with the partner u and the corners r, q of its tets (`stars.rs`), and a weight p. That is 1 on a face and next to nothing on a
//! rim (`flatness.rs`). Two nodes a and b are a pair where their surfaces face each other. They are of different
//! sponges, or of one that may touch itself and at least `SELF_CONTACT_DISTANCE` edges from each other at rest:
//!
//! ```text
//! n = (p_b n_b - p_a n_a) / |..|,   g = n . (x_a - x_b),   t^2 = |x_a - x_b|^2 - g^2
//! c = -n_a . n_b - MINIMUM_FACING - RIM_FACING (1 - max(p_a, p_b)) > 0,   -PAIR_OVERLAP e < g < PAIR_GAP e,   t < PAIR_REACH e
//! ```
//!
//! with e the larger of their edges. The normal of a node of a rim lies between those of two faces: where it meets a face,
//! the normal of the face counts. With the mean of both, blocks on each other would overlap by a twentieth of an edge there. That is many
//! times the depth that carries their weight. Two rims must face each other squarely. The contact of a pair (`touch.rs`) is the same from
//! both sides to the last bit except for its sign, because n is.
//!
//! All values are of the beginning of the step. No node moves by more than a quarter of an edge in a step (`src/clock.rs`). Two nodes
//! approach each other by half an edge at most. No pair that would pass is therefore missed.

use glam::Vec3;

use crate::{
    columns::{Columns, Nodes, lane},
    cpu::Cpu,
    grid::cells::{Cells, Domain},
    kernel::declare,
    lanes::LANES,
    params::Params,
    pbd::{
        lattice::VERTEX_COLORS,
        stars::{CORNERS, RINGS, StarGroup, Stars},
    },
};

use super::meeting::{Pair, pair_radius, vector};

declare! {
    needs: [Sponge, Solver(Vbd), Touch],
    reads: [NodePosition, NodeRest, NodeSponge, NodeStars],
    writes: [NodeNormal, NodePairs],
    oracle: crate::oracle::touch::pairs,
    bound: 2e-6,
    // The longest list that does not fit.
    twin_writes: [NodeExtremes],
    twin: [
        pass("pbd::boxes", Sponges),
        pass("pbd::normals", Nodes),
        pass("grid::count", Nodes).on(PAIR_CELLS),
        pass("grid::scan_sums", PairScan).on(PAIR_CELLS),
        pass("grid::scan_pages", PairPages).on(PAIR_CELLS),
        pass("grid::scatter", Nodes).on(PAIR_CELLS),
        pass(NAME, Nodes),
        CHECK,
    ],
    constants: {
        /// Distance at rest of two nodes of one sponge, in edges, from which on they may touch.
        const SELF_CONTACT_DISTANCE: f32 = 4.0;
        /// Area of a node, over the square of the edge, below which it has no normal.
        const MINIMUM_NODE_AREA: f32 = 1.0e-3;
    },
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let count = columns.rows.nodes;
    let Nodes { position, rest, sponge, stars, normal, pairs, .. } = &mut columns.nodes;
    normal.clear();
    normal.resize(position.len(), [0.0; 4]);
    let radius = pair_radius(params);
    let near = Near::new(params, position, &sponge[..count], radius);
    for color in 0..VERTEX_COLORS {
        let (rows, stars) = (stars.rows(color), &*stars);
        let (position, rest, sponge, near) = (&*position, &*rest, &*sponge, &near);
        cpu.for_chunks(&mut normal[rows], |first, normal| {
            normals(params, (stars, color, first), (position, rest), (sponge, near), normal);
        });
    }
    let members: Vec<u32> =
        (0..count as u32).filter(|node| normal[*node as usize][lane::nodes::normal::AREA] > 0.0).collect();
    let surface = Surface { params, radius, position, rest, sponge, normal };
    let points: Vec<[f32; 4]> = members.iter().map(|node| position[*node as usize]).collect();
    let mut cells = Cells::default();
    cells.build(cpu, &points, radius, bounds(&points));
    let targets: Vec<u32> = cells.order.iter().map(|row| members[*row as usize]).collect();
    let padding = count as u32;
    pairs.fill(cpu, position.len(), padding, |spans: &mut Vec<[u32; 2]>, node, list| {
        if surface.normal[node][lane::nodes::normal::AREA] <= 0.0 {
            return;
        }
        let x = position[node];
        let [low, high] = [-radius, radius].map(|reach| [0, 1, 2].map(|axis| x[axis] + reach));
        cells.spans(low, high, spans);
        for [begin, end] in spans {
            let others = targets[*begin as usize..*end as usize].iter().copied();
            list.extend(others.filter(|other| surface.may_touch(node, *other as usize)));
        }
        list.sort_unstable();
    });
}

/// A box around points.
fn bounds(points: &[[f32; 4]]) -> Domain {
    let minimum = points.iter().fold(Vec3::INFINITY, |low, point| low.min(vector(*point)));
    let maximum = points.iter().fold(Vec3::NEG_INFINITY, |high, point| high.max(vector(*point)));
    Domain::Bounded { minimum, maximum }
}

/// Nodes that may be near another sponge.
struct Near {
    /// For every sponge, the enlarged boxes of those that it may touch.
    boxes: Vec<Vec<(Vec3, Vec3)>>,
}

impl Near {
    fn new(params: &Params, position: &[[f32; 4]], sponge: &[u32], radius: f32) -> Self {
        let mut own = vec![(Vec3::INFINITY, Vec3::NEG_INFINITY); params.sponges.len()];
        for node in params.asleep.others(sponge.len()).flatten() {
            let (sponge, row) = (sponge[node], position[node]);
            let (low, high) = &mut own[sponge as usize];
            (*low, *high) = (low.min(vector(row)), high.max(vector(row)));
        }
        // Nothing is near a sleeping sponge.
        let wide = |other: u32| {
            let (low, high) = own[other as usize];
            (low - radius, high + radius)
        };
        let everywhere = (Vec3::NEG_INFINITY, Vec3::INFINITY);
        let all = 0..params.sponges.len() as u32;
        let boxes = |sponge: u32| {
            let others = all.clone().filter(|other| params.may_meet(sponge, *other));
            others.map(|other| if other == sponge { everywhere } else { wide(other) }).collect()
        };
        Self { boxes: all.clone().map(boxes).collect() }
    }

    fn has(&self, sponge: u32, point: Vec3) -> bool {
        let inside = |(low, high): &(Vec3, Vec3)| (point.cmpge(*low) & point.cmple(*high)).all();
        self.boxes[sponge as usize].iter().any(inside)
    }
}

/// Normals and areas of nodes of one vertex colour.
fn normals(
    params: &Params,
    (stars, color, first): (&Stars, usize, usize),
    (position, rest): (&[[f32; 4]], &[[f32; 4]]),
    (sponge, near): (&[u32], &Near),
    normal: &mut [[f32; 4]],
) {
    for (group, normal) in stars.groups_from(color, first).iter().zip(normal.chunks_mut(LANES)) {
        if params.asleep.has_group(&group.own) {
            continue;
        }
        for (lane, normal) in normal.iter_mut().enumerate() {
            let node = group.own[lane] as usize;
            let sponge = sponge[node];
            if near.has(sponge, vector(position[node])) {
                let edge = params.sponges[sponge as usize].edge;
                *normal = normal_of(group, lane, position, (edge, rest[node][lane::nodes::rest::FLATNESS]));
            }
        }
    }
}

/// Normal, with the weight as its length, and area of one node; zero inside of a sponge.
fn normal_of(group: &StarGroup, lane: usize, position: &[[f32; 4]], (edge, weight): (f32, f32)) -> [f32; 4] {
    if weight <= 0.0 {
        return [0.0; 4];
    }
    let place = |slot: usize| vector(position[group.neighbors[slot][lane] as usize]);
    let mut sum = Vec3::ZERO;
    for (direction, ring) in RINGS.iter().enumerate() {
        for k in 0..4 {
            if group.tets[4 * direction + k][lane] > 0.0 {
                let u = place(CORNERS + direction);
                sum -= (place(ring[(k + 1) % 4]) - u).cross(place(ring[k]) - u);
            }
        }
    }
    let length = sum.dot(sum).sqrt();
    let area = length / 6.0;
    // Nor has what is not a number.
    if area > MINIMUM_NODE_AREA * edge * edge {
        let scale = weight / length;
        [sum.x * scale, sum.y * scale, sum.z * scale, area]
    } else {
        [0.0; 4]
    }
}

/// The nodes that may touch.
struct Surface<'a> {
    params: &'a Params,
    /// Largest distance between the nodes of a pair \[m\].
    radius: f32,
    position: &'a [[f32; 4]],
    rest: &'a [[f32; 4]],
    sponge: &'a [u32],
    normal: &'a [[f32; 4]],
}

impl Surface<'_> {
    fn may_touch(&self, a: usize, b: usize) -> bool {
        let (own, other) = (self.sponge[a], self.sponge[b]);
        if !self.params.may_meet(own, other) {
            return false;
        }
        let edge = self.params.pair_edge(own, other);
        let (distant, reach) = (vector(self.position[a]) - vector(self.position[b]), self.radius);
        if distant.dot(distant) > reach * reach {
            return false;
        }
        if own == other {
            let apart = vector(self.rest[a]) - vector(self.rest[b]);
            if apart.dot(apart) < SELF_CONTACT_DISTANCE * SELF_CONTACT_DISTANCE * edge * edge {
                return false;
            }
        }
        let ends = [self.position[a], self.position[b]];
        Pair::new(ends, [self.normal[a], self.normal[b]]).is_some_and(|pair| pair.is_near(edge))
    }
}
