//! Images of particles in the buffers of a device: `Images` as buffers of their own. Their number changes from step to step, so that they
//! are dispatched as many as there is room for.

use wgpu::BufferUsages;

use super::{
    capacities::{Capacities, List},
    cells::{Grid, PAGE_CELLS},
    layout::{ROW_BYTES, Value, WORD_BYTES},
};
use crate::{
    columns::RowCounts,
    grid::cells::Domain,
    layout::{constants, layout},
    params::Params,
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

/// Cells over the images of as many particles.
pub(super) fn cells(params: &Params, rows: RowCounts, maximum: u64) -> Grid {
    let radius = params.fluid.smoothing.support_radius;
    let domain = match params.domain {
        Domain::Bounded { minimum, maximum } => {
            Domain::Bounded { minimum: minimum - radius, maximum: maximum + radius }
        }
        Domain::Unbounded => Domain::Unbounded,
    };
    let has_images = params.fluid.divergence().is_some();
    Grid::new(domain, radius, if has_images { rows.fluid } else { 0 }, maximum)
}

/// Name, bytes and use of the buffers of images.
pub(super) fn buffers(
    rows: RowCounts,
    capacities: Capacities,
    grids: &[Grid; 5],
) -> Vec<(&'static str, u64, BufferUsages)> {
    let (plain, uniform) = (BufferUsages::STORAGE, BufferUsages::UNIFORM);
    let images = List::Images.capacity(capacities) as u64;
    let has_images = images > 0;
    let cells = |grid: &Grid| if has_images { grid.pages() * u64::from(PAGE_CELLS) } else { 0 };
    let [of_images, of_line] = [cells(&grids[3]), cells(&grids[4])];
    let sums = |cells: u64| WORD_BYTES * cells / u64::from(PAGE_CELLS);
    let list = |list: List| if has_images { list.bytes(rows, capacities) } else { 0 };
    let fluid = if has_images { rows.fluid as u64 } else { 0 };
    let mut all = vec![
        ("image_grid", Grid::BYTES, uniform | plain),
        ("image_line", Grid::BYTES, uniform | plain),
        ("image_line_counts", of_line * WORD_BYTES, plain),
        ("image_line_sums", sums(of_line), plain),
        ("fluid_image_first", of_line * WORD_BYTES, plain),
        ("image_counts", of_images * WORD_BYTES, plain),
        ("image_starts", of_images * WORD_BYTES, plain),
        ("image_page_sums", sums(of_images), plain),
        ("fluid_near_images", list(List::NearImages), plain),
        ("image_particles", list(List::ImageParticles), plain),
        ("fluid_rate", fluid * WORD_BYTES, plain),
    ];
    all.extend(ROWS.map(|(name, bytes)| (name, images * bytes, plain)));
    all
}
