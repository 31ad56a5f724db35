//! The world: the one object that a host builds, steps and reads.

pub(crate) mod bodies;
mod build;
mod commands;
mod error;
#[cfg(all(test, feature = "serde"))]
mod failing;
mod flows;
pub(crate) mod forces;
pub(crate) mod frame;
mod holding;
#[cfg(all(test, feature = "serde", feature = "rigid"))]
mod injected;

mod material;
mod measured;
mod moving;
mod placing;
#[cfg(test)]
mod pool;
pub(crate) mod sleep;
mod slots;
mod sponges;
mod start;
pub(crate) mod tally;
mod views;
mod water;

use std::sync::{Arc, OnceLock};

use sorb_kernels::{
    SimdLevel,
    body::Wrench,
    clock::TIME_RESOLUTION,
    columns::{Column, Columns},
    cpu::Cpu,
    params::Params,
};

use crate::{
    clock::{Bound, Clock, Steps, within},
    command::Commands,
    gpu::Gpu,
    rigid::{LightBodies, RigidEngine},
    scene::Scene,
    schedule::{Offload, Plans, Runner},
    sponge::{Lattice, Skin},
    stores::Stores,
    water::Water,
};

pub use error::{StepError, WorldError};
pub use forces::{BodyLoads, Load};
pub(crate) use material::{Origin, digest_of};
pub(crate) use moving::{Pushes, fastest_body, move_bodies, take_masses};
use moving::{column_pressure, fastest, wrenches};
use tally::FrameTally;

/// Threads, SIMD level and backend of a world.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Number of threads, 1 to 1024; default: one per core. Has no effect on results.
    pub threads: Option<usize>,
    /// SIMD level; default: the best of the machine. Has no effect on results.
    pub simd: Option<SimdLevel>,
    /// Kernels that run on a GPU; by default none.
    pub offload: Offload,
    /// The GPU; default: the best of the machine. Worlds can share one, and it can use a device of the host. There is none
    /// without the feature `gpu`.
    pub gpu: Option<Arc<Gpu>>,
    /// Whether to measure the time of every kernel on the GPU, which makes its steps a little longer. On the CPU it is
    /// always measured.
    pub gpu_times: bool,
}

/// Result of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepReport {
    /// Length of the step \[s\].
    pub step: f32,
    /// What limited it.
    pub bound: Bound,
    /// Time after the step \[s\].
    pub time: f64,
    /// Largest speed of particles and nodes after the step \[m/s\].
    pub maximum_speed: f32,
}

/// Result of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameReport {
    /// Time after the frame \[s\].
    pub time: f64,
    /// Steps of the frame.
    pub steps: u32,
    /// Shortest step of the frame \[s\]; infinite if there was none.
    pub shortest_step: f32,
    /// The bound of most of the steps.
    pub bound: Bound,
    /// Largest speed of particles and nodes in the frame \[m/s\].
    pub maximum_speed: f32,
}

/// A scene in motion.
///
/// A clone continues with the same bits: keep one to return to it.
#[derive(Clone, Debug)]
pub struct World {
    pub(crate) scene: Arc<Scene>,
    /// Which scene it was before commands changed it; none before.
    pub(crate) origin: Option<Origin>,
    cpu: Cpu,
    /// That of scenes with many rows, while there are few.
    spare_cpu: Option<Cpu>,
    pub(crate) params: Params,
    pub(crate) stores: Stores,
    lattice: Lattice,
    /// The surfaces of the meshes that sponges were made of; made when they are first asked for.
    skins: Arc<OnceLock<Vec<Option<Skin>>>>,
    pub(crate) engine: Box<dyn RigidEngine>,
    /// Whether the engine is that of a host.
    pub(crate) has_own_engine: bool,
    pub(crate) light: LightBodies,
    pub(crate) plans: Plans,
    pub(crate) runner: Runner,
    pub(crate) steps: Steps,
    pub(crate) clock: Clock,
    pub(crate) sleep: sleep::Sleep,
    pub(crate) commands: Commands,
    /// What the bodies were given; decides nothing.
    pub(crate) loads: forces::Loads,
    pub(crate) failed: Option<StepError>,
    pub(crate) options: Options,
    /// Columns to keep up to date although no phase reads them, for tests.
    pub(crate) observed: Vec<Column>,
    /// The options by which the step is placed, after [`Self::move_to`] as well.
    #[cfg(feature = "gpu")]
    pub(crate) placed_by: Options,
    pub(crate) water: Water,
    /// None while gravity is constant and the container rests.
    pub(crate) frame: Option<frame::Frame>,
    #[cfg(feature = "serde")]
    pub(crate) identity: OnceLock<crate::state::Identity>,
}

impl World {
    /// Takes one step, as long as stability allows.
    ///
    /// # Errors
    /// The state is no longer finite, or would need steps below `time.minimum_step`. The world stays as it is,
    /// and every further step gives the same error.
    pub fn step(&mut self) -> Result<StepReport, StepError> {
        self.step_within(f64::INFINITY)
    }

    /// Takes as many steps as fill a frame of `1 / time.frame_rate` seconds.
    ///
    /// # Errors
    /// As [`Self::step`].
    pub fn advance_frame(&mut self) -> Result<FrameReport, StepError> {
        // A frame that single steps have already filled would not notice the failure.
        if let Some(error) = &self.failed {
            return Err(error.clone());
        }
        self.begin_step()?;
        let end = self.end_of_frame();
        let is_over = self.sleep_until(end);
        // What is slept through leaves the forces as they were.
        if !is_over {
            self.loads.begin_frame();
        }
        if !is_over && let Some(report) = self.frame_on_device() {
            return self.remember(report);
        }
        let mut tally = FrameTally::new(if is_over { Bound::Asleep } else { Bound::Frame });
        // The end is reached exactly: the last step is cut to what is left, and time is summed in f64.
        while end - self.clock.time > TIME_RESOLUTION {
            tally.add(&self.step_within(end - self.clock.time)?);
        }
        Ok(self.end_frame(tally))
    }

    /// When the present frame ends \[s\].
    pub(crate) fn end_of_frame(&self) -> f64 {
        (self.clock.frames + 1) as f64 / f64::from(self.scene.time.frame_rate)
    }

    /// Ends the present frame.
    pub(crate) fn end_frame(&mut self, tally: FrameTally) -> FrameReport {
        self.clock.frames += 1;
        tally.finish(self.clock.time)
    }

    pub(crate) fn step_within(&mut self, left: f64) -> Result<StepReport, StepError> {
        if let Some(error) = &self.failed {
            return Err(error.clone());
        }
        self.begin_step()?;
        if let Some(slept) = self.sleep_within(left) {
            let time = self.clock.time;
            let maximum_speed = self.clock.fluid_speed.max(self.clock.node_speed);
            return Ok(StepReport { step: slept as f32, bound: Bound::Asleep, time, maximum_speed });
        }
        let report = self.step_on_device().unwrap_or_else(|| self.try_step(left));
        let report = self.remember(report)?;
        self.watch();
        Ok(report)
    }

    /// Carries out commands.
    fn begin_step(&mut self) -> Result<(), StepError> {
        let result = self.carry_out().and_then(|()| self.flow());
        self.remember(result)
    }

    /// Stores a failure: the world takes no steps after it.
    fn remember<R>(&mut self, result: Result<R, StepError>) -> Result<R, StepError> {
        result.inspect_err(|error| self.failed = Some(error.clone()))
    }

    fn try_step(&mut self, left: f64) -> Result<StepReport, StepError> {
        let stable = self.steps.stable(&self.params, &self.clock);
        let (minimum, time) = (self.steps.minimum(), self.clock.time);
        if stable.0 < minimum {
            let (needed, bound) = stable;
            return Err(StepError::TooSmall { bound, needed, minimum, step: self.clock.steps, time });
        }
        let (step, bound) = within(stable, left);
        self.params.step = step;
        let carried = self.carry(step)?;
        if let Some(carried) = &carried {
            carried.turn.apply(&mut self.stores.host);
            if let Some(device) = &mut self.stores.device {
                device.take_velocities(&mut self.stores.host)?;
            }
        }
        let carried = carried.map(|carried| carried.wrenches).unwrap_or_default();
        if let Err(error) = self.run_phases(step, &carried) {
            // A particle or node that is not finite invalidates the wrenches: the error names it instead of the body.
            if matches!(error, StepError::Rigid(_)) {
                self.check()?;
            }
            return Err(error);
        }
        self.clock.time += f64::from(step);
        self.clock.steps += 1;
        self.check()?;
        let maximum_speed = self.clock.fluid_speed.max(self.clock.node_speed);
        Ok(StepReport { step, bound, time: self.clock.time, maximum_speed })
    }

    /// All phases of a step of given length, in which a turn of the container gives something to the bodies.
    fn run_phases(&mut self, step: f32, carried: &[Wrench]) -> Result<(), StepError> {
        let awake = self.awake();
        let are_bodies_still = self.sleep.are_bodies_still(self.clock.time, step);
        let (bodies, sleep) = (&mut self.stores.host.bodies.states.0, &self.sleep);
        take_masses(self.engine.as_ref(), bodies, |index| sleep.has(sleep::Kind::Body(index)));
        let Self { runner, cpu, params, stores, engine, light, loads, commands, .. } = self;
        let mut rigid = Ok(());
        let mut host = |columns: &mut Columns| {
            if are_bodies_still {
                engine.wait(f64::from(step));
                return;
            }
            let given = wrenches(columns);
            let given = Pushes { given: &given, forces: &commands.forces, carried };
            rigid = move_bodies(engine.as_mut(), light, &mut columns.bodies, given, (step, &mut *loads));
        };
        if let Some(device) = &mut stores.device {
            device.step_with(cpu, &mut stores.host, params)?;
            if stores.host.rows.bodies > 0 {
                host(&mut stores.host);
            }
            return rigid.map_err(|error| StepError::Rigid(error.to_string()));
        }
        runner.run(awake, (cpu, params), &mut stores.host, &mut host);
        rigid.map_err(|error| StepError::Rigid(error.to_string()))
    }

    /// Reads the extremes of the step, and refuses values that are not finite.
    fn check(&mut self) -> Result<(), StepError> {
        let columns = &self.stores.host;
        let (fluid, nodes) = (columns.fluid.extremes.total(), columns.nodes.extremes.total());
        let (step, time) = (self.clock.steps, self.clock.time);
        if let Some(row) = fluid.not_finite.checked_sub(1) {
            let id = columns.fluid.id.get(row as usize).copied().unwrap_or(row);
            return Err(StepError::Particle { id, step, time });
        }
        if let Some(node) = nodes.not_finite.checked_sub(1) {
            return Err(StepError::Node { node, step, time });
        }
        // Sleeping parts keep their values.
        if !self.is_fluid_asleep() {
            self.clock.fluid_speed = fluid.speed_squared.sqrt();
            self.clock.fluid_acceleration = fluid.acceleration_squared.sqrt();
            if self.params.fluid.incompressible.is_some() {
                self.clock.fluid_pressure = columns.fluid.pressure_solve.pressure();
            }
        }
        if self.has_moving_nodes() {
            self.clock.node_speed = nodes.speed_squared.sqrt();
        }
        self.clock.body_speed = fastest_body(&columns.bodies.states.0);
        Ok(())
    }
}
