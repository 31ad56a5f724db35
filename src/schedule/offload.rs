//! Where a step runs: what the host asks for, and what becomes of it.

use std::{fmt, str::FromStr};

use sorb_kernels::kernel::kernel;

/// What the host wants to run on a GPU.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Offload {
    /// Nothing: everything on the CPU, with the same bits on every machine. The default.
    #[default]
    Cpu,
    /// Everything; an error if there is no adapter.
    Gpu,
    /// Everything, if there is a real adapter and enough rows to keep it busy; else nothing. The plan says why.
    Auto,
    /// This kernel and all after it in the step; those before it on the CPU, with all columns sent to and fro in every
    /// step. To find the kernel that differs.
    From(&'static str),
}

impl Offload {
    /// Whether a GPU may be used at all.
    #[must_use]
    pub fn wants_gpu(self) -> bool {
        self != Self::Cpu
    }
}

/// A text that names no way to offload.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no backend; there are: cpu, gpu, auto, from:KERNEL with a kernel such as sph::density")]
pub struct OffloadError(String);

impl FromStr for Offload {
    type Err = OffloadError;

    fn from_str(text: &str) -> Result<Self, OffloadError> {
        match text {
            "cpu" => Ok(Self::Cpu),
            "gpu" => Ok(Self::Gpu),
            "auto" => Ok(Self::Auto),
            other => other
                .strip_prefix("from:")
                .and_then(kernel)
                .map(|kernel| Self::From(kernel.name))
                .ok_or_else(|| OffloadError(text.to_owned())),
        }
    }
}

impl fmt::Display for Offload {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cpu => formatter.write_str("cpu"),
            Self::Gpu => formatter.write_str("gpu"),
            Self::Auto => formatter.write_str("auto"),
            Self::From(kernel) => write!(formatter, "from:{kernel}"),
        }
    }
}

/// Where a phase runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// On the CPU.
    Cpu,
    /// On the GPU.
    Gpu,
}

/// Where a whole step runs, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Placement {
    /// What was asked for.
    pub offload: Offload,
    /// The first kernel that runs on the GPU; none if all run on the CPU.
    pub first: Option<&'static str>,
    /// Name of the adapter, and why it is used or not.
    pub reason: String,
    /// What is sent between host and device, in the order of a step.
    pub transfers: Vec<Transfer>,
}

/// Something that is sent in every step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Transfer {
    /// The phase that it is sent before; none for the end of the step.
    pub before: Option<&'static str>,
    /// Whether it is sent to the device, else from it.
    pub to_device: bool,
    /// What is sent: columns, or `clock`.
    pub what: String,
    /// How much \[B\].
    pub bytes: u64,
}

impl fmt::Display for Transfer {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verb = if self.to_device { "send" } else { "fetch" };
        write!(formatter, "{verb:5} {}: {} bytes", self.what, self.bytes)
    }
}

impl Placement {
    /// Everything on the CPU.
    #[must_use]
    pub fn cpu(offload: Offload, reason: impl Into<String>) -> Self {
        Self { offload, first: None, reason: reason.into(), transfers: Vec::new() }
    }
}

/// Kernels that go through the cells that `grid::sort_fluid` made, which do not travel: where the sort runs on the CPU,
/// so do they, and before everything else that does not.
pub(crate) const BESIDE_SORT: [&str; 2] = ["grid::fluid_neighbors", "couple::controls"];

/// The kernel that [`Offload::From`] really begins with: the sort, where it names the search that goes with it.
#[cfg(feature = "gpu")]
pub(crate) fn beginning(name: &'static str) -> &'static str {
    if name == "grid::fluid_neighbors" { "grid::sort_fluid" } else { name }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sorb_kernels::kernel::KERNELS;

    #[test]
    fn names_round_trip_and_others_are_refused() {
        for offload in [Offload::Cpu, Offload::Gpu, Offload::Auto, Offload::From(KERNELS[5].name)] {
            assert_eq!(offload.to_string().parse(), Ok(offload));
        }
        for bad in ["", "cuda", "from:", "from:sph::nothing", "sph::density"] {
            let error = bad.parse::<Offload>().map_err(|error| error.to_string());
            assert!(error.is_err_and(|error| error.contains("from:KERNEL")), "{bad}");
        }
    }
}
