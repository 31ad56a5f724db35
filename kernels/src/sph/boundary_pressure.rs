//! Pressure of the particles against walls and bodies, at the beginning of the step.
//!
//! ```text
//! a_i -= P_i grad lambda_i,   impulse of a body = m h sum_i P_i grad lambda_ik
//! ```

use crate::{
    body::{Body, Wrench},
    columns::{Columns, Fluid},
    cpu::{Cpu, PerChunk},
    kernel::declare,
    lanes::{self, LANES, Simd, with_lanes},
    params::Params,
    wrench,
};

use super::obstacles::{Profile, near, per_chunk};

declare! {
    needs: [Fluid, Obstacles, Density],
    reads: [FluidPosition, FluidAcceleration, BodyStates],
    writes: [FluidAcceleration, BodyFluidWrenches],
    oracle: crate::oracle::incompressible::boundary_pressure,
    bound: 4e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let count = columns.rows.fluid;
    let Fluid { position, acceleration, .. } = &mut columns.fluid;
    let bodies = &columns.bodies.states.0;
    let wrenches = &mut columns.bodies.fluid_wrenches.0;
    wrench::begin(wrenches, acceleration.len(), bodies.len());
    let Some(profile) = Profile::of(params) else { return };
    let mut per_chunk = per_chunk(wrenches, acceleration.len(), bodies.len());
    let rows = (&mut acceleration[..], PerChunk(&mut per_chunk));
    cpu.for_chunks(rows, |first, (acceleration, wrenches)| {
        let task = Task { params, profile, bodies, position, count };
        with_lanes!(cpu, simd => task.chunk(simd, first, acceleration, wrenches.0[0]));
    });
}

struct Task<'a> {
    params: &'a Params,
    profile: Profile,
    bodies: &'a [Body],
    position: &'a [[f32; 4]],
    /// Rows in use: padding rows lie far away, where a plane may be solid.
    count: usize,
}

impl Task<'_> {
    #[inline(always)]
    fn chunk<S: Simd>(&self, simd: S, first: usize, acceleration: &mut [[f32; 4]], wrenches: &mut [Wrench]) {
        let near = near(self.bodies, &self.position[first..first + acceleration.len()], self.profile.range);
        let fluid = &self.params.fluid;
        for row in (0..acceleration.len()).step_by(LANES) {
            let [x, y, z, pressure] = lanes::load_rows(simd, self.position, first + row);
            let pressure = pressure * fluid.rest_density;
            let point = [x, y, z];
            let [mut gx, mut gy, mut gz, _] = self.profile.walls(simd, self.params, point);
            let momentum = (pressure * (fluid.particle_mass * self.params.step)).to_array();
            let used = self.count.saturating_sub(first + row).min(LANES);
            for body in &near {
                let [bx, by, bz, _] = self.profile.body(simd, &self.bodies[*body], point);
                (gx, gy, gz) = (gx + bx, gy + by, gz + bz);
                let wrench = &mut wrenches[*body];
                self.profile.react(simd, &self.bodies[*body], point, &momentum[..used], wrench);
            }
            let [ax, ay, az, aw] = lanes::load_rows(simd, acceleration, row);
            let sum = [ax - pressure * gx, ay - pressure * gy, az - pressure * gz, aw];
            lanes::store_rows(acceleration, row, sum);
        }
    }
}
