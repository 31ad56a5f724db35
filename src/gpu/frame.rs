//! Steps and frames of a world on a device.

use std::{sync::Arc, time::Instant};

use sorb_kernels::{
    body::Wrench,
    clock::TIME_RESOLUTION,
    gpu::{Answer, Gpu, GpuError, Outcome, Start},
};

use super::device::{Device, Kept};
use crate::{
    Offload,
    clock::{Bound, Clock, Dormant, within},
    rigid::BodyKind,
    schedule::{Runner, run::slot},
    stores::Stores,
    world::{
        FrameReport, Options, Pushes, StepError, StepReport, World, WorldError, fastest_body, move_bodies,
        sleep::Kind, take_masses, tally::FrameTally,
    },
};

/// Largest number of steps of a submission: the host must be able to stop.
const BATCH: u32 = 256;

impl World {
    /// One step, as long as stability allows; none if no device runs the whole step.
    pub(crate) fn step_on_device(&mut self) -> Option<Result<StepReport, StepError>> {
        self.is_on_device().then(|| self.take_step())
    }

    /// As many steps as fill a frame; none if no device runs the whole step.
    pub(crate) fn frame_on_device(&mut self) -> Option<Result<FrameReport, StepError>> {
        self.is_on_device().then(|| self.fill_frame())
    }

    /// Whether a device takes the steps by itself.
    fn is_on_device(&self) -> bool {
        self.stores.device.as_ref().is_some_and(Device::has_all)
    }

    fn take_step(&mut self) -> Result<StepReport, StepError> {
        let longest = f64::from(self.stable_beside_bodies().0);
        if self.is_carried(self.clock.time, self.clock.time + longest) {
            return self.take_carried_step(f64::INFINITY);
        }
        self.carry(self.params.step)?;
        self.begin_on_device(f32::MAX)?;
        self.take_one(&[], None)
    }

    /// One step of at most `left` \[s\] in which the container moves or gravity changes. The host says how long it is: what it gives is a
    /// mean over the step.
    fn take_carried_step(&mut self, left: f64) -> Result<StepReport, StepError> {
        let stable = self.stable_beside_bodies();
        let (minimum, step, time) = (self.steps.minimum(), self.clock.steps, self.clock.time);
        if stable.0 < minimum {
            let (needed, bound) = stable;
            return Err(StepError::TooSmall { bound, needed, minimum, step, time });
        }
        let (step, bound) = within(stable, left);
        let carried = self.carry(step)?;
        self.begin_on_device(step)?;
        if let (Some(carried), Some(device)) = (&carried, &mut self.stores.device) {
            device.turn(&carried.turn)?;
        }
        self.take_one(&carried.map(|carried| carried.wrenches).unwrap_or_default(), Some(bound))
    }

    /// The bounds of the next step; the clock of a device does not have the speed of bodies.
    fn stable_beside_bodies(&self) -> (f32, Bound) {
        let body_speed = fastest_body(&self.stores.host.bodies.states.0);
        self.steps.stable(&self.params, &Clock { body_speed, ..self.clock })
    }

    /// One step of the time that was set, in which a turn of the container gives something to the bodies. `bound` is what made the host
    /// choose its length.
    fn take_one(&mut self, carried: &[Wrench], bound: Option<Bound>) -> Result<StepReport, StepError> {
        let before = self.clock.steps;
        let answer = self.advance_on_device(1, 0)?;
        if answer.steps == 1 {
            self.clock.time += f64::from(answer.last_step);
            self.clock.steps = before + 1;
        }
        self.take_over(&answer, answer.steps, carried)?;
        Ok(StepReport {
            step: answer.last_step,
            bound: bound.unwrap_or(answer.last_bound),
            time: self.clock.time,
            maximum_speed: answer.maximum_speed,
        })
    }

    /// Steps that fill a frame: all in one submission, if no bodies move in between, no part sleeps, and nothing is iterated.
    fn fill_frame(&mut self) -> Result<FrameReport, StepError> {
        let end = self.end_of_frame();
        let mut tally = FrameTally::new(Bound::Frame);
        while end - self.clock.time > TIME_RESOLUTION && !self.sleep_until(end) {
            if self.is_carried(self.clock.time, end) {
                tally.add(&self.take_carried_step(end - self.clock.time)?);
                self.watch();
            } else {
                self.fill_on_device(end, &mut tally)?;
            }
        }
        Ok(self.end_frame(tally))
    }

    /// Steps to the end of a frame, or until parts fall asleep or wake: then the device begins anew.
    fn fill_on_device(&mut self, end: f64, tally: &mut FrameTally) -> Result<(), StepError> {
        self.carry(self.params.step)?;
        self.begin_on_device((end - self.clock.time) as f32)?;
        let (first, mut counted) = (self.clock.steps, [0; Bound::ALL.len()]);
        loop {
            let taken_before = (self.clock.steps - first) as u32;
            let answer = self.advance_on_device(self.steps_to(end), taken_before)?;
            let taken = answer.steps - taken_before;
            self.clock.steps = first + u64::from(answer.steps);
            // The end is reached exactly: the last step is what is left.
            let is_over = answer.left <= TIME_RESOLUTION as f32;
            self.clock.time = if is_over { end } else { end - f64::from(answer.left) };
            self.take_over(&answer, taken, &[])?;
            tally.add_steps(taken, answer.shortest, answer.maximum_speed);
            for (index, bound) in Bound::ALL.iter().enumerate() {
                tally.add_bounds(*bound, answer.bounds[index] - counted[index]);
            }
            counted = answer.bounds;
            if self.watch() || is_over {
                return Ok(());
            }
        }
    }

    /// Expected number of steps to the end of a frame.
    fn steps_to(&self, end: f64) -> u32 {
        // Fixed bodies need no host.
        let is_moved = (0..self.engine.body_count()).any(|body| self.engine.kind(body) != BodyKind::Fixed);
        // Awake parts may come near sleeping ones in any step. Where rounds do not suffice, the steps behind would return at once, at the
        // cost of all their barriers.
        let has_rounds = self.stores.device.as_ref().is_some_and(Device::has_rounds);
        if is_moved || has_rounds || self.sleep.dormant() != Dormant::default() {
            return 1;
        }
        let step = f64::from(self.steps.stable(&self.params, &self.clock).0);
        // The last whole step becomes two halves.
        (((end - self.clock.time) / step).ceil() as u32).saturating_add(1).min(BATCH)
    }

    fn begin_on_device(&mut self, left: f32) -> Result<(), StepError> {
        let start = Start {
            left,
            fluid_speed: self.clock.fluid_speed,
            fluid_acceleration: self.clock.fluid_acceleration,
            // Speeds of sleeping parts bound nothing.
            node_speed: if self.has_moving_nodes() { self.clock.node_speed } else { 0.0 },
            fluid_pressure: self.clock.fluid_pressure,
        };
        let Stores { host, device } = &mut self.stores;
        match device {
            Some(device) => Ok(device.begin(host, &self.params, &start)?),
            None => Ok(()),
        }
    }

    /// Takes steps, and measures their time; `before` is the number of steps since the time was set.
    fn advance_on_device(&mut self, steps: u32, before: u32) -> Result<Answer, StepError> {
        let clock = Instant::now();
        self.keep_state();
        let Stores { host, device } = &mut self.stores;
        take_masses(self.engine.as_ref(), &mut host.bodies.states.0, |index| {
            self.sleep.has(Kind::Body(index))
        });
        let Some(device) = device else {
            return Err(GpuError::Refused { reason: "the world has no device".to_owned() }.into());
        };
        let answer = device.advance(host, steps)?;
        let seconds = clock.elapsed().as_secs_f64();
        record(&mut self.runner, seconds, answer.steps - before, &device.times());
        Ok(answer)
    }

    /// Stores clock and bodies of the state of the host, before the device continues from it.
    fn keep_state(&mut self) {
        if let Some(device) = self.stores.device.as_mut().filter(|device| device.is_host_current()) {
            let (clock, engine) = (self.clock, self.engine.clone());
            device.keep(Kept { clock, engine, step: self.params.step });
        }
    }

    /// Continues on another device, or on the CPU without `gpu`. For a world whose device was lost, or that is to leave a
    /// working device.
    ///
    /// A working device is read back, and nothing is lost. If it was lost, the newest state that the host has read back
    /// becomes the present one, with its clock and its bodies. Views of rows, [`Self::digest`] and all other reads of the
    /// state count. Without any, that is the initial state. The error of the loss is cleared.
    ///
    /// Kernels that the options placed on a GPU are placed there again; all of them if they placed none.
    ///
    /// # Errors
    /// Kernels are requested at places where they cannot run.
    pub fn move_to(&mut self, gpu: Option<&Arc<Gpu>>) -> Result<(), WorldError> {
        // Reads back what the host does not have yet, if it can.
        self.stores.view();
        if let Some(device) = &mut self.stores.device
            && let Some(kept) = device.release(&mut self.stores.host)
        {
            let bodies = &mut self.stores.host.bodies.states.0;
            for (index, body) in bodies.iter_mut().enumerate() {
                body.state = kept.engine.state(index);
            }
            self.clock = kept.clock;
            self.engine = kept.engine;
            self.params.step = kept.step;
        }
        if self.scene.time.sleep_after > 0.0 {
            // Everything wakes, and rest is detected anew.
            self.sleep = self.sleep.anew(&self.scene, &self.params, &self.commands.targets);
            self.apply_sleep();
        }
        if matches!(self.failed, Some(StepError::Gpu(_))) {
            self.failed = None;
        }
        let asked = self.options.offload.clone();
        let options = Options {
            gpu: gpu.cloned(),
            offload: match gpu {
                None => Offload::Cpu,
                Some(_) if matches!(asked, Offload::Cpu | Offload::Auto) => Offload::Gpu,
                Some(_) => asked,
            },
            ..self.options.clone()
        };
        self.place_by(&options)
    }

    /// Takes the results of the device, moves the bodies, and refuses values that are not finite.
    fn take_over(&mut self, answer: &Answer, taken: u32, carried: &[Wrench]) -> Result<(), StepError> {
        let (step, time) = (self.clock.steps, self.clock.time);
        // Sleeping parts keep their values.
        if !self.is_fluid_asleep() {
            self.clock.fluid_speed = answer.fluid_speed;
            self.clock.fluid_acceleration = answer.fluid_acceleration;
            self.clock.fluid_pressure = answer.fluid_pressure;
        }
        if self.has_moving_nodes() {
            self.clock.node_speed = answer.node_speed;
        }
        if taken > 0 {
            self.params.step = answer.last_step;
            let began = time - f64::from(answer.last_step);
            if self.sleep.are_bodies_still(began, answer.last_step) {
                self.engine.wait(f64::from(answer.last_step));
            } else if !answer.wrenches.is_empty() {
                let bodies = &mut self.stores.host.bodies;
                let given = Pushes { given: &answer.wrenches, forces: &self.commands.forces, carried };
                let step = (answer.last_step, &mut self.loads);
                move_bodies(self.engine.as_mut(), &self.light, bodies, given, step)
                    .map_err(|error| StepError::Rigid(error.to_string()))?;
            }
        }
        match answer.outcome {
            Outcome::Particle(row) => {
                let id = self.particle_ids().get(row as usize).copied().unwrap_or(row);
                Err(StepError::Particle { id, step, time })
            }
            Outcome::Node(node) => Err(StepError::Node { node, step, time }),
            // A step that was taken is a success; the next one says why it is not.
            Outcome::TooSmall(needed, bound) if taken == 0 => {
                Err(StepError::TooSmall { bound, needed, minimum: self.steps.minimum(), step, time })
            }
            Outcome::TooSmall(..) | Outcome::Done => Ok(()),
        }
    }
}

/// Records the time of steps on a device: of all of them together, and of every timed call of a kernel \[ms\].
fn record(runner: &mut Runner, seconds: f64, steps: u32, calls: &[(&'static str, f32)]) {
    for _ in 0..steps {
        runner.step.record_seconds(seconds / f64::from(steps));
    }
    for (name, milliseconds) in calls {
        let slot = slot(&mut runner.times, name);
        runner.times[slot].record_seconds(f64::from(*milliseconds) * 1e-3);
    }
}
