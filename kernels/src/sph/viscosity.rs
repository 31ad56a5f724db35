//! The matrix of the implicit viscosity between pairs, for a group of rows.
//!
//! ```text
//! D_i(v) = mu V / rho_0 sum_j lap W_visc(r_ij) (v_i - v_j)
//!        + 10 mu_c V / rho_0 sum_j (v_i - v_j) . x_ij / (r_ij^2 + 0.0025 H^2) x_ij (-dW/dr) / r_ij
//! ```
//!
//! These are the viscous accelerations of `sph::forces` at rest density, `V = m / rho_0`, with the opposite sign. The matrix
//! is symmetric positive semidefinite, and the two particles of a pair have opposite contributions.

use crate::{
    lanes::{self, LANES, Simd, f32x8},
    params::Params,
    periodic::Space,
    smoothing::WendlandLanes,
    vector::{Vec3x8, plus, times},
};

/// `D` with its precomputed factors.
pub(super) struct Pairs<'a, S: Simd, P: Space<S>> {
    simd: S,
    space: P,
    kernel: WendlandLanes<S>,
    scale: f32x8<S>,
    central_scale: f32x8<S>,
    softening: f32x8<S>,
    has_pairs: bool,
    position: &'a [[f32; 4]],
}

impl<'a, S: Simd, P: Space<S>> Pairs<'a, S, P> {
    /// Over particles at `position`; zero where viscosity is explicit.
    #[inline(always)]
    pub(super) fn new((simd, space): (S, P), params: &Params, position: &'a [[f32; 4]]) -> Self {
        let fluid = &params.fluid;
        let (viscosity, central) = fluid
            .implicit_viscosity
            .map_or((0.0, 0.0), |implicit| (implicit.viscosity, implicit.central_viscosity));
        let (kernel, volume) = (fluid.smoothing.lanes(simd), fluid.rest_volume());
        Self {
            simd,
            space,
            kernel,
            scale: kernel.viscosity_scale() * (viscosity * volume / fluid.rest_density),
            central_scale: kernel.gradient_scale() * (10.0 * central * volume / fluid.rest_density),
            softening: lanes::splat(simd, fluid.smoothing.softening()),
            has_pairs: viscosity + central > 0.0,
            position,
        }
    }

    /// `D` of vectors, for eight rows from `first` with their lists.
    #[inline(always)]
    pub(super) fn of(&self, vectors: &[[f32; 4]], first: usize, list: &[[u32; LANES]]) -> Vec3x8<S> {
        let [x, y, z, _] = lanes::load_rows(self.simd, self.position, first);
        let [vx, vy, vz, _] = lanes::load_rows(self.simd, vectors, first);
        let zero = lanes::splat(self.simd, 0.0);
        let (mut all, mut central) = ([zero; 3], [zero; 3]);
        // All viscosity may be by the rate of strain.
        let list = if self.has_pairs { list } else { &[] };
        for entry in list {
            let [xj, yj, zj, _] = lanes::gather_rows(self.simd, self.position, entry);
            let [vxj, vyj, vzj, _] = lanes::gather_rows(self.simd, vectors, entry);
            let [dx, dy, dz] = self.space.apart([x, y, z], [xj, yj, zj]);
            let square = dx * dx + dy * dy + dz * dz;
            let u = self.kernel.closeness(square);
            let (wx, wy, wz) = (vx - vxj, vy - vyj, vz - vzj);
            all = [all[0] + u * wx, all[1] + u * wy, all[2] + u * wz];
            let along = (wx * dx + wy * dy + wz * dz) / (square + self.softening);
            let pull = u * u * u * along;
            central = [central[0] + pull * dx, central[1] + pull * dy, central[2] + pull * dz];
        }
        plus(times(all, self.scale), times(central, self.central_scale))
    }
}
