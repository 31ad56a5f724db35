//! Kernels on the GPU against those on the CPU. A machine without an adapter fails here: lavapipe is one.

mod asleep;
mod declarations;
mod device;
mod faults;
mod parity;
mod turn;

use std::sync::{Arc, OnceLock};

use super::scene::Scene;
use crate::{
    clock::{Bound, StepLimits},
    columns::{Column, Columns},
    gpu::{Gpu, Resident},
    kernel::Kernel,
    kernel_named,
};

/// One device for all tests. Threads share rows as on a hardware adapter.
fn gpu() -> &'static Arc<Gpu> {
    static GPU: OnceLock<Arc<Gpu>> = OnceLock::new();
    GPU.get_or_init(|| {
        let gpu = Gpu::new().unwrap_or_else(|error| {
            panic!("{error}; these tests need one, and do not pass without: install mesa-vulkan-drivers and libvulkan1")
        });
        Arc::new(gpu.with_busy_threads(Gpu::BUSY_THREADS))
    })
}

/// Bounds of the step that allow anything.
pub(crate) const LIMITS: StepLimits = StepLimits {
    courant: 0.25,
    edge: f32::INFINITY,
    has_fluid: true,
    minimum: 1e-9,
    constant: 1.0,
    constant_bound: Bound::Maximum,
};

/// The columns after one kernel on a device.
fn after_on(gpu: &Arc<Gpu>, kernel: &'static Kernel, before: &Scene) -> Columns {
    after_on_all(gpu, &[kernel], before)
}

/// The columns after kernels on a device.
fn after_on_all(gpu: &Arc<Gpu>, kernels: &[&'static Kernel], before: &Scene) -> Columns {
    let mut kernels = kernels.to_vec();
    // The search of the device goes through its own cells.
    if kernels[0].searches_fluid() {
        kernels.insert(0, kernel_named("grid::sort_fluid").expect("a name of the table"));
    }
    let sorted = kernels[0].name != "grid::sort_fluid";
    let mut columns = before.columns.clone();
    let mut resident =
        Resident::new(gpu, &columns, &before.params, LIMITS).unwrap_or_else(|error| panic!("{error}"));
    let mut reads: Vec<Column> = kernels.iter().flat_map(|kernel| kernel.reads).copied().collect();
    // Twins know by its sponge whether a node is asleep.
    reads.push(Column::NodeSponge);
    let mut writes: Vec<Column> = kernels.iter().flat_map(|kernel| kernel.writes).copied().collect();
    writes.retain(|column| !column.is_on_host_only());
    resident.upload(&mut columns, &reads, sorted).unwrap_or_else(|error| panic!("{error}"));
    let mut program = resident.program(&kernels).unwrap_or_else(|error| panic!("{error}"));
    resident.run_kernels(&mut program, before.params.step).unwrap_or_else(|error| panic!("{error}"));
    resident.download(&mut columns, &writes).unwrap_or_else(|error| panic!("{error}"));
    columns
}
