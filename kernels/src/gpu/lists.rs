//! Longer lists of neighbours on a device, where those that there are do not suffice.

use wgpu::BufferUsages;

use super::{
    capacities::{Capacities, List},
    error::GpuError,
    image_layout::ROWS,
    resident::Resident,
};

impl Resident {
    /// Makes lists longer, with a quarter to spare; `longest` is 0 for those that fit.
    pub(super) fn lengthen(&mut self, longest: Capacities) -> Result<(), GpuError> {
        for (capacity, needed) in self.capacities.iter_mut().zip(longest).filter(|(_, needed)| *needed > 0) {
            *capacity = grown(needed, *capacity);
        }
        if longest[List::Images as usize] > 0 {
            self.renew_image_rows()?;
        }
        for list in List::ALL.iter().filter(|list| longest[**list as usize] > 0) {
            let Some(name) = list.buffer() else { continue };
            // The old one first: both may not fit.
            self.buffers.remove(name);
            self.allocate(name, list.bytes(self.rows, self.capacities), BufferUsages::STORAGE)?;
        }
        self.replaced += 1;
        self.fill_params();
        Ok(())
    }

    /// Makes room for more images.
    fn renew_image_rows(&mut self) -> Result<(), GpuError> {
        let images = List::Images.capacity(self.capacities) as u64;
        let of_lists = List::ImageParticles.bytes(self.rows, self.capacities);
        let of_rows = ROWS.into_iter().map(|(name, bytes)| (name, images * bytes));
        for (name, size) in of_rows.chain([("image_particles", of_lists)]) {
            // The old one first: both may not fit.
            self.buffers.remove(name);
            self.allocate(name, size, BufferUsages::STORAGE)?;
        }
        Ok(())
    }
}

/// Room for what did not fit, with a quarter to spare.
fn grown(needed: u32, before: u32) -> u32 {
    (needed + needed / 4).next_multiple_of(8).max(before)
}
