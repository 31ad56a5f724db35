//! Retention of films and drops: the line where water, surface and air meet sticks to walls and bodies until a force along it is exceeded
//! \[F62\].
//!
//! ```text
//! s_i = R / (pi rho_0 d^2) max(0, (rho_1 - rho_i) / l)         deceleration that the line at particle i can bear
//! v_i -= (v_i - v_wall)_t min(1, h s_i / |(v_i - v_wall)_t|)  within a spacing of the surface
//! ```
//!
//! R is the force over the width of a drop \[N/m\]. `rho_1` is the density of a film one particle thick, and l what a straight edge of it
//! lacks. A particle has a line of a spacing for every such lack. The line of a round drop is pi times as long as the drop is wide: hence
//! the factor. Water that is deeper than one particle has no such line, but in the corners of a tank.
//!
//! It comes after the pressure, so that what rests does not creep. Bodies receive the opposite impulse.

use crate::{
    body::{Body, Placed, Wrench},
    columns::{Columns, Fluid, lane},
    cpu::{Cpu, PerChunk},
    kernel::declare,
    lanes::{self, LANES, Simd, f32x8, select, with_lanes},
    params::{Params, Retention},
    sph::{
        friction::along,
        obstacles::{give, near, per_chunk},
    },
    vector::{Vec3x8, dot, minus, splat, times},
};

use super::rate::MINIMUM_MATERIAL;

declare! {
    needs: [Fluid, Divergence, Obstacles, Retention],
    reads: [FluidPosition, FluidVelocity, FluidDensity, FluidMoment, BodyStates, BodyFluidWrenches],
    writes: [FluidVelocity, BodyFluidWrenches],
    oracle: crate::oracle::obstacles::retention,
    bound: 4e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(retention) = params.fluid.retention else { return };
    let count = columns.rows.fluid;
    let Fluid { position, velocity, moment, density, .. } = &mut columns.fluid;
    let bodies = &columns.bodies.states.0;
    let mut wrenches = per_chunk(&mut columns.bodies.fluid_wrenches.0, velocity.len(), bodies.len());
    let task = Task { params, retention, bodies, position, count };
    let bears = |row: usize| {
        let is_in_pores = moment[row][lane::fluid::moment::MATERIAL] > MINIMUM_MATERIAL;
        if is_in_pores { 0.0 } else { retention.deceleration(density[row]) }
    };
    cpu.for_chunks((&mut velocity[..], PerChunk(&mut wrenches)), |first, (velocity, wrenches)| {
        // Deep water, which has no line, is most of it.
        let bears: Vec<f32> = (first..first + velocity.len()).map(bears).collect();
        if bears.iter().any(|bears| *bears > 0.0) {
            with_lanes!(cpu, simd => task.chunk(simd, first, &bears, velocity, wrenches.0[0]));
        }
    });
}

struct Task<'a> {
    params: &'a Params,
    retention: Retention,
    bodies: &'a [Body],
    position: &'a [[f32; 4]],
    /// Rows in use: padding rows lie far away, where a plane may be solid.
    count: usize,
}

impl Task<'_> {
    #[inline(always)]
    fn chunk<S: Simd>(
        &self,
        simd: S,
        first: usize,
        bears: &[f32],
        velocity: &mut [[f32; 4]],
        wrenches: &mut [Wrench],
    ) {
        let fluid = &self.params.fluid;
        let points = &self.position[first..first + velocity.len()];
        let near = near(self.bodies, points, self.retention.range);
        for row in (0..velocity.len()).step_by(LANES) {
            if bears[row..row + LANES].iter().all(|bears| *bears == 0.0) {
                continue;
            }
            let used = self.count.saturating_sub(first + row).min(LANES);
            let bears = lanes::load(simd, bears, row);
            let [x, y, z, _] = lanes::load_rows(simd, self.position, first + row);
            let [vx, vy, vz, vw] = lanes::load_rows(simd, velocity, row);
            let point = [x, y, z];
            let mut v = self.walls(simd, point, [vx, vy, vz], bears);
            for body in &near {
                let placed = Placed::new(simd, &self.bodies[*body]);
                let (distance, normal) = placed.distance(point);
                let slide = along(minus(v, placed.velocity(point)), normal);
                let slowed = times(slide, self.share(simd, (distance, bears), slide));
                v = minus(v, slowed);
                let centre = splat(simd, self.bodies[*body].state.position.to_array());
                give(
                    &mut wrenches[*body],
                    slowed,
                    minus(point, centre),
                    used,
                    f64::from(fluid.particle_mass),
                );
            }
            lanes::store_rows(velocity, row, [v[0], v[1], v[2], vw]);
        }
    }

    /// Velocities that the walls of the container leave.
    #[inline(always)]
    fn walls<S: Simd>(&self, simd: S, point: Vec3x8<S>, mut v: Vec3x8<S>, bears: f32x8<S>) -> Vec3x8<S> {
        let Some((low, high)) = self.params.walls else { return v };
        for axis in 0..3 {
            for distance in [point[axis] - low[axis], lanes::splat(simd, high[axis]) - point[axis]] {
                let mut slide = v;
                slide[axis] = lanes::splat(simd, 0.0);
                v = minus(v, times(slide, self.share(simd, (distance, bears), slide)));
            }
        }
        v
    }

    /// Share of a velocity along a surface that is taken.
    #[inline(always)]
    fn share<S: Simd>(&self, simd: S, (distance, bears): (f32x8<S>, f32x8<S>), slide: Vec3x8<S>) -> f32x8<S> {
        let zero = lanes::splat(simd, 0.0);
        let most = bears * self.params.step;
        let holds = distance.simd_lt(lanes::splat(simd, self.retention.range)) & most.simd_gt(zero);
        select(holds, most / dot(slide, slide).sqrt().max(most), zero)
    }
}
