//! Pipelines, compiled on first use.

use std::{
    borrow::Cow,
    collections::BTreeMap,
    sync::{
        Arc, PoisonError,
        atomic::{AtomicUsize, Ordering},
    },
    thread::{self, available_parallelism},
};

use sorb_shaders::Shader;
use wgpu::BindingType;

use super::{
    device::Gpu,
    error::GpuError,
    fusion::{Dispatched, Fused},
    pipeline::{Binding, Pipeline, Threads, bindings, has_any_group, has_shares},
    wgsl,
};

/// The constant of `rows.wgsl` for the threads of a group.
const GROUP: &str = "GROUP";
/// The constant of `shares.wgsl` for the threads of a row.
const SHARES: &str = "SHARES";

/// Values of the constants that a text leaves open.
fn constants_of(text: &str, threads: Threads) -> Vec<(&'static str, f64)> {
    let group = has_any_group(text).then_some((GROUP, f64::from(threads.group)));
    let shares = has_shares(text).then_some((SHARES, f64::from(threads.shares)));
    group.into_iter().chain(shares).collect()
}

/// Most threads that compile.
const COMPILERS: usize = 16;

/// Does work for each, on threads where there are some.
fn in_parallel<T: Sync>(all: &[T], work: impl Fn(&T) -> Result<(), GpuError> + Sync) -> Result<(), GpuError> {
    let available =
        if cfg!(target_family = "wasm") { 1 } else { available_parallelism().map_or(1, Into::into) };
    let threads = available.min(COMPILERS).min(all.len());
    if threads <= 1 {
        return all.iter().try_for_each(work);
    }
    let next = AtomicUsize::new(0);
    let run = || {
        while let Some(one) = all.get(next.fetch_add(1, Ordering::Relaxed)) {
            work(one)?;
        }
        Ok(())
    };
    let lost = |_| Err(GpuError::Refused { reason: "a thread that compiles has failed".to_owned() });
    thread::scope(|scope| {
        let started: Vec<_> = (0..threads).map(|_| scope.spawn(run)).collect();
        started.into_iter().try_for_each(|thread| thread.join().unwrap_or_else(lost))
    })
}

impl Gpu {
    /// The pipeline of an entry point of a shader, compiled if it was not used before.
    pub(super) fn pipeline(
        &self,
        shader: &'static str,
        entry: &'static str,
        threads: Threads,
    ) -> Result<Arc<Pipeline>, GpuError> {
        let key = (Cow::Borrowed(shader), entry, threads);
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

    /// The pipeline of several passes in one text.
    pub(super) fn fused_pipeline(&self, all: &Dispatched) -> Result<Arc<Pipeline>, GpuError> {
        let key = (Cow::Owned(all.key()), "fused", all.threads());
        if let Some(found) = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner).get(&key) {
            return Ok(Arc::clone(found));
        }
        let refused = || GpuError::Refused { reason: "passes cannot be one dispatch".to_owned() };
        let Fused { text, bindings } = Fused::of(all).ok_or_else(refused)?;
        let constants = constants_of(&text, all.threads());
        let text = wgsl::complete(&text);
        let compile = || self.compile_text("fused", bindings, &text, "fused", &constants);
        let made = Arc::new(self.guarded(None, compile)?);
        let mut all = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(Arc::clone(all.entry(key).or_insert(made)))
    }

    /// Compiles the pipelines of dispatches that were not used before, side by side. Most of the time of a first step is that of the
    /// compiler of the driver.
    pub(super) fn compile_all<'d>(&self, all: impl Iterator<Item = &'d Dispatched>) -> Result<(), GpuError> {
        let distinct: BTreeMap<_, _> = all.map(|own| ((own.key(), own.threads()), own)).collect();
        let distinct: Vec<&Dispatched> = distinct.into_values().collect();
        let compile = |own: &&Dispatched| match own.single() {
            Some(job) => self.pipeline(job.pass.shader, job.pass.entry, job.threads).map(|_| ()),
            None => self.fused_pipeline(own).map(|_| ()),
        };
        in_parallel(&distinct, compile)
    }

    pub(super) fn compile(&self, shader: &'static Shader, entry: &'static str, threads: Threads) -> Pipeline {
        let constants = constants_of(shader.source, threads);
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
        self.compile_text(shader.name, bindings(shader.source), text, entry, constants)
    }

    fn compile_text(
        &self,
        name: &'static str,
        bindings: Vec<Binding>,
        text: &str,
        entry: &str,
        constants: &[(&str, f64)],
    ) -> Pipeline {
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
            label: Some(name),
            entries: &entries,
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(name),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(name),
            source: wgpu::ShaderSource::Wgsl(text.into()),
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(name),
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
