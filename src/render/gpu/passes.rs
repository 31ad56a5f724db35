//! Passes: compiled on first use, bound by the names of their variables, and submitted together.

use std::{collections::BTreeMap, sync::Arc};

use sorb_kernels::gpu::{
    Gpu, GpuError, Pipeline, Profile, shaders,
    wgpu::{self, BindGroup},
};

use super::buffers::Buffers;
use super::declarations::{DECLARATIONS, GROUP};

/// Most groups along a dimension of a dispatch.
const GROUPS: u64 = 65_535;

/// Groups for so many threads.
pub(super) fn groups_of(threads: u64) -> [u32; 2] {
    two_dimensional(threads.div_ceil(u64::from(GROUP)))
}

/// So many groups, in two dimensions where one is too short.
pub(super) fn two_dimensional(groups: u64) -> [u32; 2] {
    let groups = groups.max(1);
    [groups.min(GROUPS) as u32, groups.div_ceil(GROUPS) as u32]
}

/// Groups of 8 x 8 threads.
pub(super) fn tiles_of(width: u32, height: u32) -> [u32; 2] {
    [width.div_ceil(8).max(1), height.div_ceil(8).max(1)]
}

/// Pipelines by shader.
#[derive(Debug, Default)]
pub(super) struct Passes(BTreeMap<&'static str, Arc<Pipeline>>);

impl Passes {
    fn get(&mut self, gpu: &Gpu, name: &'static str) -> Result<Arc<Pipeline>, GpuError> {
        if let Some(found) = self.0.get(name) {
            return Ok(Arc::clone(found));
        }
        let shader = shaders::render_shader(name)
            .ok_or_else(|| GpuError::Refused { reason: format!("there is no shader {name}") })?;
        let text = [shader.source, &DECLARATIONS].concat();
        let made = Arc::new(gpu.guarded(None, || gpu.compile_with(shader, &text, "main", &[]))?);
        self.0.insert(name, Arc::clone(&made));
        Ok(made)
    }
}

/// A pass that is ready to run.
struct Ready {
    name: &'static str,
    pipeline: Arc<Pipeline>,
    group: BindGroup,
    groups: [u32; 2],
}

/// What is submitted at once: buffers that are cleared, then passes.
pub(super) struct Work<'a> {
    gpu: &'a Gpu,
    passes: &'a mut Passes,
    buffers: &'a Buffers,
    cleared: Vec<(&'static str, u64)>,
    ready: Vec<Ready>,
}

impl<'a> Work<'a> {
    pub(super) fn new(gpu: &'a Gpu, passes: &'a mut Passes, buffers: &'a Buffers) -> Self {
        Self { gpu, passes, buffers, cleared: Vec::new(), ready: Vec::new() }
    }

    /// Zeroes the beginning of a buffer before the first pass.
    pub(super) fn clear(&mut self, name: &'static str, bytes: u64) {
        self.cleared.push((name, bytes));
    }

    /// Appends a pass; `names` are buffers of other names than the variables have.
    pub(super) fn run(
        &mut self,
        name: &'static str,
        names: &[(&'static str, &'static str)],
        groups: [u32; 2],
    ) -> Result<(), GpuError> {
        let pipeline = self.passes.get(self.gpu, name)?;
        let mut entries = Vec::new();
        for binding in &pipeline.bindings {
            let other = names.iter().find(|(variable, _)| *variable == binding.name);
            let buffer = self.buffers.get(other.map_or(binding.name, |(_, buffer)| buffer))?;
            entries
                .push(wgpu::BindGroupEntry { binding: binding.index, resource: buffer.as_entire_binding() });
        }
        let descriptor =
            wgpu::BindGroupDescriptor { label: Some(name), layout: &pipeline.layout, entries: &entries };
        let group = self.gpu.device().create_bind_group(&descriptor);
        self.ready.push(Ready { name, pipeline, group, groups });
        Ok(())
    }

    /// Submits everything; with copies of beginnings of buffers (bytes) to one that the host can map.
    pub(super) fn submit(
        self,
        copies: &[(&'static str, u64)],
        mut profile: Option<&mut Profile>,
    ) -> Result<Option<wgpu::Buffer>, GpuError> {
        let total: u64 = copies.iter().map(|(_, bytes)| bytes).sum();
        let device = self.gpu.device();
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for (name, bytes) in &self.cleared {
            encoder.clear_buffer(self.buffers.get(name)?, 0, Some(*bytes));
        }
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            if let Some(profile) = &mut profile {
                profile.start(&mut pass);
            }
            for ready in &self.ready {
                pass.set_pipeline(&ready.pipeline.pipeline);
                pass.set_bind_group(0, &ready.group, &[]);
                pass.dispatch_workgroups(ready.groups[0], ready.groups[1], 1);
                if let Some(profile) = &mut profile {
                    profile.mark(&mut pass, ready.name);
                }
            }
        }
        if let Some(profile) = &mut profile {
            profile.resolve(&mut encoder);
        }
        let staging = (total > 0).then(|| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("read back"),
                size: total,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        });
        if let Some(staging) = &staging {
            let mut offset = 0;
            for (name, bytes) in copies {
                encoder.copy_buffer_to_buffer(self.buffers.get(name)?, 0, staging, offset, *bytes);
                offset += bytes;
            }
        }
        self.gpu.queue().submit([encoder.finish()]);
        if let Some(profile) = &mut profile {
            profile.collect(self.gpu)?;
        }
        Ok(staging)
    }
}
