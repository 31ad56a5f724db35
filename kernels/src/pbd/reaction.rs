//! Impulses of walls, bodies and grips on the nodes of vertex block descent.
//!
//! After few sweeps the forces in a sponge do not balance, but the external ones are known. One is the force that keeps a node out of an
//! obstacle (`obstacles.rs`). The other is that of a grip against the elastic force on a held node. Bodies receive the opposite. The fourth
//! lane is the mass of the node in `pbd::momentum`.

use crate::{
    body::{Wrench, by_chunk},
    columns::Columns,
    cpu::{CHUNK, Cpu, PerChunk},
    kernel::declare,
    lanes::{self, LANES, Simd, f32x8, prelude::*, select, with_lanes},
    params::Params,
    pbd::{
        descent::{Material, local, minimum},
        lattice::VERTEX_COLORS,
        obstacles::{OBSTACLE_MARGIN, Obstacles, array, vector},
        stars::StarGroup,
        sweep::Sweep,
    },
    vector::{choose, dot, negative, plus, times},
};

declare! {
    needs: [Sponge, Solver(Vbd)],
    reads: [
        NodePosition, NodePredicted, NodeTarget, NodeStars, NodeSponge, NodeWetting, NodeTouch,
        NodeTouchStiffness, NodeTouchBetween, BodyStates, BodyNodeWrenches,
    ],
    writes: [NodeReaction, BodyNodeWrenches],
    oracle: crate::oracle::descent::reaction,
    bound: 1e-3,
    twin: [pass(NAME, Nodes)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let mut reaction = std::mem::take(&mut columns.nodes.reaction);
    let (nodes, bodies) = (&columns.nodes, &columns.bodies.states.0);
    let wrenches = &mut columns.bodies.node_wrenches.0;
    reaction.clear();
    reaction.resize(nodes.position.len(), [0.0; 4]);
    let sweep = Sweep::new(cpu, params, bodies, nodes);
    for color in 0..VERTEX_COLORS {
        let rows = nodes.stars.rows(color);
        // A vertex colour does not begin with a chunk of rows: its chunks have separate wrenches.
        let chunks = rows.len().div_ceil(CHUNK);
        let mut own = vec![Wrench::default(); chunks * bodies.len()];
        let mut of_chunks = by_chunk(&mut own, chunks, bodies.len());
        cpu.for_chunks((&mut reaction[rows], PerChunk(&mut of_chunks)), |first, (reaction, wrenches)| {
            with_lanes!(cpu, simd => sweep.react_chunk(simd, color, first, reaction, wrenches.0[0]));
        });
        wrenches.extend_from_slice(&own);
    }
    columns.nodes.reaction = reaction;
}

impl Sweep<'_> {
    #[inline(always)]
    fn react_chunk<S: Simd>(
        &self,
        simd: S,
        color: usize,
        first: usize,
        reaction: &mut [[f32; 4]],
        wrenches: &mut [Wrench],
    ) {
        let obstacles = self.obstacles();
        let groups = self.stars.groups_from(color, first);
        for (group, reaction) in groups.iter().zip(reaction.chunks_mut(LANES)) {
            if self.params.asleep.has_group(&group.own) {
                continue;
            }
            let material = self.material(simd, group);
            // A short last group repeats its last node, which must not count twice.
            let mut counts = [0.0; LANES];
            counts[..reaction.len()].fill(1.0);
            let counts = lanes::load_array(simd, &counts) * material.own;
            let found = self.external_impulse(simd, group, (&material, counts), &obstacles, wrenches);
            let mut stored = [[0.0; 4]; LANES];
            lanes::store_rows(&mut stored, 0, found);
            reaction.copy_from_slice(&stored[..reaction.len()]);
        }
    }

    /// External impulse, and mass.
    #[inline(always)]
    fn external_impulse<S: Simd>(
        &self,
        simd: S,
        group: &StarGroup,
        (material, counts): (&Material<S>, f32x8<S>),
        obstacles: &Obstacles<'_>,
        wrenches: &mut [Wrench],
    ) -> [f32x8<S>; 4] {
        let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
        let [x, y, z, w] = lanes::gather_rows(simd, self.predicted, &group.own);
        let x = [x, y, z];
        let free = w.simd_gt(zero);
        let mass = one / select(free, w, one);
        let own = select(free, counts, zero);
        let [ox, oy, oz, _] = lanes::gather_rows(simd, self.position, &group.own);
        let old = [ox, oy, oz];
        let near = obstacles.near(&array(x), &array(old), &(material.edge * OBSTACLE_MARGIN).to_array());
        let near = lanes::load_array(simd, &near) * own;
        let is_held = !free & counts.simd_gt(zero);
        if !(is_held | near.simd_gt(zero)).any_true() {
            return [zero, zero, zero, mass * own];
        }
        let [tx, ty, tz, drawn] = lanes::gather_rows(simd, self.target, &group.own);
        let target = [tx, ty, tz];
        let places = (self.predicted, self.position, self.wet);
        let step = self.params.step;
        let mut energy = local(simd, (group, &self.stars.shape), material, places, (x, old));
        self.touch.add(simd, &group.own, &mut energy);
        let (elastic, stiffness) = (energy.force, energy.stiffness);
        let (way, quadratic) = minimum(simd, energy, (x, target, drawn), step);
        let point = plus(x, way);
        let mut contact = quadratic.contact((point, old), material, near);
        let pushed = vector(simd, &obstacles.push(&mut contact, Some(wrenches)));
        let force = choose(free, pushed, times(negative(elastic), counts));
        let touches = dot(force, force).simd_gt(zero) | is_held;
        let mean = (stiffness[0] + stiffness[1] + stiffness[2]) * (1.0 / 3.0);
        let resists = mean * lanes::splat(simd, step * step) * counts;
        let [x, y, z] = times(force, lanes::splat(simd, step));
        [x, y, z, select(touches, -resists, mass * own)]
    }
}
