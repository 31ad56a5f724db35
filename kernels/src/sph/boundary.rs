//! Boundary volume fraction of walls and bodies around a particle, at the end of the step.
//!
//! ```text
//! lambda(y) = s max(0, 1 - y / R)^6   at the distance y from a surface, added up over surfaces
//! ```
//!
//! The first layer of a lattice, half a spacing from the surface, then has rest density. The pressure of its neighbours does not push it
//! into the wall. `boundary_profile` computes the value and slope for that. Nothing is stored on the surface.

use crate::{
    body::Body,
    columns::{Columns, Fluid},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
};

use super::obstacles::{Profile, at_end, near};

declare! {
    needs: [Fluid, Incompressible],
    reads: [FluidPredicted, BodyStates],
    writes: [FluidBoundary],
    oracle: crate::oracle::incompressible::boundary,
    // Near the axis of a thin capsule the outward direction is less precise than the position.
    bound: 2e-5,
    // The sixth power of a distance over the range, a tenth of a millimetre for 65 537 particles: 2.6e-5.
    twin_bound: 1e-4,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Fluid { predicted, boundary, .. } = &mut columns.fluid;
    boundary.resize(predicted.len(), [0.0; 4]);
    let bodies = at_end(&columns.bodies.states.0, params.step);
    fill(cpu, params, &bodies, predicted, boundary);
}

/// Gradients of the boundary volume fraction \[1/m\], and in w the fraction \[1\], at the present positions of the
/// particles.
#[must_use]
pub fn shares(cpu: &Cpu, params: &Params, columns: &Columns) -> Vec<[f32; 4]> {
    let mut shares = vec![[0.0; 4]; columns.fluid.position.len()];
    fill(cpu, params, &columns.bodies.states.0, &columns.fluid.position, &mut shares);
    shares
}

fn fill(cpu: &Cpu, params: &Params, bodies: &[Body], points: &[[f32; 4]], boundary: &mut [[f32; 4]]) {
    let Some(profile) = Profile::of(params) else { return };
    cpu.for_chunks(boundary, |first, boundary| {
        let near = near(bodies, &points[first..first + boundary.len()], profile.range());
        with_lanes!(cpu, simd => {
            for row in (0..boundary.len()).step_by(LANES) {
                let [x, y, z, _] = lanes::load_rows(simd, points, first + row);
                let [mut gx, mut gy, mut gz, mut share] = profile.walls(simd, params, [x, y, z]);
                for body in &near {
                    let [bx, by, bz, own] = profile.body(simd, &bodies[*body], [x, y, z]);
                    (gx, gy, gz, share) = (gx + bx, gy + by, gz + bz, share + own);
                }
                lanes::store_rows(boundary, row, [gx, gy, gz, share]);
            }
        });
    });
}
