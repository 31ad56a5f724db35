//! Lists of neighbours on a device: how long they are.

use super::layout::WORD_BYTES;
use crate::{
    columns::{Column, RowCounts},
    layout::enumeration,
    params::Params,
};

enumeration! {
    /// What has a length on a device that the host chooses: the order of [`Capacities`], and of their part of
    /// [`Extreme`](super::answer::Extreme).
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub(super) enum List {
        /// Lists fluid to fluid.
        Neighbors,
        /// Lists fluid to controls.
        Controls,
        /// Lists controls to fluid.
        ControlFluid,
        /// Lists of nodes to nodes that they may touch.
        Pairs,
        /// Lists fluid to images.
        NearImages,
        /// Lists images to fluid.
        ImageParticles,
        /// No lists: the images that there is room for.
        Images,
    }
}

/// Longest lists that fit, in the order of [`List`], and a word that is unused.
pub(super) type Capacities = [u32; 8];

impl List {
    /// Number of entries that fit.
    pub(super) fn capacity(self, capacities: Capacities) -> usize {
        capacities[self as usize] as usize
    }

    /// Its buffer; images have several.
    pub(super) fn buffer(self) -> Option<&'static str> {
        Some(match self {
            Self::Neighbors => Column::FluidNeighbors.buffer(),
            Self::Controls => Column::FluidControls.buffer(),
            Self::ControlFluid => Column::ControlFluid.buffer(),
            Self::Pairs => Column::NodePairs.buffer(),
            Self::NearImages => "fluid_near_images",
            Self::ImageParticles => "image_particles",
            Self::Images => return None,
        })
    }

    /// Rows that have a list.
    fn rows(self, rows: RowCounts, capacities: Capacities) -> usize {
        match self {
            Self::Neighbors | Self::Controls | Self::NearImages => rows.fluid,
            Self::ControlFluid | Self::Pairs => rows.nodes,
            Self::ImageParticles | Self::Images => Self::Images.capacity(capacities),
        }
    }

    /// Words of all lists: every list has its length before its entries.
    pub(super) fn words(self, rows: RowCounts, capacities: Capacities) -> usize {
        self.rows(rows, capacities) * (self.capacity(capacities) + 1)
    }

    /// Bytes of all lists.
    pub(super) fn bytes(self, rows: RowCounts, capacities: Capacities) -> u64 {
        self.words(rows, capacities) as u64 * WORD_BYTES
    }
}

/// Nodes that a node may touch: those of a flat surface within reach, and half as many again.
const PAIRS: u32 = 32;

/// Images that a cube of particles has in a container around it: two layers of its six sides, and half as many again.
fn images_of(particles: usize) -> u32 {
    let side = libm::cbrt((particles as f64) * (particles as f64));
    (18.0 * side).ceil() as u32 + 64
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
    let of_list = |list: List| match list {
        List::Neighbors if rows.fluid > 0 => entries(params.fluid.list_radius(), spacing, rows.fluid),
        List::Controls if rows.fluid > 0 => entries(radius, pitch, rows.nodes),
        List::ControlFluid if rows.fluid > 0 => entries(radius, spacing, rows.fluid),
        List::Pairs if params.has_touch() => PAIRS,
        List::NearImages => seen,
        List::ImageParticles if rows.bodies > 0 => seen,
        List::Images if mirrors => images_of(rows.fluid),
        _ => 0,
    };
    std::array::from_fn(|index| List::ALL.get(index).copied().map_or(0, of_list))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        gpu::{answer::Extreme, layout::Enumeration},
        tests::scene::{FULL, Scene},
    };

    /// `clock.wgsl` takes lengths that did not fit over in this order.
    #[test]
    fn lists_are_in_the_order_of_their_extremes() {
        let first = Extreme::Neighbors as usize;
        let own = &Extreme::VARIANTS[first..][..List::ALL.len()];
        assert_eq!(own, List::VARIANTS);
    }

    #[test]
    fn lists_of_fine_particles_have_as_many_entries_as_there_are() {
        let mut params = Scene::new(FULL).params;
        let rows = RowCounts { fluid: 1_000_001, nodes: 0, tets: 0, bodies: 0 };
        let entries = |params: &Params| List::ControlFluid.capacity(capacities(params, rows));
        assert!(entries(&params) < 2000);
        params.fluid.spacing = 1e-7;
        assert_eq!(entries(&params), 1_000_008);
    }
}
