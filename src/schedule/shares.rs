//! The share of a step that a device has.

use sorb_kernels::{columns::Column, kernel::Kernel};

use super::{
    offload::BESIDE_SORT,
    plan::{Plan, Verdict, Work},
};

/// Kernels of a step by place, repetitions written out, and what travels between them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shares {
    /// On the CPU, before all others.
    pub(crate) cpu: Vec<&'static Kernel>,
    /// On the device.
    pub(crate) gpu: Vec<&'static Kernel>,
    /// Columns that the device needs and does not make itself.
    pub(crate) sent: Vec<Column>,
    /// Columns that the device makes.
    pub(crate) fetched: Vec<Column>,
    /// Whether the particles are sorted before the device has its turn.
    pub(crate) sort_is_done: bool,
}

impl Plan {
    /// Kernels that run, in order, repetitions written out.
    fn kernels(&self) -> Vec<&'static Kernel> {
        let mut all = Vec::new();
        let lines = self.lines();
        for group in lines.chunk_by(|a, b| a.group().is_some() && a.group() == b.group()) {
            let times = group[0].repeat.map_or(1, |(_, times)| times);
            for _ in 0..times {
                for line in group.iter().filter(|line| line.verdict == Verdict::Runs) {
                    if let Work::Kernel(kernel) = line.work {
                        all.push(kernel);
                    }
                }
            }
        }
        all
    }

    /// The first kernel that runs.
    #[cfg(feature = "gpu")]
    pub(crate) fn first_kernel(&self) -> Option<&'static str> {
        self.kernels().first().map(|kernel| kernel.name)
    }

    /// Whether a kernel runs.
    #[cfg(feature = "gpu")]
    pub(crate) fn runs(&self, name: &str) -> bool {
        self.lines().iter().any(|line| line.name == name && line.verdict == Verdict::Runs)
    }

    /// The shares of CPU and device, as the plan is placed.
    pub(crate) fn shares(&self) -> Shares {
        let first = self.placement().and_then(|placement| placement.first);
        self.shares_from(first)
    }

    /// The shares if the device has everything from `first` on.
    pub(crate) fn shares_from(&self, first: Option<&str>) -> Shares {
        let mut shares = Shares { cpu: self.kernels(), ..Shares::default() };
        let Some(at) = first.and_then(|first| shares.cpu.iter().position(|kernel| kernel.name == first))
        else {
            return shares;
        };
        shares.gpu = shares.cpu.split_off(at);
        shares.sort_is_done = shares.cpu.iter().any(|kernel| kernel.name == "grid::sort_fluid");
        if shares.sort_is_done {
            let (beside, rest) = shares.gpu.iter().partition(|kernel| BESIDE_SORT.contains(&kernel.name));
            shares.gpu = rest;
            shares.cpu.extend::<Vec<_>>(beside);
        }
        for kernel in &shares.gpu {
            for column in kernel.reads.iter().filter(|column| !shares.fetched.contains(column)) {
                if !shares.sent.contains(column) {
                    shares.sent.push(*column);
                }
            }
            for column in kernel.writes {
                if !shares.fetched.contains(column) {
                    shares.fetched.push(*column);
                }
            }
        }
        shares
    }
}
