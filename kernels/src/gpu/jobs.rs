//! The passes of a step before they are bound: which, over how many rows, by how many threads.

use super::{
    capacities::List,
    cells::ONE_GROUP_PAGES,
    groups::{CONTROLS_PER_GROUP, GROUP_THREADS, group_of, shares_of, sponge_parts},
    pack::BATCHES,
    pipeline::{Threads, has_any_group, has_shares},
    resident::Resident,
    twins::{BODY_WRENCHES, CHECK, FINISH, LAST, Pass, Rows},
};
use crate::{column::Life, columns::RowCounts, kernel::Kernel, pbd::lattice::COLORS, stage::Stage};

/// A pass, over the rows that a scene has for it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Job {
    pub(super) kernel: &'static str,
    pub(super) pass: Pass,
    /// Which of the batches, for passes that are dispatched once for each.
    pub(super) color: usize,
    pub(super) work: Work,
    pub(super) threads: Threads,
    pub(super) groups: [u32; 3],
}

/// The passes of a part of a step, in order.
#[derive(Debug)]
pub(super) enum Jobs {
    Once(Vec<Job>),
    /// Of one round.
    Rounds {
        maximum: u32,
        jobs: Vec<Job>,
    },
}

impl Jobs {
    pub(super) fn jobs(&self) -> &[Job] {
        match self {
            Self::Once(jobs) | Self::Rounds { jobs, .. } => jobs,
        }
    }
}

impl Resident {
    /// The passes of stages, without those that have no rows.
    pub(super) fn jobs_of(&self, stages: &[Stage]) -> Vec<Jobs> {
        let mut all = Vec::new();
        let mut before: Option<&Kernel> = None;
        let mut unchecked: Option<&'static str> = None;
        for (index, stage) in stages.iter().enumerate() {
            let mut jobs = Vec::new();
            let later = &stages[index..];
            // As late as it can be: nothing waits for it that need not.
            if let Some(kernel) = unchecked.filter(|_| is_check_due(later)) {
                unchecked = None;
                push_once(&mut all, self.jobs(kernel, &CHECK));
            }
            for kernel in stage.kernels() {
                let is_done = before.is_some_and(|before| kernel.is_done_by(before));
                let needed = kernel.twin.iter().filter(|pass| !is_done && **pass != CHECK);
                jobs.extend(needed.flat_map(|pass| self.jobs(kernel.name, pass)));
                unchecked = if kernel.searches_fluid() { Some(kernel.name) } else { unchecked };
                before = Some(kernel);
            }
            match stage {
                Stage::Run(_) => push_once(&mut all, jobs),
                Stage::Rounds { maximum, .. } => {
                    jobs.last_mut().into_iter().for_each(|job| job.pass = job.pass.from(LAST));
                    all.push(Jobs::Rounds { maximum: *maximum, jobs });
                }
            }
        }
        if let Some(kernel) = unchecked {
            push_once(&mut all, self.jobs(kernel, &CHECK));
        }
        all
    }

    /// The passes after the last phase of a step.
    pub(super) fn last_jobs(&self) -> Vec<Job> {
        let wrenches = if self.rows.bodies > 0 { self.jobs("clock", &BODY_WRENCHES) } else { Vec::new() };
        [wrenches, self.jobs("clock", &FINISH)].concat()
    }

    /// A pass as often as it is dispatched: once for every batch if it is over batches, and not at all without rows.
    pub(super) fn jobs(&self, kernel: &'static str, pass: &Pass) -> Vec<Job> {
        let text = sorb_shaders::shader(pass.shader).map_or("", |text| text.source);
        let batches = match pass.rows {
            Rows::Colors => 0..COLORS,
            Rows::VertexColors => COLORS..BATCHES,
            _ => 0..1,
        };
        let job = |color| {
            let work = self.work(pass.rows, color);
            let (threads, count) = match work {
                Work::Groups(count) => (Threads { group: GROUP_THREADS, shares: 1 }, count),
                Work::Rows(rows) => {
                    let shares = if has_shares(text) {
                        shares_of(self.sharing(pass.rows, rows), self.gpu.busy_threads)
                    } else {
                        1
                    };
                    let group = if has_any_group(text) { group_of(rows) } else { GROUP_THREADS };
                    (Threads { group, shares }, rows.div_ceil(u64::from(group / shares)))
                }
            };
            Job { kernel, pass: *pass, color, work, threads, groups: self.lines(count) }
        };
        batches.map(job).filter(|job| job.groups[0] > 0).collect()
    }

    /// Rows that decide how many threads share one: as many for images as for their particles.
    fn sharing(&self, rows: Rows, count: u64) -> u64 {
        if matches!(rows, Rows::Images | Rows::ImagesOfBodies) { self.rows.fluid as u64 } else { count }
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
            Rows::SpongeParts => groups((self.params.sponges.len() * sponge_parts(nodes)) as u64),
            Rows::DividedSponges => {
                groups(if sponge_parts(nodes) > 1 { self.params.sponges.len() as u64 } else { 0 })
            }
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
            Rows::Images => threads(List::Images.capacity(self.capacities)),
            Rows::ImagesOfBodies => {
                threads(if bodies > 0 { List::Images.capacity(self.capacities) } else { 0 })
            }
            Rows::FluidBesideBodies => threads(if bodies > 0 { fluid } else { 0 }),
            Rows::Bodies => groups(bodies as u64),
        }
    }

    /// Groups in two dimensions, none larger than the device allows.
    pub(super) fn lines(&self, count: u64) -> [u32; 3] {
        let maximum = u64::from(self.gpu.limits.max_compute_workgroups_per_dimension);
        if count <= maximum {
            return [count as u32, 1, 1];
        }
        let lines = count.div_ceil(maximum);
        [count.div_ceil(lines) as u32, lines as u32, 1]
    }
}

/// Appends passes to the last part.
fn push_once(all: &mut Vec<Jobs>, mut jobs: Vec<Job>) {
    match all.last_mut() {
        Some(Jobs::Once(last)) => last.append(&mut jobs),
        _ => all.push(Jobs::Once(jobs)),
    }
}

/// Whether what comes next may only be done if all lists fit: rounds, and what writes what survives the step.
fn is_check_due(stages: &[Stage]) -> bool {
    let searches = |kernel: &&Kernel| kernel.searches_fluid();
    let lasts = |kernel: &&Kernel| kernel.writes.iter().any(|column| column.life() == Life::State);
    let is_last = !stages.iter().flat_map(Stage::kernels).any(searches);
    let next = stages.first();
    is_last
        && next
            .is_some_and(|stage| matches!(stage, Stage::Rounds { .. }) || stage.kernels().iter().any(lasts))
}

/// What a pass is over.
#[derive(Clone, Copy, Debug)]
pub(super) enum Work {
    /// Rows: groups are as large as is best, and threads share rows where there are few.
    Rows(u64),
    /// Groups of threads.
    Groups(u64),
}
