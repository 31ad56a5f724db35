//! What runs in a step, and where: the plan of a world, where its phases are placed, and the time they take.

mod awake;
pub(crate) mod offload;
pub(crate) mod order;
pub(crate) mod plan;
pub(crate) mod run;

pub(crate) use awake::{Awake, Plans};
pub use offload::{Offload, OffloadError, Place, PlaceError, Placement, Transfer};
pub use plan::{Plan, PlanError, PlannedPhase, Verdict};
pub use run::PhaseTime;
pub(crate) use run::Runner;
