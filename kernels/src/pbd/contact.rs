//! Contact of nodes with walls and bodies, with friction (the paper, sections 3.2 and 3.3).
//!
//! A node whose path leads into a body (`sweep.rs`) is moved to the tangent plane at the point of contact. Its tangential
//! motion relative to the body is undone as far as Coulomb friction reaches: up to `mu` times the depth. Bodies receive the
//! opposite impulse `-m dy / h`.

use glam::{DVec3, Vec3};

use crate::{
    body::{Body, Piece, Placed, Wrench, by_chunk},
    columns::{Columns, Nodes},
    cpu::{CHUNK, Cpu, PerChunk},
    kernel::declare,
    lanes::{self, LANES, Simd, f32x8, select, with_lanes},
    params::{Params, Solver, SpongeParams},
    pbd::obstacles::CLEARANCE,
    sweep::met,
    vector::{Vec3x8, dot, minus, plus, times},
};

declare! {
    needs: [Sponge, Projection, Obstacles],
    reads: [NodePosition, NodePredicted, NodeSponge, BodyStates, BodyNodeWrenches],
    writes: [NodePredicted, BodyNodeWrenches],
    oracle: crate::oracle::pbd::contact,
    bound: 3e-5,
    twin: [pass(NAME, Nodes)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Nodes { position, predicted, sponge, .. } = &mut columns.nodes;
    let bodies = &columns.bodies.states.0;
    let some_descend = params.sponges.iter().any(|sponge| sponge.solver == Solver::Vbd);
    let chunks = predicted.len().div_ceil(CHUNK);
    let mut wrenches = by_chunk(&mut columns.bodies.node_wrenches.0, chunks, bodies.len());
    cpu.for_chunks((&mut predicted[..], PerChunk(&mut wrenches)), |first, (predicted, wrenches)| {
        let task = Task { params, bodies, position, sponge, some_descend };
        with_lanes!(cpu, simd => task.chunk(simd, first, predicted, wrenches.0[0]));
    });
}

struct Task<'a> {
    params: &'a Params,
    bodies: &'a [Body],
    position: &'a [[f32; 4]],
    sponge: &'a [u32],
    some_descend: bool,
}

impl Task<'_> {
    #[inline(always)]
    fn chunk<S: Simd>(&self, simd: S, first: usize, predicted: &mut [[f32; 4]], wrenches: &mut [Wrench]) {
        let pieces: Vec<Piece<'_>> =
            Piece::of_all(self.bodies).filter(|piece| self.bodies[piece.body].touches_nodes).collect();
        let placed: Vec<(usize, Placed<'_, S>)> = pieces
            .iter()
            .map(|piece| (piece.body, Placed::of_piece(simd, &self.bodies[piece.body], piece.geometry())))
            .collect();
        for row in (0..predicted.len()).step_by(LANES) {
            if self.params.asleep.has_all(first + row..first + row + LANES) {
                continue;
            }
            let [x, y, z, w] = lanes::load_rows(simd, predicted, row);
            let [ox, oy, oz, _] = lanes::load_rows(simd, self.position, first + row);
            let (mut point, old) = ([x, y, z], [ox, oy, oz]);
            // Eight nodes may belong to several sponges, and padding rows to none.
            let clearance = f32x8::from_fn(simd, |lane| {
                self.sponge_of(first + row + lane).map_or(0.0, |sponge| CLEARANCE * sponge.edge)
            });
            let moves = self.moves(simd, first + row, w);
            self.walls(simd, first + row, moves, old, &mut point);
            for (index, placed) in &placed {
                let body = &self.bodies[*index];
                let drift = times(placed.velocity(point), lanes::splat(simd, self.params.step));
                // The body is at its place of the beginning of the step: so is the node, in the body's frame.
                let way = [placed.local(old), placed.local(minus(point, drift))];
                let met = met(simd, placed, way, clearance);
                let normal = placed.turned(met.normal);
                let depth = lanes::positive(simd, -(met.distance + met.beyond)) * moves;
                let slide = minus(minus(point, old), drift);
                let change = contact(simd, depth, normal, slide, lanes::splat(simd, body.friction));
                point = plus(point, change);
                self.react(depth.to_array(), change, w, point, body.state.position, &mut wrenches[*index]);
            }
            self.stays_inside(simd, moves, &mut point);
            lanes::store_rows(predicted, row, [point[0], point[1], point[2], w]);
        }
    }

    /// 1 for movable nodes, 0 for held ones and for those whose own solver handles obstacles.
    #[inline(always)]
    fn moves<S: Simd>(&self, simd: S, row: usize, inverse_mass: f32x8<S>) -> f32x8<S> {
        let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
        let free = select(inverse_mass.simd_gt(zero), one, zero);
        if !self.some_descend {
            return free;
        }
        let here = f32x8::from_fn(simd, |lane| {
            let solver = self.sponge.get(row + lane).and_then(|sponge| self.params.solver(*sponge));
            if solver == Some(Solver::Vbd) { 0.0 } else { 1.0 }
        });
        free * here
    }

    /// The sponge of a node.
    fn sponge_of(&self, row: usize) -> Option<&SpongeParams> {
        self.sponge.get(row).and_then(|sponge| self.params.sponges.get(*sponge as usize))
    }

    #[inline(always)]
    fn walls<S: Simd>(&self, simd: S, row: usize, moves: f32x8<S>, old: Vec3x8<S>, point: &mut Vec3x8<S>) {
        let Some((minimum, maximum)) = self.params.walls else {
            return;
        };
        let zero = lanes::splat(simd, 0.0);
        let friction =
            f32x8::from_fn(simd, |lane| self.sponge_of(row + lane).map_or(0.0, |sponge| sponge.friction));
        for axis in 0..3 {
            for (sign, wall) in [(1.0, minimum[axis]), (-1.0, maximum[axis])] {
                let distance = (point[axis] - wall) * sign;
                let depth = lanes::positive(simd, -distance) * moves;
                let mut normal = [zero; 3];
                normal[axis] = lanes::splat(simd, sign);
                let slide = minus(*point, old);
                let change = contact(simd, depth, normal, slide, friction);
                *point = plus(*point, change);
            }
        }
    }

    /// One obstacle may push a node into another: walls come last.
    #[inline(always)]
    fn stays_inside<S: Simd>(&self, simd: S, moves: f32x8<S>, point: &mut Vec3x8<S>) {
        let Some((minimum, maximum)) = self.params.walls else { return };
        let can_move = moves.simd_gt(lanes::splat(simd, 0.0));
        for axis in 0..3 {
            let (low, high) = (lanes::splat(simd, minimum[axis]), lanes::splat(simd, maximum[axis]));
            // NaN stays NaN.
            point[axis] = select(can_move & point[axis].simd_lt(low), low, point[axis]);
            point[axis] = select(can_move & point[axis].simd_gt(high), high, point[axis]);
        }
    }

    #[inline(always)]
    fn react<S: Simd>(
        &self,
        depth: [f32; LANES],
        change: Vec3x8<S>,
        w: f32x8<S>,
        point: Vec3x8<S>,
        centre: Vec3,
        wrench: &mut Wrench,
    ) {
        for lane in (0..LANES).filter(|lane| depth[*lane] > 0.0) {
            let lane_of = |vector: Vec3x8<S>| {
                DVec3::new(f64::from(vector[0][lane]), f64::from(vector[1][lane]), f64::from(vector[2][lane]))
            };
            let mass = 1.0 / f64::from(w[lane]);
            let impulse = lane_of(change) * (-mass / f64::from(self.params.step));
            wrench.add(impulse, lane_of(point) - centre.as_dvec3());
        }
    }
}

/// Change of position: out along the normal, and back along the surface.
#[inline(always)]
fn contact<S: Simd>(
    simd: S,
    depth: f32x8<S>,
    normal: Vec3x8<S>,
    slide: Vec3x8<S>,
    friction: f32x8<S>,
) -> Vec3x8<S> {
    let one = lanes::splat(simd, 1.0);
    let along = dot(slide, normal);
    let tangent = minus(slide, times(normal, along));
    let length = dot(tangent, tangent).sqrt();
    let reach = depth * friction;
    let slips = length.simd_gt(reach);
    // Sticks if friction reaches as far as the slip, also for a slip of zero.
    let undone = select(slips, reach / select(slips, length, one), one);
    let touches = depth.simd_gt(lanes::splat(simd, 0.0));
    let undone = select(touches, undone, lanes::splat(simd, 0.0));
    minus(times(normal, depth), times(tangent, undone))
}
