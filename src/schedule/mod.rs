//! What runs, in which order, for which scene.

mod plan;
mod run;
mod step;

pub use plan::{Content, Plan, PlanError, PlanLine, Verdict};
pub use run::{PhaseTime, Runner};
pub use step::{HostPhase, Phase, RIGID, STEP, Times};
