//! Surface tension from the colour field \[MCG03, eqs. 15 to 19\].
//!
//! ```text
//! n = sum_j V_j grad W_ij,   a_i -= sigma / rho_i (sum_j V_j lap W_ij) n / |n|   where |n| H > 1
//! ```
//!
//! These are no pair forces: momentum is conserved only on average.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    grid::neighbors::ChunkLists,
    kernel::declare,
    lanes::{self, LANES, Simd, select},
    params::Params,
    periodic::{Space, with_space},
    vector::{dot, times},
};

declare! {
    needs: [Fluid, SurfaceTension],
    reads: [FluidPosition, FluidVelocity, FluidNeighbors, FluidAcceleration],
    writes: [FluidAcceleration],
    oracle: crate::oracle::sph::surface_tension,
    bound: 1e-5,
    twin: [pass(NAME, Fluid)],
    constants: {
        /// Length of the normal times the support radius below which a particle is not at the surface.
        const SURFACE_THRESHOLD: f32 = 1.0;
    },
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Fluid { position, velocity, neighbors, acceleration, .. } = &mut columns.fluid;
    cpu.for_chunks(&mut acceleration[..], |first, acceleration| {
        let lists = neighbors.chunk(first);
        with_space!(cpu, params, simd, space =>
            chunk((simd, space), params, first, (position, velocity), lists, acceleration));
    });
}

#[inline(always)]
fn chunk<S: Simd>(
    (simd, space): (S, impl Space<S>),
    params: &Params,
    first: usize,
    (position, velocity): (&[[f32; 4]], &[[f32; 4]]),
    lists: &ChunkLists,
    acceleration: &mut [[f32; 4]],
) {
    let fluid = &params.fluid;
    let kernel = fluid.smoothing.lanes(simd);
    let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
    let threshold = SURFACE_THRESHOLD / fluid.smoothing.support_radius;
    for row in (0..acceleration.len()).step_by(LANES) {
        let [x, y, z, _] = lanes::load_rows(simd, position, first + row);
        let [_, _, _, volume] = lanes::load_rows(simd, velocity, first + row);
        let mut normal = [zero; 3];
        let mut laplacian = zero;
        for entry in lists.group(row) {
            let [xj, yj, zj, _] = lanes::gather_rows(simd, position, entry);
            let [_, _, _, volume_j] = lanes::gather_rows(simd, velocity, entry);
            let [dx, dy, dz] = space.apart([x, y, z], [xj, yj, zj]);
            let u = kernel.closeness(dx * dx + dy * dy + dz * dz);
            let weight = volume_j * u * u;
            let slope = weight * u;
            normal = [normal[0] - slope * dx, normal[1] - slope * dy, normal[2] - slope * dz];
            laplacian -= weight * (u + u - one);
        }
        let normal = times(normal, kernel.gradient_scale());
        let length = dot(normal, normal).sqrt();
        let at_surface = length.simd_gt(lanes::splat(simd, threshold));
        let strength =
            laplacian * kernel.laplacian_scale() * volume * (fluid.surface_tension / fluid.particle_mass);
        let strength = select(at_surface, strength / select(at_surface, length, one), zero);
        let [ax, ay, az, aw] = lanes::load_rows(simd, acceleration, row);
        let sum = [ax - strength * normal[0], ay - strength * normal[1], az - strength * normal[2], aw];
        lanes::store_rows(acceleration, row, sum);
    }
}
