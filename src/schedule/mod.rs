//! What runs, in which order, for which scene.

mod awake;
mod blocks;
pub(crate) mod offload;
pub(crate) mod order;
pub(crate) mod plan;
pub(crate) mod run;
mod step;

pub(crate) use awake::{Awake, Plans};
pub use offload::{Offload, OffloadError, Place, PlaceError, Placement, Transfer};
pub use plan::{Plan, PlanError, PlanLine, Verdict};
pub use run::{PhaseTime, Runner};
pub use step::{Block, HostPhase, POROUS_STEP, Phase, RIGID, STEP, Solve, Times};
