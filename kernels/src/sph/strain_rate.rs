//! Viscosity by the rate of strain: what neighbours move relative to each other beside the rotation of the fluid.
//!
//! ```text
//! a_i += 2 mu V / rho_0 sum_j lap W_visc(r_ij) (v_j - v_i - (w_i + w_j) / 2 x (x_j - x_i))
//! ```
//!
//! with the spins w of `sph::spin`. In a smooth flow of constant volume the sum is that of `sph::forces`, the Laplacian of the velocity:
//! the rotation takes half of it, which the factor 2 gives back. At a free surface it is the stress `mu (grad v + grad v^T)` that
//! vanishes there, instead of `mu grad v`. A fluid that turns as a whole feels nothing.
//!
//! Forces are equal and opposite. Because w is the best fit by the same weights, the sum over i of `sum_j u_ij x_ij x (..)` is zero for
//! every i, so that angular momentum is conserved. The power is `-sum_ij u_ij |v_j - v_i - w_i x (x_j - x_i)|^2`: never above zero.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    grid::neighbors::ChunkLists,
    kernel::declare,
    lanes::{self, LANES, Simd},
    params::Params,
    periodic::{Space, with_space},
    vector::{cross, dot, minus, plus, times},
};

declare! {
    needs: [Fluid, StrainRate],
    reads: [FluidPosition, FluidVelocity, FluidNeighbors, FluidSpin, FluidAcceleration],
    writes: [FluidAcceleration],
    oracle: crate::oracle::sph::strain_rate,
    bound: 2e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Fluid { position, velocity, neighbors, spin, acceleration, .. } = &mut columns.fluid;
    cpu.for_chunks(&mut acceleration[..], |first, acceleration| {
        let lists = neighbors.chunk(first);
        with_space!(cpu, params, simd, space =>
            chunk((simd, space), params, first, (position, velocity, spin), lists, acceleration));
    });
}

#[inline(always)]
fn chunk<S: Simd>(
    (simd, space): (S, impl Space<S>),
    params: &Params,
    first: usize,
    (position, velocity, spin): (&[[f32; 4]], &[[f32; 4]], &[[f32; 4]]),
    lists: &ChunkLists,
    acceleration: &mut [[f32; 4]],
) {
    let fluid = &params.fluid;
    let kernel = fluid.smoothing.lanes(simd);
    let scale = kernel.viscosity_scale() * (2.0 * fluid.strain_viscosity * fluid.rest_volume() / fluid.rest_density);
    let half = lanes::splat(simd, 0.5);
    for row in (0..acceleration.len()).step_by(LANES) {
        let [x, y, z, _] = lanes::load_rows(simd, position, first + row);
        let [vx, vy, vz, _] = lanes::load_rows(simd, velocity, first + row);
        let [wx, wy, wz, _] = lanes::load_rows(simd, spin, first + row);
        let mut sum = [lanes::splat(simd, 0.0); 3];
        for entry in lists.group(row) {
            let [xj, yj, zj, _] = lanes::gather_rows(simd, position, entry);
            let [vxj, vyj, vzj, _] = lanes::gather_rows(simd, velocity, entry);
            let [wxj, wyj, wzj, _] = lanes::gather_rows(simd, spin, entry);
            let apart = space.apart([x, y, z], [xj, yj, zj]);
            let turned = cross(apart, times(plus([wx, wy, wz], [wxj, wyj, wzj]), half));
            let strained = minus(minus([vxj, vyj, vzj], [vx, vy, vz]), turned);
            sum = plus(sum, times(strained, kernel.closeness(dot(apart, apart))));
        }
        let viscous = times(sum, scale);
        let [ax, ay, az, aw] = lanes::load_rows(simd, acceleration, row);
        lanes::store_rows(acceleration, row, [ax + viscous[0], ay + viscous[1], az + viscous[2], aw]);
    }
}
