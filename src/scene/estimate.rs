//! Size of a scene, before anything is allocated.

use glam::Vec3;

use super::{FluidBlock, Scene, Sponge};

/// Largest number of fluid particles of a scene.
pub const MAXIMUM_PARTICLES: u64 = 50_000_000;

/// Largest number of sponge nodes of a scene.
pub const MAXIMUM_NODES: u64 = 10_000_000;

/// Approximate sizes of a scene; exact for whole blocks that touch nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Estimate {
    /// Fluid particles in blocks and in saturated sponges.
    pub particles: u64,
    /// Sponge nodes.
    pub nodes: u64,
    /// Sponge tets.
    pub tets: u64,
}

impl Scene {
    /// Estimates the numbers of particles, nodes and tets from sizes alone.
    #[must_use]
    pub fn estimate(&self) -> Estimate {
        let sponges = || self.sponges.iter().filter(|sponge| !sponge.is_removed());
        let nodes = sponges().map(nodes).sum::<f64>();
        let tets = sponges().map(tets).sum::<f64>();
        let particles = self.fluid.as_ref().map_or(0.0, |fluid| {
            let particle = f64::from(fluid.spacing).powi(3);
            let free = fluid.blocks.iter().map(|block| {
                let (counts, _) = block.lattice(self, fluid.spacing);
                let count: f64 =
                    counts.iter().map(|&n| f64::from(n)).product::<f64>() * block.shape.fraction();
                let displaced: f64 = self.sponges.iter().map(|sponge| overlap(block, sponge)).sum();
                (count - displaced / particle).max(0.0)
            });
            let soaked = self.sponges.iter().map(|sponge| water(sponge) / particle);
            free.sum::<f64>() + soaked.sum::<f64>()
        });
        Estimate { particles: whole(particles), nodes: whole(nodes), tets: whole(tets) }
    }
}

/// Nodes of a sponge: two interleaved grids, without the 8 corners, which no tet touches.
fn nodes(sponge: &Sponge) -> f64 {
    let [x, y, z] = sponge.cells.to_array().map(f64::from);
    let block = (x + 1.0) * (y + 1.0) * (z + 1.0) + x * y * z - 8.0;
    block * sponge.shape.fraction()
}

/// Tets of a sponge: four around every face between two cells.
fn tets(sponge: &Sponge) -> f64 {
    let [x, y, z] = sponge.cells.to_array().map(f64::from);
    let faces = (x - 1.0) * y * z + x * (y - 1.0) * z + x * y * (z - 1.0);
    4.0 * faces * sponge.shape.fraction()
}

/// Water in a sponge at time zero \[m^3\].
fn water(sponge: &Sponge) -> f64 {
    let cells: f64 = sponge.cells.to_array().map(f64::from).iter().product();
    let volume = cells * f64::from(sponge.edge).powi(3) * sponge.shape.fraction();
    volume * f64::from(sponge.porosity) * f64::from(sponge.saturation)
}

/// Volume of a block that a sponge occupies \[m^3\].
fn overlap(block: &FluidBlock, sponge: &Sponge) -> f64 {
    let low = block.minimum.max(sponge.position);
    let high = block.maximum.min(sponge.maximum());
    let size = (high - low).max(Vec3::ZERO).as_dvec3();
    size.x * size.y * size.z * sponge.shape.fraction() * block.shape.fraction()
}

#[expect(clippy::cast_possible_truncation, reason = "the cast saturates, and a count that large is refused")]
#[expect(clippy::cast_sign_loss, reason = "negative counts of degenerate sponges become zero")]
fn whole(count: f64) -> u64 {
    count.round() as u64
}
