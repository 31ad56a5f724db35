//! The passes of a step, bound to the buffers of a world.

use std::sync::Arc;

use wgpu::{BindGroup, Buffer, BufferUsages, CommandBuffer, util::DeviceExt};

use super::{
    answer::REPETITIONS,
    error::GpuError,
    fusion::{Dispatched, dispatched},
    jobs::{Job, Jobs},
    layout::Value,
    pack::{BATCH_STRIDE, Batch, Repetition},
    pipeline::Pipeline,
    resident::Resident,
    twins::{BEGIN, END_ROUNDS, Pass, RESUME, Rows},
};
use crate::{kernel::Kernel, stage::Stage};

/// Rounds that are encoded before it is known how many are needed.
pub(super) const FIRST_ROUNDS: u32 = 4;

/// A pass bound to its buffers.
#[derive(Debug)]
pub(super) struct Dispatch {
    pub(super) kernel: &'static str,
    pub(super) pipeline: Arc<Pipeline>,
    pub(super) bind: BindGroup,
    pub(super) groups: [u32; 3],
}

/// The passes of a stage, bound to their buffers.
#[derive(Debug)]
pub(super) enum BoundStage {
    Once(Vec<Dispatch>),
    Rounds(Rounds),
}

/// A repetition that ends when it has converged. The rounds after that are encoded as well, and return at once.
#[derive(Debug)]
pub(super) struct Rounds {
    pub(super) maximum: u32,
    /// Rounds that are encoded: a few more than were needed before. If they do not suffice the device stops, and the
    /// host submits more.
    pub(super) planned: u32,
    pub(super) round: Vec<Dispatch>,
    pub(super) end: Vec<Dispatch>,
}

/// The passes of a step in order, bound to the buffers of a [`Resident`].
#[derive(Debug)]
pub struct Program {
    pub(super) stages: Vec<Stage>,
    pub(super) begin: Vec<Dispatch>,
    pub(super) resume: Vec<Dispatch>,
    pub(super) step: Vec<BoundStage>,
    pub(super) finish: Vec<Dispatch>,
    /// A step that is encoded and waits for its turn.
    pub(super) prepared: Option<CommandBuffer>,
    /// The buffers that it is bound to.
    pub(super) bound: u32,
}

impl Program {
    /// Passes of a step, as many rounds of repetitions as are encoded at present.
    #[must_use]
    pub fn passes(&self) -> usize {
        let bound = self.passes_from(0, 0);
        bound.iter().map(|passes| passes.len()).sum::<usize>() + self.finish.len()
    }

    /// Whether a kernel with a property runs.
    pub(super) fn runs(&self, has: impl Fn(&Kernel) -> bool) -> bool {
        self.stages.iter().flat_map(Stage::kernels).any(|kernel| has(kernel))
    }

    /// The passes of a step in order, from the repetition `index` on if `index` is above 0: of that one `added` rounds.
    pub(super) fn passes_from(&self, index: usize, added: u32) -> Vec<&[Dispatch]> {
        let mut all: Vec<&[Dispatch]> = Vec::new();
        let mut seen = 0;
        for stage in &self.step {
            match stage {
                BoundStage::Once(dispatches) if seen >= index => all.push(dispatches),
                BoundStage::Once(_) => {}
                BoundStage::Rounds(rounds) => {
                    seen += 1;
                    let count = if seen == index { added } else { rounds.planned };
                    if seen >= index {
                        all.extend((0..count).map(|_| &rounds.round[..]));
                        all.push(&rounds.end);
                    }
                }
            }
        }
        all
    }

    fn repetitions(&mut self) -> impl Iterator<Item = &mut Rounds> {
        self.step.iter_mut().filter_map(|stage| match stage {
            BoundStage::Rounds(rounds) => Some(rounds),
            BoundStage::Once(_) => None,
        })
    }

    /// Plans one round more than were needed: one that returns at once costs as much as its barriers, one that is missing costs
    /// an answer. A step that is encoded already stays, unless more rounds were needed than it has.
    pub(super) fn expect(&mut self, needed: [u32; REPETITIONS]) {
        let mut grew = false;
        for (rounds, needed) in self.repetitions().zip(needed).filter(|(_, needed)| *needed > 0) {
            grew |= needed > rounds.planned;
            rounds.planned = (needed + 1).min(rounds.maximum);
        }
        if grew {
            self.prepared = None;
        }
    }

    /// How many rounds to submit in addition for a repetition, counted from 1, that has not converged in those before.
    pub(super) fn added_rounds(&mut self, index: usize, done: u32) -> u32 {
        let rounds = self.repetitions().nth(index - 1);
        rounds.map_or(1, |rounds| (done / 4).max(2).min(rounds.maximum.saturating_sub(done)).max(1))
    }
}

impl Resident {
    /// Binds kernels, in the order in which they are to run.
    ///
    /// # Errors
    /// A pipeline cannot be compiled.
    pub fn program(&self, kernels: &[&'static Kernel]) -> Result<Program, GpuError> {
        self.program_of(kernels.iter().map(|kernel| Stage::Run(kernel)).collect())
    }

    /// Binds stages, in the order in which they are to run.
    ///
    /// # Errors
    /// As [`Self::program`], or there are too many repetitions.
    pub fn program_of(&self, stages: Vec<Stage>) -> Result<Program, GpuError> {
        let mut step = Vec::new();
        let mut repetitions = 0;
        let of_stages: Vec<(Jobs, Vec<Dispatched>)> = self
            .jobs_of(&stages)
            .into_iter()
            .map(|jobs| {
                let all = self.dispatched(jobs.jobs());
                (jobs, all)
            })
            .collect();
        self.gpu.compile_all(of_stages.iter().flat_map(|(_, all)| all))?;
        for (jobs, fused) in of_stages {
            let dispatches = fused.iter().map(|all| self.bind_fused(all)).collect::<Result<_, _>>()?;
            step.push(match jobs {
                Jobs::Once(_) => BoundStage::Once(dispatches),
                Jobs::Rounds { maximum, .. } => {
                    repetitions += 1;
                    BoundStage::Rounds(self.rounds(maximum, repetitions, dispatches)?)
                }
            });
        }
        let begin = self.bind_all(&self.jobs("clock", &BEGIN), &[])?;
        let resume = self.bind_all(&self.jobs("clock", &RESUME), &[])?;
        let finish = self.bind_all(&self.last_jobs(), &[])?;
        Ok(Program { stages, begin, resume, step, finish, prepared: None, bound: self.replaced })
    }

    /// Passes in as few dispatches as the device permits.
    pub(super) fn dispatched(&self, jobs: &[Job]) -> Vec<Dispatched> {
        let limits = self.is_fused.then_some(&self.gpu.limits);
        dispatched(jobs, limits)
    }

    /// A repetition, counted from 1.
    pub(super) fn rounds(
        &self,
        maximum: u32,
        index: usize,
        round: Vec<Dispatch>,
    ) -> Result<Rounds, GpuError> {
        if index > REPETITIONS {
            let reason = format!("more than {REPETITIONS} repetitions that end when they have converged");
            return Err(GpuError::Refused { reason });
        }
        let maximum = maximum.max(1);
        let repetition = self.uniform("repetition", &Repetition { maximum, index: index as u32 })?;
        let end = self.bind_all(&self.jobs("clock", &END_ROUNDS), &[("repetition", &repetition)])?;
        Ok(Rounds { maximum, planned: maximum.min(FIRST_ROUNDS), round, end })
    }

    /// A buffer of a value that never changes.
    pub(super) fn uniform<V: Value>(&self, name: &'static str, value: &V) -> Result<Buffer, GpuError> {
        self.gpu.guarded(Some((name, V::BYTES)), || {
            self.gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(name),
                contents: bytemuck::cast_slice(&value.words()),
                usage: BufferUsages::UNIFORM,
            })
        })
    }

    /// Binds a program anew if its buffers were replaced.
    pub(super) fn keep_bound(&self, program: &mut Program) -> Result<(), GpuError> {
        if program.bound != self.replaced {
            *program = self.program_of(std::mem::take(&mut program.stages))?;
        }
        Ok(())
    }

    pub(super) fn bind_all(&self, jobs: &[Job], own: &[(&str, &Buffer)]) -> Result<Vec<Dispatch>, GpuError> {
        jobs.iter().map(|job| self.bind(job, own)).collect()
    }

    fn bind(&self, job: &Job, own: &[(&str, &Buffer)]) -> Result<Dispatch, GpuError> {
        let Job { kernel, pass, color, threads, groups, .. } = *job;
        let pipeline = self.gpu.pipeline(pass.shader, pass.entry, threads)?;
        let bind = self.gpu.guarded(None, || self.bind_group(&pass, &pipeline, color, own))?;
        Ok(Dispatch { kernel, pipeline, bind, groups })
    }

    /// Passes of one dispatch.
    fn bind_fused(&self, all: &Dispatched) -> Result<Dispatch, GpuError> {
        if let Some(job) = all.single() {
            return self.bind(job, &[]);
        }
        let kernel = all.jobs().next().map_or("", |job| job.kernel);
        let pipeline = self.gpu.fused_pipeline(all)?;
        let pass = Pass { shader: "fused", entry: "fused", rows: Rows::One, names: &[] };
        let bind = self.gpu.guarded(None, || self.bind_group(&pass, &pipeline, 0, &[]))?;
        let (count, beside) = all.groups();
        let [x, y, _] = self.lines(count);
        Ok(Dispatch { kernel, pipeline, bind, groups: [x, y, beside] })
    }

    pub(super) fn bind_group(
        &self,
        pass: &Pass,
        pipeline: &Pipeline,
        color: usize,
        own: &[(&str, &Buffer)],
    ) -> BindGroup {
        let entries: Vec<_> = pipeline
            .bindings
            .iter()
            .map(|binding| {
                let name = pass.buffer(binding.name);
                let own = own.iter().find(|(own, _)| *own == name).map(|(_, buffer)| *buffer);
                let mut part = own.unwrap_or_else(|| self.buffer(name)).as_entire_buffer_binding();
                if name == "batch" {
                    part.offset = color as u64 * BATCH_STRIDE;
                    part.size = std::num::NonZeroU64::new(Batch::BYTES);
                }
                wgpu::BindGroupEntry { binding: binding.index, resource: wgpu::BindingResource::Buffer(part) }
            })
            .collect();
        self.gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(pass.shader),
            layout: &pipeline.layout,
            entries: &entries,
        })
    }
}
