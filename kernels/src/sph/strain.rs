//! Rates of strain between particles: what their velocities differ by beside the rotation of the fluid.
//!
//! ```text
//! w_i = argmin sum_j u_ij |v_j - v_i - w x (x_j - x_i)|^2                                 spin
//!     = (sum_j u_ij (r_ij^2 - x_ij x_ij^T))^-1 sum_j u_ij x_ji x (v_j - v_i)
//! e_ij = v_j - v_i - (w_i + w_j) / 2 x (x_j - x_i)                                        strain of a pair
//! f_i = 2 mu V / rho_0 sum_j lap W_visc(r_ij) e_ij                                        acceleration
//! ```
//!
//! with the weights `u = 1 - r / H` of that Laplacian. In a smooth flow of constant volume f is that of `sph::forces`, the Laplacian of the
//! velocity: the rotation takes half of it, which the factor 2 gives back. At a free surface it is the stress `mu (grad v + grad v^T)` that
//! vanishes, instead of `mu grad v`. A fluid that turns as a whole feels nothing.
//!
//! Forces are equal and opposite. Because w is the best fit by the same weights, the sum over j of `u_ij x_ij x (v_ji - w_i x x_ji)` is
//! zero for every i. Angular momentum is therefore conserved. The power is `-sum_ij u_ij |v_ji - w_i x x_ji|^2`: never above zero.
//!
//! The matrix of the fit is that of the moments of inertia. It is divided by its trace, and `REGULAR` is added to its diagonal. Then it has
//! an inverse for any number of neighbours. Of the torque of a form without spins, some ten thousandths are left.

use crate::{
    cpu::Cpu,
    grid::neighbors::{ChunkLists, Neighbors},
    lanes::{self, LANES, Simd, select},
    layout::constants,
    params::Params,
    periodic::{Space, with_space},
    symmetric::Symmetric,
    vector::{cross, dot, minus, plus, times},
};

constants! {
    /// Added to moments of inertia over their trace \[1\].
    pub(crate) const REGULAR: f32 = 1.0e-4;
}

/// A field of vectors on the particles: velocities, or others in their place.
#[derive(Clone, Copy)]
pub(super) struct Field<'a> {
    pub(super) position: &'a [[f32; 4]],
    pub(super) vectors: &'a [[f32; 4]],
}

impl Field<'_> {
    /// Spins of all particles.
    pub(super) fn spins(self, cpu: &Cpu, params: &Params, neighbors: &Neighbors, spin: &mut [[f32; 4]]) {
        cpu.for_chunks(spin, |first, spin| {
            let lists = neighbors.chunk(first);
            with_space!(cpu, params, simd, space => self.fit((simd, space), params, first, lists, spin));
        });
    }

    /// Adds the sums of strains to accelerations, times `sign`.
    pub(super) fn add_strains(
        self,
        cpu: &Cpu,
        params: &Params,
        (neighbors, spin): (&Neighbors, &[[f32; 4]]),
        sign: f32,
        acceleration: &mut [[f32; 4]],
    ) {
        cpu.for_chunks(acceleration, |first, acceleration| {
            let lists = neighbors.chunk(first);
            with_space!(cpu, params, simd, space =>
                self.strain((simd, space), params, (first, lists), spin, sign, acceleration));
        });
    }

    #[inline(always)]
    fn fit<S: Simd>(
        self,
        (simd, space): (S, impl Space<S>),
        params: &Params,
        first: usize,
        lists: &ChunkLists,
        spin: &mut [[f32; 4]],
    ) {
        let kernel = params.fluid.smoothing.lanes(simd);
        let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
        for row in (0..spin.len()).step_by(LANES) {
            let [x, y, z, _] = lanes::load_rows(simd, self.position, first + row);
            let [vx, vy, vz, _] = lanes::load_rows(simd, self.vectors, first + row);
            let mut moment = Symmetric::splat(simd, 0.0);
            let mut turning = [zero; 3];
            for entry in lists.group(row) {
                let [xj, yj, zj, _] = lanes::gather_rows(simd, self.position, entry);
                let [vxj, vyj, vzj, _] = lanes::gather_rows(simd, self.vectors, entry);
                let apart = space.apart([x, y, z], [xj, yj, zj]);
                let weighted = times(apart, kernel.closeness(dot(apart, apart)));
                moment.add_square(weighted, apart);
                turning = plus(turning, cross(minus([vxj, vyj, vzj], [vx, vy, vz]), weighted));
            }
            let [xx, yy, zz] = moment.along;
            let trace = xx + yy + zz;
            let has_neighbors = trace.simd_gt(zero);
            // Twice the trace of the moments is that of the moments of inertia.
            let scale =
                select(has_neighbors, lanes::splat(simd, 0.5) / select(has_neighbors, trace, one), zero);
            let whole = trace * scale + lanes::splat(simd, REGULAR);
            let Symmetric { along: [xx, yy, zz], between: [yz, zx, xy] } = moment.scaled(scale);
            let inertia = Symmetric { along: [whole - xx, whole - yy, whole - zz], between: [-yz, -zx, -xy] };
            let [wx, wy, wz] = inertia.inverse(simd).times(times(turning, scale));
            lanes::store_rows(spin, row, [wx, wy, wz, zero]);
        }
    }

    #[inline(always)]
    fn strain<S: Simd>(
        self,
        (simd, space): (S, impl Space<S>),
        params: &Params,
        (first, lists): (usize, &ChunkLists),
        spin: &[[f32; 4]],
        sign: f32,
        acceleration: &mut [[f32; 4]],
    ) {
        let fluid = &params.fluid;
        let kernel = fluid.smoothing.lanes(simd);
        let scale = kernel.viscosity_scale()
            * (sign * 2.0 * fluid.strain_viscosity * fluid.rest_volume() / fluid.rest_density);
        let half = lanes::splat(simd, 0.5);
        for row in (0..acceleration.len()).step_by(LANES) {
            let [x, y, z, _] = lanes::load_rows(simd, self.position, first + row);
            let [vx, vy, vz, _] = lanes::load_rows(simd, self.vectors, first + row);
            let [wx, wy, wz, _] = lanes::load_rows(simd, spin, first + row);
            let mut sum = [lanes::splat(simd, 0.0); 3];
            for entry in lists.group(row) {
                let [xj, yj, zj, _] = lanes::gather_rows(simd, self.position, entry);
                let [vxj, vyj, vzj, _] = lanes::gather_rows(simd, self.vectors, entry);
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
}
