//! Whether subgroup operations do on a device what prefix sums need of them.

use std::sync::Mutex;

use sorb_shaders::PROBE;
use wgpu::{BufferUsages, Features, util::DeviceExt};

use super::{device::Gpu, groups::GROUP_THREADS, pipeline::Threads};

impl Gpu {
    /// The same device with prefix sums by subgroup operations, if it has them and its subgroups are runs of threads.
    ///
    /// Not the default: on an H200 sorts went wrong with them. WGSL does not promise that the threads of a subgroup converge after a
    /// branch. Sums over threads that have not converged are incomplete.
    #[must_use]
    pub fn with_subgroups(mut self) -> Self {
        self.has_subgroups = self.device.features().contains(Features::SUBGROUP) && self.subgroups_are_runs();
        self.pipelines = Mutex::default();
        self
    }

    /// Whether the subgroups of a group are runs of its threads, in order: WGSL does not say so. Tried out once per
    /// device; whatever goes wrong is a no.
    fn subgroups_are_runs(&self) -> bool {
        let try_out = || {
            let buffer = self.guarded(None, || {
                let pipeline = self.compile(&PROBE, "main", Threads { group: GROUP_THREADS, shares: 1 });
                let found = self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                    label: Some("probe"),
                    contents: &[0xff; 1024],
                    usage: BufferUsages::STORAGE | BufferUsages::COPY_SRC,
                });
                let read = self.device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("probe"),
                    size: 1024,
                    usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
                    mapped_at_creation: false,
                });
                let bind = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
                    label: Some("probe"),
                    layout: &pipeline.layout,
                    entries: &[wgpu::BindGroupEntry { binding: 0, resource: found.as_entire_binding() }],
                });
                let mut encoder = self
                    .device
                    .create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("probe") });
                {
                    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
                    pass.set_pipeline(&pipeline.pipeline);
                    pass.set_bind_group(0, &bind, &[]);
                    pass.dispatch_workgroups(1, 1, 1);
                }
                encoder.copy_buffer_to_buffer(&found, 0, &read, 0, 1024);
                self.queue.submit([encoder.finish()]);
                read
            })?;
            self.map(&buffer)
        };
        let expected = |lane: u32| lane * lane.wrapping_sub(1) / 2;
        try_out().is_ok_and(|bytes| {
            let found: Vec<u32> = bytemuck::pod_collect_to_vec(&bytes);
            found.iter().zip(0..).all(|(found, lane)| *found == if lane == 0 { 0 } else { expected(lane) })
        })
    }
}
