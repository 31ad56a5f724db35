//! Suction: the pressure force with control nodes in place of particles (the paper, sections 3.1 and 3.3).
//!
//! ```text
//! F_i = -V_0 sum_a V_a p_a grad W_ia
//! ```
//!
//! with the control pressure `p_a` below zero, and a support radius of its own.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
};

declare! {
    needs: [Fluid, Sponge],
    reads: [FluidPosition, FluidControls, FluidAcceleration, ControlPosition, ControlSuction],
    writes: [FluidAcceleration],
    oracle: crate::oracle::couple::suction,
    bound: 4e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Fluid { position, controls: lists, acceleration, .. } = &mut columns.fluid;
    let (controls, suction) = (&columns.controls.position, &columns.controls.suction);
    cpu.for_chunks(&mut acceleration[..], |first, acceleration| {
        let lists = lists.chunk(first);
        with_lanes!(cpu, simd => {
            let kernel = params.coupling.lanes(simd);
            let scale = kernel.gradient_scale() * (1.0 / params.fluid.rest_density);
            for row in (0..acceleration.len()).step_by(LANES) {
                let [x, y, z, _] = lanes::load_rows(simd, position, first + row);
                let mut sum = [lanes::splat(simd, 0.0); 3];
                for entry in lists.group(row) {
                    let [xa, ya, za, _] = lanes::gather_rows(simd, controls, entry);
                    let (dx, dy, dz) = (x - xa, y - ya, z - za);
                    let u = kernel.closeness(dx * dx + dy * dy + dz * dz);
                    let pull = lanes::gather(simd, suction, entry) * (u * u * u);
                    sum = [sum[0] + pull * dx, sum[1] + pull * dy, sum[2] + pull * dz];
                }
                let [ax, ay, az, aw] = lanes::load_rows(simd, acceleration, row);
                let total = [ax + sum[0] * scale, ay + sum[1] * scale, az + sum[2] * scale, aw];
                lanes::store_rows(acceleration, row, total);
            }
        });
    });
}
