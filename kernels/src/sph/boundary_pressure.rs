//! Pressure of the particles against walls and bodies, at the beginning of the step.
//!
//! ```text
//! a_i -= P_i grad lambda_i,   impulse of a body = m h sum_i P_i grad lambda_ik
//! ```

use crate::{
    columns::{Columns, Fluid, lane},
    cpu::{Cpu, PerChunk},
    kernel::declare,
    lanes::{self, Simd, f32x8, with_lanes},
    params::Params,
    wrench,
};

use super::{
    obstacles::{Profile, per_chunk},
    push::{Pressures, Push},
};

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
    let pressures = Solved { position, rest_density: params.fluid.rest_density };
    let push = Push { params, profile, bodies, position, count, pressures };
    let mut per_chunk = per_chunk(wrenches, acceleration.len(), bodies.len());
    let rows = (&mut acceleration[..], PerChunk(&mut per_chunk));
    cpu.for_chunks(rows, |first, (acceleration, wrenches)| {
        with_lanes!(cpu, simd => push.chunk(simd, first, acceleration, wrenches.0[0]));
    });
}

/// Kinematic pressures of the last step.
struct Solved<'a> {
    position: &'a [[f32; 4]],
    rest_density: f32,
}

impl Pressures for Solved<'_> {
    #[inline(always)]
    fn at<S: Simd>(&self, simd: S, row: usize) -> f32x8<S> {
        lanes::load_rows(simd, self.position, row)[lane::fluid::position::PRESSURE_OVER_SQUARED_DENSITY]
            * self.rest_density
    }
}
