//! Parameters, sponges, bodies and cells in the layout of `common/*.wgsl`.

use glam::{Mat3, Vec3};

use crate::{
    body::{Body, Shape},
    columns::{Nodes, RowCounts},
    grid::cells::Domain,
    params::{Cohesion, EquationOfState, Params, Solver},
    pbd::{
        lattice::{COLORS, Topology},
        meeting::pair_radius,
        momentum::joined,
        stars::{NEIGHBORS, TETS},
    },
    smoothing::Wendland,
};

/// Most sponges that fit the uniform buffer.
pub(super) const SPONGES: usize = 256;
/// Bytes from one batch of tets to the next: the alignment that every device takes.
pub(super) const BATCH_STRIDE: u64 = 256;
/// Batches: colours of tets, then colours of nodes.
pub(super) const BATCHES: usize = COLORS + 4;
/// Bytes of a sponge.
pub(super) const SPONGE_BYTES: usize = 96;
/// Bytes of a body.
pub(super) const BODY_BYTES: u64 = 144;

/// How long a step may be, beside what the step itself finds: the constant part of the host's clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepLimits {
    /// Factor on support radius over speed of sound and flow \[1\].
    pub courant: f32,
    /// Step over the time in which pressure moves a particle by a spacing, where pressure is solved for \[1\].
    pub pressure_courant: f32,
    /// Smallest lattice constant of the sponges that are awake \[m\]; infinite without any.
    pub edge: f32,
    /// Whether there is fluid, and it is awake.
    pub has_fluid: bool,
    /// Shortest step that is allowed \[s\].
    pub minimum: f32,
    /// Smallest of the bounds that do not change \[s\].
    pub constant: f32,
    /// Which that is: an index that the device gives back as it is.
    pub constant_bound: u32,
}

/// Bytes that are put together value by value.
#[derive(Debug, Default)]
pub(super) struct Bytes(pub(super) Vec<u8>);

impl Bytes {
    fn floats(&mut self, values: &[f32]) -> &mut Self {
        self.0.extend(values.iter().flat_map(|value| value.to_ne_bytes()));
        self
    }

    fn words(&mut self, values: &[u32]) -> &mut Self {
        self.0.extend(values.iter().flat_map(|value| value.to_ne_bytes()));
        self
    }

    fn vector(&mut self, vector: Vec3, w: f32) -> &mut Self {
        self.floats(&[vector.x, vector.y, vector.z, w])
    }
}

/// Longest lists that fit: fluid to fluid, fluid to controls, controls to fluid, nodes to nodes that they may touch.
pub(super) type Capacities = [u32; 4];

pub(super) fn params(
    params: &Params,
    rows: RowCounts,
    limits: &StepLimits,
    capacities: Capacities,
) -> Vec<u8> {
    let fluid = &params.fluid;
    let (low, high) = params.walls.unwrap_or((Vec3::ZERO, Vec3::ZERO));
    let mut bytes = Bytes::default();
    bytes
        .vector(params.gravity, 0.0)
        .vector(low, if params.walls.is_some() { 1.0 } else { 0.0 })
        .vector(high, 0.0)
        .words(&[rows.fluid, rows.nodes, rows.bodies, rows.tets].map(|rows| rows as u32))
        .floats(&[fluid.spacing, fluid.rest_density, fluid.particle_mass, fluid.sound_speed])
        .floats(&[
            fluid.viscosity,
            fluid.surface_tension,
            fluid.repulsion_range,
            fluid.repulsion_stiffness,
            fluid.repulsion_damping,
        ])
        .words(&[u32::from(fluid.equation_of_state == EquationOfState::Tait)])
        // Finite: shaders may assume that nothing is infinite.
        .floats(&[limits.courant, limits.edge.min(f32::MAX), limits.minimum, limits.constant])
        .words(&[limits.constant_bound])
        .words(&capacities[..3])
        .floats(&[fluid.central_viscosity, fluid.roughness]);
    let solid = params.solid.unwrap_or(params.coupling);
    for smoothing in [&fluid.smoothing, &params.coupling, &solid] {
        bytes.floats(&smoothing_factors(smoothing));
    }
    match &fluid.incompressible {
        Some(solve) => bytes
            .floats(&[solve.tolerance])
            .words(&[solve.rounds])
            .floats(&[solve.lattice_diagonal, solve.correction_speed])
            .floats(&[solve.boundary_range, solve.boundary_share])
            .words(&[1])
            .floats(&[limits.pressure_courant]),
        None => bytes.words(&[0; 8]),
    };
    let (own, numbers) = fluid.cohesion.as_ref().map_or((&fluid.smoothing, [0.0; 4]), |cohesion| {
        let Cohesion { stiffness, volume, boundary_range, boundary_share, .. } = *cohesion;
        (&cohesion.smoothing, [stiffness, volume, boundary_range, boundary_share])
    });
    bytes
        .floats(&smoothing_factors(own))
        .floats(&numbers)
        .floats(&[fluid.list_radius(), fluid.wall_viscosity])
        .words(&[u32::from(params.no_slip), u32::from(params.has_wetting())]);
    match params.fluid.implicit_viscosity {
        Some(implicit) => bytes
            .floats(&[implicit.viscosity, implicit.central_viscosity, implicit.tolerance])
            .words(&[implicit.rounds]),
        None => bytes.words(&[0; 4]),
    };
    bytes.vector(params.origin(), 0.0);
    match &params.periodic {
        Some(periodic) => {
            let (low, high) = periodic.corners();
            bytes.vector(low, 0.0).vector(high, 0.0);
            bytes.vector(periodic.periods(), 1.0).vector(periodic.halves(), 0.0)
        }
        None => bytes.words(&[0; 16]),
    };
    bytes.floats(&[pair_radius(params)]).words(&[u32::from(limits.has_fluid), 0, 0]);
    bytes.0
}

fn smoothing_factors(smoothing: &Wendland) -> [f32; 8] {
    let [inverse_radius, value, gradient, laplacian, viscosity] = smoothing.factors();
    [smoothing.support_radius, inverse_radius, value, gradient, laplacian, viscosity, 0.0, 0.0]
}

/// Beside the solver of a sponge that is asleep.
const ASLEEP: u32 = 4;

/// Sponges, of whose nodes `first` has the first of each.
pub(super) fn sponges(params: &Params, first: &[usize]) -> Vec<u8> {
    let mut bytes = Bytes::default();
    for (sponge, first) in params.sponges.iter().zip(first) {
        bytes.floats(&[
            sponge.edge,
            sponge.stretch_modulus,
            sponge.shear_modulus,
            sponge.volume_modulus,
            sponge.damping_time,
            sponge.iterations as f32,
            sponge.friction,
            sponge.porosity,
            sponge.drag_rate,
            sponge.entry_pressure,
            sponge.saturation_gain,
            sponge.reaction,
        ]);
        let solver = match sponge.solver {
            Solver::Sbd => 0,
            Solver::Vbd => 1,
            Solver::XpbdNeoHookean => 2,
        };
        bytes
            .words(&[if params.asleep.has(*first) { solver | ASLEEP } else { solver }])
            .floats(&[sponge.mu, sponge.lambda, sponge.damping, sponge.inertial_drag])
            .words(&[u32::from(sponge.pores_close), sponge.wetting.exponent])
            .floats(&[sponge.wetting.softening, sponge.wetting.swelling])
            .floats(&[sponge.wetting.time, sponge.wetting.receding])
            .words(&[u32::from(sponge.self_contact)]);
    }
    bytes.0.resize(SPONGES * SPONGE_BYTES, 0);
    bytes.0
}

/// Bodies, and the face planes of all hulls.
pub(super) fn bodies(bodies: &[Body]) -> (Vec<u8>, Vec<u8>) {
    let (mut all, mut planes) = (Bytes::default(), Bytes::default());
    for body in bodies {
        let state = &body.state;
        let axes = Mat3::from_quat(state.rotation);
        let first = planes.0.len() as u32 / 16;
        let (shape, extents, radius) = match &body.shape {
            Shape::Plane => (0, Vec3::ZERO, 0.0),
            Shape::Sphere { radius } => (1, Vec3::ZERO, *radius),
            Shape::Cuboid { half_extents } => (2, *half_extents, 0.0),
            Shape::Capsule { half_height, radius } => (3, Vec3::new(*half_height, 0.0, 0.0), *radius),
            Shape::Hull { planes: faces, .. } => {
                faces.iter().for_each(|(normal, offset)| {
                    planes.vector(*normal, *offset);
                });
                (4, Vec3::ZERO, 0.0)
            }
        };
        let faces = planes.0.len() as u32 / 16 - first;
        all.vector(state.position, 0.0)
            .vector(axes.x_axis, 0.0)
            .vector(axes.y_axis, 0.0)
            .vector(axes.z_axis, 0.0)
            .vector(state.linear_velocity, 0.0)
            .vector(state.angular_velocity, 0.0)
            .vector(extents, radius)
            .words(&[shape, first, faces, u32::from(body.touches_nodes)])
            .floats(&[body.friction, if body.no_slip { 1.0 } else { 0.0 }, 0.0, 0.0]);
    }
    (all.0, planes.0)
}

/// Number of face planes of all hulls.
pub(super) fn plane_count(bodies: &[Body]) -> usize {
    let planes = |body: &Body| match &body.shape {
        Shape::Hull { planes, .. } => planes.len(),
        _ => 0,
    };
    bodies.iter().map(planes).sum()
}

/// First tet or node and number of them of every batch, and the sponge of every tet.
pub(super) fn batches(topology: &Topology) -> ([[u32; 2]; BATCHES], Vec<u32>) {
    let mut sponges = vec![0; topology.tets.len()];
    let mut batches = [[0; 2]; BATCHES];
    for (color, chunks) in batches.iter_mut().zip(&topology.chunks) {
        let first = chunks.iter().map(|chunk| chunk.tets.start).min().unwrap_or(0);
        let end = chunks.iter().map(|chunk| chunk.tets.end).max().unwrap_or(0);
        *color = [first, end - first];
        for chunk in chunks {
            sponges[chunk.tets.start as usize..chunk.tets.end as usize].fill(chunk.sponge);
        }
    }
    for (color, batch) in batches[COLORS..].iter_mut().enumerate() {
        let [first, end] = [topology.vertex_color_start[color], topology.vertex_color_start[color + 1]];
        *batch = [first, end - first];
    }
    (batches, sponges)
}

pub(super) fn batch_bytes(batches: &[[u32; 2]; BATCHES]) -> Vec<u8> {
    let mut bytes = Bytes::default();
    for batch in batches {
        bytes.words(&[batch[0], batch[1], 0, 0]);
        let end = bytes.0.len().next_multiple_of(BATCH_STRIDE as usize);
        bytes.0.resize(end, 0);
    }
    bytes.0
}

/// Words of the star of a node: neighbours, tets, sponge, wetness, place of the weights of its tets, or 0 if all are 1. The wetness is no
/// constant, but passes that need it have no binding left.
pub(super) const STAR_WORDS: usize = NEIGHBORS + 4;

/// Words of what touches a node, behind the stars of all nodes for the same reason: force and stiffness.
pub(super) const TOUCH_WORDS: usize = 9;

/// Words of every node; those of weights are behind all that, and most nodes have none.
fn row_words(has_touch: bool) -> usize {
    STAR_WORDS + if has_touch { TOUCH_WORDS } else { 0 }
}

/// Number of words of [`stars`].
pub(super) fn star_words(nodes: &Nodes, rows: usize, has_touch: bool) -> usize {
    let weighted = nodes.stars.each().filter(|(_, _, weights)| is_weighted(weights)).count();
    row_words(has_touch) * rows + weighted * TETS
}

/// Whether a tet stands for more or less than its own volume.
fn is_weighted(weights: &[f32; TETS]) -> bool {
    weights.iter().any(|weight| *weight != 0.0 && *weight != 1.0)
}

/// The stars of all nodes, a row each, what touches the nodes, if anything does, and weights.
pub(super) fn stars(nodes: &Nodes, rows: usize, has_touch: bool) -> Vec<u32> {
    let mut words = vec![0; rows * STAR_WORDS];
    for ((force, along), between) in
        nodes.touch.iter().zip(&nodes.touch_stiffness).zip(&nodes.touch_between).take(rows)
    {
        words.extend(
            [force, along, between].iter().flat_map(|row| row[..3].iter().map(|value| value.to_bits())),
        );
    }
    words.resize(row_words(has_touch) * rows, 0);
    for (node, neighbors, weights) in nodes.stars.each() {
        let first = node as usize * STAR_WORDS;
        words[first..first + NEIGHBORS].copy_from_slice(&neighbors);
        let wetness = nodes.wetting.get(node as usize).map_or(0.0, |row| row[0]);
        let tets = (0..TETS).map(|tet| u32::from(weights[tet] > 0.0) << tet).sum();
        let table = if is_weighted(&weights) { words.len() as u32 } else { 0 };
        let own = [tets, nodes.sponge[node as usize], wetness.to_bits(), table];
        words[first + NEIGHBORS..][..4].copy_from_slice(&own);
        if table != 0 {
            words.extend(weights.map(f32::to_bits));
        }
    }
    words
}

/// Pairs of words of a sponge: ranges of nodes, and a bit for every sponge.
pub(super) const RANGES: usize = 8;

/// First node and end of the nodes of every sponge in each vertex colour; then which others it touches, directly or through others,
/// a bit each.
pub(super) fn sponge_ranges(nodes: &Nodes, sponges: usize) -> Vec<[u32; 2]> {
    let mut ranges = vec![[0, 0]; sponges * RANGES];
    let stars = &nodes.stars;
    for piece in &stars.pieces {
        let color = (0..4).find(|color| piece.rows.start < stars.color_start[color + 1]).unwrap_or(0);
        let range = &mut ranges[piece.sponge as usize * RANGES + color];
        if range[1] == 0 {
            range[0] = piece.rows.start;
        }
        range[1] = piece.rows.end;
    }
    let first = joined(&nodes.sponge, [&nodes.touch, &nodes.touch_stiffness], sponges);
    for (own, group) in first.iter().enumerate() {
        for other in (0..sponges).filter(|other| first[*other] == *group) {
            ranges[own * RANGES + 4 + other / 64][other / 32 % 2] |= 1 << (other % 32);
        }
    }
    ranges
}

/// Cells over points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid {
    origin: Vec3,
    edge: f32,
    size: [u32; 3],
    wrap: [bool; 3],
}

/// Cells per point up to which a dense grid is worth its prefix sums.
const CELLS_PER_POINT: u64 = 16;
/// Fewest cells of an axis that wraps.
const SMALLEST_TORUS: u32 = 64;

impl Grid {
    /// Cells of half the radius: a dense grid over a box, or a torus where there is no box or it has more cells than the
    /// points are worth, or than `most` allows.
    pub(super) fn new(domain: Domain, radius: f32, points: usize, most: u64) -> Self {
        let edge = 0.5 * radius;
        let most = most.min(CELLS_PER_POINT * points as u64).max(u64::from(SMALLEST_TORUS).pow(3));
        let (origin, extent) = match domain {
            Domain::Bounded { minimum, maximum } => (minimum, (maximum - minimum).max(Vec3::ZERO)),
            Domain::Unbounded => (Vec3::ZERO, Vec3::INFINITY),
        };
        let mut size = [0, 1, 2].map(|axis| ((extent[axis] / edge).floor() + 1.0).min(1.0e6) as u32);
        let mut wrap = [false; 3];
        let cells = |size: [u32; 3]| size.iter().map(|size| u64::from(*size)).product::<u64>();
        while cells(size) > most {
            let longest = (0..3).max_by_key(|axis| size[*axis]).unwrap_or(0);
            if size[longest] <= SMALLEST_TORUS {
                break;
            }
            wrap[longest] = true;
            // The next smaller power of two.
            size[longest] = (size[longest] - 1).checked_ilog2().map_or(1, |power| 1 << power);
        }
        Self { origin, edge, size, wrap }
    }

    pub(super) fn cells(&self) -> u64 {
        self.size.iter().map(|size| u64::from(*size)).product()
    }

    /// Pages of 4096 cells; the last cell is followed by one more start.
    pub(super) fn pages(&self) -> u64 {
        self.cells() / 4096 + 1
    }

    pub(super) fn bytes(&self, rows: usize) -> Vec<u8> {
        let mut bytes = Bytes::default();
        let [x, y, z] = self.wrap.map(u32::from);
        bytes
            .vector(self.origin, 1.0 / self.edge)
            .words(&[self.size[0], self.size[1], self.size[2], self.cells() as u32])
            .words(&[x, y, z, rows as u32]);
        bytes.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_is_dense_and_everything_else_a_torus() {
        let domain = Domain::Bounded { minimum: Vec3::ZERO, maximum: Vec3::new(1.0, 0.5, 0.25) };
        let dense = Grid::new(domain, 0.05, 100_000, 1 << 26);
        assert_eq!((dense.size, dense.wrap), ([40, 20, 10].map(|size| size + 1), [false; 3]));
        for torus in [
            Grid::new(Domain::Unbounded, 0.05, 1_000_000, 1 << 26),
            Grid::new(Domain::Unbounded, 0.05, 0, 1),
            Grid::new(domain, 0.001, 100_000, 1 << 20),
        ] {
            assert!(torus.wrap.contains(&true), "{torus:?}");
            for axis in (0..3).filter(|axis| torus.wrap[*axis]) {
                assert!(torus.size[axis].is_power_of_two() && torus.size[axis] >= 64, "{torus:?}");
            }
        }
    }
}
