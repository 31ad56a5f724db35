//! Times of kernels on the device.

use wgpu::{Buffer, BufferUsages, CommandEncoder, ComputePass, QuerySet};

use super::{device::Gpu, error::GpuError};

/// Most time stamps of a submission.
const MARKS: u32 = 4096;

/// Takes the time of every kernel. Each time stamp waits for the kernels before it, so that a step that is timed takes a
/// little longer than one that is not.
#[derive(Debug)]
pub struct Profile {
    set: QuerySet,
    resolved: Buffer,
    staging: Buffer,
    /// Kernel before every mark but the first.
    kernels: Vec<&'static str>,
    /// Milliseconds per tick.
    period_ms: f64,
    times: Vec<(&'static str, f32)>,
}

impl Profile {
    /// For a device that has time stamps.
    ///
    /// # Errors
    /// There is no memory for them.
    pub fn new(gpu: &Gpu) -> Result<Option<Self>, GpuError> {
        if !gpu.has_timestamps() {
            return Ok(None);
        }
        let size = u64::from(MARKS) * 8;
        let buffer = |usage| {
            let label = Some("time stamps");
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label,
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let made = gpu.guarded(Some(("time stamps", size)), || Self {
            set: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("time stamps"),
                ty: wgpu::QueryType::Timestamp,
                count: MARKS,
            }),
            resolved: buffer(BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC),
            staging: buffer(BufferUsages::MAP_READ | BufferUsages::COPY_DST),
            kernels: Vec::new(),
            period_ms: f64::from(gpu.queue.get_timestamp_period()) * 1e-6,
            times: Vec::new(),
        })?;
        Ok(Some(made))
    }

    /// Steps of `passes` passes each that can be timed in one submission.
    #[must_use]
    pub fn steps(passes: usize) -> u32 {
        ((MARKS as usize - 2) / passes.max(1)).max(1) as u32
    }

    /// Begins a submission.
    pub fn start(&mut self, pass: &mut ComputePass<'_>) {
        self.kernels.clear();
        pass.write_timestamp(&self.set, 0);
    }

    /// Notes the time after the last pass of a kernel.
    pub fn mark(&mut self, pass: &mut ComputePass<'_>, kernel: &'static str) {
        if self.kernels.len() + 1 < MARKS as usize {
            self.kernels.push(kernel);
            pass.write_timestamp(&self.set, self.kernels.len() as u32);
        }
    }

    /// Ends a submission: its times are on their way.
    pub fn resolve(&self, encoder: &mut CommandEncoder) {
        let marks = self.kernels.len() as u32 + 1;
        encoder.resolve_query_set(&self.set, 0..marks, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.staging, 0, u64::from(marks) * 8);
    }

    /// Takes the times of the submission, once it is done.
    ///
    /// # Errors
    /// The device was lost.
    pub fn collect(&mut self, gpu: &Gpu) -> Result<(), GpuError> {
        let bytes = gpu.map(&self.staging)?;
        self.staging.unmap();
        let ticks: Vec<u64> = bytemuck::pod_collect_to_vec(&bytes);
        for (kernel, ticks) in self.kernels.iter().zip(ticks.windows(2)) {
            let passed = ticks[1].saturating_sub(ticks[0]);
            self.times.push((*kernel, (passed as f64 * self.period_ms) as f32));
        }
        Ok(())
    }

    /// Milliseconds of every call of a kernel since the last time this was asked, in order; `clock` is what the steps
    /// need beside their kernels.
    pub fn take(&mut self) -> Vec<(&'static str, f32)> {
        std::mem::take(&mut self.times)
    }
}
