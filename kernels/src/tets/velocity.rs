//! Iteration of the pressure solve with sponges: velocities with the drag, and the material that flows past them.
//!
//! ```text
//! w_i <- b_i w_i + (1 - b_i) sum_k b_ik w_k
//! -div_i = w_i . q_i - sum_k w_k . g_ik                    by the material
//! ```
//!
//! as in `couple::solid_velocity`, by the corners of the tet of a particle.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
    vector::{dot, plus, times},
};

declare! {
    needs: [Fluid, Sponge, Divergence, Porous, Barycentric],
    reads: [FluidCorrection, FluidCorners, FluidShares, FluidPushed, ControlSolved],
    writes: [FluidCorrection],
    oracle: crate::oracle::tets::velocity,
    bound: 1e-5,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, _: &Params, columns: &mut Columns) {
    let solved = &columns.controls.solved;
    let Fluid { correction, corners, shares, pushed, .. } = &mut columns.fluid;
    cpu.for_chunks(&mut correction[..], |first, correction| {
        with_lanes!(cpu, simd => {
            let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
            for row in (0..correction.len()).step_by(LANES) {
                if corners.are_outside(first + row) {
                    continue;
                }
                let (mut mean, mut rate) = ([zero; 3], zero);
                for corner in 0..4 {
                    let [ux, uy, uz, _] = lanes::gather_rows(simd, solved, &corners.entry(first + row, corner));
                    let [gx, gy, gz, weight] = shares.load(simd, first + row, corner);
                    mean = plus(mean, times([ux, uy, uz], weight));
                    rate -= dot([ux, uy, uz], [gx, gy, gz]);
                }
                let [vx, vy, vz, _] = lanes::load_rows(simd, correction, row);
                let [qx, qy, qz, mobility] = lanes::load_rows(simd, pushed, first + row);
                let own = plus(times([vx, vy, vz], mobility), times(mean, one - mobility));
                lanes::store_rows(correction, row, [own[0], own[1], own[2], rate + dot(own, [qx, qy, qz])]);
            }
        });
    });
}
