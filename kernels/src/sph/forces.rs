//! Acceleration by gravity, pressure \[M92, eq. 3.3\] and viscosity \[MCG03, eq. 14, made symmetric; M92, eq. 4.1\].
//!
//! ```text
//! a_i = g - sum_j m (p_i / rho_i^2 + p_j / rho_j^2) grad W_ij
//!         + mu / rho_i sum_j V_j (v_j - v_i) lap W_visc(r_ij)
//!         + 10 mu_c / rho_i sum_j V_j (v_j - v_i) . x_ij / (r_ij^2 + 0.0025 H^2) x_ij (-dW/dr) / r_ij
//! ```
//!
//! All sums are equal and opposite for the two particles of a pair. The first and the last act along the line between them,
//! which conserves angular momentum as well.
//!
//! The fourth lane of the result is the compression that the pressure stabilisation permits (see `sph::factors`). It is that
//! beyond water at rest, over pairs in which both have a pressure:
//!
//! ```text
//! w_i = e sum_j c_ij (q_j - q_i),   q = P - g . x,   P = rho_0 p / rho^2,   c_ij = V_0 (-dW/dr) / r
//! ```

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    grid::neighbors::ChunkLists,
    kernel::declare,
    lanes::{self, LANES, Simd},
    params::Params,
    periodic::{Space, with_space},
    vector::{self, plus, times},
};

declare! {
    needs: [Fluid],
    reads: [FluidPosition, FluidVelocity, FluidNeighbors],
    writes: [FluidAcceleration],
    oracle: crate::oracle::sph::forces,
    bound: 2e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Fluid { position, velocity, neighbors, acceleration, .. } = &mut columns.fluid;
    acceleration.resize(position.len(), [0.0; 4]);
    cpu.for_chunks(&mut acceleration[..], |first, acceleration| {
        let lists = neighbors.chunk(first);
        // A solve for the divergence has all of the pressure.
        if params.fluid.divergence().is_some() {
            with_space!(cpu, params, simd, space =>
                chunk::<_, false>((simd, space), params, first, (position, velocity), lists, acceleration));
        } else {
            with_space!(cpu, params, simd, space =>
                chunk::<_, true>((simd, space), params, first, (position, velocity), lists, acceleration));
        }
    });
}

#[inline(always)]
fn chunk<S: Simd, const PRESSURE: bool>(
    (simd, space): (S, impl Space<S>),
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
    let central_scale = kernel.gradient_scale() * (10.0 * fluid.central_viscosity / fluid.particle_mass);
    let softening = lanes::splat(simd, fluid.smoothing.softening());
    let gravity = vector::splat(simd, params.gravity.to_array());
    let weight = times(gravity, lanes::splat(simd, 1.0 / fluid.rest_density));
    let roughness_scale = pressure_scale * fluid.roughness;
    // With a pressure solve particles keep their volume, and the fourth lane of the velocity has another quantity.
    let is_known = fluid.incompressible.is_some();
    let has_pairs = PRESSURE || fluid.viscosity + fluid.central_viscosity > 0.0;
    let rest_volume = lanes::splat(simd, fluid.rest_volume());
    for row in (0..acceleration.len()).step_by(LANES) {
        let [x, y, z, p] = lanes::load_rows(simd, position, first + row);
        let [vx, vy, vz, volume] = lanes::load_rows(simd, velocity, first + row);
        let volume = if is_known { rest_volume } else { volume };
        let zero = lanes::splat(simd, 0.0);
        let mut pressure = [zero; 3];
        let mut viscosity = [zero; 3];
        let mut central = [zero; 3];
        let mut roughness = zero;
        for entry in if has_pairs { lists.group(row) } else { &[] } {
            let [xj, yj, zj, pj] = lanes::gather_rows(simd, position, entry);
            let [vxj, vyj, vzj, volume_j] = lanes::gather_rows(simd, velocity, entry);
            let [dx, dy, dz] = space.apart([x, y, z], [xj, yj, zj]);
            let square = dx * dx + dy * dy + dz * dz;
            let u = kernel.closeness(square);
            let cube = u * u * u;
            if PRESSURE {
                let push = (p + pj) * cube;
                pressure = [pressure[0] + push * dx, pressure[1] + push * dy, pressure[2] + push * dz];
                let beyond = pj - p + (weight[0] * dx + weight[1] * dy + weight[2] * dz);
                roughness += lanes::select(p.min(pj).simd_gt(zero), cube * beyond, zero);
            }
            let volume_j = if is_known { rest_volume } else { volume_j };
            let pull = volume_j * u;
            let (wx, wy, wz) = (vxj - vx, vyj - vy, vzj - vz);
            viscosity = [viscosity[0] + pull * wx, viscosity[1] + pull * wy, viscosity[2] + pull * wz];
            let pull = volume_j * cube * (wx * dx + wy * dy + wz * dz) / (square + softening);
            central = [central[0] + pull * dx, central[1] + pull * dy, central[2] + pull * dz];
        }
        let viscosity = times(viscosity, viscosity_scale * volume);
        let central = times(central, central_scale * volume);
        let sum = plus(plus(plus(times(pressure, pressure_scale), viscosity), central), gravity);
        lanes::store_rows(acceleration, row, [sum[0], sum[1], sum[2], roughness * roughness_scale]);
    }
}
