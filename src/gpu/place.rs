//! Whether a world runs on a GPU, and why.

use std::sync::Arc;

use sorb_kernels::{
    columns::{Column, RowCounts},
    gpu::{Gpu, GpuError},
};

use super::Device;
use crate::{
    clock::Steps,
    schedule::{Offload, Placement, Plan, Transfer, beginning},
    world::Options,
};

/// Particles and nodes from which [`Offload::Auto`] takes a GPU; `docs/gpu.md` has the measurements.
const ROWS_FOR_GPU: usize = 5_000;

/// A plan with its place, and the device if it is one.
///
/// # Errors
/// A GPU is asked for, and there is none.
pub(crate) fn placed(
    plan: Plan,
    rows: RowCounts,
    steps: &Steps,
    options: &Options,
) -> Result<(Plan, Option<Device>), GpuError> {
    if !options.offload.wants_gpu() {
        return Ok((plan, None));
    }
    let (placement, gpu) = place(&plan, rows, options.offload, options.gpu.as_ref())?;
    let plan = plan.placed(placement);
    let device = gpu.map(|gpu| Device::new(gpu, &plan, steps.limits(), &options.observed, options.gpu_times));
    Ok((plan, device))
}

/// Decides where the step runs, on the device that the host gives or one of its own.
///
/// # Errors
/// A GPU is asked for, and there is none.
fn place(
    plan: &Plan,
    rows: RowCounts,
    offload: Offload,
    given: Option<&Arc<Gpu>>,
) -> Result<(Placement, Option<Arc<Gpu>>), GpuError> {
    let on_cpu = |reason: String| Ok((Placement::cpu(offload, reason), None));
    let device = || given.map_or_else(|| Gpu::new().map(Arc::new), |gpu| Ok(Arc::clone(gpu)));
    let Some(first) = plan.first_kernel() else {
        return on_cpu("nothing runs".to_owned());
    };
    match offload {
        Offload::Cpu => on_cpu("asked for".to_owned()),
        Offload::Gpu => on_gpu(plan, rows, offload, first, device()?),
        Offload::From(name) => {
            let name = beginning(name);
            if !plan.runs(name) {
                return on_cpu(format!("{name} does not run in this scene"));
            }
            on_gpu(plan, rows, offload, name, device()?)
        }
        Offload::Auto => {
            let few = rows.fluid + rows.nodes;
            if few < ROWS_FOR_GPU {
                return on_cpu(format!("{few} particles and nodes, of {ROWS_FOR_GPU} that are worth a GPU"));
            }
            match device() {
                Ok(gpu) if gpu.report().is_software() => {
                    on_cpu(format!("`{}` is a program on the CPU", gpu.report().name))
                }
                Ok(gpu) => on_gpu(plan, rows, offload, first, gpu),
                Err(error) => on_cpu(error.to_string()),
            }
        }
    }
}

fn on_gpu(
    plan: &Plan,
    rows: RowCounts,
    offload: Offload,
    first: &'static str,
    gpu: Arc<Gpu>,
) -> Result<(Placement, Option<Arc<Gpu>>), GpuError> {
    let report = gpu.report();
    let reason = format!("{} ({})", report.name, report.driver);
    let transfers = transfers(plan, rows, first);
    Ok((Placement { offload, first: Some(first), reason, transfers }, Some(gpu)))
}

/// What travels in every step.
fn transfers(plan: &Plan, rows: RowCounts, first: &'static str) -> Vec<Transfer> {
    let shares = plan.shares_from(Some(first));
    let bodies = rows.bodies as u64;
    if !shares.cpu.is_empty() {
        let all = |columns: &[Column]| {
            let names: Vec<_> = columns.iter().map(|column| column.name()).collect();
            let bytes = columns.iter().map(|column| rows.of(column.store()) as u64 * 16).sum();
            (names.join(", "), bytes)
        };
        let ((sent, sent_bytes), (fetched, fetched_bytes)) = (all(&shares.sent), all(&shares.fetched));
        return vec![
            Transfer { before: Some(first), to_device: true, what: sent, bytes: sent_bytes },
            Transfer { before: None, to_device: false, what: fetched, bytes: fetched_bytes },
        ];
    }
    let clock = 128;
    if bodies == 0 {
        let what = "clock (once for the steps of a frame)".to_owned();
        return vec![Transfer { before: None, to_device: false, what, bytes: clock }];
    }
    let wrenches = "clock, bodies.fluid_wrenches, bodies.node_wrenches".to_owned();
    vec![
        Transfer {
            before: Some(first),
            to_device: true,
            what: "bodies.states".to_owned(),
            bytes: bodies * 144,
        },
        Transfer {
            before: Some("rigid::step"),
            to_device: false,
            what: wrenches,
            bytes: clock + bodies * 64,
        },
    ]
}
