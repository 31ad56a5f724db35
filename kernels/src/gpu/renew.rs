//! Another state on a device in the buffers that are there: with more or fewer particles, and other parameters.

use wgpu::BufferUsages;

use super::{capacities::capacities, error::GpuError, resident::Resident, resident::grids};
use crate::{clock::StepLimits, columns::Columns, params::Params};

/// What follows from the lattice and never changes.
const CONSTANT: [&str; 9] = [
    "sponges",
    "batch",
    "node_rest",
    "tets",
    "tet_sponge",
    "tet_weight",
    "node_traits",
    "node_stars",
    "sponge_ranges",
];

/// Buffers of whose length shaders make use.
const EXACT: [&str; 3] = ["solve_sums", "viscosity_sums", "image_line_sums"];

impl Resident {
    /// Makes room for a state of the same scene, whatever the number of particles, and forgets the present one. Buffers that are too
    /// small grow by half; the others stay. What is uploaded afterwards is on the device as if everything were new. False, and
    /// nothing has changed, for another scene, and for one without water where there was some or the other way round.
    ///
    /// # Errors
    /// There is not enough memory, or a buffer would exceed a limit of the device.
    pub fn renew(
        &mut self,
        columns: &Columns,
        params: &Params,
        limits: StepLimits,
    ) -> Result<bool, GpuError> {
        let (own, new) = (self.rows, columns.rows);
        let is_same = (own.nodes, own.tets, own.bodies) == (new.nodes, new.tets, new.bodies);
        if !is_same || (own.fluid == 0) != (new.fluid == 0) {
            return Ok(false);
        }
        (self.rows, self.params, self.limits) = (new, params.clone(), limits);
        self.grids = grids(&self.gpu, params, new);
        for (own, new) in self.capacities.iter_mut().zip(capacities(params, new)) {
            *own = new.max(*own);
        }
        let mut encoder = self.gpu.encoder();
        for (name, size, usage) in self.layout(columns) {
            if CONSTANT.contains(&name) {
                continue;
            }
            if !self.fit(name, size, usage)? {
                encoder.clear_buffer(self.buffer(name), 0, None);
            }
        }
        self.gpu.queue.submit([encoder.finish()]);
        (self.sorted, self.steps, self.has_begun) = (false, 0, false);
        self.replaced += 1;
        self.fill_grids();
        self.fill_params();
        Ok(true)
    }

    /// Replaces a buffer that does not fit; returns whether it did.
    fn fit(&mut self, name: &'static str, size: u64, usage: BufferUsages) -> Result<bool, GpuError> {
        let needed = Self::buffer_size(size);
        let have = self.buffers.get(name).map_or(0, wgpu::Buffer::size);
        let is_exact = EXACT.contains(&name);
        if have == needed || have > needed && !is_exact {
            return Ok(false);
        }
        let limits = &self.gpu.limits;
        let most = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        let grown = if is_exact { needed } else { needed.max((have + have / 2).min(most / 16 * 16)) };
        // The old one first: both may not fit.
        self.buffers.remove(name);
        self.allocate(name, grown, usage)?;
        Ok(true)
    }
}
