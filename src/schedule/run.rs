//! Runs a plan on the CPU, and takes the time of every phase.

use std::time::Instant;

use sorb_kernels::{columns::Columns, cpu::Cpu, kernel::has_converged, params::Params};

use super::{
    awake::Awake,
    plan::{Plan, Verdict, Work},
};

/// Times of a phase that are kept for its median.
const RECENT: usize = 512;

/// Time spent in a phase.
#[derive(Clone, Debug)]
pub struct PhaseTime {
    /// `family::name`.
    pub name: &'static str,
    /// Calls so far.
    pub calls: u64,
    /// Time of all calls \[s\].
    pub total_s: f64,
    recent_ms: Vec<f32>,
}

impl PhaseTime {
    fn new(name: &'static str) -> Self {
        Self { name, calls: 0, total_s: 0.0, recent_ms: Vec::with_capacity(RECENT) }
    }

    /// Median over the last calls \[ms\]; 0 if there were none.
    #[must_use]
    pub fn median_ms(&self) -> f32 {
        let mut sorted = self.recent_ms.clone();
        sorted.sort_by(f32::total_cmp);
        sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
    }

    fn record(&mut self, start: Instant) {
        self.record_seconds(start.elapsed().as_secs_f64());
    }

    fn record_seconds(&mut self, seconds: f64) {
        let slot = self.calls as usize % RECENT;
        self.calls += 1;
        self.total_s += seconds;
        let milliseconds = (seconds * 1e3) as f32;
        match self.recent_ms.get_mut(slot) {
            Some(recent) => *recent = milliseconds,
            None => self.recent_ms.push(milliseconds),
        }
    }
}

/// Consecutive kernels that are run together.
#[derive(Clone, Debug)]
struct Group {
    first: usize,
    last: usize,
    times: u32,
    /// Whether the repetitions end when the solve that they are rounds of has converged.
    until_converged: bool,
}

/// Plans, flattened to what is left of them.
#[derive(Clone, Debug)]
pub struct Runner {
    /// Of every plan, in the order of [`Awake::ALL`]; of one alone for a runner of that.
    sequences: Vec<Sequence>,
    times: Vec<PhaseTime>,
    step: PhaseTime,
}

/// What runs in a step, in order; with the place of its time.
#[derive(Clone, Debug, Default)]
struct Sequence {
    kernels: Vec<(Work, usize)>,
    groups: Vec<Group>,
}

impl Runner {
    /// The runner of a plan.
    #[must_use]
    pub fn new(plan: &Plan) -> Self {
        Self::of_all(std::slice::from_ref(plan))
    }

    /// The runner of several plans, which share its times.
    pub(crate) fn of_all(plans: &[Plan]) -> Self {
        let mut times = Vec::new();
        let sequences = plans.iter().map(|plan| Sequence::new(plan, &mut times)).collect();
        Self { sequences, times, step: PhaseTime::new("step") }
    }

    /// Runs all phases of the plan of what is awake in order; `host` does the host phases.
    pub(crate) fn run(
        &mut self,
        awake: Awake,
        (cpu, params): (&Cpu, &Params),
        columns: &mut Columns,
        host: impl FnMut(&mut Columns) + Send,
    ) {
        let Self { sequences, times, step } = self;
        let start = Instant::now();
        // Waking the threads would be all the cost of an empty scene.
        if let Some(sequence) = sequences.get(awake.index()).filter(|sequence| !sequence.kernels.is_empty()) {
            cpu.enter(|| sequence.run((cpu, params), columns, host, times));
        }
        step.record(start);
    }

    /// Takes over the time of steps on a device: of all of them together, and of every call of a kernel \[ms\] as far as
    /// it was taken.
    #[cfg(feature = "gpu")]
    pub(crate) fn record(&mut self, seconds: f64, steps: u32, calls: &[(&'static str, f32)]) {
        for _ in 0..steps {
            self.step.record_seconds(seconds / f64::from(steps));
        }
        for (name, milliseconds) in calls {
            let found = self.times.iter().position(|time| time.name == *name);
            let at = found.unwrap_or_else(|| {
                self.times.push(PhaseTime::new(name));
                self.times.len() - 1
            });
            self.times[at].record_seconds(f64::from(*milliseconds) * 1e-3);
        }
    }

    /// Time spent in whole steps.
    #[must_use]
    pub fn step_time(&self) -> &PhaseTime {
        &self.step
    }

    /// Time spent in every phase that runs, in the order of the step.
    #[must_use]
    pub fn times(&self) -> &[PhaseTime] {
        &self.times
    }

    /// Whether there is nothing to run.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.sequences.iter().all(|sequence| sequence.kernels.is_empty())
    }
}

impl Sequence {
    fn new(plan: &Plan, times: &mut Vec<PhaseTime>) -> Self {
        let mut sequence = Self::default();
        let mut group = None;
        for line in plan.lines().iter().filter(|line| line.verdict == Verdict::Runs) {
            let time = times.iter().position(|time| time.name == line.name).unwrap_or_else(|| {
                times.push(PhaseTime::new(line.name));
                times.len() - 1
            });
            let at = sequence.kernels.len();
            match (sequence.groups.last_mut(), line.repeat) {
                (Some(group_of), Some((index, _))) if group == Some(index) => group_of.last = at + 1,
                (_, repeat) => sequence.groups.push(Group {
                    first: at,
                    last: at + 1,
                    times: repeat.map_or(1, |(_, times)| times),
                    until_converged: line.until_converged,
                }),
            }
            group = line.repeat.map(|(index, _)| index);
            sequence.kernels.push((line.work, time));
        }
        sequence
    }

    fn run(
        &self,
        (cpu, params): (&Cpu, &Params),
        columns: &mut Columns,
        mut host: impl FnMut(&mut Columns),
        times: &mut [PhaseTime],
    ) {
        for group in &self.groups {
            let members = &self.kernels[group.first..group.last];
            for _ in 0..group.times {
                for (work, time) in members {
                    let start = Instant::now();
                    match work {
                        Work::Kernel(kernel) => (kernel.cpu)(cpu, params, columns),
                        Work::Host(_) => host(columns),
                    }
                    times[*time].record(start);
                }
                let has_converged = |(work, _): &(Work, usize)| match work {
                    Work::Kernel(kernel) => has_converged(kernel, columns),
                    Work::Host(_) => true,
                };
                if group.until_converged && members.iter().all(has_converged) {
                    break;
                }
            }
        }
    }
}
