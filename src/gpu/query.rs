//! Questions that a device answers: points and rays go there, and 32 bytes for each come back.

use std::f32::consts::PI;

use glam::Vec3;
use sorb_kernels::gpu::{Resident, SURFACE_SHARE, SpongeValues, WaterHit, WaterShares};

use crate::{
    query::{Probe, Ray, SpongeProbe, field},
    world::World,
};

const _: () = assert!(field::SURFACE as f32 == SURFACE_SHARE);

/// Where rays for the level begin where there is no container \[m\]: as high as points may be.
const SKY: f32 = 1000.0;

impl World {
    /// The state on the device, if that has all of it and the host has not read it back. What fails here fails in the next step as well;
    /// until then the host answers, from what was read back before.
    fn asked(&self) -> Option<&Resident> {
        let device = self.stores.device.as_ref()?;
        device.resident().filter(|_| device.has_all() && !device.is_host_current())
    }

    fn water_shares(&self) -> WaterShares {
        let fluid = &self.params.fluid;
        let radius = field::RADIUS * fluid.spacing;
        let volume = fluid.particle_mass / fluid.rest_density;
        let scale = volume * 21.0 / (2.0 * PI * radius * radius * radius);
        WaterShares { radius, scale, step: field::STEP * fluid.spacing }
    }

    /// What is at points; none where the host has to answer.
    pub(crate) fn probe_on_device(&self, points: &[Vec3]) -> Option<Vec<Probe>> {
        let resident = self.asked()?;
        let rows = self.stores.host.rows;
        // Other solvers have the pressure in several columns, or compute it anew.
        if points.is_empty() || rows.fluid > 0 && self.params.fluid.divergence().is_none() {
            return None;
        }
        let mut probes = vec![Probe::default(); points.len()];
        if rows.fluid > 0 {
            let density = self.params.fluid.rest_density;
            let sums = resident.water_around(points, &self.water_shares()).ok()?;
            for (probe, sums) in probes.iter_mut().zip(sums) {
                let pressure = sums.pressure * f64::from(density);
                *probe = Probe::of_water([sums.filled, sums.share, pressure], sums.velocity, density);
            }
        }
        if rows.tets > 0 {
            let sponges = resident.sponges_at(points).ok()?;
            for (probe, values) in probes.iter_mut().zip(sponges) {
                probe.sponge = values.map(|values| self.sponge_probe(&values, probe.pressure));
            }
        }
        Some(probes)
    }

    fn sponge_probe(&self, values: &SpongeValues, pressure: f32) -> SpongeProbe {
        let SpongeValues { sponge, saturation, volume, velocity } = *values;
        SpongeProbe { saturation, velocity, ..SpongeProbe::of(self, sponge, volume.into(), pressure) }
    }

    /// Where rays of unit direction meet water; none where the host has to answer.
    pub(crate) fn water_on_device(&self, rays: &[Ray]) -> Option<Vec<WaterHit>> {
        let resident = self.asked()?;
        if rays.is_empty() || self.stores.host.rows.fluid == 0 {
            return None;
        }
        let rays: Vec<_> = rays.iter().map(|ray| (ray.origin, ray.direction, ray.length)).collect();
        resident.rays_on_water(&rays, &self.water_shares()).ok().flatten()
    }

    /// Heights of the water at points; none where the host has to answer.
    pub(crate) fn levels_on_device(&self, points: &[Vec3]) -> Option<Vec<Option<f32>>> {
        let walls = self.params.walls.map(|(low, high)| (low.y, high.y));
        let inside = walls.filter(|(low, high)| *low > -SKY && *high < SKY);
        let beyond = 2.0 * field::RADIUS * self.params.fluid.spacing;
        let (low, high) = inside.map_or((-SKY, SKY), |(low, high)| (low - beyond, high + beyond));
        let ray =
            |point: &Vec3| Ray { origin: point.with_y(high), direction: Vec3::NEG_Y, length: high - low };
        let rays: Vec<Ray> = points.iter().map(ray).collect();
        let hits = self.water_on_device(&rays)?;
        Some(hits.into_iter().map(|hit| hit.map(|(distance, _)| high - distance)).collect())
    }
}
