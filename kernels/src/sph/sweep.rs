//! Limits velocities so that no particle passes a body in the step (`sweep.rs`).
//!
//! ```text
//! v <- v + dq / h,   impulse of the body = -m dq / h
//! ```
//!
//! Pressure keeps particles half a spacing away from bodies at moderate speeds; this kernel is for faster motion.

use crate::{
    body::{Body, Wrench},
    columns::{Columns, Fluid},
    cpu::{Cpu, PerChunk},
    kernel::declare,
    lanes::{self, LANES, Simd, prelude::*, with_lanes},
    params::Params,
    sweep::Swept,
    vector::{dot, minus, plus, splat, times},
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
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let count = columns.rows.fluid;
    let Fluid { position, velocity, .. } = &mut columns.fluid;
    let (bodies, radii) = obstacles(params, &columns.bodies.states.0);
    let (bodies, ends) = (&bodies[..], at_end(&bodies, params.step));
    let fastest = bodies.iter().map(Body::fastest).fold(0.0, f32::max);
    let largest = radii.iter().copied().fold(0.0, f32::max);
    let mut wrenches = per_chunk(&mut columns.bodies.fluid_wrenches.0, velocity.len(), bodies.len());
    cpu.for_chunks((&mut velocity[..], PerChunk(&mut wrenches)), |first, (velocity, wrenches)| {
        let used = count.saturating_sub(first).min(velocity.len());
        let points = &position[first..first + velocity.len()];
        let reach = params.step * (fastest + speed(&velocity[..used])) + params.fluid.spacing + largest;
        let near = near(bodies, points, reach);
        if near.is_empty() {
            return;
        }
        let task = Task { params, bodies: [bodies, &ends], radii: &radii, near: &near };
        with_lanes!(cpu, simd => task.chunk(simd, points, &mut velocity[..used.next_multiple_of(LANES)], used, wrenches.0[0]));
    });
}

/// The bodies, and 0; with a solve for the divergence their cores, and the radius of the ball that sweeps each \[m\]: particles that
/// have images must not pass the surface that these belong to.
pub(crate) fn obstacles(params: &Params, bodies: &[Body]) -> (Vec<Body>, Vec<f32>) {
    if params.fluid.divergence().is_some() {
        bodies.iter().map(Body::core).unzip()
    } else {
        (bodies.to_vec(), vec![0.0; bodies.len()])
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
    /// Of the balls that sweep them \[m\].
    radii: &'a [f32],
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
        for body in self.near {
            let pair = [&self.bodies[0][*body], &self.bodies[1][*body]];
            let swept = Swept::new(simd, pair, WALL_MARGIN * fluid.spacing + self.radii[*body]);
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
                let mut stored = [[0.0; 4]; LANES];
                let [vx, vy, vz] = plus(v, change);
                lanes::store_rows(&mut stored, 0, [vx, vy, vz, w]);
                // Padding rows may lie inside a plane, and must not move.
                let lanes = used.saturating_sub(row).min(LANES);
                velocity[row..row + lanes].copy_from_slice(&stored[..lanes]);
                let centre = splat(simd, pair[1].state.position.to_array());
                let arm = minus(plus(to, correction), centre);
                give(&mut wrenches[*body], change, arm, lanes, -f64::from(fluid.particle_mass));
            }
        }
    }
}
