//! The tet of every particle in a sponge, the weights of its corners, and for every node the particles in its tets.
//!
//! ```text
//! x = sum_k b_k x_k,   sum_k b_k = 1,   grad b_k = (x_l - x_m) x (x_n - x_m) / (6 V)
//! ```
//!
//! The tet is one of those around the nearest node: on the lattice at rest the tet of a point always has it. At the face of the sponge or
//! in a crushed lattice none of them may contain the particle. Then it is the one whose smallest weight is largest. Its weights are then
//! extrapolated: some are negative.

use super::rows::{CornerRows, Corners};
use crate::{
    column::padded,
    columns::{Columns, Controls, Nodes},
    cpu::Cpu,
    grid::neighbors::Neighbors,
    kernel::declare,
    lanes::{self, LANES, Simd, f32x8, select, with_lanes},
    params::Params,
    pbd::stars::{CORNERS, DIRECTIONS, RINGS, StarGroup},
    vector::{Vec3x8, choose, cross, dot, minus, negative, plus, times},
};

declare! {
    needs: [Fluid, Sponge, Divergence, Porous, Barycentric],
    reads: [FluidPosition, FluidControls, ControlNode, ControlPosition, NodePosition, NodeSponge, NodeStars],
    writes: [FluidCorners, FluidShares, ControlCorners],
    oracle: crate::oracle::tets::corners,
    bound: 1e-4,
    twin: [
        pass("tets::corner_rows", Nodes),
        pass(NAME, Fluid),
        pass("tets::corner_count", Fluid),
        pass("tets::corner_starts", One),
        pass("tets::corner_fill", Fluid),
        pass("tets::corner_order", Controls),
    ],
    constants: {
        /// Smallest weight of a corner with which a point counts as one within the tet.
        const INSIDE_TET: f32 = -1.0e-5;
        /// Least volume of a tet over that at rest that counts: the gradients of a flat one are infinite.
        const MINIMUM_TET: f32 = 0.1;
        /// Steepest gradient of a weight, times the edge. It is the square root of 2 at rest.
        const STEEPEST: f32 = 3.0;
        /// Largest weight of a corner of a tet that does not contain the particle.
        const LARGEST_WEIGHT: f32 = 2.0;
        /// Smallest.
        const SMALLEST_WEIGHT: f32 = -1.0;
    },
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let particles = columns.rows.fluid;
    let (fluid, nodes, controls) = (&mut columns.fluid, &columns.nodes, &mut columns.controls);
    let count = controls.node.len() as u32;
    let mut row_of = vec![count; nodes.position.len()];
    (0..).zip(&controls.node).for_each(|(row, node)| row_of[*node as usize] = row);
    let search = Search { params, nodes, controls, row_of: &row_of };
    let (position, lists) = (&fluid.position, &fluid.controls);
    let Corners(corners) = &mut fluid.corners;
    let CornerRows(shares) = &mut fluid.shares;
    corners.clear();
    corners.resize(position.len(), [count; 4]);
    shares.clear();
    shares.resize(position.len(), [[0.0; 4]; 4]);
    // Without controls there are no lists.
    let coupled = if count > 0 { position.len() } else { 0 };
    cpu.for_chunks((&mut corners[..coupled], &mut shares[..coupled]), |first, (corners, shares)| {
        let lists = lists.chunk(first);
        with_lanes!(cpu, simd => {
            for row in (0..corners.len()).step_by(LANES) {
                let group = lists.group(row);
                if !group.is_empty() {
                    let points = &position[first + row..][..LANES];
                    search.group(simd, points, group, (&mut corners[row..][..LANES], &mut shares[row..][..LANES]));
                }
            }
        });
    });
    list(cpu, corners, particles, count as usize, &mut controls.corners);
}

/// The search for the tets of eight particles.
struct Search<'a> {
    params: &'a Params,
    nodes: &'a Nodes,
    controls: &'a Controls,
    /// Control row of every node.
    row_of: &'a [u32],
}

/// The tets around the nearest nodes of eight particles.
struct Around<'a, S: Simd> {
    /// Where the nearest nodes are in the stars.
    place: [(&'a StarGroup, usize); LANES],
    own: Vec3x8<S>,
    offset: Vec3x8<S>,
    /// Least volume that counts, six times.
    minimum: f32x8<S>,
}

/// The best tets so far.
#[derive(Clone, Copy)]
struct Best<S: Simd> {
    /// The smallest weight, and the tet in the star as a float.
    least: f32x8<S>,
    tet: f32x8<S>,
    weights: [f32x8<S>; 4],
    gradients: [Vec3x8<S>; 3],
}

impl Search<'_> {
    #[inline(always)]
    fn group<S: Simd>(
        &self,
        simd: S,
        points: &[[f32; 4]],
        group: &[[u32; LANES]],
        (corners, shares): (&mut [[u32; 4]], &mut [[[f32; 4]; 4]]),
    ) {
        let count = self.controls.node.len();
        let nearest = nearest(simd, points, group, &self.controls.position);
        let node = nearest.map(|row| self.controls.node.get(row as usize).copied().unwrap_or(0));
        let [x, y, z, _] = lanes::load_rows(simd, points, 0);
        let [ox, oy, oz, _] = lanes::gather_rows(simd, &self.nodes.position, &node);
        let own = [ox, oy, oz];
        let minimum = node.map(|node| {
            let edge = self.params.sponges[self.nodes.sponge[node as usize] as usize].edge;
            MINIMUM_TET * 0.5 * (edge * edge * edge)
        });
        let around = Around {
            place: node.map(|node| self.nodes.stars.place(node as usize)),
            own,
            offset: minus([x, y, z], own),
            minimum: lanes::load_array(simd, &minimum),
        };
        let best = self.best(simd, &around);
        let tet = best.tet.to_array();
        let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
        let mut weights = [zero; 4];
        let mut sum = zero;
        for (within, weight) in weights.iter_mut().zip(best.weights) {
            *within = weight.max(lanes::splat(simd, SMALLEST_WEIGHT)).min(lanes::splat(simd, LARGEST_WEIGHT));
            sum += *within;
        }
        let missing = (one - sum) * 0.25;
        let gradients = self.bounded(simd, best.gradients, node);
        for corner in 0..4 {
            let [x, y, z] = gradients[corner];
            let (x, y, z) = (x.to_array(), y.to_array(), z.to_array());
            let weight = (weights[corner] + missing).to_array();
            for lane in (0..LANES).filter(|lane| (nearest[*lane] as usize) < count) {
                let (stars, place) = around.place[lane];
                let node = match corner {
                    0 => node[lane],
                    _ => stars.neighbors[tet_places(tet[lane] as usize)[corner - 1]][place],
                };
                corners[lane][corner] = self.row_of[node as usize];
                shares[lane][corner] = [x[lane], y[lane], z[lane], weight[lane]];
            }
        }
    }

    /// The gradients of all corners, all less where one is steeper than in a lattice that is only moderately compressed.
    #[inline(always)]
    fn bounded<S: Simd>(&self, simd: S, [p, q, r]: [Vec3x8<S>; 3], node: [u32; LANES]) -> [Vec3x8<S>; 4] {
        let mut gradients = [negative(plus(plus(p, q), r)), p, q, r];
        let limit = node.map(|node| {
            let limit = STEEPEST / self.params.sponges[self.nodes.sponge[node as usize] as usize].edge;
            limit * limit
        });
        let limit = lanes::load_array(simd, &limit);
        let mut steepest = limit;
        for gradient in gradients {
            steepest = steepest.max(dot(gradient, gradient));
        }
        let scale = (limit / steepest).sqrt();
        for gradient in &mut gradients {
            *gradient = times(*gradient, scale);
        }
        gradients
    }

    /// The tets of eight particles: those around the neighbour that lies in their direction, if they are in one of these.
    #[inline(always)]
    fn best<S: Simd>(&self, simd: S, around: &Around<'_, S>) -> Best<S> {
        let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
        let mut most = lanes::splat(simd, f32::NEG_INFINITY);
        let mut toward = zero;
        for direction in 0..DIRECTIONS {
            let to = self.way(simd, around, [CORNERS + direction; LANES]);
            let square = dot(to, to);
            let exists = square.simd_gt(zero);
            let along = dot(to, around.offset) / select(exists, square, one);
            let along = select(exists, along, lanes::splat(simd, f32::NEG_INFINITY));
            let is_more = along.simd_gt(most);
            most = select(is_more, along, most);
            toward = select(is_more, lanes::splat(simd, direction as f32), toward);
        }
        let first = toward.to_array().map(|direction| direction as usize);
        let mut best = Best {
            least: lanes::splat(simd, f32::NEG_INFINITY),
            tet: zero,
            weights: [one, zero, zero, zero],
            gradients: [[zero; 3]; 3],
        };
        self.compare(simd, around, first, &mut best);
        if best.least.to_array().iter().any(|least| *least < INSIDE_TET) {
            for direction in 0..DIRECTIONS {
                self.compare(simd, around, [direction; LANES], &mut best);
            }
        }
        best
    }

    /// The ways from the nodes to these of their neighbours.
    #[inline(always)]
    fn way<S: Simd>(&self, simd: S, around: &Around<'_, S>, place: [usize; LANES]) -> Vec3x8<S> {
        let neighbor = std::array::from_fn(|lane| {
            let (group, own) = around.place[lane];
            group.neighbors[place[lane]][own]
        });
        let [x, y, z, _] = lanes::gather_rows(simd, &self.nodes.position, &neighbor);
        minus([x, y, z], around.own)
    }

    /// Compares the tets around a direction, of every lane, with the best so far. Those of particles that have one already stay.
    #[inline(always)]
    fn compare<S: Simd>(
        &self,
        simd: S,
        around: &Around<'_, S>,
        direction: [usize; LANES],
        best: &mut Best<S>,
    ) {
        let one = lanes::splat(simd, 1.0);
        let partner = self.way(simd, around, direction.map(|direction| CORNERS + direction));
        let ring = |k: usize| direction.map(|direction| RINGS[direction][k % 4]);
        let mut r = self.way(simd, around, ring(0));
        let searches = best.least.simd_lt(lanes::splat(simd, INSIDE_TET));
        for k in 0..4 {
            let q = self.way(simd, around, ring(k + 1));
            let exists: [f32; LANES] = std::array::from_fn(|lane| {
                let (group, own) = around.place[lane];
                group.tets[4 * direction[lane] + k][own]
            });
            let area = cross(q, r);
            let six = dot(partner, area);
            let six = select(six.abs().simd_lt(around.minimum), around.minimum, six);
            let inverse = one / six;
            let gradients =
                [times(area, inverse), times(cross(r, partner), inverse), times(cross(partner, q), inverse)];
            let mut weights = [one; 4];
            for (corner, gradient) in gradients.into_iter().enumerate() {
                weights[corner + 1] = dot(gradient, around.offset);
                weights[0] -= weights[corner + 1];
            }
            let smallest = weights[0].min(weights[1]).min(weights[2].min(weights[3]));
            let smallest = select(
                lanes::load_array(simd, &exists).simd_gt(lanes::splat(simd, 0.0)),
                smallest,
                lanes::splat(simd, f32::NEG_INFINITY),
            );
            let is_better = searches & smallest.simd_gt(best.least);
            best.least = select(is_better, smallest, best.least);
            let tet = direction.map(|direction| (4 * direction + k) as f32);
            best.tet = select(is_better, lanes::load_array(simd, &tet), best.tet);
            for (own, weight) in best.weights.iter_mut().zip(weights) {
                *own = select(is_better, weight, *own);
            }
            for (own, gradient) in best.gradients.iter_mut().zip(gradients) {
                *own = choose(is_better, gradient, *own);
            }
            r = q;
        }
    }
}

/// Neighbours in the star that are the other corners of a tet.
fn tet_places(tet: usize) -> [usize; 3] {
    let (direction, k) = (tet / 4, tet % 4);
    [CORNERS + direction, RINGS[direction][(k + 1) % 4], RINGS[direction][k]]
}

/// The nearest controls of eight particles.
#[inline(always)]
fn nearest<S: Simd>(
    simd: S,
    points: &[[f32; 4]],
    group: &[[u32; LANES]],
    controls: &[[f32; 4]],
) -> [u32; LANES] {
    let [x, y, z, _] = lanes::load_rows(simd, points, 0);
    let mut least = lanes::splat(simd, f32::INFINITY);
    // The bits of rows, which are only selected.
    let mut nearest = lanes::splat(simd, f32::from_bits(u32::MAX));
    for entry in group {
        let [xa, ya, za, _] = lanes::gather_rows(simd, controls, entry);
        let apart = minus([x, y, z], [xa, ya, za]);
        let square = dot(apart, apart);
        let is_nearer = square.simd_lt(least);
        least = select(is_nearer, square, least);
        nearest = select(is_nearer, lanes::load_array(simd, &entry.map(f32::from_bits)), nearest);
    }
    nearest.to_array().map(f32::to_bits)
}

/// For every control the corners that it is of the tets of particles: four times the row of the particle, and the corner.
fn list(cpu: &Cpu, corners: &[[u32; 4]], particles: usize, controls: usize, lists: &mut Neighbors) {
    let mut start = vec![0_u32; controls + 2];
    let all = || (0_u32..).zip(corners.as_flattened()).filter(|(_, control)| (**control as usize) < controls);
    all().for_each(|(_, control)| start[*control as usize + 2] += 1);
    (2..start.len()).for_each(|row| start[row] += start[row - 1]);
    let mut order = vec![0_u32; start[controls + 1] as usize];
    for (place, control) in all() {
        let next = &mut start[*control as usize + 1];
        order[*next as usize] = place;
        *next += 1;
    }
    lists.fill(cpu, padded(controls), 4 * particles as u32, |(): &mut (), control, list| {
        if control < controls {
            list.extend(&order[start[control] as usize..start[control + 1] as usize]);
        }
    });
}
