//! What the material of a sponge counts for in the divergence at a particle, by the corners of its tet.
//!
//! ```text
//! -div_i = sum_a c_ia (w_a - w_i) . L_i (x_i - x_a)         images of the nodes in walls included
//!        = w_i . q_i - sum_k w_k . g_ik
//! q_i  = L_i sum_a c_ia e_ia
//! g_ik = b_k sum_m R_m L_i z_m + Q_i grad b_k,   Q_i = sum_m R_m L_i (z_m d_m^T + M_m R_m)
//! ```
//!
//! with the velocity linear in the tet, `w_a = sum_k (b_k + grad b_k . (x_a - x_i)) w_k`. The sums `z_m` and `M_m` are those of
//! `tets::moments` over the images by mirror m, which turns vectors by `R_m`. `d_m` is the way from the particle to its own image.

use super::rows::load;
use crate::{
    columns::{Columns, Fluid},
    couple::solid_mirrors::Mirrors,
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
    symmetric::Symmetric,
    vector::{dot, minus, plus, times},
};

declare! {
    needs: [Fluid, Sponge, Divergence, Porous, Barycentric],
    reads: [
        FluidPosition, FluidControls, FluidShares, FluidRenormalisation, FluidRenormalisationBetween, ControlPosition,
        ControlMaterial,
    ],
    writes: [FluidShares, FluidPushed],
    oracle: crate::oracle::tets::flux,
    bound: 2e-5,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(smoothing) = &params.solid else { return };
    let controls = &columns.controls;
    let Fluid { position, controls: lists, shares, pushed, renormalisation, renormalisation_between, .. } =
        &mut columns.fluid;
    pushed.resize(position.len(), [0.0; 4]);
    cpu.for_chunks((&mut shares.0[..], &mut pushed[..]), |first, (shares, pushed)| {
        let lists = lists.chunk(first);
        with_lanes!(cpu, simd => {
            let kernel = smoothing.lanes(simd);
            let zero = lanes::splat(simd, 0.0);
            for row in (0..pushed.len()).step_by(LANES) {
                let group = lists.group(row);
                if group.is_empty() {
                    pushed[row..row + LANES].fill([0.0; 4]);
                    continue;
                }
                let [x, y, z, _] = lanes::load_rows(simd, position, first + row);
                let [xx, yy, zz, _] = lanes::load_rows(simd, renormalisation, first + row);
                let [yz, zx, xy, _] = lanes::load_rows(simd, renormalisation_between, first + row);
                let inverse = Symmetric { along: [xx, yy, zz], between: [yz, zx, xy] };
                let mut corners = [[zero; 4]; 4];
                for (corner, rows) in corners.iter_mut().enumerate() {
                    *rows = load(simd, shares, row, corner);
                }
                let mut own = [[zero; 3]; 4];
                let mut received = [zero; 3];
                let mirrors = Mirrors::near(params, &position[first + row..][..LANES]);
                for mirror in mirrors.iter() {
                    let mut sum = [zero; 3];
                    let mut second = Symmetric::splat(simd, 0.0);
                    for entry in group {
                        let [xa, ya, za, _] = lanes::gather_rows(simd, &controls.position, entry);
                        let [_, _, _, volume] = lanes::gather_rows(simd, &controls.material, entry);
                        let offset = minus(mirror.image(simd, [xa, ya, za]), [x, y, z]);
                        let u = kernel.closeness(dot(offset, offset));
                        let push = times(offset, volume * (u * u * u));
                        sum = plus(sum, push);
                        second.add_square(push, offset);
                    }
                    let push = inverse.times(sum);
                    received = plus(received, push);
                    let way = minus(mirror.image(simd, [x, y, z]), [x, y, z]);
                    for (own, [gx, gy, gz, weight]) in own.iter_mut().zip(corners) {
                        let gradient = [gx, gy, gz];
                        let part = times(push, weight + dot(gradient, way));
                        let turned = inverse.times(second.times(mirror.turned(gradient)));
                        *own = plus(*own, mirror.turned(plus(part, turned)));
                    }
                }
                let scale = kernel.gradient_scale();
                let [qx, qy, qz] = times(received, scale);
                lanes::store_rows(pushed, row, [qx, qy, qz, zero]);
                let mut weights = [zero; 4];
                let mut sum = zero;
                for (weight, [_, _, _, linear]) in weights.iter_mut().zip(corners) {
                    *weight = lanes::positive(simd, linear);
                    sum += *weight;
                }
                let inside = sum.simd_gt(zero);
                let inverse = lanes::splat(simd, 1.0) / lanes::select(inside, sum, lanes::splat(simd, 1.0));
                for (corner, (own, weight)) in own.into_iter().zip(weights).enumerate() {
                    let ([gx, gy, gz], weight) = (times(own, scale), weight * inverse);
                    let (gx, gy, gz, weight) = (gx.to_array(), gy.to_array(), gz.to_array(), weight.to_array());
                    for lane in 0..LANES {
                        shares[row + lane][corner] = [gx[lane], gy[lane], gz[lane], weight[lane]];
                    }
                }
            }
        });
    });
}
