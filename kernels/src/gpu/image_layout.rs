//! Images of particles in the buffers of a device.

use super::{
    capacities::{Capacities, List},
    layout::{ROW_BYTES, Value, WORD_BYTES},
};
use crate::{
    columns::RowCounts,
    layout::{constants, layout},
};

constants! {
    /// Lane of the image of a vector: one more than the body that mirrors it, 0 for none.
    const IMAGE_BODY: usize = 3;
    /// Lane beside the renormalisation of a particle between the axes, in `divergence::moments` alone: the diagonal without images.
    const BEFORE_IMAGES: usize = 3;
}

layout! {
    /// An image but for its position.
    #[derive(Clone, Copy, Debug)]
    pub(super) struct DeviceImage as Image {
        /// Its position in the body, before the walls.
        pub(super) foot: [f32; 3],
        /// Row of its particle.
        pub(super) source: u32,
        /// Map of velocities by the body: xx, yy, zz.
        pub(super) along: [f32; 3],
        pub(super) body: u32,
        /// yz, zx, xy.
        pub(super) between: [f32; 3],
        /// Axes whose walls mirror it, a bit each.
        pub(super) axes: u32,
    }
}

/// Buffers of a row for every image that there is room for, and the bytes of a row.
pub(super) const ROWS: [(&str, u64); 8] = [
    ("image_position", ROW_BYTES),
    ("images", DeviceImage::BYTES),
    ("fluid_image_vectors", ROW_BYTES),
    ("image_forces", ROW_BYTES),
    ("image_cells", WORD_BYTES),
    ("image_slots", WORD_BYTES),
    ("image_grouped", WORD_BYTES),
    ("image_order", WORD_BYTES),
];

/// Bytes of images and their lists.
pub(super) fn bytes(rows: RowCounts, capacities: Capacities) -> u64 {
    let row: u64 = ROWS.iter().map(|(_, bytes)| bytes).sum();
    let lists = [List::NearImages, List::ImageParticles];
    let of_lists = lists.into_iter().filter(|list| list.capacity(capacities) > 0);
    let bytes: u64 = of_lists.map(|list| list.bytes(rows, capacities)).sum();
    List::Images.capacity(capacities) as u64 * row + bytes
}
