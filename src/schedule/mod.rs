//! What runs, in which order, for which scene.

mod awake;
mod blocks;
mod offload;
mod plan;
mod run;
#[cfg(feature = "gpu")]
mod shares;
mod step;

pub(crate) use awake::{Awake, Plans};
pub use offload::{Offload, OffloadError, Place, PlaceError, Placement, Transfer};
pub use plan::{Plan, PlanError, PlanLine, Verdict};
pub use run::{PhaseTime, Runner};
#[cfg(feature = "gpu")]
pub(crate) use shares::Shares;
pub use step::{Block, HostPhase, POROUS_STEP, Phase, RIGID, STEP, Solve, Times};
