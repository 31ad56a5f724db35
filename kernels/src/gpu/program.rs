//! The passes of a step, bound to the buffers of a world.

use std::sync::Arc;

use wgpu::{BindGroup, Buffer, BufferUsages, CommandBuffer, util::DeviceExt};

use super::{
    cells::ONE_GROUP_PAGES,
    error::GpuError,
    groups::{CONTROLS_PER_GROUP, GROUP_THREADS, group_of, shares_of},
    layout::Value,
    lists::IMAGES,
    pack::{BATCH_STRIDE, BATCHES, Batch, Repetition},
    pipeline::{Pipeline, Threads, has_any_group, has_shares},
    resident::Resident,
    twins::{BEGIN, BODY_WRENCHES, CHECK, END_ROUND, END_ROUNDS, FINISH, Pass, RESUME, Rows},
};
use crate::{columns::RowCounts, kernel::Kernel, pbd::lattice::COLORS, stage::Stage};

/// Most repetitions of a step that end when they have converged: the clock counts the rounds of each.
pub(super) const REPETITIONS: usize = 4;
/// Rounds that are encoded before it is known how many are needed.
const FIRST_ROUNDS: u32 = 4;

/// A pass bound to its buffers.
#[derive(Debug)]
pub(super) struct Dispatch {
    pub(super) kernel: &'static str,
    pub(super) pipeline: Arc<Pipeline>,
    pub(super) bind: BindGroup,
    pub(super) groups: [u32; 2],
}

/// A part of a step.
#[derive(Debug)]
pub(super) enum Part {
    Once(Vec<Dispatch>),
    Rounds(Rounds),
}

/// A repetition that ends when it has converged. The rounds after that are encoded as well, and leave at once.
#[derive(Debug)]
pub(super) struct Rounds {
    pub(super) maximum: u32,
    /// Rounds that are encoded: a few more than were needed before. If they do not suffice the device stops, and the
    /// host hands in more.
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
    pub(super) step: Vec<Part>,
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
        let parts = self.parts(0, 0);
        parts.iter().map(|part| part.len()).sum::<usize>() + self.finish.len()
    }

    /// Whether a kernel with a property runs.
    pub(super) fn runs(&self, has: impl Fn(&Kernel) -> bool) -> bool {
        self.stages.iter().flat_map(Stage::kernels).any(|kernel| has(kernel))
    }

    /// The passes of a step in order, from the repetition `index` on if `index` is above 0: of that one `more` rounds.
    pub(super) fn parts(&self, index: usize, more: u32) -> Vec<&[Dispatch]> {
        let mut all: Vec<&[Dispatch]> = Vec::new();
        let mut seen = 0;
        for part in &self.step {
            match part {
                Part::Once(dispatches) if seen >= index => all.push(dispatches),
                Part::Once(_) => {}
                Part::Rounds(rounds) => {
                    seen += 1;
                    let count = if seen == index { more } else { rounds.planned };
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
        self.step.iter_mut().filter_map(|part| match part {
            Part::Rounds(rounds) => Some(rounds),
            Part::Once(_) => None,
        })
    }

    /// Plans one round more than were needed: one that leaves at once costs as much as its barriers, one that is missing costs
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

    /// Rounds to hand in for a repetition, counted from 1, of which some did not suffice.
    pub(super) fn more(&mut self, index: usize, done: u32) -> u32 {
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
        let mut before: Option<&Kernel> = None;
        let mut repetitions = 0;
        let kernels = stages.iter().flat_map(Stage::kernels);
        let last_search = kernels.rev().find(|kernel| kernel.searches_fluid()).map(|kernel| kernel.name);
        for stage in &stages {
            let mut dispatches = Vec::new();
            for kernel in stage.kernels() {
                let is_done = before.is_some_and(|before| kernel.is_done_by(before));
                let is_checked_later = kernel.searches_fluid() && last_search != Some(kernel.name);
                let is_needed = |pass: &&Pass| !(is_done || is_checked_later && **pass == CHECK);
                for pass in kernel.twin.iter().filter(is_needed) {
                    self.bind(kernel.name, pass, None, &mut dispatches)?;
                }
                before = Some(kernel);
            }
            match stage {
                Stage::Run(_) => match step.last_mut() {
                    Some(Part::Once(last)) => last.append(&mut dispatches),
                    _ => step.push(Part::Once(dispatches)),
                },
                Stage::Rounds { maximum, .. } => {
                    repetitions += 1;
                    step.push(Part::Rounds(self.rounds(*maximum, repetitions, dispatches)?));
                }
            }
        }
        let (mut begin, mut resume, mut finish) = (Vec::new(), Vec::new(), Vec::new());
        self.bind("clock", &BEGIN, None, &mut begin)?;
        self.bind("clock", &RESUME, None, &mut resume)?;
        if self.rows.bodies > 0 {
            self.bind("clock", &BODY_WRENCHES, None, &mut finish)?;
        }
        self.bind("clock", &FINISH, None, &mut finish)?;
        Ok(Program { stages, begin, resume, step, finish, prepared: None, bound: self.replaced })
    }

    /// A repetition, counted from 1.
    pub(super) fn rounds(
        &self,
        maximum: u32,
        index: usize,
        mut round: Vec<Dispatch>,
    ) -> Result<Rounds, GpuError> {
        if index > REPETITIONS {
            let reason = format!("more than {REPETITIONS} repetitions that end when they have converged");
            return Err(GpuError::Refused { reason });
        }
        let maximum = maximum.max(1);
        let repetition = self.uniform("repetition", &Repetition { maximum, index: index as u32 })?;
        let mut end = Vec::new();
        let own = Some(("repetition", &repetition));
        self.bind("clock", &END_ROUND, own, &mut round)?;
        self.bind("clock", &END_ROUNDS, own, &mut end)?;
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

    pub(super) fn bind(
        &self,
        kernel: &'static str,
        pass: &Pass,
        own: Option<(&str, &Buffer)>,
        into: &mut Vec<Dispatch>,
    ) -> Result<(), GpuError> {
        let text = sorb_shaders::shader(pass.shader).map_or("", |text| text.source);
        let batches = match pass.rows {
            Rows::Colors => 0..COLORS,
            Rows::VertexColors => COLORS..BATCHES,
            _ => 0..1,
        };
        for color in batches {
            let (threads, count) = match self.work(pass.rows, color) {
                Work::Groups(count) => (Threads { group: GROUP_THREADS, shares: 1 }, count),
                Work::Rows(rows) => {
                    let shares = if has_shares(text) { shares_of(rows) } else { 1 };
                    let group = if has_any_group(text) { group_of(rows) } else { GROUP_THREADS };
                    (Threads { group, shares }, rows.div_ceil(u64::from(group / shares)))
                }
            };
            let groups = self.lines(count);
            if groups[0] > 0 {
                let pipeline = self.gpu.pipeline(pass.shader, pass.entry, threads)?;
                let bind = self.gpu.guarded(None, || self.bind_group(pass, &pipeline, color, own))?;
                into.push(Dispatch { kernel, pipeline, bind, groups });
            }
        }
        Ok(())
    }

    pub(super) fn bind_group(
        &self,
        pass: &Pass,
        pipeline: &Pipeline,
        color: usize,
        own: Option<(&str, &Buffer)>,
    ) -> BindGroup {
        let entries: Vec<_> = pipeline
            .bindings
            .iter()
            .map(|binding| {
                let name = pass.buffer(binding.name);
                let own = own.filter(|(own, _)| *own == name).map(|(_, buffer)| buffer);
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

    /// Rows of a pass, or groups if its threads come in groups.
    fn work(&self, rows: Rows, color: usize) -> Work {
        let RowCounts { fluid, nodes, tets, bodies } = self.rows;
        let threads = |rows: usize| Work::Rows(rows as u64);
        let groups = Work::Groups;
        match rows {
            Rows::One => groups(1),
            Rows::Fluid => threads(fluid),
            Rows::Nodes => threads(nodes),
            Rows::Tets => threads(tets),
            Rows::FluidOrNodes => threads(fluid.max(nodes)),
            Rows::Colors | Rows::VertexColors => threads(self.batches[color].count as usize),
            Rows::Sponges => groups(self.params.sponges.len() as u64),
            Rows::Controls => groups(nodes.div_ceil(CONTROLS_PER_GROUP as usize) as u64),
            Rows::FluidScan => groups(u64::from(self.grids[0].pages() > u64::from(ONE_GROUP_PAGES))),
            Rows::ControlScan => groups(u64::from(self.grids[1].pages() > u64::from(ONE_GROUP_PAGES))),
            Rows::PairScan => groups(u64::from(self.grids[2].pages() > u64::from(ONE_GROUP_PAGES))),
            Rows::PairPages => groups(self.grids[2].pages()),
            Rows::FluidPages => groups(self.grids[0].pages()),
            Rows::ControlPages => groups(self.grids[1].pages()),
            Rows::ImageLineScan => groups(u64::from(self.grids[4].pages() > u64::from(ONE_GROUP_PAGES))),
            Rows::ImageLinePages => groups(self.grids[4].pages()),
            Rows::ImageScan => groups(u64::from(self.grids[3].pages() > u64::from(ONE_GROUP_PAGES))),
            Rows::ImagePages => groups(self.grids[3].pages()),
            Rows::Images => threads(self.capacities[IMAGES] as usize),
            Rows::ImagesOfBodies => threads(if bodies > 0 { self.capacities[IMAGES] as usize } else { 0 }),
            Rows::FluidBesideBodies => threads(if bodies > 0 { fluid } else { 0 }),
            Rows::Bodies => groups(bodies as u64),
        }
    }

    /// Groups in two dimensions, none larger than the device allows.
    fn lines(&self, count: u64) -> [u32; 2] {
        let maximum = u64::from(self.gpu.limits.max_compute_workgroups_per_dimension);
        if count <= maximum {
            return [count as u32, 1];
        }
        let lines = count.div_ceil(maximum);
        [count.div_ceil(lines) as u32, lines as u32]
    }
}

/// What a pass is over.
enum Work {
    /// Rows: groups are as large as is best, and threads share rows where there are few.
    Rows(u64),
    /// Groups of threads.
    Groups(u64),
}
