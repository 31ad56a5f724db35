//! Placement of a step: the request of the host, and the result.

use std::{fmt, str::FromStr};

use sorb_kernels::{KERNELS, kernel::Kernel, kernel_named};

/// Kernels that the host wants to run on a GPU.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Offload {
    /// Nothing: everything on the CPU, with the same bits on every machine. The default.
    #[default]
    Cpu,
    /// Everything; an error if there is no adapter.
    Gpu,
    /// Everything, if there is a hardware adapter and enough rows to keep it busy; otherwise nothing. The plan gives the
    /// reason.
    Auto,
    /// This kernel and all after it in the step; those before it on the CPU, with transfers in every step. To find the
    /// kernel that differs.
    From(&'static str),
    /// Kernel by kernel. The last matching entry counts, and kernels without an entry run on the CPU, with transfers in
    /// every step.
    Each(Vec<(&'static str, Place)>),
}

impl Offload {
    /// Whether a GPU may be used at all.
    #[must_use]
    pub fn wants_gpu(&self) -> bool {
        match self {
            Self::Cpu => false,
            Self::Each(list) => KERNELS.iter().any(|kernel| place_in(list, kernel) == Place::Gpu),
            Self::Gpu | Self::Auto | Self::From(_) => true,
        }
    }
}

/// The place that a list gives to a kernel.
pub(crate) fn place_in(list: &[(&'static str, Place)], kernel: &Kernel) -> Place {
    let entry = list.iter().rev().find(|(name, _)| *name == kernel.name);
    entry.map_or(Place::Cpu, |(_, place)| *place)
}

/// A text that is no valid backend.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{0}` is no backend; there are: cpu, gpu, auto, from:KERNEL with a kernel such as sph::density, and \
     each:NAME=PLACE,.. with a kernel, a family such as sph, or all, and cpu or gpu"
)]
pub struct OffloadError(String);

impl FromStr for Offload {
    type Err = OffloadError;

    fn from_str(text: &str) -> Result<Self, OffloadError> {
        let offload = match text {
            "cpu" => Some(Self::Cpu),
            "gpu" => Some(Self::Gpu),
            "auto" => Some(Self::Auto),
            other => match other.split_once(':') {
                Some(("from", name)) => kernel_named(name).map(|kernel| Self::From(kernel.name)),
                Some(("each", entries)) => each(entries).map(Self::Each),
                _ => None,
            },
        };
        offload.ok_or_else(|| OffloadError(text.to_owned()))
    }
}

/// Entries `NAME=PLACE`, where a name is a kernel, a family or `all`.
fn each(entries: &str) -> Option<Vec<(&'static str, Place)>> {
    let mut list = Vec::new();
    for entry in entries.split(',') {
        let (name, place) = entry.trim().split_once('=')?;
        let place = match place {
            "cpu" => Place::Cpu,
            "gpu" => Place::Gpu,
            _ => return None,
        };
        let is_meant = |kernel: &&&Kernel| {
            name == "all"
                || kernel.name == name
                || kernel.name.split_once("::").is_some_and(|(family, _)| family == name)
        };
        let before = list.len();
        list.extend(KERNELS.iter().filter(is_meant).map(|kernel| (kernel.name, place)));
        if list.len() == before {
            return None;
        }
    }
    Some(list)
}

impl fmt::Display for Offload {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cpu => formatter.write_str("cpu"),
            Self::Gpu => formatter.write_str("gpu"),
            Self::Auto => formatter.write_str("auto"),
            Self::From(kernel) => write!(formatter, "from:{kernel}"),
            Self::Each(list) => {
                let entry = |(kernel, place): &(&str, Place)| format!("{kernel}={place}");
                write!(formatter, "each:{}", list.iter().map(entry).collect::<Vec<_>>().join(","))
            }
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

impl fmt::Display for Place {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Cpu => "cpu",
            Self::Gpu => "gpu",
        })
    }
}

/// Placement of a whole step, with the reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Placement {
    /// The request.
    pub offload: Offload,
    /// The kernels that run on the GPU; none if all run on the CPU.
    pub on_gpu: Vec<&'static str>,
    /// Name of the adapter, and why it is used or not.
    pub reason: String,
    /// Transfers between host and device, in the order of a step.
    pub transfers: Vec<Transfer>,
}

/// A transfer of every step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Transfer {
    /// The phase after the transfer; none for the end of the step.
    pub before: Option<&'static str>,
    /// The line of this phase in the plan, from 0.
    pub line: Option<usize>,
    /// Whether the transfer is to the device, otherwise from it.
    pub to_device: bool,
    /// Its content: columns, or `clock`.
    pub what: String,
    /// Size of one transfer \[B\]; lists have the length of those of a fluid and a lattice at rest.
    pub bytes: u64,
    /// Number of transfers in a step: less than the repetitions if later ones need less.
    pub times: u32,
}

impl fmt::Display for Transfer {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verb = if self.to_device { "send" } else { "fetch" };
        write!(formatter, "{verb:5} ")?;
        if self.times > 1 {
            write!(formatter, "{} x ", self.times)?;
        }
        write!(formatter, "{}: {} bytes", self.what, self.bytes)
    }
}

impl Placement {
    /// Everything on the CPU.
    #[must_use]
    pub fn cpu(offload: Offload, reason: impl Into<String>) -> Self {
        Self { offload, on_gpu: Vec::new(), reason: reason.into(), transfers: Vec::new() }
    }
}

/// Kernels are requested at places where they cannot run.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PlaceError {
    /// A kernel that needs the cells of another is at another place.
    #[error(
        "backend `{kernel}={place}`: it goes through the cells of {sort}, which do not travel; both run at one place"
    )]
    BesideSort {
        /// The kernel.
        kernel: &'static str,
        /// The requested place.
        place: Place,
        /// The kernel that it must be with.
        sort: &'static str,
    },
    /// Kernels that are repeated until they have converged are at two places.
    #[error(
        "backend `{kernel}={place}`: it is repeated with {with} until they have converged; both run at one place"
    )]
    Apart {
        /// The kernel.
        kernel: &'static str,
        /// The requested place.
        place: Place,
        /// The kernel that it must be with.
        with: &'static str,
    },
    /// No kernel has this name.
    #[error("backend: there is no kernel `{0}`")]
    Unknown(&'static str),
}

#[cfg(test)]
mod tests {
    use super::*;
    use sorb_kernels::KERNELS;

    #[test]
    fn names_round_trip_and_others_are_refused() {
        let list = vec![(KERNELS[3].name, Place::Gpu), (KERNELS[4].name, Place::Cpu)];
        let from = Offload::From(KERNELS[5].name);
        for offload in [Offload::Cpu, Offload::Gpu, Offload::Auto, from, Offload::Each(list)] {
            assert_eq!(offload.to_string().parse(), Ok(offload));
        }
        let bad = ["", "cuda", "from:", "from:sph::nothing", "sph::density", "each:", "each:sph::density"];
        let each = ["each:sph::nothing=gpu", "each:s=gpu", "each:sph=cuda", "each:sph=gpu,"];
        for bad in bad.into_iter().chain(each) {
            let error = bad.parse::<Offload>().map_err(|error| error.to_string());
            assert!(error.is_err_and(|error| error.contains("from:KERNEL")), "{bad}");
        }
    }
    #[test]
    fn lists_name_kernels_families_and_all_and_the_last_entry_counts() {
        let place = |text: &str, name: &str| match text.parse() {
            Ok(Offload::Each(list)) => kernel_named(name).map(|kernel| place_in(&list, kernel)),
            other => panic!("{other:?}"),
        };
        let text = "each:all=gpu,sph=cpu, sph::kick=gpu";
        assert_eq!(place(text, "pbd::strain"), Some(Place::Gpu));
        assert_eq!(place(text, "sph::density"), Some(Place::Cpu));
        assert_eq!(place(text, "sph::kick"), Some(Place::Gpu));
        assert_eq!(place("each:pbd::strain=gpu", "sph::kick"), Some(Place::Cpu));
        let wants = |text: &str| text.parse::<Offload>().is_ok_and(|offload| offload.wants_gpu());
        assert!(wants(text) && !wants("each:all=gpu,all=cpu"));
    }
}
