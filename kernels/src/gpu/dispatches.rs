//! How many dispatches a step takes on a device.

use std::fmt;

use super::{
    fusion::{Dispatched, dispatched},
    groups::CONTROL_THREADS,
    jobs::{Job, Jobs},
    program::FIRST_ROUNDS,
    resident::Resident,
    twins::{END_ROUNDS, Rows},
};
use crate::stage::Stage;

/// Dispatches of a step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dispatches {
    /// Every dispatch in order: its passes, those side by side after a bar; and whether it is of a round.
    pub passes: Vec<(String, bool)>,
    /// Kernels in the order of their first pass.
    pub kernels: Vec<KernelDispatches>,
    /// Dispatches outside of repetitions that end when they have converged.
    pub once: usize,
    /// For every such repetition the dispatches of a round, and the rounds that are assumed.
    pub rounds: Vec<(usize, u32)>,
}

/// Dispatches of a kernel in a step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KernelDispatches {
    /// `family::name`; `clock` for what chooses the length of steps and ends repetitions.
    pub kernel: &'static str,
    /// Passes outside of repetitions that end when they have converged.
    pub once: usize,
    /// Passes in a round of such a repetition.
    pub in_round: usize,
    /// Most threads that share a row in one of its passes.
    pub threads: u32,
}

impl Dispatches {
    /// All of a step.
    #[must_use]
    pub fn total(&self) -> usize {
        self.once + self.rounds.iter().map(|(passes, rounds)| passes * *rounds as usize).sum::<usize>()
    }

    /// Lists dispatches, and returns their number.
    fn list(&mut self, dispatched: &[Dispatched], is_round: bool) -> usize {
        self.passes.extend(dispatched.iter().map(|all| (all.names(), is_round)));
        dispatched.len()
    }

    fn count(&mut self, jobs: &[Job], is_round: bool) {
        for job in jobs {
            let threads = if job.pass.rows == Rows::Controls { CONTROL_THREADS } else { job.threads.shares };
            let index = self.kernels.iter().position(|own| own.kernel == job.kernel).unwrap_or_else(|| {
                self.kernels.push(KernelDispatches { kernel: job.kernel, once: 0, in_round: 0, threads: 1 });
                self.kernels.len() - 1
            });
            let own = &mut self.kernels[index];
            own.threads = own.threads.max(threads);
            *(if is_round { &mut own.in_round } else { &mut own.once }) += 1;
        }
    }
}

impl fmt::Display for Dispatches {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(formatter, "dispatches of a step, and of a round:")?;
        for (names, is_round) in &self.passes {
            writeln!(formatter, "{} {names}", if *is_round { "round" } else { "once " })?;
        }
        writeln!(formatter, "passes of a step, those of a round, and threads of a row:")?;
        for KernelDispatches { kernel, once, in_round, threads } in &self.kernels {
            writeln!(formatter, "{once:6} {in_round:6} {threads:6}  {kernel}")?;
        }
        write!(formatter, "dispatches of a step: {}", self.once)?;
        for (passes, rounds) in &self.rounds {
            write!(formatter, ", {rounds} rounds of {passes}")?;
        }
        writeln!(formatter, "; {} in all", self.total())
    }
}

impl Resident {
    /// The dispatches of a step of these stages. Of repetitions that end when they have converged it has the rounds that
    /// are encoded at first.
    #[must_use]
    pub fn dispatches_of(&self, stages: &[Stage]) -> Dispatches {
        let mut all = Dispatches { passes: Vec::new(), kernels: Vec::new(), once: 0, rounds: Vec::new() };
        for part in self.jobs_of(stages) {
            match part {
                Jobs::Once(jobs) => {
                    all.once += all.list(&self.dispatched(&jobs), false);
                    all.count(&jobs, false);
                }
                Jobs::Rounds { maximum, jobs } => {
                    let end = self.jobs("clock", &END_ROUNDS);
                    let of_round = all.list(&self.dispatched(&jobs), true);
                    all.rounds.push((of_round, maximum.min(FIRST_ROUNDS)));
                    all.once += all.list(&dispatched(&end, None), false);
                    all.count(&jobs, true);
                    all.count(&end, false);
                }
            }
        }
        let last = self.last_jobs();
        all.once += all.list(&dispatched(&last, None), false);
        all.count(&last, false);
        all
    }
}
