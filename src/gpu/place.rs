//! Decides whether a world runs on a GPU, and why.

use std::sync::Arc;

use sorb_kernels::{
    columns::{Column, RowCounts},
    gpu::{BODY_BYTES, CLOCK_BYTES, Gpu, GpuError, column_bytes},
    params::Params,
    step::RIGID,
};

use super::{Device, device::read_by_host};
use crate::{
    schedule::{Offload, Place, Placement, Plan, Transfer},
    world::{Options, World, WorldError},
};

/// Particles and nodes from which [`Offload::Auto`] uses a GPU; `docs/gpu.md` has the measurements.
const ROWS_FOR_GPU: usize = 5_000;

/// Inputs of a placement.
struct Request<'a> {
    plan: &'a Plan,
    rows: RowCounts,
    params: &'a Params,
    options: &'a Options,
    observed: &'a [Column],
}

impl World {
    /// Places the step according to the options.
    ///
    /// # Errors
    /// As [`Self::place_by`].
    pub(crate) fn place(&mut self) -> Result<(), WorldError> {
        self.place_by(&self.options.clone())
    }

    /// The same for other contents, where [`Self::move_to`] has placed it last.
    ///
    /// # Errors
    /// As [`Self::place_by`].
    pub(crate) fn place_again(&mut self) -> Result<(), WorldError> {
        self.place_by(&self.placed_by.clone())
    }

    /// Places the step, on a device of its own if it is a GPU.
    ///
    /// # Errors
    /// A GPU is asked for, and there is none; or kernels are asked for at places where they cannot be.
    pub(super) fn place_by(&mut self, options: &Options) -> Result<(), WorldError> {
        self.placed_by.clone_from(options);
        let (rows, params, plans) = (self.stores.host.rows, &self.params, &mut self.plans);
        let observed = &self.observed[..];
        if options.offload == Offload::Cpu {
            self.stores.device = None;
            plans.0.iter_mut().for_each(|plan| plan.placement = None);
            return Ok(());
        }
        let (placement, gpu) = Request { plan: plans.whole(), rows, params, options, observed }.place()?;
        for plan in &mut plans.0 {
            let transfers = Request { plan, rows, params, options, observed }.transfers(&placement.on_gpu);
            plan.placement = Some(Placement { transfers, ..placement.clone() });
        }
        let device = |gpu| Device::new(gpu, plans, self.steps.limits(), observed, options.gpu_times);
        self.stores.device = gpu.map(device);
        Ok(())
    }
}

type Placed = (Placement, Option<Arc<Gpu>>);

impl Request<'_> {
    /// Decides where the step runs, on the device of the host or a separate one.
    fn place(&self) -> Result<Placed, WorldError> {
        let offload = &self.options.offload;
        let on_gpu = self.plan.kernels_on_gpu(offload)?;
        if on_gpu.is_empty() {
            let why = match offload {
                Offload::From(name) => format!("{name} does not run in this scene"),
                Offload::Each(_) => "none of the kernels for a GPU runs in this scene".to_owned(),
                _ => "nothing runs".to_owned(),
            };
            return Ok(self.on_cpu(why));
        }
        if *offload != Offload::Auto {
            return Ok(self.on_gpu(on_gpu, self.device()?));
        }
        let few = self.rows.fluid + self.rows.nodes;
        if few < ROWS_FOR_GPU {
            return Ok(
                self.on_cpu(format!("{few} particles and nodes, of {ROWS_FOR_GPU} that are worth a GPU"))
            );
        }
        Ok(match self.device() {
            Ok(gpu) if gpu.report().is_software() => {
                self.on_cpu(format!("`{}` is a program on the CPU", gpu.report().name))
            }
            Ok(gpu) => self.on_gpu(on_gpu, gpu),
            Err(error) => self.on_cpu(error.to_string()),
        })
    }

    fn device(&self) -> Result<Arc<Gpu>, GpuError> {
        let given = self.options.gpu.as_ref();
        given.map_or_else(|| Gpu::new().map(Arc::new), |gpu| Ok(Arc::clone(gpu)))
    }

    fn on_cpu(&self, reason: String) -> Placed {
        (Placement::cpu(self.options.offload.clone(), reason), None)
    }

    fn on_gpu(&self, on_gpu: Vec<&'static str>, gpu: Arc<Gpu>) -> Placed {
        let report = gpu.report();
        let reason = format!("{} ({})", report.name, report.driver);
        let transfers = self.transfers(&on_gpu);
        (Placement { offload: self.options.offload.clone(), on_gpu, reason, transfers }, Some(gpu))
    }

    /// Transfers of every step.
    fn transfers(&self, on_gpu: &[&'static str]) -> Vec<Transfer> {
        let shares = self.plan.shares_with(on_gpu, &read_by_host(self.observed));
        if shares.are_all_on_gpu() {
            return self.few_transfers();
        }
        let mut all: Vec<Transfer> = Vec::new();
        for share in shares.all.iter().filter(|share| !share.needs.is_empty()) {
            let line = share.line;
            let mut transfer = self.columns(&share.needs, share.place == Place::Gpu);
            transfer.before = share.kernels().next().map(|kernel| kernel.name);
            transfer.line = Some(line);
            let same = |other: &&mut Transfer| {
                (other.line, other.to_device, &other.what) == (Some(line), transfer.to_device, &transfer.what)
            };
            match all.iter_mut().find(same) {
                Some(other) => other.times += 1,
                None => all.push(transfer),
            }
        }
        if !shares.fetched.is_empty() {
            all.push(self.columns(&shares.fetched, false));
        }
        all
    }

    fn columns(&self, columns: &[Column], to_device: bool) -> Transfer {
        let bytes = |column: &Column| column_bytes(self.params, self.rows, *column);
        let names: Vec<_> =
            columns.iter().filter(|column| bytes(column) > 0).map(|column| column.name()).collect();
        Transfer {
            before: None,
            line: None,
            to_device,
            what: names.join(", "),
            bytes: columns.iter().map(bytes).sum(),
            times: 1,
        }
    }

    /// Transfers where the whole step runs on the device.
    fn few_transfers(&self) -> Vec<Transfer> {
        let (clock, bodies) = (CLOCK_BYTES, self.rows.bodies as u64);
        let transfer = |before: Option<&'static str>, to_device, what: &str, bytes| Transfer {
            before,
            line: before.and_then(|name| self.plan.lines().iter().position(|line| line.name == name)),
            to_device,
            what: what.to_owned(),
            bytes,
            times: 1,
        };
        if bodies == 0 {
            return vec![transfer(None, false, "clock (once for the steps of a frame)", clock)];
        }
        let first = self.plan.lines().iter().map(|line| line.name).find(|name| self.plan.runs(name));
        let wrenches = "clock, bodies.fluid_wrenches, bodies.node_wrenches";
        vec![
            transfer(first, true, "bodies.states", bodies * BODY_BYTES),
            transfer(Some(RIGID.name), false, wrenches, clock + bodies * 64),
        ]
    }
}
