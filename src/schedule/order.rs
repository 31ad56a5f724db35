//! A plan in execution order: without skipped phases, with repetitions written out.

use sorb_kernels::{stage::Stage, step::HostPhase};

use super::plan::{Plan, PlannedPhase, Verdict, Work};

/// A stage of a plan.
#[derive(Clone, Debug)]
pub(crate) enum PlannedStage {
    /// Kernels, with the indices of their lines in the plan.
    Kernels(Stage, Vec<usize>),
    /// A phase of the host.
    Host(&'static HostPhase),
}

impl Plan {
    /// The active phases in order. Repetitions are written out, except iterations until convergence.
    pub(crate) fn in_order(&self) -> Vec<PlannedStage> {
        let mut stages = Vec::new();
        let mut first = 0;
        for group in self.groups() {
            let lines = (first..).zip(group).filter(|(_, line)| line.verdict == Verdict::Runs);
            let times = group[0].repeat.map_or(1, |(_, times)| times);
            if group[0].until_converged {
                stages.extend(rounds(times, lines));
            } else {
                for _ in 0..times {
                    stages.extend(lines.clone().map(|(number, line)| match line.work {
                        Work::Kernel(kernel) => PlannedStage::Kernels(Stage::Run(kernel), vec![number]),
                        Work::Host(host) => PlannedStage::Host(host),
                    }));
                }
            }
            first += group.len();
        }
        stages
    }
}

/// Iterations until convergence; none without kernels.
fn rounds<'a>(maximum: u32, lines: impl Iterator<Item = (usize, &'a PlannedPhase)>) -> Option<PlannedStage> {
    let kernel = |(number, line): (usize, &PlannedPhase)| match line.work {
        Work::Kernel(kernel) => Some((kernel, number)),
        Work::Host(_) => None,
    };
    let (kernels, numbers): (Vec<_>, Vec<_>) = lines.filter_map(kernel).unzip();
    (!kernels.is_empty()).then_some(PlannedStage::Kernels(Stage::Rounds { maximum, kernels }, numbers))
}
