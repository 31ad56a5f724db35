//! Spin of the fluid around every particle: the rotation that fits the velocities of its neighbours best.
//!
//! ```text
//! w_i = argmin sum_j u_ij |v_j - v_i - w x (x_j - x_i)|^2
//!     = (sum_j u_ij (r_ij^2 - x_ij x_ij^T))^-1 sum_j u_ij x_ji x (v_j - v_i)
//! ```
//!
//! with the weights u of the viscosity in `sph::strain_rate`, which needs that the fit is the best by just these weights.
//!
//! The matrix is that of the moments of inertia. It is divided by its trace, and `REGULAR` is added to its diagonal. Then it has an
//! inverse for any number of neighbours.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    symmetric::Symmetric,
    grid::neighbors::ChunkLists,
    kernel::declare,
    lanes::{self, LANES, Simd, select},
    params::Params,
    periodic::{Space, with_space},
    vector::{cross, dot, minus, plus, times},
};

declare! {
    needs: [Fluid, StrainRate],
    reads: [FluidPosition, FluidVelocity, FluidNeighbors],
    writes: [FluidSpin],
    oracle: crate::oracle::sph::spin,
    bound: 2e-5,
    twin: [pass(NAME, Fluid)],
    constants: {
        /// Added to moments of inertia over their trace \[1\].
        pub(crate) const REGULAR: f32 = 1.0e-4;
    },
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Fluid { position, velocity, neighbors, spin, .. } = &mut columns.fluid;
    spin.resize(position.len(), [0.0; 4]);
    cpu.for_chunks(&mut spin[..], |first, spin| {
        let lists = neighbors.chunk(first);
        with_space!(cpu, params, simd, space =>
            chunk((simd, space), params, first, (position, velocity), lists, spin));
    });
}

#[inline(always)]
fn chunk<S: Simd>(
    (simd, space): (S, impl Space<S>),
    params: &Params,
    first: usize,
    (position, velocity): (&[[f32; 4]], &[[f32; 4]]),
    lists: &ChunkLists,
    spin: &mut [[f32; 4]],
) {
    let kernel = params.fluid.smoothing.lanes(simd);
    let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
    for row in (0..spin.len()).step_by(LANES) {
        let [x, y, z, _] = lanes::load_rows(simd, position, first + row);
        let [vx, vy, vz, _] = lanes::load_rows(simd, velocity, first + row);
        let mut moment = Symmetric::splat(simd, 0.0);
        let mut turning = [zero; 3];
        for entry in lists.group(row) {
            let [xj, yj, zj, _] = lanes::gather_rows(simd, position, entry);
            let [vxj, vyj, vzj, _] = lanes::gather_rows(simd, velocity, entry);
            let apart = space.apart([x, y, z], [xj, yj, zj]);
            let weighted = times(apart, kernel.closeness(dot(apart, apart)));
            moment.add_square(weighted, apart);
            turning = plus(turning, cross(minus([vxj, vyj, vzj], [vx, vy, vz]), weighted));
        }
        let [xx, yy, zz] = moment.along;
        let trace = xx + yy + zz;
        let has_neighbors = trace.simd_gt(zero);
        // Twice the trace of the moments is that of the moments of inertia.
        let scale = select(has_neighbors, lanes::splat(simd, 0.5) / select(has_neighbors, trace, one), zero);
        let whole = trace * scale + lanes::splat(simd, REGULAR);
        let Symmetric { along: [xx, yy, zz], between: [yz, zx, xy] } = moment.scaled(scale);
        let inertia = Symmetric { along: [whole - xx, whole - yy, whole - zz], between: [-yz, -zx, -xy] };
        let [wx, wy, wz] = inertia.inverse(simd).times(times(turning, scale));
        lanes::store_rows(spin, row, [wx, wy, wz, zero]);
    }
}
