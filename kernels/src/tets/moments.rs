//! The material of sponges in the neighbourhoods of the particles, once a step.
//!
//! ```text
//! c_ia = V_s (-dW/dr) / r,   e_ia = x_a - x_i              images of the nodes in walls included
//! z_i = sum_a c_ia e_ia,   M_i = sum_a c_ia e_ia e_ia^T,   lambda_i = sum_a V_s W_ia
//! ```

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
    reads: [FluidPosition, FluidControls, ControlPosition, ControlMaterial],
    writes: [FluidMoment, FluidRenormalisation, FluidRenormalisationBetween],
    oracle: crate::oracle::tets::moments,
    bound: 2e-5,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(smoothing) = &params.solid else { return };
    let controls = &columns.controls;
    let Fluid {
        position,
        controls: lists,
        moment,
        renormalisation: along,
        renormalisation_between: between,
        ..
    } = &mut columns.fluid;
    for column in [&mut *moment, along, between] {
        column.resize(position.len(), [0.0; 4]);
    }
    let rows = (&mut moment[..], &mut along[..], &mut between[..]);
    cpu.for_chunks(rows, |first, (moment, along, between)| {
        let lists = lists.chunk(first);
        with_lanes!(cpu, simd => {
            let kernel = smoothing.lanes(simd);
            let zero = lanes::splat(simd, 0.0);
            for row in (0..moment.len()).step_by(LANES) {
                let group = lists.group(row);
                if group.is_empty() {
                    [&mut *moment, along, between].into_iter().for_each(|rows| rows[row..row + LANES].fill([0.0; 4]));
                    continue;
                }
                let [x, y, z, _] = lanes::load_rows(simd, position, first + row);
                let mirrors = Mirrors::near(params, &position[first + row..][..LANES]);
                let (mut sum, mut share) = ([zero; 3], zero);
                let mut second = Symmetric::splat(simd, 0.0);
                for entry in group {
                    let [xa, ya, za, _] = lanes::gather_rows(simd, &controls.position, entry);
                    let [_, _, _, volume] = lanes::gather_rows(simd, &controls.material, entry);
                    for mirror in mirrors.iter() {
                        let offset = minus(mirror.image(simd, [xa, ya, za]), [x, y, z]);
                        let u = kernel.closeness(dot(offset, offset));
                        let push = times(offset, volume * kernel.gradient_scale() * (u * u * u));
                        sum = plus(sum, push);
                        second.add_square(push, offset);
                        share += volume * kernel.shape(u);
                    }
                }
                let ([xx, yy, zz], [yz, zx, xy]) = (second.along, second.between);
                lanes::store_rows(moment, row, [sum[0], sum[1], sum[2], share * kernel.value_scale()]);
                lanes::store_rows(along, row, [xx, yy, zz, zero]);
                lanes::store_rows(between, row, [yz, zx, xy, zero]);
            }
        });
    });
}
