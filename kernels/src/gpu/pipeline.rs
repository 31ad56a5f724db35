//! Pipelines, compiled on first use. What a pass is bound to is read off its text, so that it is said once.

use std::sync::{Arc, PoisonError};

use sorb_shaders::Shader;
use wgpu::{BindGroupLayout, BindingType, BufferBindingType, ComputePipeline};

use super::{device::Gpu, error::GpuError, wgsl};

/// The constant of `rows.wgsl` for the threads of a group.
const GROUP: &str = "GROUP";
/// The constant of `shares.wgsl` for the threads of a row.
const SHARES: &str = "SHARES";

/// Whether the groups of a pass can have any number of threads; else they have 256, or one.
pub(super) fn has_any_group(source: &str) -> bool {
    source.contains("@workgroup_size(GROUP)")
}

/// Whether several threads can share a row of a pass.
pub(super) fn has_shares(source: &str) -> bool {
    source.contains("override SHARES")
}

/// Threads of a group, and how many of them share a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Threads {
    pub(super) group: u32,
    pub(super) shares: u32,
}

/// One binding of a pass.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binding {
    /// Its number in the group.
    pub index: u32,
    /// Name of the variable.
    pub name: &'static str,
    kind: BufferBindingType,
}

impl Binding {
    #[cfg(test)]
    pub(super) fn is_storage(&self) -> bool {
        matches!(self.kind, BufferBindingType::Storage { .. })
    }
}

/// A compiled pass.
#[derive(Debug)]
pub struct Pipeline {
    /// What it is bound to.
    pub bindings: Vec<Binding>,
    /// Layout of these bindings.
    pub layout: BindGroupLayout,
    /// The pipeline itself.
    pub pipeline: ComputePipeline,
}

/// The bindings that a text declares: one line each, all in group 0.
pub(super) fn bindings(source: &'static str) -> Vec<Binding> {
    source.lines().filter_map(binding).collect()
}

fn binding(line: &'static str) -> Option<Binding> {
    let rest = line.strip_prefix("@group(0) @binding(")?;
    let (index, rest) = rest.split_once(')')?;
    let (space, rest) = rest.trim_start().strip_prefix("var<")?.split_once('>')?;
    let (name, _) = rest.split_once(':')?;
    let kind = match space {
        "uniform" => BufferBindingType::Uniform,
        "storage, read" => BufferBindingType::Storage { read_only: true },
        _ => BufferBindingType::Storage { read_only: false },
    };
    Some(Binding { index: index.parse().ok()?, name: name.trim(), kind })
}

impl Gpu {
    /// The pipeline of an entry point of a shader, compiled if it was not used before.
    pub(super) fn pipeline(
        &self,
        shader: &'static str,
        entry: &'static str,
        threads: Threads,
    ) -> Result<Arc<Pipeline>, GpuError> {
        let key = (shader, entry, threads);
        if let Some(found) = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner).get(&key) {
            return Ok(Arc::clone(found));
        }
        let subgroups = sorb_shaders::subgroup_shader(shader).filter(|_| self.has_subgroups);
        let text = subgroups
            .or_else(|| sorb_shaders::shader(shader))
            .ok_or_else(|| GpuError::Refused { reason: format!("there is no shader {shader}") })?;
        let made = Arc::new(self.guarded(None, || self.compile(text, entry, threads))?);
        let mut all = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(Arc::clone(all.entry(key).or_insert(made)))
    }

    pub(super) fn compile(&self, shader: &'static Shader, entry: &'static str, threads: Threads) -> Pipeline {
        let mut constants = Vec::new();
        if has_any_group(shader.source) {
            constants.push((GROUP, f64::from(threads.group)));
        }
        if has_shares(shader.source) {
            constants.push((SHARES, f64::from(threads.shares)));
        }
        self.compile_with(shader, &wgsl::complete(shader.source), entry, &constants)
    }

    /// Compiles an entry point of a shader, whose text is completed with declarations, with values of its overridable constants. To be
    /// called by [`Self::guarded`].
    #[must_use]
    pub fn compile_with(
        &self,
        shader: &'static Shader,
        text: &str,
        entry: &'static str,
        constants: &[(&str, f64)],
    ) -> Pipeline {
        let bindings = bindings(shader.source);
        let entries: Vec<_> = bindings
            .iter()
            .map(|binding| wgpu::BindGroupLayoutEntry {
                binding: binding.index,
                visibility: wgpu::ShaderStages::COMPUTE,
                ty: BindingType::Buffer {
                    ty: binding.kind,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            })
            .collect();
        let device = &self.device;
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(shader.name),
            entries: &entries,
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(shader.name),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(shader.name),
            source: wgpu::ShaderSource::Wgsl(text.into()),
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(shader.name),
            layout: Some(&pipeline_layout),
            module: &module,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions {
                // Every workgroup variable is written before it is read.
                zero_initialize_workgroup_memory: false,
                constants,
            },
            cache: None,
        });
        Pipeline { bindings, layout, pipeline }
    }
}
