//! Iteration of the pressure solve with sponges: velocities with the drag, and the material that flows past them.
//!
//! ```text
//! w_i <- b_i w_i + (1 - b_i) sum_a w_ia w_a
//! -div_i = sum_a c_ia (w_a - w_i) . L_i (x_i - x_a)        images of the nodes in walls included
//!        = L_i : sum_a c_ia w_a (x_i - x_a)^T - w_i . L_i sum_a c_ia (x_i - x_a)
//! ```
//!
//! The divergence of water and material together is that of `phi v + (1 - phi) u`. With the drag outside of the solve, it would take
//! back what the pressure gives, and water would be left in pores that close (docs/porous.md).

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
    symmetric::Symmetric,
    vector::{dot, minus, plus, times},
};

use super::{impulses::weight_inside, solid_mirrors::Mirrors};

declare! {
    needs: [Fluid, Sponge, Divergence, Porous, Smoothed],
    reads: [
        FluidPosition, FluidCorrection, FluidControls, FluidControlWeights, FluidMobility,
        FluidRenormalisation, FluidRenormalisationBetween, ControlPosition, ControlSolved,
    ],
    writes: [FluidCorrection],
    oracle: crate::oracle::solid::velocity,
    bound: 1e-5,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(smoothing) = &params.solid else { return };
    let controls = &columns.controls;
    let Fluid {
        position,
        correction,
        controls: lists,
        control_weights,
        mobility,
        renormalisation,
        renormalisation_between,
        ..
    } = &mut columns.fluid;
    cpu.for_chunks(&mut correction[..], |first, correction| {
        let (lists, weights) = (lists.chunk(first), control_weights.chunk(first));
        with_lanes!(cpu, simd => {
            let kernel = smoothing.lanes(simd);
            let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
            for row in (0..correction.len()).step_by(LANES) {
                let group = lists.group(row);
                if group.is_empty() {
                    continue;
                }
                let [x, y, z, _] = lanes::load_rows(simd, position, first + row);
                let [vx, vy, vz, _] = lanes::load_rows(simd, correction, row);
                let mirrors = Mirrors::near(params, &position[first + row..][..LANES]);
                let (mut mean, mut chi, mut moment) = ([zero; 3], zero, [zero; 3]);
                let mut sums = Symmetric::splat(simd, 0.0);
                for (entry, weight) in group.iter().zip(&weights[lists.range(row)]) {
                    let [xa, ya, za, _] = lanes::gather_rows(simd, &controls.position, entry);
                    let [ux, uy, uz, volume] = lanes::gather_rows(simd, &controls.solved, entry);
                    let weight = lanes::load_array(simd, weight);
                    mean = plus(mean, times([ux, uy, uz], weight));
                    chi += weight;
                    for mirror in mirrors.iter() {
                        let apart = minus([x, y, z], mirror.image(simd, [xa, ya, za]));
                        let u = kernel.closeness(dot(apart, apart));
                        let push = times(apart, volume * (u * u * u));
                        moment = plus(moment, push);
                        sums.add_twice(mirror.turned([ux, uy, uz]), push);
                    }
                }
                let [mobility, ..] = lanes::load_rows(simd, mobility, first + row);
                let drawn = (one - mobility) * weight_inside(simd, chi);
                let own = plus(times([vx, vy, vz], mobility), times(mean, drawn));
                sums.add_twice(own, minus([zero; 3], moment));
                let [xx, yy, zz, _] = lanes::load_rows(simd, renormalisation, first + row);
                let [yz, zx, xy, _] = lanes::load_rows(simd, renormalisation_between, first + row);
                let rate = dot(sums.along, [xx, yy, zz]) + dot(sums.between, [yz, zx, xy]);
                let rate = rate * kernel.gradient_scale();
                lanes::store_rows(correction, row, [own[0], own[1], own[2], rate]);
            }
        });
    });
}
