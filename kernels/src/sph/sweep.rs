//! Limits velocities so that no particle passes a body in the step (`sweep.rs`).
//!
//! ```text
//! v <- v + dq / h,   impulse of the body = -m dq / h
//! ```
//!
//! Where parts of a compound meet, one may move a particle into another. It is carried by the body then, and goes nowhere along it.
//!
//! Pressure keeps particles half a spacing away from bodies at moderate speeds; this kernel is for faster motion.

use crate::{
    body::{Body, Piece, Placed, Shape, Wrench},
    columns::{Columns, Fluid},
    cpu::{Cpu, PerChunk},
    kernel::declare,
    lanes::{self, LANES, Simd, f32x8, prelude::*, select, with_lanes},
    params::Params,
    sweep::Swept,
    vector::{Vec3x8, dot, minus, plus, splat, times},
};

use super::{
    container::WALL_MARGIN,
    obstacles::per_chunk,
    obstacles::{at_end, give, near},
};

declare! {
    needs: [Fluid, Bodies],
    reads: [FluidPosition, FluidVelocity, BodyStates, BodyFluidWrenches],
    writes: [FluidVelocity, BodyFluidWrenches],
    oracle: crate::oracle::obstacles::sweep_fluid,
    bound: 2e-3,
    twin: [pass(NAME, Fluid)],
    constants: {
        /// Way into a part of a compound over the spacing that is nothing.
        const PART_SLACK: f32 = 2e-5;
    },
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let count = columns.rows.fluid;
    let Fluid { position, velocity, .. } = &mut columns.fluid;
    let bodies = &columns.bodies.states.0[..];
    let (pieces, ends) = (obstacles(params, bodies), at_end(bodies, params.step));
    let fastest = bodies.iter().map(Body::fastest).fold(0.0, f32::max);
    let largest = pieces.iter().map(|piece| piece.radius).fold(0.0, f32::max);
    let mut wrenches = per_chunk(&mut columns.bodies.fluid_wrenches.0, velocity.len(), bodies.len());
    cpu.for_chunks((&mut velocity[..], PerChunk(&mut wrenches)), |first, (velocity, wrenches)| {
        let used = count.saturating_sub(first).min(velocity.len());
        let points = &position[first..first + velocity.len()];
        let reach = params.step * (fastest + speed(&velocity[..used])) + params.fluid.spacing + largest;
        let near = near(bodies, points, reach);
        if near.is_empty() {
            return;
        }
        let task = Task { params, bodies: [bodies, &ends], pieces: &pieces, near: &near };
        with_lanes!(cpu, simd => task.chunk(simd, points, &mut velocity[..used.next_multiple_of(LANES)], used, wrenches.0[0]));
    });
}

/// The convex pieces of bodies. With a solve for the divergence they are cores, and balls that sweep them: particles that have images must
/// not pass the surface of these.
pub(crate) fn obstacles<'a>(params: &Params, bodies: &'a [Body]) -> Vec<Piece<'a>> {
    if params.fluid.divergence().is_some() {
        Piece::cores_of_all(bodies).collect()
    } else {
        Piece::of_all(bodies).collect()
    }
}

/// The largest speed.
fn speed(velocity: &[[f32; 4]]) -> f32 {
    let square = |v: &[f32; 4]| v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    velocity.iter().map(square).fold(0.0, f32::max).sqrt()
}

struct Task<'a> {
    params: &'a Params,
    /// Before and after the step.
    bodies: [&'a [Body]; 2],
    /// In the order of the bodies.
    pieces: &'a [Piece<'a>],
    near: &'a [usize],
}

impl Task<'_> {
    #[inline(always)]
    fn chunk<S: Simd>(
        &self,
        simd: S,
        points: &[[f32; 4]],
        velocity: &mut [[f32; 4]],
        used: usize,
        wrenches: &mut [Wrench],
    ) {
        let fluid = &self.params.fluid;
        let (step, rate) = (lanes::splat(simd, self.params.step), 1.0 / self.params.step);
        for piece in self.pieces.iter().filter(|piece| self.near.contains(&piece.body)) {
            let pair = [&self.bodies[0][piece.body], &self.bodies[1][piece.body]];
            let swept = Swept::new(simd, pair, piece, WALL_MARGIN * fluid.spacing);
            for row in (0..velocity.len()).step_by(LANES) {
                let [x, y, z, _] = lanes::load_rows(simd, points, row);
                let [vx, vy, vz, w] = lanes::load_rows(simd, velocity, row);
                let (from, v) = ([x, y, z], [vx, vy, vz]);
                let to = plus(from, times(v, step));
                let correction = swept.correction(from, to);
                if !dot(correction, correction).simd_gt(lanes::splat(simd, 0.0)).any_true() {
                    continue;
                }
                let change = times(correction, lanes::splat(simd, rate));
                // Padding rows may lie inside a plane, and must not move.
                let lanes = used.saturating_sub(row).min(LANES);
                store(&mut velocity[row..row + lanes], (plus(v, change), w));
                let centre = splat(simd, pair[1].state.position.to_array());
                let arm = minus(plus(to, correction), centre);
                give(&mut wrenches[piece.body], change, arm, lanes, -f64::from(fluid.particle_mass));
            }
        }
        let compounds =
            self.near.iter().filter(|body| matches!(self.bodies[0][**body].shape, Shape::Compound(_)));
        for body in compounds {
            let pieces = self.pieces.partition_point(|piece| piece.body < *body)
                ..self.pieces.partition_point(|piece| piece.body <= *body);
            self.hold(simd, &self.pieces[pieces], points, velocity, used, &mut wrenches[*body]);
        }
    }

    /// Particles that one part of a compound has moved into another are carried by the body.
    #[inline(always)]
    fn hold<S: Simd>(
        &self,
        simd: S,
        pieces: &[Piece<'_>],
        points: &[[f32; 4]],
        velocity: &mut [[f32; 4]],
        used: usize,
        wrench: &mut Wrench,
    ) {
        let Some(first) = pieces.first() else { return };
        let fluid = &self.params.fluid;
        let pair = [&self.bodies[0][first.body], &self.bodies[1][first.body]];
        let (step, zero) = (lanes::splat(simd, self.params.step), lanes::splat(simd, 0.0));
        let rate = lanes::splat(simd, 1.0 / self.params.step);
        let slack = lanes::splat(simd, (PART_SLACK * fluid.spacing).powi(2));
        for row in (0..velocity.len()).step_by(LANES) {
            let [x, y, z, _] = lanes::load_rows(simd, points, row);
            let [vx, vy, vz, w] = lanes::load_rows(simd, velocity, row);
            let (from, v) = ([x, y, z], [vx, vy, vz]);
            let to = plus(from, times(v, step));
            let mut deepest = zero;
            for piece in pieces {
                let correction =
                    Swept::new(simd, pair, piece, WALL_MARGIN * fluid.spacing).correction(from, to);
                let square = dot(correction, correction);
                deepest = select(square.simd_gt(deepest), square, deepest);
            }
            let is_held = deepest.simd_gt(slack);
            if !is_held.any_true() {
                continue;
            }
            let [before, after] = pair.map(|body| Placed::new(simd, body));
            let carried = after.world(before.local(from));
            let moved = times(minus(carried, to), rate);
            let change = [0, 1, 2].map(|axis| select(is_held, moved[axis], zero));
            let lanes = used.saturating_sub(row).min(LANES);
            store(&mut velocity[row..row + lanes], (plus(v, change), w));
            let arm = minus(carried, splat(simd, pair[1].state.position.to_array()));
            give(wrench, change, arm, lanes, -f64::from(fluid.particle_mass));
        }
    }
}

/// Stores velocities of at most eight particles.
#[inline(always)]
fn store<S: Simd>(rows: &mut [[f32; 4]], ([x, y, z], w): (Vec3x8<S>, f32x8<S>)) {
    let mut stored = [[0.0; 4]; LANES];
    lanes::store_rows(&mut stored, 0, [x, y, z, w]);
    rows.copy_from_slice(&stored[..rows.len()]);
}
