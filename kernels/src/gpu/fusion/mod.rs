//! Passes that are one dispatch. Passes over the same rows run one after the other, and independent ones side by side. A dispatch waits for
//! the one before it, which costs a small scene more than the work.

mod access;
#[cfg(test)]
mod tests;
mod text;

use std::sync::Arc;

use sorb_shaders::Shader;
use wgpu::Limits;

use super::{
    groups::{CONTROLS_PER_GROUP, GROUP_THREADS},
    jobs::{Job, Work},
    pipeline::{Threads, has_any_group, has_shares},
    twins::Rows,
};
use access::{Access, Order, accesses, occurrences, order};
pub(super) use text::Fused;

/// Rows from which on a pass is alone: it keeps a device busy, and how long it waits does not matter.
const MANY_ROWS: u64 = 131_072;

/// What the rows of a pass are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Domain {
    Fluid,
    Nodes,
    Images,
    Tets,
    /// Groups, which know themselves whether they have work.
    Groups,
}

/// Which thread has which row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mapping {
    /// Each its own.
    Plain,
    /// Several share one.
    Shared,
    /// Thirty-two share one.
    Controls,
}

/// A pass and what decides with which others it can be.
#[derive(Clone, Debug)]
struct Candidate {
    job: Job,
    /// What it shares with others, and what it has for itself.
    common: Vec<&'static str>,
    own: String,
    accesses: Vec<Access>,
    /// None for a pass that is always alone.
    domain: Option<Domain>,
    mapping: Mapping,
    /// Whether groups can have any number of threads.
    has_any_group: bool,
    /// Whether it depends on which rows are in a group.
    knows_groups: bool,
}

/// Passes over the same rows, one after the other.
#[derive(Clone, Debug)]
struct Strand {
    domain: Option<Domain>,
    mapping: Mapping,
    passes: Vec<Arc<Candidate>>,
}

/// Passes of one dispatch.
#[derive(Clone, Debug)]
pub(super) struct Dispatched {
    threads: Threads,
    strands: Vec<Strand>,
}

impl Candidate {
    fn of(job: &Job, shader: &'static Shader) -> Self {
        let mapping = match job.pass.rows {
            Rows::Controls => Mapping::Controls,
            _ if has_shares(shader.source) => Mapping::Shared,
            _ => Mapping::Plain,
        };
        let domain = domain_of(job, shader);
        let (common, own) = text::parts_of(shader, job.pass.names);
        Self {
            job: *job,
            common,
            accesses: accesses(&job.pass, shader),
            domain,
            mapping,
            has_any_group: has_any_group(shader.source),
            knows_groups: domain == Some(Domain::Groups) || occurrences(&own, "group_of").next().is_some(),
            own,
        }
    }

    /// Whether it can have its rows by another mapping than its own, with several threads a row.
    fn follows(&self, mapping: Mapping) -> bool {
        self.mapping == mapping || self.mapping == Mapping::Plain && !self.knows_groups
    }

    /// Whether its groups can have this number of threads.
    fn allows(&self, group: u32) -> bool {
        self.job.threads.group == group || self.has_any_group && !self.knows_groups && group == GROUP_THREADS
    }
}

/// What the rows of a pass are; none for a pass that is always alone.
fn domain_of(job: &Job, shader: &Shader) -> Option<Domain> {
    let domain = match job.pass.rows {
        Rows::Fluid | Rows::FluidBesideBodies => Domain::Fluid,
        Rows::Nodes | Rows::Controls => Domain::Nodes,
        Rows::Images | Rows::ImagesOfBodies => Domain::Images,
        Rows::Tets => Domain::Tets,
        Rows::One if shader.own.contains("@workgroup_size(GROUP_THREADS)") => Domain::Groups,
        Rows::Bodies
        | Rows::FluidPages
        | Rows::ControlPages
        | Rows::PairPages
        | Rows::ImagePages
        | Rows::ImageLinePages => Domain::Groups,
        _ => return None,
    };
    let is_large = matches!(job.work, Work::Rows(rows) if rows >= MANY_ROWS);
    (!is_large).then_some(domain)
}

impl Strand {
    fn of(pass: Arc<Candidate>) -> Self {
        Self { domain: pass.domain, mapping: pass.mapping, passes: vec![pass] }
    }

    /// With a pass behind the others, if it can be over the same rows.
    fn with(&self, pass: &Arc<Candidate>) -> Option<Self> {
        let mapping = if pass.mapping == Mapping::Plain { self.mapping } else { pass.mapping };
        let follow = self.passes.iter().chain([pass]).all(|pass| pass.follows(mapping));
        let is_same = self.domain == pass.domain && self.domain != Some(Domain::Groups);
        let passes = || self.passes.iter().chain([pass]).cloned().collect();
        (is_same && follow).then(|| Self { domain: self.domain, mapping, passes: passes() })
    }
}

/// Puts passes into as few dispatches as their buffers and the limits of a device permit: each as early as what it depends on.
/// Without limits every pass is a dispatch.
pub(super) fn dispatched(jobs: &[Job], limits: Option<&Limits>) -> Vec<Dispatched> {
    let mut all: Vec<Dispatched> = Vec::new();
    for job in jobs {
        let Some(shader) = sorb_shaders::shader(job.pass.shader) else { continue };
        let pass = Arc::new(Candidate::of(job, shader));
        let (first, strand) = earliest(&all, &pass);
        let joined = (first..all.len()).find_map(|index| {
            let required = strand.filter(|_| index == first);
            let joined = all[index].with(&pass, required, limits?);
            joined.map(|joined| (index, joined))
        });
        match joined {
            Some((index, joined)) => all[index] = joined,
            None => all.push(Dispatched { threads: job.threads, strands: vec![Strand::of(pass)] }),
        }
    }
    all
}

/// The first dispatch that a pass can be in, and the strand of it that it then has to join.
fn earliest(all: &[Dispatched], pass: &Candidate) -> (usize, Option<usize>) {
    for (index, dispatched) in all.iter().enumerate().rev() {
        let order_of = |strand: &Strand| {
            let orders = strand.passes.iter().map(|before| order(&before.accesses, &pass.accesses));
            orders.max().unwrap_or(Order::Any)
        };
        let orders: Vec<Order> = dispatched.strands.iter().map(order_of).collect();
        let mut bound = (0..orders.len()).filter(|strand| orders[*strand] != Order::Any);
        if let Some(strand) = bound.next() {
            let is_by_row = orders[strand] == Order::ByRow && bound.next().is_none();
            return if is_by_row { (index, Some(strand)) } else { (index + 1, None) };
        }
    }
    (0, None)
}

impl Dispatched {
    /// With another pass: in the strand that is required, or in any, or beside them all.
    fn with(&self, pass: &Arc<Candidate>, required: Option<usize>, limits: &Limits) -> Option<Self> {
        let is_open = pass.domain.is_some() && self.passes().all(|pass| pass.domain.is_some());
        let threads = self.threads_with(pass).filter(|_| is_open)?;
        let replaced = |index: usize| {
            let mut strands = self.strands.clone();
            strands[index] = strands[index].with(pass)?;
            Some(Self { threads, strands })
        };
        let beside = || {
            let strands = self.strands.iter().cloned().chain([Strand::of(Arc::clone(pass))]).collect();
            Some(Self { threads, strands })
        };
        let joined = match required {
            Some(index) => replaced(index),
            None => (0..self.strands.len()).find_map(replaced).or_else(beside),
        };
        joined.filter(|joined| joined.fits(limits))
    }

    /// Threads of a group and of a row with another pass.
    fn threads_with(&self, pass: &Arc<Candidate>) -> Option<Threads> {
        let group = self.threads.group.max(pass.job.threads.group);
        let is_allowed = self.passes().chain([pass]).all(|pass| pass.allows(group));
        let mut shares = self.passes().chain([pass]).filter(|pass| pass.mapping == Mapping::Shared);
        let first = shares.next().map_or(1, |pass| pass.job.threads.shares);
        let is_same = shares.all(|pass| pass.job.threads.shares == first);
        (is_allowed && is_same).then_some(Threads { group, shares: first })
    }

    /// Whether a device can bind it.
    fn fits(&self, limits: &Limits) -> bool {
        let Some(bindings) = text::bindings_of(self) else { return false };
        let storage = bindings.iter().filter(|binding| binding.is_storage()).count();
        storage <= limits.max_storage_buffers_per_shader_stage as usize
            && bindings.len() <= limits.max_buffers_and_acceleration_structures_per_shader_stage as usize
            && text::workgroup_bytes(self) <= limits.max_compute_workgroup_storage_size
    }

    fn passes(&self) -> impl Iterator<Item = &Arc<Candidate>> {
        self.strands.iter().flat_map(|strand| &strand.passes)
    }

    /// Its pass, if it is only one.
    pub(super) fn single(&self) -> Option<&Job> {
        let mut passes = self.passes();
        let first = passes.next()?;
        passes.next().is_none().then_some(&first.job)
    }

    pub(super) fn jobs(&self) -> impl Iterator<Item = &Job> {
        self.passes().map(|pass| &pass.job)
    }

    /// Names of the passes: one after the other, and side by side.
    pub(super) fn names(&self) -> String {
        let of_strand = |strand: &Strand| {
            strand.passes.iter().map(|pass| pass.job.pass.shader).collect::<Vec<_>>().join(", ")
        };
        self.strands.iter().map(of_strand).collect::<Vec<_>>().join(" | ")
    }

    /// What tells its text from others.
    pub(super) fn key(&self) -> String {
        let of_pass = |pass: &Arc<Candidate>| format!("{:?}", pass.job.pass);
        let of_strand = |strand: &Strand| strand.passes.iter().map(of_pass).collect::<Vec<_>>().join(", ");
        self.strands.iter().map(of_strand).collect::<Vec<_>>().join(" | ")
    }

    pub(super) fn threads(&self) -> Threads {
        self.threads
    }

    /// Its groups; in line, and side by side.
    pub(super) fn groups(&self) -> (u64, u32) {
        let Threads { group, shares } = self.threads;
        let count = |strand: &Strand| match strand.passes[0].job.work {
            Work::Groups(count) => count,
            Work::Rows(rows) => match strand.mapping {
                Mapping::Plain => rows.div_ceil(group.into()),
                Mapping::Shared => rows.div_ceil((group / shares).into()),
                Mapping::Controls => rows.div_ceil(CONTROLS_PER_GROUP.into()),
            },
        };
        (self.strands.iter().map(count).max().unwrap_or(0), self.strands.len() as u32)
    }
}
