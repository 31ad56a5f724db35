//! Surface tension at walls and bodies: the part of the surface energy of `sph::cohesion` that they have.
//!
//! ```text
//! a_i += k V / m w_i s_i sum_k grad lambda_ik / (1 - lambda_ik),   impulse of a body = -m h sum_i of its part
//! ```
//!
//! In the deficits of `sph::deficit` what a wall or body takes of a neighbourhood does not lack. The fluid therefore has no surface there
//! and meets it at a right angle. This is the derivative of that energy by the place of the wall, with `s_i` and `lambda_ik` as there.
//! Along the line where the surface meets the wall, it pulls at the wall with the surface tension. Without this term only the pressure of
//! the fluid acts there, and a bridge of water pushes two plates apart that it should draw together.

use crate::{
    columns::{Columns, Fluid},
    cpu::{Cpu, PerChunk},
    kernel::declare,
    lanes::{self, Simd, f32x8, with_lanes},
    params::{Cohesion, Params},
};

use super::{
    obstacles::{Profile, per_chunk},
    push::{Pressures, Push},
};

declare! {
    needs: [Fluid, Cohesion, Obstacles],
    reads: [FluidPosition, FluidAdhesion, FluidAcceleration, BodyStates, BodyFluidWrenches],
    writes: [FluidAcceleration, BodyFluidWrenches],
    oracle: crate::oracle::surface::adhesion,
    bound: 3e-5,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(cohesion) = &params.fluid.cohesion else { return };
    let count = columns.rows.fluid;
    let Fluid { position, adhesion, acceleration, .. } = &mut columns.fluid;
    let bodies = &columns.bodies.states.0;
    let profile = Profile::HalfSpace { radius: cohesion.smoothing.support_radius };
    let pressures = Tension { adhesion, scale: scale(cohesion, params.fluid.particle_mass) };
    let push = Push { params, profile, bodies, position, count, pressures };
    let mut wrenches = per_chunk(&mut columns.bodies.fluid_wrenches.0, acceleration.len(), bodies.len());
    cpu.for_chunks((&mut acceleration[..], PerChunk(&mut wrenches)), |first, (acceleration, wrenches)| {
        with_lanes!(cpu, simd => push.chunk(simd, first, acceleration, wrenches.0[0]));
    });
}

/// Pressure of a weight \[m^2/s^2\].
fn scale(cohesion: &Cohesion, mass: f32) -> f32 {
    -cohesion.stiffness * (cohesion.volume / mass)
}

/// Weights of the deficits at walls as pressures.
struct Tension<'a> {
    adhesion: &'a [f32],
    scale: f32,
}

impl Pressures for Tension<'_> {
    #[inline(always)]
    fn at<S: Simd>(&self, simd: S, row: usize) -> f32x8<S> {
        lanes::load(simd, self.adhesion, row) * self.scale
    }
}
