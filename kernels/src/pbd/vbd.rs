//! Vertex block descent: every node moves to the minimum of its energy while the others are fixed \[CLYX24\].
//!
//! ```text
//! E(x) = m / (2 h^2) |x - z|^2 + sum over tets of V psi(F) + damping,   x <- x + (m / h^2 + H)^-1 (m / h^2 (z - x) - dE/dx)
//! ```
//!
//! with the target z and the energy of `descent.rs`. With fluid, target and mass include its drag (`couple::drag_target`).
//! There are four vertex colours: the neighbours of a node have other colours, so that nodes of a colour can move at the
//! same time. A node is over-relaxed by three tenths of the way to its minimum, so that errors of long wavelength need fewer
//! sweeps. Steps of a single sweep are an exception, because vibrations would grow. So are tets far from their volume and
//! long ways, where the energy is not nearly quadratic. Contact and friction are solved together with the elasticity of the
//! node, in `obstacles.rs`. Without contact a sweep never raises the total energy, and is stable at any step.
//!
//! Differs from the paper: the Hessian is exact and positive definite, because the energy of one node is convex. Contact is
//! exact instead of a penalty. Over-relaxation takes the place of Chebyshev acceleration.

use crate::{
    columns::Columns,
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, Simd, f32x8, select, with_lanes},
    params::Params,
    pbd::{
        descent::{Material, local, minimum},
        lattice::VERTEX_COLORS,
        obstacles::{Obstacles, array, vector},
        stars::StarGroup,
        sweep::Sweep,
    },
    vector::{Vec3x8, choose, dot, minus, times},
};

declare! {
    needs: [Sponge, Solver(Vbd)],
    reads: [
        NodePosition, NodePredicted, NodeTarget, NodeStars, NodeSponge, NodeWetting, NodeTouch,
        NodeTouchStiffness, NodeTouchBetween, BodyStates,
    ],
    writes: [NodePredicted],
    oracle: crate::oracle::descent::vbd,
    bound: 5e-4,
    twin: [pass(NAME, VertexColors)],
    constants: {
        /// Change of the volume of a tet around a node, over that at rest, up to which the node goes all the way further \[1\].
        const FULL_RELAXATION_STRAIN: f32 = 0.2;
        /// The same from which on it goes no further than to its least energy \[1\].
        const NO_RELAXATION_STRAIN: f32 = 0.5;
        /// Way, in edges, from which on a node goes no further than to its least energy. It goes all the way
        /// further up to half of that \[1\].
        const NO_RELAXATION_WAY: f32 = 0.1;
        /// Parts of the last digit of a position from which the random number is taken, see [`moved`] \[1\].
        const ROUNDING_PARTS: f32 = 4096.0;
        /// Least absolute coordinate in the unit of stochastic rounding: the unit of a coordinate of zero would be zero \[m\].
        const MINIMUM_COORDINATE: f32 = 1.0e-6;
        const EPSILON: f32 = f32::EPSILON;
    },
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let (nodes, bodies) = (&mut columns.nodes, &columns.bodies.states.0);
    let mut moved = Vec::new();
    for color in 0..VERTEX_COLORS {
        let rows = nodes.stars.rows(color);
        for awake in params.asleep.awake_groups(rows.clone(), LANES) {
            moved.clear();
            moved.resize(awake.len(), [0.0; 4]);
            let sweep = Sweep::new(cpu, params, bodies, nodes);
            let before = awake.start - rows.start;
            cpu.for_chunks(&mut moved[..], |first, moved| {
                with_lanes!(cpu, simd => sweep.move_chunk(simd, color, before + first, moved));
            });
            nodes.predicted[awake].copy_from_slice(&moved);
        }
    }
}

impl Sweep<'_> {
    #[inline(always)]
    fn move_chunk<S: Simd>(&self, simd: S, color: usize, first: usize, moved: &mut [[f32; 4]]) {
        let obstacles = self.obstacles();
        let groups = self.stars.groups_from(color, first);
        for (group, moved) in groups.iter().zip(moved.chunks_mut(LANES)) {
            let material = self.material(simd, group);
            let solved = self.minimise(simd, group, &material, &obstacles);
            let mut stored = [[0.0; 4]; LANES];
            lanes::store_rows(&mut stored, 0, solved);
            moved.copy_from_slice(&stored[..moved.len()]);
        }
    }

    #[inline(always)]
    fn minimise<S: Simd>(
        &self,
        simd: S,
        group: &StarGroup,
        material: &Material<S>,
        obstacles: &Obstacles<'_>,
    ) -> [f32x8<S>; 4] {
        let [x, y, z, w] = lanes::gather_rows(simd, self.predicted, &group.own);
        let [ox, oy, oz, _] = lanes::gather_rows(simd, self.position, &group.own);
        let [tx, ty, tz, mass] = lanes::gather_rows(simd, self.target, &group.own);
        let (x, old, target) = ([x, y, z], [ox, oy, oz], [tx, ty, tz]);
        let zero = lanes::splat(simd, 0.0);
        let moves = w.simd_gt(zero) & material.own.simd_gt(zero);
        let places = (self.predicted, self.position, self.wet);
        let mut energy = local(simd, (group, &self.stars.shape), material, places, (x, old));
        self.touch.add(simd, &group.own, &mut energy);
        let strain = energy.strain;
        let (way, quadratic) = minimum(simd, energy, (x, target, mass), self.params.step);
        let point = moved(simd, x, way);
        let relaxed = moved(simd, x, times(way, relaxation(simd, material, strain, way)));
        let own = select(moves, lanes::splat(simd, 1.0), zero);
        let mut contact = quadratic.contact((relaxed, old), material, own);
        obstacles.push(&mut contact, None);
        let mut end = vector(simd, &contact.point);
        if contact.point != array(relaxed) {
            // The contact force is that of the minimum, without over-relaxation.
            let mut contact = quadratic.contact((point, old), material, own);
            obstacles.push(&mut contact, None);
            let off = minus(end, relaxed);
            end = choose(dot(off, off).simd_gt(zero), vector(simd, &contact.point), end);
        }
        let [x, y, z] = choose(moves, end, x);
        [x, y, z, w]
    }
}

/// Over-relaxed way of a node, over the way to its minimum.
#[inline(always)]
fn relaxation<S: Simd>(simd: S, material: &Material<S>, strain: f32x8<S>, way: Vec3x8<S>) -> f32x8<S> {
    let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
    let edges = times(way, material.inverse_edge);
    // From 1 at half of that way down to 0 at all of it.
    let short = (lanes::splat(simd, NO_RELAXATION_WAY * NO_RELAXATION_WAY) - dot(edges, edges))
        * lanes::splat(simd, 4.0 / (3.0 * NO_RELAXATION_WAY * NO_RELAXATION_WAY));
    let share = (lanes::splat(simd, NO_RELAXATION_STRAIN) - strain)
        * lanes::splat(simd, 1.0 / (NO_RELAXATION_STRAIN - FULL_RELAXATION_STRAIN));
    one + share.min(short).max(zero).min(one) * material.relaxation
}

/// Adds a way to points with stochastic rounding: up or down with a probability in proportion to the remainder.
///
/// The forces that bend a long bar move single nodes by less than half of the last digit of their positions. Rounded to the
/// nearest, the nodes would stay in place, and the bar 1e-4 of its length short of its equilibrium. The random number is the
/// remainder of the way beyond a few thousandths of that digit.
#[inline(always)]
fn moved<S: Simd>(simd: S, points: Vec3x8<S>, way: Vec3x8<S>) -> Vec3x8<S> {
    let (half, minimum) = (lanes::splat(simd, 0.5), lanes::splat(simd, MINIMUM_COORDINATE));
    let mut moved = points;
    for axis in 0..3 {
        let digit = points[axis].abs().max(minimum) * EPSILON;
        let parts = way[axis] / digit * ROUNDING_PARTS + half;
        moved[axis] += way[axis] + (parts - parts.floor() - half) * digit;
    }
    moved
}
