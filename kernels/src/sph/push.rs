//! Pressure of particles against walls and bodies through their boundary volume fraction.

use crate::{
    body::{Body, Wrench},
    lanes::{self, LANES, Simd, f32x8},
    params::Params,
};

use super::obstacles::{Profile, near};

/// Kinematic pressures of particles \[m^2/s^2\]; negative ones draw to the surface.
pub(super) trait Pressures: Sync {
    /// Those of eight rows.
    fn at<S: Simd>(&self, simd: S, row: usize) -> f32x8<S>;
}

/// What walls and bodies do to particles of such pressures.
pub(super) struct Push<'a, P> {
    pub(super) params: &'a Params,
    pub(super) profile: Profile,
    pub(super) bodies: &'a [Body],
    pub(super) position: &'a [[f32; 4]],
    /// Rows in use: padding rows lie far away, where a plane may be solid.
    pub(super) count: usize,
    pub(super) pressures: P,
}

impl<P: Pressures> Push<'_, P> {
    /// `a_i -= P_i grad lambda_i`, and `m h P_i grad lambda_ik` to the bodies.
    #[inline(always)]
    pub(super) fn chunk<S: Simd>(
        &self,
        simd: S,
        first: usize,
        acceleration: &mut [[f32; 4]],
        wrenches: &mut [Wrench],
    ) {
        let near = near(self.bodies, &self.position[first..first + acceleration.len()], self.profile.range());
        let fluid = &self.params.fluid;
        for row in (0..acceleration.len()).step_by(LANES) {
            let [x, y, z, _] = lanes::load_rows(simd, self.position, first + row);
            let pressure = self.pressures.at(simd, first + row);
            let point = [x, y, z];
            let [mut gx, mut gy, mut gz, _] = self.profile.walls(simd, self.params, point);
            let momentum = (pressure * (fluid.particle_mass * self.params.step)).to_array();
            let used = self.count.saturating_sub(first + row).min(LANES);
            for body in &near {
                let [bx, by, bz, _] = self.profile.body(simd, &self.bodies[*body], point);
                (gx, gy, gz) = (gx + bx, gy + by, gz + bz);
                let wrench = &mut wrenches[*body];
                self.profile.react(simd, &self.bodies[*body], point, &momentum[..used], wrench);
            }
            let [ax, ay, az, aw] = lanes::load_rows(simd, acceleration, row);
            let sum = [ax - pressure * gx, ay - pressure * gy, az - pressure * gz, aw];
            lanes::store_rows(acceleration, row, sum);
        }
    }
}
