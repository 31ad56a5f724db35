//! Solid volume fraction around a particle, at the expected positions at the end of the step.
//!
//! ```text
//! lambda_i += sum_a V_s W(x*_i - x*_a),   V_s = (1 - phi) V_a
//! ```
//!
//! added to the boundary volume fraction of walls and bodies (`sph::boundary`), so that the pressure solve treats both
//! alike.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
};

declare! {
    needs: [Fluid, Sponge, Incompressible, Porous],
    reads: [FluidPredicted, FluidControls, FluidBoundary, ControlSolid],
    writes: [FluidBoundary],
    oracle: crate::oracle::porous::solid_share,
    bound: 5e-5,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(smoothing) = &params.solid else { return };
    let Fluid { predicted, controls: lists, boundary, .. } = &mut columns.fluid;
    let solid = &columns.controls.solid;
    cpu.for_chunks(&mut boundary[..], |first, boundary| {
        let lists = lists.chunk(first);
        with_lanes!(cpu, simd => {
            let kernel = smoothing.lanes(simd);
            let (value, gradient) = (kernel.value_scale(), kernel.gradient_scale());
            for row in (0..boundary.len()).step_by(LANES) {
                let [x, y, z, _] = lanes::load_rows(simd, predicted, first + row);
                let mut slope = [lanes::splat(simd, 0.0); 3];
                let mut share = lanes::splat(simd, 0.0);
                for entry in lists.group(row) {
                    let [xa, ya, za, volume] = lanes::gather_rows(simd, solid, entry);
                    let (dx, dy, dz) = (x - xa, y - ya, z - za);
                    let u = kernel.closeness(dx * dx + dy * dy + dz * dz);
                    let c = volume * (u * u * u);
                    slope = [slope[0] + c * dx, slope[1] + c * dy, slope[2] + c * dz];
                    share += volume * kernel.shape(u);
                }
                let [gx, gy, gz, before] = lanes::load_rows(simd, boundary, row);
                let total = [
                    gx - slope[0] * gradient,
                    gy - slope[1] * gradient,
                    gz - slope[2] * gradient,
                    before + share * value,
                ];
                lanes::store_rows(boundary, row, total);
            }
        });
    });
}
