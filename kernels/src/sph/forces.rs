//! Acceleration by gravity, pressure \[M92, eq. 3.3\] and viscosity \[MCG03, eq. 14, made symmetric\].
//!
//! ```text
//! a_i = g - sum_j m (p_i / rho_i^2 + p_j / rho_j^2) grad W_ij
//!         + mu / rho_i sum_j V_j (v_j - v_i) lap W_visc(r_ij)
//! ```
//!
//! Both sums are equal and opposite for the two particles of a pair.

use crate::{
    columns::{Column::*, Columns, Fluid},
    cpu::Cpu,
    grid::neighbors::ChunkLists,
    kernel::{Kernel, Need},
    lanes::{self, LANES, Simd, with_lanes},
    params::Params,
    vector::{self, plus, times},
};

/// `sph::forces`.
pub static KERNEL: Kernel = Kernel {
    name: "sph::forces",
    needs: &[Need::Fluid],
    reads: &[FluidPosition, FluidVelocity, FluidNeighbors],
    writes: &[FluidAcceleration],
    cpu,
};

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Fluid { position, velocity, neighbors, acceleration, .. } = &mut columns.fluid;
    acceleration.resize(position.len(), [0.0; 4]);
    cpu.for_chunks(&mut acceleration[..], |first, acceleration| {
        let lists = neighbors.chunk(first);
        with_lanes!(cpu, simd => chunk(simd, params, first, (position, velocity), lists, acceleration));
    });
}

#[inline(always)]
fn chunk<S: Simd>(
    simd: S,
    params: &Params,
    first: usize,
    (position, velocity): (&[[f32; 4]], &[[f32; 4]]),
    lists: &ChunkLists,
    acceleration: &mut [[f32; 4]],
) {
    let fluid = &params.fluid;
    let kernel = fluid.smoothing.lanes(simd);
    let pressure_scale = kernel.gradient_scale() * fluid.particle_mass;
    // mu / rho_i = mu V_i / m.
    let viscosity_scale = kernel.viscosity_scale() * (fluid.viscosity / fluid.particle_mass);
    let gravity = vector::splat(simd, params.gravity.to_array());
    for row in (0..acceleration.len()).step_by(LANES) {
        let [x, y, z, p] = lanes::load_rows(simd, position, first + row);
        let [vx, vy, vz, volume] = lanes::load_rows(simd, velocity, first + row);
        let zero = lanes::splat(simd, 0.0);
        let mut pressure = [zero; 3];
        let mut viscosity = [zero; 3];
        for entry in lists.group(row) {
            let [xj, yj, zj, pj] = lanes::gather_rows(simd, position, entry);
            let [vxj, vyj, vzj, volume_j] = lanes::gather_rows(simd, velocity, entry);
            let (dx, dy, dz) = (x - xj, y - yj, z - zj);
            let u = kernel.closeness(dx * dx + dy * dy + dz * dz);
            let push = (p + pj) * (u * u * u);
            pressure = [pressure[0] + push * dx, pressure[1] + push * dy, pressure[2] + push * dz];
            let pull = volume_j * u;
            viscosity = [
                viscosity[0] + pull * (vxj - vx),
                viscosity[1] + pull * (vyj - vy),
                viscosity[2] + pull * (vzj - vz),
            ];
        }
        let viscosity_scale = viscosity_scale * volume;
        let sum = plus(plus(times(pressure, pressure_scale), times(viscosity, viscosity_scale)), gravity);
        lanes::store_rows(acceleration, row, [sum[0], sum[1], sum[2], zero]);
    }
}
