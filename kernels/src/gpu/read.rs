//! From the device to the host.

use std::{
    fmt,
    sync::{Arc, atomic::Ordering, mpsc},
    time::{Duration, Instant},
};

use wgpu::BufferUsages;

use super::{device::Gpu, error::GpuError, form::take_plain, resident::Resident};
use crate::columns::{Column, Columns, RowCounts};

impl Resident {
    /// Reads the beginnings of buffers back, sizes in bytes, after everything that was submitted.
    pub(super) fn read(&self, wanted: &[(&'static str, u64)]) -> Result<Vec<Vec<u32>>, GpuError> {
        let total: u64 = wanted.iter().map(|(_, size)| size).sum();
        if total == 0 {
            return Ok(wanted.iter().map(|_| Vec::new()).collect());
        }
        let buffers: Vec<_> = wanted.iter().map(|(name, size)| (self.buffer(name), *size)).collect();
        self.read_buffers(&buffers)
    }

    /// The same of buffers that need not be those of columns.
    pub(super) fn read_buffers(&self, wanted: &[(&wgpu::Buffer, u64)]) -> Result<Vec<Vec<u32>>, GpuError> {
        let staging = self.copied(wanted)?;
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

impl Resident {
    /// The beginnings of buffers one after the other, in a buffer that the host can map, after everything that was
    /// submitted.
    fn copied(&self, wanted: &[(&wgpu::Buffer, u64)]) -> Result<wgpu::Buffer, GpuError> {
        let total: u64 = wanted.iter().map(|(_, size)| size).sum();
        self.gpu.guarded(Some(("columns that are read back", total)), || {
            let staging = self.gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("read back"),
                // Nothing can be mapped of an empty buffer.
                size: total.max(4),
                usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            let mut encoder = self.gpu.encoder();
            let mut offset = 0;
            for (buffer, size) in wanted.iter().filter(|(_, size)| *size > 0) {
                encoder.copy_buffer_to_buffer(buffer, 0, &staging, offset, *size);
                offset += size;
            }
            self.gpu.queue.submit([encoder.finish()]);
            staging
        })
    }
}

/// Time for which the host asks again and again whether the device has answered, before it sleeps.
const SOON: Duration = Duration::from_micros(500);

type Mapped = Result<(), wgpu::BufferAsyncError>;

/// Columns that were asked for, on their way: as they were when they were asked for, whatever runs meanwhile.
#[derive(Debug)]
pub struct Pending {
    gpu: Arc<Gpu>,
    staging: wgpu::Buffer,
    mapped: mpsc::Receiver<Mapped>,
    /// What the mapping came to, once it is known.
    result: Option<Result<(), GpuError>>,
    /// Columns with the bytes that each has.
    columns: Vec<(Column, usize)>,
    rows: RowCounts,
}

impl Resident {
    /// Asks for columns as they are after everything that was submitted so far, and does not wait. Lists, bodies and what
    /// sums up over groups are left out.
    ///
    /// # Errors
    /// The device was lost, or there is no memory to copy to.
    pub fn request_columns(&self, columns: &[Column]) -> Result<Pending, GpuError> {
        let wanted: Vec<_> = columns.iter().filter_map(|column| self.plain_buffer(*column)).collect();
        let parts: Vec<_> =
            wanted.iter().map(|(_, name, bytes)| (self.buffer(name), *bytes as u64)).collect();
        let staging = self.copied(&parts)?;
        let (sender, mapped) = mpsc::channel();
        staging.map_async(wgpu::MapMode::Read, .., move |result| {
            // Nobody listens if the request was dropped.
            let _ = sender.send(result);
        });
        let columns = wanted.into_iter().map(|(column, _, bytes)| (column, bytes)).collect();
        Ok(Pending { gpu: Arc::clone(&self.gpu), staging, mapped, result: None, columns, rows: self.rows })
    }
}

impl Pending {
    /// Whether the columns have arrived, or will never: [`Self::take`] does not wait then.
    pub fn is_ready(&mut self) -> bool {
        if self.result.is_none() {
            // What fails here fails in `take` as well.
            let _ = self.gpu.device.poll(wgpu::PollType::Poll);
            self.result = match (self.gpu.check_lost(), self.mapped.try_recv()) {
                (Err(error), _) => Some(Err(error)),
                (_, Ok(result)) => Some(result.map_err(refused)),
                (_, Err(mpsc::TryRecvError::Empty)) => None,
                (_, Err(error)) => Some(Err(refused(error))),
            };
        }
        self.result.is_some()
    }

    /// Puts the columns where they belong, padded; waits if they have not arrived.
    ///
    /// # Errors
    /// The device was lost.
    pub fn take(mut self, columns: &mut Columns) -> Result<(), GpuError> {
        if !self.is_ready() {
            let waited = self.gpu.device.poll(wgpu::PollType::wait_indefinitely());
            self.gpu.check_lost()?;
            waited.map_err(refused)?;
            self.result = Some(self.mapped.recv().map_err(refused)?.map_err(refused));
        }
        if let Some(Err(error)) = self.result {
            return Err(error);
        }
        let view = self.staging.get_mapped_range(..).map_err(refused)?;
        let mut rest = &view[..];
        columns.rows = self.rows;
        for (column, bytes) in self.columns {
            let (part, after) = rest.split_at(bytes);
            take_plain(columns, column, &bytemuck::pod_collect_to_vec(part));
            rest = after;
        }
        Ok(())
    }
}

fn refused(error: impl fmt::Display) -> GpuError {
    GpuError::Refused { reason: error.to_string() }
}

impl Gpu {
    /// The content of a buffer, once all that was submitted is done.
    ///
    /// # Errors
    /// The device was lost.
    pub fn map(&self, buffer: &wgpu::Buffer) -> Result<Vec<u8>, GpuError> {
        self.bytes_read.fetch_add(buffer.size(), Ordering::Relaxed);
        let (sender, receiver) = mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            // Nobody listens if waiting has failed already.
            let _ = sender.send(result);
        });
        if let Some(result) = self.soon(&receiver) {
            self.check_lost()?;
            result.map_err(refused)?;
            return Ok(buffer.get_mapped_range(..).map_err(refused)?.to_vec());
        }
        let waited = self.device.poll(wgpu::PollType::wait_indefinitely());
        self.check_lost()?;
        waited.map_err(refused)?;
        // Where worlds share a device, another thread that waits may be the one that calls back, a little later.
        match receiver.recv() {
            Ok(Ok(())) => {
                let view = buffer.get_mapped_range(..).map_err(refused)?;
                Ok(view.to_vec())
            }
            Ok(Err(error)) => Err(refused(error)),
            Err(_) => Err(refused("a buffer was not mapped")),
        }
    }

    /// Bytes that the host has waited for and read from the device so far, by all worlds on it. These are answers of steps, columns, and
    /// answers to questions. Those of [`Resident::request_columns`] do not count.
    #[must_use]
    pub fn bytes_read(&self) -> u64 {
        self.bytes_read.load(Ordering::Relaxed)
    }

    /// What a mapping came to, if it comes soon: being woken takes longer than a small step.
    fn soon(&self, mapped: &mpsc::Receiver<Mapped>) -> Option<Mapped> {
        let start = Instant::now();
        // A software adapter needs the cores itself.
        while !self.report().is_software() && start.elapsed() < SOON {
            // What fails here fails again where it is waited for.
            let _ = self.device.poll(wgpu::PollType::Poll);
            if let Ok(result) = mapped.try_recv() {
                return Some(result);
            }
            std::hint::spin_loop();
        }
        None
    }
}
