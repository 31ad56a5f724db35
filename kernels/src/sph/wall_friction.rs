//! Friction of the fluid at no-slip walls and bodies \[MFZ97\].
//!
//! ```text
//! a_i -= f(y) (v_i - v_wall)_t,   impulse of a body = m h sum_i f(y) (v_i - v_wall)_t
//! ```
//!
//! This is the viscosity of `sph::forces` with fluid inside the wall, whose velocity continues linearly through that of the
//! surface. Integrated over the half-space at a distance y, with q = y / H,
//!
//! ```text
//! f(y) = mu / rho_0 int_{z > y} lap W z / y dV = 90 mu / (rho_0 H y) (1/40 - q^2 / 12 + q^4 / 8 - q^5 / 15)
//! ```
//!
//! limited to what stops the particle in the step, and to the value at an eighth of H.

use crate::{
    body::{Body, Placed, Wrench},
    columns::{Columns, Fluid},
    cpu::{Cpu, PerChunk},
    kernel::declare,
    lanes::{self, LANES, Simd, f32x8, with_lanes},
    params::Params,
    vector::{Vec3x8, minus, plus, splat, times},
};

use super::{
    obstacles::per_chunk,
    obstacles::{give, near},
};

use super::friction::{along, friction_rate};

declare! {
    needs: [Fluid, Obstacles, NoSlip, ExplicitViscosity],
    reads: [FluidPosition, FluidVelocity, FluidAcceleration, BodyStates, BodyFluidWrenches],
    writes: [FluidAcceleration, BodyFluidWrenches],
    oracle: crate::oracle::obstacles::wall_friction,
    bound: 4e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let count = columns.rows.fluid;
    let Fluid { position, velocity, acceleration, .. } = &mut columns.fluid;
    let bodies = &columns.bodies.states.0;
    let mut wrenches = per_chunk(&mut columns.bodies.fluid_wrenches.0, acceleration.len(), bodies.len());
    let task = Task { params, bodies, position, velocity, count };
    cpu.for_chunks((&mut acceleration[..], PerChunk(&mut wrenches)), |first, (acceleration, wrenches)| {
        with_lanes!(cpu, simd => task.chunk(simd, first, acceleration, wrenches.0[0]));
    });
}

struct Task<'a> {
    params: &'a Params,
    bodies: &'a [Body],
    position: &'a [[f32; 4]],
    velocity: &'a [[f32; 4]],
    /// Rows in use: padding rows lie far away, where a plane may be solid.
    count: usize,
}

impl Task<'_> {
    #[inline(always)]
    fn chunk<S: Simd>(&self, simd: S, first: usize, acceleration: &mut [[f32; 4]], wrenches: &mut [Wrench]) {
        let fluid = &self.params.fluid;
        let points = &self.position[first..first + acceleration.len()];
        let near = near(self.bodies, points, fluid.smoothing.support_radius);
        for row in (0..acceleration.len()).step_by(LANES) {
            let used = self.count.saturating_sub(first + row).min(LANES);
            let [x, y, z, _] = lanes::load_rows(simd, self.position, first + row);
            let [vx, vy, vz, _] = lanes::load_rows(simd, self.velocity, first + row);
            let (point, velocity) = ([x, y, z], [vx, vy, vz]);
            let mut sum = self.walls(simd, point, velocity);
            for body in near.iter().filter(|body| self.bodies[**body].no_slip) {
                let placed = Placed::new(simd, &self.bodies[*body]);
                let (distance, normal) = placed.distance(point);
                let slide = along(minus(velocity, placed.velocity(point)), normal);
                let slowed = times(slide, self.rate(simd, distance));
                sum = plus(sum, slowed);
                let centre = splat(simd, self.bodies[*body].state.position.to_array());
                let impulse = f64::from(fluid.particle_mass * self.params.step);
                give(&mut wrenches[*body], slowed, minus(point, centre), used, impulse);
            }
            let [ax, ay, az, aw] = lanes::load_rows(simd, acceleration, row);
            lanes::store_rows(acceleration, row, [ax - sum[0], ay - sum[1], az - sum[2], aw]);
        }
    }

    /// Deceleration by the walls of the container.
    #[inline(always)]
    fn walls<S: Simd>(&self, simd: S, point: Vec3x8<S>, velocity: Vec3x8<S>) -> Vec3x8<S> {
        let mut sum = [lanes::splat(simd, 0.0); 3];
        let Some((low, high)) = self.params.walls.filter(|_| self.params.no_slip) else { return sum };
        for axis in 0..3 {
            let below = self.rate(simd, point[axis] - low[axis]);
            let above = self.rate(simd, lanes::splat(simd, high[axis]) - point[axis]);
            for other in 0..3 {
                if other != axis {
                    sum[other] += velocity[other] * (below + above);
                }
            }
        }
        sum
    }

    /// f(y) \[1/s\].
    #[inline(always)]
    fn rate<S: Simd>(&self, simd: S, distance: f32x8<S>) -> f32x8<S> {
        let rate = friction_rate(simd, &self.params.fluid, distance);
        lanes::positive(simd, rate.min(lanes::splat(simd, 1.0 / self.params.step)))
    }
}
