//! Elastic repulsion of particles from walls and bodies (the paper, section 3.1).
//!
//! ```text
//! a_i += (k (R - d) - c v_n) n   where the distance d from the surface is less than R, not pulling
//! ```
//!
//! Bodies receive the opposite, as one wrench per chunk of particles.

use glam::DVec3;

use crate::{
    body::{Body, Placed, Wrench},
    columns::{Columns, Fluid},
    cpu::{Cpu, PerChunk},
    kernel::declare,
    lanes::{self, LANES, Simd, select, with_lanes},
    params::Params,
    vector::{Vec3x8, dot, minus, plus, times},
    wrench,
};

use super::obstacles::{near, per_chunk};

declare! {
    needs: [Fluid, Obstacles, EquationOfState],
    reads: [FluidPosition, FluidVelocity, FluidAcceleration, BodyStates],
    writes: [FluidAcceleration, BodyFluidWrenches],
    oracle: crate::oracle::sph::repulsion,
    bound: 4e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let count = columns.rows.fluid;
    let Fluid { position, velocity, acceleration, .. } = &mut columns.fluid;
    let bodies = &columns.bodies.states.0;
    let wrenches = &mut columns.bodies.fluid_wrenches.0;
    wrench::begin(wrenches, acceleration.len(), bodies.len());
    let mut per_chunk = per_chunk(wrenches, acceleration.len(), bodies.len());
    let rows = (&mut acceleration[..], PerChunk(&mut per_chunk));
    cpu.for_chunks(rows, |first, (acceleration, wrenches)| {
        let task = Task { params, bodies, position, velocity, count };
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
        let end = (first + acceleration.len()).min(self.position.len());
        let near = near(self.bodies, &self.position[first..end], self.params.fluid.repulsion_range);
        let placed: Vec<(usize, Placed<'_, S>)> =
            near.into_iter().map(|body| (body, Placed::new(simd, &self.bodies[body]))).collect();
        for row in (0..acceleration.len()).step_by(LANES) {
            let [x, y, z, _] = lanes::load_rows(simd, self.position, first + row);
            let [vx, vy, vz, _] = lanes::load_rows(simd, self.velocity, first + row);
            let (point, velocity) = ([x, y, z], [vx, vy, vz]);
            let [ax, ay, az, aw] = lanes::load_rows(simd, acceleration, row);
            let mut sum = [ax, ay, az];
            let used = self.count.saturating_sub(first + row).min(LANES);
            self.walls(simd, point, velocity, &mut sum);
            for (body, placed) in &placed {
                let (distance, normal) = placed.distance(point);
                let approach = minus(velocity, placed.velocity(point));
                let push = self.push(simd, distance, dot(approach, normal));
                sum = plus(sum, times(normal, push));
                self.react(
                    &push.to_array()[..used],
                    point,
                    distance,
                    normal,
                    self.bodies[*body].state.position,
                    &mut wrenches[*body],
                );
            }
            lanes::store_rows(acceleration, row, [sum[0], sum[1], sum[2], aw]);
        }
    }

    /// Acceleration along the normal, from the distance and the speed along the normal.
    #[inline(always)]
    fn push<S: Simd>(&self, simd: S, distance: lanes::f32x8<S>, speed: lanes::f32x8<S>) -> lanes::f32x8<S> {
        let fluid = &self.params.fluid;
        let depth = lanes::splat(simd, fluid.repulsion_range) - distance;
        let push = depth * fluid.repulsion_stiffness - speed * fluid.repulsion_damping;
        select(depth.simd_gt(lanes::splat(simd, 0.0)), lanes::positive(simd, push), lanes::splat(simd, 0.0))
    }

    #[inline(always)]
    fn walls<S: Simd>(&self, simd: S, point: Vec3x8<S>, velocity: Vec3x8<S>, sum: &mut Vec3x8<S>) {
        let Some((minimum, maximum)) = self.params.walls else {
            return;
        };
        for axis in 0..3 {
            let low = self.push(simd, point[axis] - minimum[axis], velocity[axis]);
            let high = self.push(simd, lanes::splat(simd, maximum[axis]) - point[axis], -velocity[axis]);
            sum[axis] += low - high;
        }
    }

    #[inline(always)]
    fn react<S: Simd>(
        &self,
        push: &[f32],
        point: Vec3x8<S>,
        distance: lanes::f32x8<S>,
        normal: Vec3x8<S>,
        centre: glam::Vec3,
        wrench: &mut Wrench,
    ) {
        for lane in (0..push.len()).filter(|lane| push[*lane] > 0.0) {
            let lane_of = |vector: Vec3x8<S>| {
                DVec3::new(f64::from(vector[0][lane]), f64::from(vector[1][lane]), f64::from(vector[2][lane]))
            };
            let normal = lane_of(normal);
            let impulse =
                f64::from(push[lane]) * f64::from(self.params.step * self.params.fluid.particle_mass);
            let contact = lane_of(point) - normal * f64::from(distance[lane]);
            wrench.add(normal * -impulse, contact - centre.as_dvec3());
        }
    }
}
