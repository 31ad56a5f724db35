//! What worlds are made of: columns, parameters, kernels and the step. **Without any promise**: all of it may change with any version,
//! names included. For tests, benches and tools of this project.

pub use sorb_kernels::{
    KERNELS, column, columns, contents, kernel, kernel_named, need, params,
    step::{Block, HostPhase, POROUS_STEP, Phase, RIGID, STEP, Solve, Times},
};

use sorb_kernels::{
    columns::{Column, Columns},
    contents::Contents,
    params::Params,
};

pub use crate::schedule::{Place, Placement, Plan, PlanError, PlannedPhase, Transfer, Verdict, run::Runner};
use crate::{World, WorldError};

/// All columns of a world. Rows of the fluid change their order from step to step.
///
/// On a GPU this reads back the state and the columns of measures (density, interior, saturation), at most once after every
/// step or frame. Other scratch columns are not stored.
#[must_use]
pub fn columns(world: &World) -> &Columns {
    world.columns()
}

/// Parameters of the last step of a world.
#[must_use]
pub fn params(world: &World) -> &Params {
    &world.params
}

/// Keeps columns of a world up to date although no phase reads them.
///
/// # Errors
/// A phase reads a scratch column that no phase before it has written, or the device has not enough memory.
pub fn observe(world: &mut World, columns: &[Column]) -> Result<(), WorldError> {
    world.observed = columns.to_vec();
    world.plan_anew()
}

/// Overwrites a column of a world on the CPU with values that are noticed when something reads them.
pub fn poison(world: &mut World, column: Column) {
    world.stores.host.data_mut(column).poison();
}

/// Plans a step for a scene. `observed` columns are kept up to date although no phase reads them.
///
/// # Errors
/// A phase reads a scratch column that no phase before it has written.
pub fn plan(step: &[Phase], contents: &Contents<'_>, observed: &[Column]) -> Result<Plan, PlanError> {
    Plan::new(step, contents, observed)
}

/// The columns of a requested state. Columns that are not read back are empty.
#[cfg(feature = "gpu")]
#[must_use]
pub fn state_columns(state: &crate::gpu::State) -> &Columns {
    state.columns()
}

/// The columns of a world on its device; none for a world on the CPU, and before the first step.
#[cfg(feature = "gpu")]
#[must_use]
pub fn resident(world: &World) -> Option<&sorb_kernels::gpu::Resident> {
    world.resident()
}

/// How many dispatches a step of a world takes on its device; none for a world on the CPU.
///
/// # Errors
/// There is not enough memory on the device.
#[cfg(feature = "gpu")]
pub fn dispatches(
    world: &World,
) -> Result<Option<sorb_kernels::gpu::Dispatches>, sorb_kernels::gpu::GpuError> {
    let device = world.stores.device.as_ref();
    device.map(|device| device.dispatches(&world.stores.host, &world.params)).transpose()
}
