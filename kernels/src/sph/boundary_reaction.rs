//! Reaction of bodies to the change of the pressure.
//!
//! ```text
//! impulse of a body += m h sum_i dP_i grad lambda_ik   where the body will be at the end of the step
//! ```

use crate::{
    columns::{Columns, Fluid},
    cpu::{Cpu, PerChunk},
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
};

use super::{
    obstacles::per_chunk,
    obstacles::{Profile, at_end, near},
};

declare! {
    needs: [Fluid, Bodies, Incompressible],
    reads: [FluidPredicted, BodyStates, BodyFluidWrenches],
    writes: [BodyFluidWrenches],
    oracle: crate::oracle::incompressible::boundary_reaction,
    bound: 2e-5,
    // Impulses of either sign, summed in f32 over 65 537 particles; on thin walls the sums are small: 4.9e-5.
    twin_bound: 1e-4,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let count = columns.rows.fluid;
    let Fluid { predicted, .. } = &columns.fluid;
    let bodies = at_end(&columns.bodies.states.0, params.step);
    let Some(profile) = Profile::of(params) else { return };
    let wrenches = &mut columns.bodies.fluid_wrenches.0;
    let mut per_chunk = per_chunk(wrenches, predicted.len(), bodies.len());
    let scale = params.fluid.particle_mass * params.step;
    cpu.for_chunks(PerChunk(&mut per_chunk), |first, wrenches| {
        let end = predicted.len().min(first + crate::cpu::CHUNK);
        let near = near(&bodies, &predicted[first..end], profile.range());
        with_lanes!(cpu, simd => {
            for row in (first..end).step_by(LANES) {
                let [x, y, z, change] = lanes::load_rows(simd, predicted, row);
                let momentum = (change * scale).to_array();
                let used = count.saturating_sub(row).min(LANES);
                for body in &near {
                    let wrench = &mut wrenches.0[0][*body];
                    profile.react(simd, &bodies[*body], [x, y, z], &momentum[..used], wrench);
                }
            }
        });
    });
}
