//! From the device to the host.

use std::sync::mpsc;

use wgpu::BufferUsages;

use super::{device::Gpu, error::GpuError, resident::Resident};

impl Resident {
    /// Reads the beginnings of buffers back, sizes in bytes, after everything that was submitted.
    pub(super) fn read(&self, wanted: &[(&'static str, u64)]) -> Result<Vec<Vec<u32>>, GpuError> {
        let total: u64 = wanted.iter().map(|(_, size)| size).sum();
        if total == 0 {
            return Ok(wanted.iter().map(|_| Vec::new()).collect());
        }
        let staging = self.gpu.guarded(Some(("columns that are read back", total)), || {
            let staging = self.gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("read back"),
                size: total,
                usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            let mut encoder = self.encoder();
            let mut offset = 0;
            for (name, size) in wanted.iter().filter(|(_, size)| *size > 0) {
                encoder.copy_buffer_to_buffer(self.buffer(name), 0, &staging, offset, *size);
                offset += size;
            }
            self.gpu.queue.submit([encoder.finish()]);
            staging
        })?;
        let bytes = self.gpu.map(&staging)?;
        let mut rest = &bytes[..];
        let mut parts = Vec::new();
        for (_, size) in wanted {
            let (part, after) = rest.split_at(*size as usize);
            // The bytes of a part lie anywhere; its words must not.
            parts.push(bytemuck::pod_collect_to_vec(part));
            rest = after;
        }
        Ok(parts)
    }
}

impl Gpu {
    /// The content of a buffer, once all that was submitted is done.
    pub(super) fn map(&self, buffer: &wgpu::Buffer) -> Result<Vec<u8>, GpuError> {
        let (sender, receiver) = mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            // Nobody listens if waiting has failed already.
            let _ = sender.send(result);
        });
        let refused = |reason: String| GpuError::Refused { reason };
        let waited = self.device.poll(wgpu::PollType::wait_indefinitely());
        self.check_lost()?;
        waited.map_err(|error| refused(error.to_string()))?;
        // Where worlds share a device, another thread that waits may be the one that calls back, a little later.
        match receiver.recv() {
            Ok(Ok(())) => {
                let view = buffer.get_mapped_range(..).map_err(|error| refused(error.to_string()))?;
                Ok(view.to_vec())
            }
            Ok(Err(error)) => Err(refused(error.to_string())),
            Err(_) => Err(refused("a buffer was not mapped".to_owned())),
        }
    }
}
