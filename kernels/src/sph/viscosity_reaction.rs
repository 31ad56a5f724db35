//! Reaction of no-slip bodies where viscosity is implicit.
//!
//! ```text
//! impulse = m h sum_i f(y) (v*_i + y_i - v_body)_t
//! ```
//!
//! with `f` from `sph::wall_friction`, without its limit by the step, and `y` from `viscosity_solve`.

use crate::{
    body::{Body, Placed, Wrench},
    columns::{Columns, Fluid},
    cpu::{Cpu, PerChunk},
    kernel::declare,
    lanes::{self, LANES, Simd, with_lanes},
    params::Params,
    vector::{minus, plus, splat, times},
};

use super::{
    friction::{along, friction_rate},
    obstacles::per_chunk,
    obstacles::{give, near},
};

declare! {
    needs: [Fluid, Bodies, NoSlip, ImplicitViscosity],
    reads: [FluidPosition, FluidVelocity, FluidViscosityChange, BodyStates, BodyFluidWrenches],
    writes: [BodyFluidWrenches],
    oracle: crate::oracle::viscosity::reaction,
    bound: 4e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let count = columns.rows.fluid;
    let Fluid { position, velocity, viscosity_change: change, .. } = &columns.fluid;
    let bodies = &columns.bodies.states.0;
    let mut wrenches = per_chunk(&mut columns.bodies.fluid_wrenches.0, position.len(), bodies.len());
    let task = Task { params, bodies, position, velocity, change, count };
    cpu.for_chunks(PerChunk(&mut wrenches), |first, wrenches| {
        with_lanes!(cpu, simd => task.chunk(simd, first, wrenches.0[0]));
    });
}

struct Task<'a> {
    params: &'a Params,
    bodies: &'a [Body],
    position: &'a [[f32; 4]],
    velocity: &'a [[f32; 4]],
    change: &'a [[f32; 4]],
    /// Rows in use: padding rows lie far away, where a plane may be solid.
    count: usize,
}

impl Task<'_> {
    #[inline(always)]
    fn chunk<S: Simd>(&self, simd: S, first: usize, wrenches: &mut [Wrench]) {
        let fluid = &self.params.fluid;
        let end = self.position.len().min(first + crate::cpu::CHUNK);
        let near = near(self.bodies, &self.position[first..end], fluid.smoothing.support_radius);
        let impulse = f64::from(fluid.particle_mass * self.params.step);
        for row in (first..end).step_by(LANES) {
            let used = self.count.saturating_sub(row).min(LANES);
            let [x, y, z, _] = lanes::load_rows(simd, self.position, row);
            let [vx, vy, vz, _] = lanes::load_rows(simd, self.velocity, row);
            let [cx, cy, cz, _] = lanes::load_rows(simd, self.change, row);
            let (point, velocity) = ([x, y, z], plus([vx, vy, vz], [cx, cy, cz]));
            for body in near.iter().filter(|body| self.bodies[**body].no_slip) {
                let placed = Placed::new(simd, &self.bodies[*body]);
                let (distance, normal) = placed.distance(point);
                let slide = along(minus(velocity, placed.velocity(point)), normal);
                let slowed = times(slide, lanes::positive(simd, friction_rate(simd, fluid, distance)));
                let centre = splat(simd, self.bodies[*body].state.position.to_array());
                give(&mut wrenches[*body], slowed, minus(point, centre), used, impulse);
            }
        }
    }
}
