//! The world: the one object that a host builds, steps and looks at.

use glam::Vec3;
use sorb_kernels::{
    SimdLevel,
    body::{Body, Wrench},
    columns::{BodyStore, Column, Columns},
    couple,
    cpu::{Cpu, CpuError},
    grid,
    params::Params,
    sph,
};

use crate::{
    clock::{Bound, Clock, Steps, within},
    digest,
    measure::Measures,
    rigid::{RigidEngine, RigidError},
    scene::{Scene, SceneError},
    schedule::{Content, Offload, PhaseTime, Plan, PlanError, PlanLine, Runner, STEP, Verdict},
    setup::Setup,
    sponge::{Lattice, LatticeError},
    stores::Stores,
};

/// Why a world could not be built.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WorldError {
    /// The scene has values out of range, or that do not fit together.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The lattice of a sponge cannot be made.
    #[error(transparent)]
    Lattice(#[from] LatticeError),
    /// The corners of a hull do not span a volume.
    #[cfg(feature = "rigid")]
    #[error("body `{body}`: {source}")]
    Hull {
        /// Name of the body.
        body: String,
        /// What is wrong.
        source: crate::rigid::HullError,
    },
    /// A body needs rapier3d.
    #[error("body `{body}`: convex hulls need the feature `rigid`")]
    NeedsRigid {
        /// Name of the body.
        body: String,
    },
    /// A body has bad values.
    #[error(transparent)]
    Rigid(#[from] RigidError),
    /// Threads or SIMD level.
    #[error(transparent)]
    Cpu(#[from] CpuError),
    /// The step contradicts a kernel's declaration.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// A GPU was asked for.
    #[cfg(not(feature = "gpu"))]
    #[error("backend `{0}`: built without the feature `gpu`")]
    NeedsGpu(Offload),
    /// A GPU was asked for, and there is none that can be used.
    #[cfg(feature = "gpu")]
    #[error(transparent)]
    Gpu(#[from] crate::gpu::GpuError),
}

/// Why a step failed. The world keeps the state it had after the step and refuses to go on.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StepError {
    /// A particle's position or velocity is not a finite number.
    #[error("step {step} at {time:.6} s: particle {id} is no longer finite after `sph::advect`")]
    Particle {
        /// Identity of the particle.
        id: u32,
        /// Steps taken.
        step: u64,
        /// Simulated time \[s\].
        time: f64,
    },
    /// A node's position is not a finite number.
    #[error("step {step} at {time:.6} s: node {node} is no longer finite after `pbd::velocity`")]
    Node {
        /// Row of the node.
        node: u32,
        /// Steps taken.
        step: u64,
        /// Simulated time \[s\].
        time: f64,
    },
    /// Stability asks for a step below `time.minimum_step`.
    #[error(
        "step {step} at {time:.6} s: `{}` asks for a step of {needed:e} s, below time.minimum_step = {minimum:e} s",
        .bound.name()
    )]
    TooSmall {
        /// What asks for it.
        bound: Bound,
        /// The step it asks for \[s\].
        needed: f32,
        /// `time.minimum_step` \[s\].
        minimum: f32,
        /// Steps taken.
        step: u64,
        /// Simulated time \[s\].
        time: f64,
    },
    /// The engine of the bodies failed.
    #[error("rigid bodies: {0}")]
    Rigid(String),
    /// The GPU failed. A clone of the world that was made before can go on: it uploads its state anew.
    #[cfg(feature = "gpu")]
    #[error(transparent)]
    Gpu(#[from] crate::gpu::GpuError),
}

/// What to run on.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Number of threads, 1 to 1024; default: one per core. Has no effect on results.
    pub threads: Option<usize>,
    /// SIMD level; default: the best of the machine. Has no effect on results.
    pub simd: Option<SimdLevel>,
    /// Columns to keep up to date although no phase reads them.
    pub observed: Vec<Column>,
    /// What to run on a GPU; by default nothing.
    pub offload: Offload,
    /// The GPU to run on; default: the best of the machine. Worlds can share one, and it can be made of a device of the
    /// host.
    #[cfg(feature = "gpu")]
    pub gpu: Option<std::sync::Arc<crate::gpu::Gpu>>,
    /// Whether to take the time of every kernel on the GPU, which makes its steps a little longer. On the CPU it is
    /// always taken.
    #[cfg(feature = "gpu")]
    pub gpu_times: bool,
}

/// What a step did.
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

/// What the steps of a frame did.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameReport {
    /// Time after the frame \[s\].
    pub time: f64,
    /// Steps of the frame.
    pub steps: u32,
    /// Shortest step of the frame \[s\].
    pub shortest_step: f32,
    /// What limited most of the steps.
    pub bound: Bound,
    /// Largest speed of particles and nodes in the frame \[m/s\].
    pub maximum_speed: f32,
}

/// Particles and nodes below which one thread is faster than waking others.
const ROWS_FOR_THREADS: u64 = 1000;

/// A scene in motion.
///
/// A clone continues with the same bits: keep one to go back to it.
#[derive(Clone, Debug)]
pub struct World {
    pub(crate) scene: Scene,
    cpu: Cpu,
    pub(crate) params: Params,
    pub(crate) stores: Stores,
    lattice: Lattice,
    pub(crate) engine: Box<dyn RigidEngine>,
    plan: Plan,
    pub(crate) runner: Runner,
    pub(crate) steps: Steps,
    pub(crate) clock: Clock,
    failed: Option<StepError>,
}

impl World {
    /// Builds a scene, on all cores at the machine's best SIMD level.
    ///
    /// # Errors
    /// The scene has values that are out of range or do not fit together; the message names the key.
    pub fn new(scene: &Scene) -> Result<Self, WorldError> {
        Self::with_options(scene, &Options::default())
    }

    /// Builds a scene.
    ///
    /// # Errors
    /// As [`Self::new`], or the machine lacks what the options ask for.
    pub fn with_options(scene: &Scene, options: &Options) -> Result<Self, WorldError> {
        let level = options.simd.unwrap_or_else(SimdLevel::best);
        let threads = options.threads.unwrap_or_else(default_threads);
        Self::build(scene, Cpu::with_threads(level, threads)?, options)
    }

    /// Builds a scene on a CPU context of the host, for example one with the host's own thread pool.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn on(scene: &Scene, cpu: Cpu, observed: &[Column]) -> Result<Self, WorldError> {
        Self::build(scene, cpu, &Options { observed: observed.to_vec(), ..Options::default() })
    }

    fn build(scene: &Scene, cpu: Cpu, options: &Options) -> Result<Self, WorldError> {
        scene.validate()?;
        let estimate = scene.estimate();
        let few = estimate.particles + estimate.nodes < ROWS_FOR_THREADS;
        let cpu = if few { Cpu::serial(cpu.simd())? } else { cpu };
        let Setup { params, columns, lattice, engine } = Setup::new(scene, &cpu)?;
        let content = Content {
            fluid: columns.rows.fluid > 0,
            sponge: columns.rows.nodes > 0,
            walls: params.walls.is_some(),
            bodies: columns.rows.bodies > 0,
            surface_tension: params.fluid.surface_tension > 0.0,
            iterations: params.sponges.iter().map(|sponge| sponge.iterations).max().unwrap_or(0),
        };
        let plan = Plan::new(STEP, content, &options.observed)?;
        let steps = Steps::new(scene, &params);
        #[cfg(not(feature = "gpu"))]
        if options.offload.wants_gpu() {
            return Err(WorldError::NeedsGpu(options.offload));
        }
        #[cfg(feature = "gpu")]
        let (plan, device) = crate::gpu::placed(plan, columns.rows, &steps, options)?;
        let stores = Stores {
            host: columns,
            #[cfg(feature = "gpu")]
            device,
        };
        let mut world = Self {
            runner: Runner::new(&plan),
            steps,
            scene: scene.clone(),
            cpu,
            params,
            stores,
            lattice,
            engine,
            plan,
            clock: Clock::default(),
            failed: None,
        };
        let Columns { rows, fluid, nodes, .. } = &world.stores.host;
        world.clock.fluid_speed = fastest(&fluid.velocity[..rows.fluid]);
        world.clock.fluid_acceleration = scene.gravity.length();
        world.clock.node_speed = fastest(&nodes.velocity[..rows.nodes]);
        world.look();
        Ok(world)
    }

    /// Runs the phases that measures depend on, so that they hold at time zero as well.
    fn look(&mut self) {
        let phases = [
            &grid::sort_fluid::KERNEL,
            &grid::fluid_neighbors::KERNEL,
            &sph::density::KERNEL,
            &couple::controls::KERNEL,
            &couple::saturation::KERNEL,
            &couple::interior::KERNEL,
        ];
        let Self { cpu, params, stores, plan, .. } = self;
        let columns = &mut stores.host;
        for kernel in phases {
            let runs = |line: &PlanLine| line.name == kernel.name && line.verdict == Verdict::Runs;
            if plan.lines().iter().any(runs) {
                cpu.enter(|| (kernel.cpu)(cpu, params, columns));
            }
        }
    }

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
        #[cfg(feature = "gpu")]
        if self.is_on_device() {
            return self.going_on(Self::frame_on_device);
        }
        let end = (self.clock.frames + 1) as f64 / f64::from(self.scene.time.frame_rate);
        let mut report = FrameReport {
            time: self.clock.time,
            steps: 0,
            shortest_step: f32::INFINITY,
            bound: Bound::Frame,
            maximum_speed: 0.0,
        };
        let mut bounds: Vec<(Bound, u32)> = Vec::new();
        // The end is reached exactly: the last step is cut to what is left, and time is summed in f64.
        while end - self.clock.time > 1e-9 {
            let step = self.step_within(end - self.clock.time)?;
            report.steps += 1;
            report.shortest_step = report.shortest_step.min(step.step);
            report.maximum_speed = report.maximum_speed.max(step.maximum_speed);
            match bounds.iter_mut().find(|(bound, _)| *bound == step.bound) {
                Some((_, count)) => *count += 1,
                None => bounds.push((step.bound, 1)),
            }
        }
        self.clock.frames += 1;
        report.time = self.clock.time;
        report.bound =
            bounds.iter().rev().max_by_key(|(_, count)| *count).map_or(Bound::Frame, |best| best.0);
        Ok(report)
    }

    fn step_within(&mut self, left: f64) -> Result<StepReport, StepError> {
        #[cfg(feature = "gpu")]
        if self.is_on_device() {
            return self.going_on(Self::step_on_device);
        }
        self.going_on(|world| world.try_step(left))
    }

    /// Does something unless the world has failed, and remembers if it fails now.
    fn going_on<R>(&mut self, work: impl FnOnce(&mut Self) -> Result<R, StepError>) -> Result<R, StepError> {
        if let Some(error) = &self.failed {
            return Err(error.clone());
        }
        work(self).inspect_err(|error| self.failed = Some(error.clone()))
    }

    /// Whether a device takes the steps on its own.
    #[cfg(feature = "gpu")]
    fn is_on_device(&self) -> bool {
        self.stores.device.as_ref().is_some_and(crate::gpu::Device::has_all)
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
        self.run_phases(step)?;
        self.clock.time += f64::from(step);
        self.clock.steps += 1;
        self.check()?;
        let maximum_speed = self.clock.fluid_speed.max(self.clock.node_speed);
        Ok(StepReport { step, bound, time: self.clock.time, maximum_speed })
    }

    /// All phases of a step of given length.
    fn run_phases(&mut self, step: f32) -> Result<(), StepError> {
        let Self { runner, cpu, params, stores, engine, .. } = self;
        let mut rigid = Ok(());
        let mut host = |columns: &mut Columns| {
            let wrenches = wrenches(columns);
            rigid = move_bodies(engine.as_mut(), &mut columns.bodies, &wrenches, step);
        };
        #[cfg(feature = "gpu")]
        if let Some(device) = &mut stores.device {
            device.step_with(cpu, &mut stores.host, params)?;
            if stores.host.rows.bodies > 0 {
                host(&mut stores.host);
            }
            return rigid.map_err(|error| StepError::Rigid(error.to_string()));
        }
        runner.run(cpu, params, &mut stores.host, host);
        rigid.map_err(|error| StepError::Rigid(error.to_string()))
    }

    /// Takes over the extremes of the step, and refuses what is not finite.
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
        self.clock.fluid_speed = fluid.speed_squared.sqrt();
        self.clock.fluid_acceleration = fluid.acceleration_squared.sqrt();
        self.clock.node_speed = nodes.speed_squared.sqrt();
        Ok(())
    }

    /// The scene that the world was built from.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// What runs in a step, and what is skipped and why.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Time spent in every phase that runs.
    #[must_use]
    pub fn phase_times(&self) -> &[PhaseTime] {
        self.runner.times()
    }

    /// Time spent in whole steps.
    #[must_use]
    pub fn step_time(&self) -> &PhaseTime {
        self.runner.step_time()
    }

    /// Threads and SIMD level.
    #[must_use]
    pub fn cpu(&self) -> &Cpu {
        &self.cpu
    }

    /// Simulated time, steps and frames.
    #[must_use]
    pub fn clock(&self) -> &Clock {
        &self.clock
    }

    /// Parameters of the last step.
    #[must_use]
    pub fn params(&self) -> &Params {
        &self.params
    }

    /// All columns, read only. Rows of the fluid change their order from step to step.
    ///
    /// On a GPU this reads back the state and what measures need (density, interior, saturation), once after every step
    /// or frame that is looked at; other scratch columns are not kept.
    #[must_use]
    pub fn columns(&self) -> &Columns {
        self.stores.view()
    }

    /// The columns on the GPU, for a renderer that draws from the same buffers; none for a world on the CPU, and before
    /// the first step.
    #[cfg(feature = "gpu")]
    #[must_use]
    pub fn resident(&self) -> Option<&sorb_kernels::gpu::Resident> {
        self.stores.device.as_ref().and_then(crate::gpu::Device::resident)
    }

    /// The GPU that the world runs on.
    #[cfg(feature = "gpu")]
    #[must_use]
    pub fn gpu(&self) -> Option<&std::sync::Arc<crate::gpu::Gpu>> {
        self.stores.device.as_ref().map(crate::gpu::Device::gpu)
    }

    /// Positions of the particles \[m\], in the order of their cells; w: pressure over squared density.
    #[must_use]
    pub fn particle_positions(&self) -> &[[f32; 4]] {
        &self.columns().fluid.position[..self.stores.host.rows.fluid]
    }

    /// Velocities of the particles \[m/s\]; w: volume \[m^3\].
    #[must_use]
    pub fn particle_velocities(&self) -> &[[f32; 4]] {
        &self.columns().fluid.velocity[..self.stores.host.rows.fluid]
    }

    /// Identities of the particles: `ids[row]` is the same particle for ever.
    #[must_use]
    pub fn particle_ids(&self) -> &[u32] {
        &self.columns().fluid.id[..self.stores.host.rows.fluid]
    }

    /// Positions of the sponge nodes \[m\], of all sponges; w: inverse mass \[1/kg\].
    #[must_use]
    pub fn node_positions(&self) -> &[[f32; 4]] {
        &self.columns().nodes.position[..self.stores.host.rows.nodes]
    }

    /// Velocities of the sponge nodes \[m/s\].
    #[must_use]
    pub fn node_velocities(&self) -> &[[f32; 4]] {
        &self.columns().nodes.velocity[..self.stores.host.rows.nodes]
    }

    /// Saturation of the sponge nodes \[1\], about 0 to 1; empty without fluid.
    #[must_use]
    pub fn node_saturations(&self) -> &[f32] {
        let saturation = &self.columns().nodes.saturation;
        &saturation[..saturation.len().min(self.stores.host.rows.nodes)]
    }

    /// The lattice: tets, outer surface, which node belongs to which sponge.
    #[must_use]
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// Shapes and poses of the bodies, in the order of the scene.
    #[must_use]
    pub fn bodies(&self) -> &[Body] {
        &self.stores.host.bodies.states.0
    }

    /// The engine that moves the bodies.
    #[must_use]
    pub fn rigid_engine(&self) -> &dyn RigidEngine {
        &*self.engine
    }

    /// Masses, momenta, energies and errors of the present state.
    #[must_use]
    pub fn measures(&self) -> Measures {
        Measures::of(self)
    }

    /// Digest of the state: equal digests mean equal bits, whatever the machine, threads and SIMD level.
    #[must_use]
    pub fn digest(&self) -> u64 {
        digest::digest(self.columns(), &self.clock)
    }
}

/// One thread per core.
fn default_threads() -> usize {
    if cfg!(feature = "threads") {
        std::thread::available_parallelism().map_or(1, usize::from).min(1024)
    } else {
        1
    }
}

fn fastest(velocities: &[[f32; 4]]) -> f32 {
    velocities.iter().map(|v| Vec3::new(v[0], v[1], v[2]).length()).fold(0.0, f32::max)
}

/// What fluid and sponges gave to every body in this step.
fn wrenches(columns: &Columns) -> Vec<Wrench> {
    let store = &columns.bodies;
    let count = store.states.0.len();
    let total = |body| {
        let (fluid, nodes) =
            (store.fluid_wrenches.total(body, count), store.node_wrenches.total(body, count));
        Wrench {
            impulse: fluid.impulse + nodes.impulse,
            angular_impulse: fluid.angular_impulse + nodes.angular_impulse,
        }
    };
    (0..count).map(total).collect()
}

/// Hands the wrenches to the engine, and takes over where the bodies are then.
pub(crate) fn move_bodies(
    engine: &mut dyn RigidEngine,
    bodies: &mut BodyStore,
    wrenches: &[Wrench],
    step: f32,
) -> Result<(), RigidError> {
    engine.step(step, wrenches)?;
    for (index, body) in bodies.states.0.iter_mut().enumerate() {
        body.state = engine.state(index);
    }
    Ok(())
}
