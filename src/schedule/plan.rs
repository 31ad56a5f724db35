//! The plan: the checked step, without phases that the scene does not need or whose results nobody reads.

use std::fmt;

use sorb_kernels::{
    column::Life,
    columns::Column,
    contents::Contents,
    kernel::Kernel,
    need::Need,
    step::{HostPhase, Phase, Times},
};

use super::offload::{Place, Placement};

/// Decision about a phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It runs.
    Runs,
    /// It does not, for this reason.
    Skipped(&'static str),
}

/// A phase of a plan: a kernel or what the host does, with the decision about it.
#[derive(Clone, Debug)]
pub struct PlannedPhase {
    /// `family::name`.
    pub name: &'static str,
    /// Whether it runs.
    pub verdict: Verdict,
    /// Group of the repetition, and number of repetitions.
    pub repeat: Option<(usize, u32)>,
    /// Whether the repetitions end when their solve has converged.
    pub until_converged: bool,
    pub(crate) work: Work,
}

/// What a line runs.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Work {
    Kernel(&'static Kernel),
    Host(&'static HostPhase),
}

/// Why a step cannot be planned: a mistake in the step or in a declaration, not in a scene.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{kernel} reads {column}, which is rebuilt in every step and was not written before it")]
pub struct PlanError {
    /// The reader.
    pub kernel: &'static str,
    /// What it reads.
    pub column: &'static str,
}

/// The phases of a step for one scene.
#[derive(Clone, Debug)]
pub struct Plan {
    lines: Vec<PlannedPhase>,
    pub(crate) placement: Option<Placement>,
}

impl Plan {
    /// Plans `step` for a scene. `observed` columns are kept up to date although no phase reads them.
    ///
    /// # Errors
    /// A phase reads a scratch column that no phase before it has written.
    pub(crate) fn new(
        step: &[Phase],
        contents: &Contents<'_>,
        observed: &[Column],
    ) -> Result<Self, PlanError> {
        let mut plan = Self { lines: Vec::new(), placement: None };
        plan.collect(step, contents, None, &mut 0);
        plan.drop_dead(observed);
        plan.check()?;
        Ok(plan)
    }

    /// All lines, in the order of the step.
    #[must_use]
    pub fn lines(&self) -> &[PlannedPhase] {
        &self.lines
    }

    /// Placement of the step; none if only the CPU was requested.
    #[must_use]
    pub fn placement(&self) -> Option<&Placement> {
        self.placement.as_ref()
    }

    /// Where a phase runs.
    #[must_use]
    pub fn place(&self, name: &str) -> Place {
        let on_gpu = self.placement.as_ref().map_or(&[][..], |placement| &placement.on_gpu);
        if on_gpu.contains(&name) { Place::Gpu } else { Place::Cpu }
    }

    /// Lines that are repeated together, and single ones.
    pub(crate) fn groups(&self) -> impl DoubleEndedIterator<Item = &[PlannedPhase]> {
        self.lines.chunk_by(|a, b| a.group().is_some() && a.group() == b.group())
    }

    fn collect(
        &mut self,
        phases: &[Phase],
        contents: &Contents<'_>,
        repeat: Option<(usize, u32)>,
        groups: &mut usize,
    ) {
        for phase in phases {
            match phase {
                Phase::Named(block) => self.collect(block.phases, contents, repeat, groups),
                Phase::Run(kernel) => {
                    self.lines.push(PlannedPhase::new(Work::Kernel(kernel), contents, repeat))
                }
                Phase::Host(host) => self.lines.push(PlannedPhase::new(Work::Host(host), contents, repeat)),
                Phase::Repeat { times, phases } => {
                    *groups += 1;
                    let first = self.lines.len();
                    self.collect(phases, contents, Some((*groups, times.number(contents))), groups);
                    let until_converged = matches!(times, Times::UntilConverged(_));
                    self.lines[first..].iter_mut().for_each(|line| line.until_converged = until_converged);
                }
                Phase::With { needs, phases } => {
                    let first = self.lines.len();
                    self.collect(phases, contents, repeat, groups);
                    if let Some(reason) = needs.iter().find_map(|need| need.missing(contents)) {
                        self.lines[first..]
                            .iter_mut()
                            .for_each(|line| line.verdict = Verdict::Skipped(reason));
                    }
                }
                Phase::KeepDensity { solve, divergence, projection } => {
                    let kept = Phase::kept([solve, divergence, projection], contents);
                    self.collect(kept, contents, repeat, groups);
                }
            }
        }
    }

    /// Goes backwards and skips phases on which neither the state nor a later phase depends.
    fn drop_dead(&mut self, observed: &[Column]) {
        let mut live: Vec<Column> =
            Column::ALL.iter().copied().filter(|column| column.life() == Life::State).collect();
        live.extend_from_slice(observed);
        let mut runs = vec![false; self.lines.len()];
        let mut first = self.lines.len();
        for group in self.groups().rev() {
            first -= group.len();
            // A repetition may read what the previous one wrote: two passes find all of it.
            for _ in 0..if group[0].group().is_some() { 2 } else { 1 } {
                for (line, runs) in group.iter().zip(&mut runs[first..]).rev() {
                    *runs = line.verdict == Verdict::Runs
                        && line.work.writes().iter().any(|column| live.contains(column));
                    if *runs {
                        live.extend_from_slice(line.work.reads());
                    }
                }
            }
        }
        for (line, runs) in self.lines.iter_mut().zip(runs) {
            if line.verdict == Verdict::Runs && !runs {
                line.verdict = Verdict::Skipped("nobody reads what it writes");
            }
        }
    }

    fn check(&self) -> Result<(), PlanError> {
        let mut written: Vec<Column> = Vec::new();
        for line in self.lines.iter().filter(|line| line.verdict == Verdict::Runs) {
            if let Work::Kernel(kernel) = line.work {
                let early = kernel
                    .reads
                    .iter()
                    .find(|column| column.life().is_rebuilt() && !written.contains(column));
                if let Some(column) = early {
                    return Err(PlanError { kernel: kernel.name, column: column.name() });
                }
            }
            written.extend_from_slice(line.work.writes());
        }
        Ok(())
    }
}

impl Work {
    fn name(self) -> &'static str {
        match self {
            Self::Kernel(kernel) => kernel.name,
            Self::Host(host) => host.name,
        }
    }

    fn needs(self) -> &'static [Need] {
        match self {
            Self::Kernel(kernel) => kernel.needs,
            Self::Host(host) => host.needs,
        }
    }

    pub(crate) fn reads(self) -> &'static [Column] {
        match self {
            Self::Kernel(kernel) => kernel.reads,
            Self::Host(host) => host.reads,
        }
    }

    pub(crate) fn writes(self) -> &'static [Column] {
        match self {
            Self::Kernel(kernel) => kernel.writes,
            Self::Host(host) => host.writes,
        }
    }
}

impl PlannedPhase {
    fn new(work: Work, contents: &Contents<'_>, repeat: Option<(usize, u32)>) -> Self {
        let missing = work.needs().iter().find_map(|need| need.missing(contents));
        let verdict = missing.map_or(Verdict::Runs, Verdict::Skipped);
        Self { name: work.name(), verdict, repeat, until_converged: false, work }
    }

    /// The group that the line is repeated in.
    fn group(&self) -> Option<usize> {
        self.repeat.map(|(group, _)| group)
    }

    /// Names of the columns that the phase reads, `store.quantity`.
    pub fn reads(&self) -> impl Iterator<Item = &'static str> {
        self.work.reads().iter().map(|column| column.name())
    }

    /// Names of the columns that the phase writes.
    pub fn writes(&self) -> impl Iterator<Item = &'static str> {
        self.work.writes().iter().map(|column| column.name())
    }
}

impl fmt::Display for Plan {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let transfers = self.placement.as_ref().map_or(&[][..], |placement| &placement.transfers);
        if let Some(Placement { offload, on_gpu, reason, .. }) = &self.placement {
            let place = if on_gpu.is_empty() { "cpu" } else { "gpu" };
            writeln!(formatter, "backend {place}, of {offload}: {reason}")?;
        }
        for (index, line) in self.lines.iter().enumerate() {
            for transfer in transfers.iter().filter(|transfer| transfer.line == Some(index)) {
                writeln!(formatter, "{transfer}")?;
            }
            let repeat = match line.repeat {
                Some((_, times)) if line.until_converged => format!("up to {times} x "),
                Some((_, times)) => format!("{times} x "),
                None => String::new(),
            };
            match line.verdict {
                Verdict::Runs => {
                    writeln!(formatter, "{:5} {repeat}{}", self.verb(line), line.name)?;
                    writeln!(formatter, "      reads  {}", line.reads().collect::<Vec<_>>().join(", "))?;
                    writeln!(formatter, "      writes {}", line.writes().collect::<Vec<_>>().join(", "))?;
                }
                Verdict::Skipped(reason) => writeln!(formatter, "skip  {repeat}{}: {reason}", line.name)?,
            }
        }
        for transfer in transfers.iter().filter(|transfer| transfer.line.is_none()) {
            writeln!(formatter, "{transfer}")?;
        }
        Ok(())
    }
}

impl Plan {
    /// What a line of a phase begins with.
    fn verb(&self, line: &PlannedPhase) -> &'static str {
        match (&self.placement, line.work, self.place(line.name)) {
            (None, ..) => "run",
            (_, Work::Host(_), _) => "host",
            (_, _, Place::Cpu) => "cpu",
            (_, _, Place::Gpu) => "gpu",
        }
    }
}
