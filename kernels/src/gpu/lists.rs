//! Lists of neighbours on a device: how long they may be.

use wgpu::BufferUsages;

use super::{error::GpuError, pack::Capacities, resident::Resident};
use crate::{columns::RowCounts, params::Params};

/// Where [`Capacities`] have the lists from particles to images, those from images to particles, and the number of images.
pub(super) const NEAR_IMAGES: usize = 4;
pub(super) const IMAGE_PARTICLES: usize = 5;
pub(super) const IMAGES: usize = 6;

impl Resident {
    /// Makes lists longer, with a quarter to spare; `longest` is 0 for those that fit.
    pub(super) fn lengthen(&mut self, longest: Capacities) -> Result<(), GpuError> {
        let names = [
            "fluid_neighbors",
            "fluid_controls",
            "control_fluid",
            "node_pairs",
            "fluid_near_images",
            "image_particles",
        ];
        if longest[IMAGES] > 0 {
            self.capacities[IMAGES] = grown(longest[IMAGES], self.capacities[IMAGES]);
            self.renew_image_rows()?;
        }
        let images = self.capacities[IMAGES] as usize;
        let RowCounts { fluid, nodes, .. } = self.rows;
        let rows = [fluid, fluid, nodes, nodes, fluid, images];
        let of_lists = longest.into_iter().take(names.len());
        for (which, needed) in of_lists.enumerate().filter(|(_, needed)| *needed > 0) {
            let capacity = grown(needed, self.capacities[which]);
            self.capacities[which] = capacity;
            // The old one first: both may not fit.
            self.buffers.remove(names[which]);
            let size = rows[which] as u64 * (u64::from(capacity) + 1) * 4;
            self.allocate(names[which], size, BufferUsages::STORAGE)?;
        }
        self.replaced += 1;
        self.fill_params();
        Ok(())
    }
}

/// Nodes that a node may touch: those of a flat surface within reach, and half as many again.
const PAIRS: u32 = 32;

/// Images that a cube of particles has in a container around it: two layers of its six sides, and half as many again.
fn images_of(particles: usize) -> u32 {
    let side = libm::cbrt((particles as f64) * (particles as f64));
    (18.0 * side).ceil() as u32 + 64
}

/// Room for what did not fit, with a quarter to spare.
fn grown(needed: u32, before: u32) -> u32 {
    (needed + needed / 4).next_multiple_of(8).max(before)
}

/// Entries that lists of a fluid and a lattice at rest need, and half as many again.
pub(super) fn capacities(params: &Params, rows: RowCounts) -> Capacities {
    let ball = |radius: f32| f64::from(radius).powi(3) * 4.0 / 3.0 * std::f64::consts::PI;
    let spacing = f64::from(params.fluid.spacing).powi(3);
    // Two nodes per cell of the lattice.
    let edge = params.sponges.iter().map(|sponge| sponge.edge).fold(f32::INFINITY, f32::min);
    let pitch = 0.5 * f64::from(edge).powi(3);
    let entries = |radius: f32, volume: f64, maximum: usize| {
        // Far more than there are where particles are fine beside the radius: the maximum is below that.
        let entries = (1.5 * ball(radius) / volume).ceil().min(f64::from(u32::MAX / 2)) as u32;
        entries.next_multiple_of(8).max(32).min(maximum.next_multiple_of(8).min(u32::MAX as usize) as u32)
    };
    let radius = params.coupling.support_radius;
    let mirrors = rows.fluid > 0 && params.fluid.divergence().is_some();
    // Beside a plane there are as many images as there are particles elsewhere.
    let seen =
        if mirrors { entries(params.fluid.smoothing.support_radius, spacing, usize::MAX >> 8) } else { 0 };
    [
        if rows.fluid > 0 { entries(params.fluid.list_radius(), spacing, rows.fluid) } else { 0 },
        if rows.fluid > 0 { entries(radius, pitch, rows.nodes) } else { 0 },
        if rows.fluid > 0 { entries(radius, spacing, rows.fluid) } else { 0 },
        if params.has_touch() { PAIRS } else { 0 },
        seen,
        if rows.bodies > 0 { seen } else { 0 },
        if mirrors { images_of(rows.fluid) } else { 0 },
        0,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::scene::{FULL, Scene};

    #[test]
    fn lists_of_fine_particles_have_as_many_entries_as_there_are() {
        let mut params = Scene::new(FULL).params;
        let rows = RowCounts { fluid: 1_000_001, nodes: 0, tets: 0, bodies: 0 };
        let entries = |params: &Params| capacities(params, rows)[2];
        assert!(entries(&params) < 2000);
        params.fluid.spacing = 1e-7;
        assert_eq!(entries(&params), 1_000_008);
    }
}
