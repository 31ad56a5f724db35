//! Runs a plan on the CPU, and measures the time of every phase.

use sorb_kernels::{columns::Columns, cpu::Cpu, params::Params};

use super::{
    awake::Awake,
    order::PlannedStage,
    plan::{Plan, Verdict},
};
use crate::stopwatch::Stopwatch;

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
    pub(crate) fn new(name: &'static str) -> Self {
        Self { name, calls: 0, total_s: 0.0, recent_ms: Vec::with_capacity(RECENT) }
    }

    /// Median over the last calls \[ms\]; 0 if there were none.
    #[must_use]
    pub fn median_ms(&self) -> f32 {
        let mut sorted = self.recent_ms.clone();
        sorted.sort_by(f32::total_cmp);
        sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
    }

    fn record(&mut self, start: Stopwatch) {
        self.record_seconds(start.seconds());
    }

    pub(crate) fn record_seconds(&mut self, seconds: f64) {
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

/// Plans, reduced to their active phases.
#[derive(Clone, Debug)]
pub struct Runner {
    /// One for every plan, in the order of [`Awake::ALL`]; a single one for a runner of one plan.
    orders: Vec<RunOrder>,
    pub(crate) times: Vec<PhaseTime>,
    pub(crate) step: PhaseTime,
}

/// The stages of a step in order, with the indices of the times of its kernels.
#[derive(Clone, Debug, Default)]
struct RunOrder {
    stages: Vec<(PlannedStage, Vec<usize>)>,
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
        let orders = plans.iter().map(|plan| RunOrder::new(plan, &mut times)).collect();
        Self { orders, times, step: PhaseTime::new("step") }
    }

    /// Takes over other plans, and keeps the times.
    pub(crate) fn follow(&mut self, plans: &[Plan]) {
        self.orders = plans.iter().map(|plan| RunOrder::new(plan, &mut self.times)).collect();
    }

    /// Runs all phases of the plan for the awake parts in order; `host` runs the host phases.
    pub(crate) fn run(
        &mut self,
        awake: Awake,
        (cpu, params): (&Cpu, &Params),
        columns: &mut Columns,
        host: impl FnMut(&mut Columns) + Send,
    ) {
        let Self { orders, times, step } = self;
        let start = Stopwatch::start();
        // Waking the threads would be the whole cost of an empty scene.
        if let Some(order) = orders.get(awake.index()).filter(|order| !order.stages.is_empty()) {
            cpu.enter(|| order.run((cpu, params), columns, host, times));
        }
        step.record(start);
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
        self.orders.iter().all(|order| order.stages.is_empty())
    }
}

impl RunOrder {
    fn new(plan: &Plan, times: &mut Vec<PhaseTime>) -> Self {
        for line in plan.lines().iter().filter(|line| line.verdict == Verdict::Runs) {
            slot(times, line.name);
        }
        let with_slots = |stage: PlannedStage| {
            let slots = match &stage {
                PlannedStage::Kernels(_, lines) => {
                    lines.iter().map(|line| slot(times, plan.lines()[*line].name)).collect()
                }
                PlannedStage::Host(host) => vec![slot(times, host.name)],
            };
            (stage, slots)
        };
        Self { stages: plan.in_order().into_iter().map(with_slots).collect() }
    }

    fn run(
        &self,
        (cpu, params): (&Cpu, &Params),
        columns: &mut Columns,
        mut host: impl FnMut(&mut Columns),
        times: &mut [PhaseTime],
    ) {
        for (stage, slots) in &self.stages {
            match stage {
                PlannedStage::Kernels(stage, _) => stage.run(columns, |index, kernel, columns| {
                    let start = Stopwatch::start();
                    (kernel.cpu)(cpu, params, columns);
                    times[slots[index]].record(start);
                }),
                PlannedStage::Host(_) => {
                    let start = Stopwatch::start();
                    host(columns);
                    times[slots[0]].record(start);
                }
            }
        }
    }
}

/// Index of the time of a phase, which is added if it is missing.
pub(crate) fn slot(times: &mut Vec<PhaseTime>, name: &'static str) -> usize {
    times.iter().position(|time| time.name == name).unwrap_or_else(|| {
        times.push(PhaseTime::new(name));
        times.len() - 1
    })
}
