//! What comes back from the device: bounds, and pictures.

use glam::Vec3;
use sorb_kernels::gpu::{Gpu, GpuError, wgpu};

use crate::render::Image;

/// Lowest and highest corner of a box (m).
pub(super) type Bounds = (Vec3, Vec3);

/// Words of the two boxes that passes find, that of the particles and that of their kernels.
pub(super) const BOUNDS: [u32; 12] =
    [u32::MAX, u32::MAX, u32::MAX, 0, 0, 0, u32::MAX, u32::MAX, u32::MAX, 0, 0, 0];

/// Bytes of one box, and of both.
pub(super) const BOX_BYTES: u64 = 24;
pub(super) const BOUNDS_BYTES: u64 = 2 * BOX_BYTES;

/// A float by a number that grows as it does.
fn of_ordered(number: u32) -> f32 {
    let is_positive = number & 0x8000_0000 != 0;
    f32::from_bits(if is_positive { number ^ 0x8000_0000 } else { !number })
}

/// A box by its numbers; nothing if nothing is in it.
pub(super) fn bounds(words: &[u32]) -> Option<Bounds> {
    let &[a, b, c, d, e, f] = words.first_chunk::<6>()?;
    let corner = |words: [u32; 3]| Vec3::from(words.map(of_ordered));
    (a <= d).then(|| (corner([a, b, c]), corner([d, e, f])))
}

/// The middle of some rows, axis by axis, without those whose last number is 0.
pub(super) fn median(rows: &[[f32; 4]]) -> Vec3 {
    let middle = |axis: usize| {
        let mut places: Vec<f32> = rows.iter().filter(|row| row[3] > 0.0).map(|row| row[axis]).collect();
        let half = places.len() / 2;
        if places.is_empty() { 0.0 } else { *places.select_nth_unstable_by(half, f32::total_cmp).1 }
    };
    Vec3::new(middle(0), middle(1), middle(2))
}

/// Words of a buffer that the host can map.
pub(super) fn words(gpu: &Gpu, staging: Option<wgpu::Buffer>) -> Result<Vec<u32>, GpuError> {
    let Some(staging) = staging else { return Ok(Vec::new()) };
    Ok(bytemuck::pod_collect_to_vec(&gpu.map(&staging)?))
}

/// A picture by its rows of words, which are longer than it is wide.
pub(super) fn image(words: &[u32], row: usize, (width, height): (u32, u32)) -> Image {
    let rows = words.chunks(row.max(1)).take(height as usize);
    let pixels = rows.flat_map(|row| &row[..width as usize]);
    let pixels = pixels.flat_map(|word| [*word as u8, (*word >> 8) as u8, (*word >> 16) as u8]).collect();
    Image { width, height, pixels }
}
