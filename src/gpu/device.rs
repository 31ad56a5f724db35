//! The columns of one world on a device.

use std::sync::{Arc, OnceLock};

use sorb_kernels::{
    asleep::Asleep,
    clock::StepLimits,
    column::Life,
    columns::{Column, Columns},
    couple::weights::weigh,
    cpu::Cpu,
    gpu::{Answer, Dispatches, Gpu, GpuError, Pending, Profile, Program, Resident, Start, make_room},
    params::Params,
    stage::Stage,
    turn::Turn,
};

use super::shares::Shares;
use crate::{
    clock::{Clock, Steps},
    rigid::RigidEngine,
    schedule::{Awake, Place, Plan, Plans},
};

/// Scratch columns that the clock of the host reads.
const EXTREMES: [Column; 3] = [Column::FluidExtremes, Column::FluidPressureSolve, Column::NodeExtremes];

/// Scratch columns that the host reads after a step that it shares with a device.
pub(super) fn read_by_host(observed: &[Column]) -> Vec<Column> {
    let observed = observed.iter().filter(|column| !column.is_on_host_only());
    let kept = Column::ALL.iter().filter(|column| column.life() == Life::Kept);
    kept.chain(&EXTREMES).chain(observed).copied().collect()
}

/// Runs the kernels of a world on a device.
#[derive(Debug)]
pub(crate) struct Device {
    gpu: Arc<Gpu>,
    limits: StepLimits,
    shares: Shares,
    /// Stages of the reduced steps while parts sleep, in the order of [`Awake::ALL`]; none where the device does not run the
    /// whole step.
    reduced: Vec<Vec<Stage>>,
    /// Awake parts of the next steps.
    awake: Awake,
    /// Columns that are read back for the host.
    read_by_host: Vec<Column>,
    wants_times: bool,
    resident: Option<On>,
    /// The same with a state that is past, for the next one.
    spare: Option<On>,
    /// Whether the device is ahead of the host.
    is_ahead: bool,
    /// The present state, once the host has looked at it.
    mirror: OnceLock<Columns>,
    /// Clock and bodies of the state that the host has, if the device is ahead of it.
    kept: Option<Kept>,
}

/// The state of a world beside its columns.
#[derive(Clone, Debug)]
pub(crate) struct Kept {
    pub(crate) clock: Clock,
    pub(crate) engine: Box<dyn RigidEngine>,
    /// Length of the previous step \[s\].
    pub(crate) step: f32,
}

/// Columns on the device, with the kernels bound to them.
#[derive(Debug)]
struct On {
    resident: Resident,
    /// One for every share of the device, in order.
    programs: Vec<Program>,
    /// One for every reduced plan that was used.
    reduced: Vec<Option<Program>>,
    profile: Option<Profile>,
}

impl Device {
    pub(crate) fn new(
        gpu: Arc<Gpu>,
        plans: &Plans,
        limits: StepLimits,
        observed: &[Column],
        wants_times: bool,
    ) -> Self {
        let shares = plans.whole().shares(&read_by_host(observed));
        let written: Vec<Column> = shares.on_gpu().flat_map(|kernel| kernel.writes).copied().collect();
        let wanted = |column: &Column| {
            (column.life().is_saved() || observed.contains(column))
                && written.contains(column)
                && !column.is_on_host_only()
        };
        let read_by_host = Column::ALL.iter().copied().filter(wanted).collect();
        let stages = |plan: &Plan| {
            let shares = plan.shares(&[]).all;
            shares.into_iter().flat_map(|share| share.stages).collect()
        };
        let reduced = if shares.are_all_on_gpu() { plans.0.iter().map(stages).collect() } else { Vec::new() };
        Self {
            gpu,
            limits,
            shares,
            reduced,
            awake: Awake::EVERYTHING,
            read_by_host,
            wants_times,
            resident: None,
            spare: None,
            is_ahead: false,
            mirror: OnceLock::new(),
            kept: None,
        }
    }

    /// The same without the data on the device, for a copy of the host's columns. If these are of an earlier state, because
    /// the device was lost, the copy records that.
    pub(crate) fn without_data(&self) -> Self {
        let is_ahead = !self.is_host_current();
        Self {
            gpu: Arc::clone(&self.gpu),
            limits: self.limits,
            shares: self.shares.clone(),
            reduced: self.reduced.clone(),
            awake: self.awake,
            read_by_host: self.read_by_host.clone(),
            wants_times: self.wants_times,
            resident: None,
            spare: None,
            is_ahead,
            mirror: OnceLock::new(),
            kept: self.kept.clone().filter(|_| is_ahead),
        }
    }

    /// The device.
    pub(crate) fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    /// The dispatches of a step: of the kernels that run here.
    pub(crate) fn dispatches(&self, host: &Columns, params: &Params) -> Result<Dispatches, GpuError> {
        let shares = self.shares.all.iter().filter(|share| share.place == Place::Gpu);
        let stages: Vec<Stage> = shares.flat_map(|share| share.stages.clone()).collect();
        Ok(match self.resident() {
            Some(resident) => resident.dispatches_of(&stages),
            None => Resident::new(&self.gpu, host, params, self.limits)?.dispatches_of(&stages),
        })
    }

    /// The columns on the device, if there are any yet.
    pub(crate) fn resident(&self) -> Option<&Resident> {
        self.resident.as_ref().map(|on| &on.resident)
    }

    /// Whether all kernels of the step run here, so that the device can take many steps by itself.
    pub(crate) fn has_all(&self) -> bool {
        self.shares.are_all_on_gpu()
    }

    /// The present state, read back at the first access. If that fails the device is lost, which the next step reports;
    /// until then this is the state that was read back before.
    pub(crate) fn view<'a>(&'a self, host: &'a Columns) -> &'a Columns {
        let Some(on) = self.resident.as_ref().filter(|_| self.is_ahead) else { return host };
        if let Some(mirror) = self.mirror.get() {
            return mirror;
        }
        let mut columns = host.clone();
        match on.resident.download(&mut columns, &self.read_by_host) {
            Ok(()) => self.mirror.get_or_init(|| columns),
            Err(_) => host,
        }
    }

    /// Whether a step has iterations that end when they have converged.
    pub(crate) fn has_rounds(&self) -> bool {
        let mut stages = self.shares.all.iter().flat_map(|share| &share.stages);
        stages.any(|stage| matches!(stage, Stage::Rounds { .. }))
    }

    /// Requests the columns that the host reads; none if there is nothing on the device.
    pub(crate) fn request_columns(&self) -> Result<Option<Pending>, GpuError> {
        self.resident.as_ref().map(|on| on.resident.request_columns(&self.read_by_host)).transpose()
    }

    /// Whether the host has the present state, so that the next step leaves it behind.
    pub(crate) fn is_host_current(&self) -> bool {
        !self.is_ahead || self.mirror.get().is_some()
    }

    /// Stores clock and bodies of the state that the next step leaves behind.
    pub(crate) fn keep(&mut self, kept: Kept) {
        self.kept = Some(kept);
    }

    /// Drops the data on the device: the newest state of the host becomes the present one. Some if that is an earlier one.
    pub(crate) fn release(&mut self, host: &mut Columns) -> Option<Kept> {
        let is_earlier = !self.is_host_current();
        self.take_mirror(host);
        self.is_ahead = false;
        self.resident = None;
        self.kept.take().filter(|_| is_earlier)
    }

    /// Makes the present state that of the host, and uploads it anew before the next step. False if the device is lost.
    pub(crate) fn move_to_host(&mut self, host: &mut Columns) -> bool {
        self.view(host);
        let is_there = self.is_host_current();
        if is_there {
            self.take_mirror(host);
            self.set_aside();
        }
        is_there
    }

    /// Forgets the state of the device for another one, which the host has.
    pub(crate) fn discard_state(&mut self) {
        self.mirror.take();
        self.set_aside();
    }

    /// Keeps the buffers for another state.
    fn set_aside(&mut self) {
        self.spare = self.resident.take().or_else(|| self.spare.take());
        (self.is_ahead, self.kept) = (false, None);
    }

    /// The read-back state becomes that of the host: the newest one if the device is lost.
    fn take_mirror(&mut self, host: &mut Columns) {
        if let Some(mut mirror) = self.mirror.take() {
            std::mem::swap(&mut mirror.bodies, &mut host.bodies);
            *host = mirror;
        }
        self.is_ahead = true;
    }

    /// Uploads a state, unless the device has one.
    fn ready(&mut self, host: &mut Columns, params: &Params) -> Result<(), GpuError> {
        if self.resident.is_some() {
            return Ok(());
        }
        let lives = |column: &Column| column.life() != Life::Scratch && !column.is_on_host_only();
        let columns: Vec<Column> = Column::ALL.iter().copied().filter(lives).collect();
        if let Some(mut on) = self.spare.take()
            && on.resident.renew(host, params, self.limits)?
        {
            on.resident.upload(host, &columns, false)?;
            self.resident = Some(on);
            self.make_room(host);
            return Ok(());
        }
        let mut resident = Resident::new(&self.gpu, host, params, self.limits)?;
        resident.upload(host, &columns, false)?;
        // Kernels are timed one by one.
        resident.set_fused(!self.wants_times);
        let shares = self.shares.all.iter().filter(|share| share.place == Place::Gpu);
        let programs =
            shares.map(|share| resident.program_of(share.stages.clone())).collect::<Result<_, _>>()?;
        let profile = if self.wants_times { Profile::new(&self.gpu)? } else { None };
        let reduced = self.reduced.iter().map(|_| None).collect();
        self.resident = Some(On { resident, programs, reduced, profile });
        self.make_room(host);
        Ok(())
    }

    /// Room on the host for what the device gives back.
    fn make_room(&self, host: &mut Columns) {
        if self.has_all() {
            forget_lists(host);
        } else {
            Column::ALL.iter().for_each(|column| make_room(host, *column));
        }
    }

    /// Another acceleration of free fall \[m/s^2\] for the next steps.
    pub(crate) fn set_gravity(&mut self, gravity: glam::Vec3) {
        if let Some(on) = &mut self.resident {
            on.resident.set_gravity(gravity);
        }
    }

    /// Does to velocities what a turn of the container does in the next step.
    pub(crate) fn turn(&mut self, turn: &Turn) -> Result<(), GpuError> {
        self.resident.as_mut().map_or(Ok(()), |on| on.resident.turn(turn))
    }

    /// Takes over velocities that the host has changed between two steps that it shares.
    pub(crate) fn take_velocities(&mut self, host: &mut Columns) -> Result<(), GpuError> {
        let particles = [Column::FluidPosition, Column::FluidVelocity, Column::FluidId];
        let columns = [&particles[..], &[Column::NodeVelocity]].concat();
        self.resident.as_mut().map_or(Ok(()), |on| on.resident.upload(host, &columns, false))
    }

    /// Restricts the next steps to awake parts; the awake fluid may be outside of all sponges. The time has to be set anew.
    pub(crate) fn set_asleep(&mut self, awake: Awake, asleep: &Asleep, steps: &Steps, is_outside: bool) {
        (self.limits, self.awake) = (steps.limits(), awake);
        if let Some(on) = &mut self.resident {
            on.resident.set_asleep(asleep, self.limits, is_outside);
        }
    }

    /// Sets the time that the next steps are to fill.
    pub(crate) fn begin(
        &mut self,
        host: &mut Columns,
        params: &Params,
        start: &Start,
    ) -> Result<(), GpuError> {
        self.ready(host, params)?;
        if let Some(on) = &mut self.resident {
            on.resident.set_time(start);
        }
        Ok(())
    }

    /// Takes steps that the device chooses.
    pub(crate) fn advance(&mut self, host: &mut Columns, steps: u32) -> Result<Answer, GpuError> {
        self.take_mirror(host);
        let refused = || GpuError::Refused { reason: "no state was uploaded".to_owned() };
        let On { resident, programs, reduced, profile } = self.resident.as_mut().ok_or_else(refused)?;
        let index = self.awake.index();
        let program = match self.reduced.get(index).zip(reduced.get_mut(index)) {
            Some((stages, program)) if index > 0 => match program {
                Some(program) => program,
                None => program.insert(resident.program_of(stages.clone())?),
            },
            _ => programs.first_mut().ok_or_else(refused)?,
        };
        resident.upload_bodies(&host.bodies.states.0);
        let steps = if profile.is_some() { steps.min(Profile::steps(program.passes())) } else { steps };
        resident.advance(program, steps, profile.as_mut())
    }

    /// One step of given length, shared with the CPU. Columns are transferred to the side that reads them.
    pub(crate) fn step_with(
        &mut self,
        cpu: &Cpu,
        host: &mut Columns,
        params: &Params,
    ) -> Result<(), GpuError> {
        self.ready(host, params)?;
        let before = host.clone();
        // A step that cannot be finished changes nothing.
        self.try_step_with(cpu, host, params).inspect_err(|_| *host = before)
    }

    fn try_step_with(&mut self, cpu: &Cpu, host: &mut Columns, params: &Params) -> Result<(), GpuError> {
        let Some(On { resident, programs, .. }) = &mut self.resident else { return Ok(()) };
        let mut programs = programs.iter_mut();
        for share in &self.shares.all {
            match share.place {
                Place::Cpu => {
                    fetch(resident, host, params, &share.needs)?;
                    for stage in &share.stages {
                        stage.run(host, |_, kernel, host| cpu.enter(|| (kernel.cpu)(cpu, params, host)));
                    }
                }
                Place::Gpu => {
                    resident.upload(host, &share.needs, share.is_sorted)?;
                    if let Some(program) = programs.next() {
                        resident.run_kernels(program, params.step)?;
                    }
                }
            }
        }
        fetch(resident, host, params, &self.shares.fetched)
    }

    /// Milliseconds of every call of a kernel since the last query, in order.
    pub(crate) fn times(&mut self) -> Vec<(&'static str, f32)> {
        let profile = self.resident.as_mut().and_then(|on| on.profile.as_mut());
        profile.map(Profile::take).unwrap_or_default()
    }
}

/// Reads columns back, and computes those that a device does not store.
fn fetch(
    resident: &Resident,
    host: &mut Columns,
    params: &Params,
    columns: &[Column],
) -> Result<(), GpuError> {
    resident.download(host, columns)?;
    columns.iter().for_each(|column| weigh(params, host, *column));
    Ok(())
}

/// Cells and lists of the CPU, which are out of date while the device takes the steps: most of the memory.
fn forget_lists(host: &mut Columns) {
    let Columns { fluid, controls, .. } = host;
    (fluid.cells, fluid.neighbors) = Default::default();
    (fluid.controls, fluid.control_weights) = Default::default();
    (controls.cells, controls.fluid, controls.fluid_weights) = Default::default();
}
