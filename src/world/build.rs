//! Worlds from scenes.

use std::sync::Arc;

use glam::Vec3;
use sorb_kernels::{
    SimdLevel,
    columns::Columns,
    contents::Contents,
    cpu::Cpu,
    step::{POROUS_STEP, STEP},
};

use super::{
    Options, Origin, World, WorldError, column_pressure, fastest, fastest_body, forces, frame::Frame, sleep,
};
use crate::{
    clock::{Clock, Dormant, Steps},
    command::Commands,
    rigid::{LightBodies, RigidEngine},
    scene::Scene,
    schedule::{Plans, Runner},
    setup::{Begin, Setup},
    state::StateError,
    stores::Stores,
    water::Water,
};

/// Particles and nodes below which one thread is faster than waking others.
pub(super) const ROWS_FOR_THREADS: u64 = 1000;

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
        Self::build(scene, Cpu::with_threads(level, threads)?, options, Begin::default())
    }

    /// Builds a scene whose bodies an engine of the host moves. It has the bodies of the scene in their order, of the same kinds:
    /// [`rigid::body_setups`](crate::rigid::body_setups) lists them with shapes and states. Contacts between bodies and with the walls of
    /// the container are up to the engine. Fluid and sponges push its bodies through the wrenches of
    /// [`RigidEngine::step`](crate::rigid::RigidEngine::step).
    ///
    /// Saves, recordings and commands need the methods of the engine that have defaults; without them they are refused. A save is
    /// restored by [`World::resume`](Self::resume) in a world that was built with an equal engine: [`World::restore`](Self::restore)
    /// knows only the engines of the library.
    ///
    /// # Errors
    /// As [`Self::with_options`], or the engine has other bodies than the scene.
    pub fn with_engine(
        scene: &Scene,
        engine: Box<dyn RigidEngine>,
        options: &Options,
    ) -> Result<Self, WorldError> {
        let level = options.simd.unwrap_or_else(SimdLevel::best);
        let threads = options.threads.unwrap_or_else(default_threads);
        let begin = Begin { engine: Some(engine), ..Begin::default() };
        Self::build(scene, Cpu::with_threads(level, threads)?, options, begin)
    }

    /// Builds what commands have made of a scene, for a state of it, which may have other particles.
    #[cfg(feature = "serde")]
    pub(crate) fn for_state(
        scene: &Scene,
        options: &Options,
        origin: Option<Origin>,
        is_dry: bool,
    ) -> Result<Self, WorldError> {
        let level = options.simd.unwrap_or_else(SimdLevel::best);
        let threads = options.threads.unwrap_or_else(default_threads);
        let begin = Begin { is_dry, ..Begin::of(origin) };
        Self::build(scene, Cpu::with_threads(level, threads)?, options, begin)
    }

    /// Builds what commands have made of the scene of this world, or what they made it of, for a state of it.
    pub(crate) fn of_scene(&self, scene: &Scene, origin: Option<Origin>) -> Result<Self, StateError> {
        let fail = |error| StateError::World(Box::new(error));
        let engine = self.has_own_engine.then(|| self.engine.clone());
        let cpu = self.spare_cpu.as_ref().unwrap_or(&self.cpu).clone();
        #[cfg_attr(not(feature = "gpu"), expect(unused_mut, reason = "placed on a GPU"))]
        let mut world =
            Self::build(scene, cpu, &self.options, Begin { engine, is_dry: true, ..Begin::of(origin) })
                .map_err(fail)?;
        #[cfg(feature = "gpu")]
        {
            world.placed_by.clone_from(&self.placed_by);
            world.place_again().map_err(fail)?;
        }
        Ok(world)
    }

    /// Builds a scene on a CPU context of the host, for example one with the host's own thread pool. Threads and SIMD level are those
    /// of the context, whatever the options say.
    ///
    /// # Errors
    /// As [`Self::with_options`].
    pub fn on(scene: &Scene, cpu: Cpu, options: &Options) -> Result<Self, WorldError> {
        Self::build(scene, cpu, options, Begin::default())
    }

    fn build(scene: &Scene, cpu: Cpu, options: &Options, begin: Begin) -> Result<Self, WorldError> {
        scene.validate()?;
        let has_own_engine = begin.engine.is_some();
        let estimate = scene.estimate();
        let few = estimate.particles + estimate.nodes < ROWS_FOR_THREADS;
        // Water may come.
        let spare_cpu = Some(&cpu).filter(|_| few && scene.fluid.is_some()).cloned();
        let cpu = if few { Cpu::serial(cpu.simd())? } else { cpu };
        let Setup { params, columns, lattice, engine } = Setup::new(scene, &cpu, begin)?;
        let step = if params.solid.is_some() { POROUS_STEP } else { STEP };
        let plans = Plans::new(step, &Contents::new(&params, &columns), &[])?;
        let bodies = &columns.bodies.states.0;
        let steps = Steps::new(scene, &params, bodies, engine.as_ref(), &Dormant::default());
        let mut world = Self {
            runner: Runner::of_all(&plans.0),
            sleep: sleep::Sleep::new(scene, &params),
            steps,
            scene: Arc::new(scene.clone()),
            origin: None,
            cpu,
            spare_cpu,
            params,
            stores: Stores { host: columns, device: None },
            lattice,
            skins: Arc::default(),
            engine,
            has_own_engine,
            light: LightBodies::new(scene),
            plans,
            clock: Clock::default(),
            commands: Commands::default(),
            loads: forces::Loads::default(),
            failed: None,
            options: options.clone(),
            observed: Vec::new(),
            #[cfg(feature = "gpu")]
            placed_by: options.clone(),
            water: Water::default(),
            frame: Frame::of_scene(scene),
            #[cfg(feature = "serde")]
            identity: std::sync::OnceLock::new(),
        };
        world.follow_frame();
        world.place()?;
        world.begin_clock();
        world.compute_measured();
        Ok(world)
    }

    /// The clock of the state at time zero.
    fn begin_clock(&mut self) {
        let Columns { rows, fluid, nodes, bodies, .. } = &self.stores.host;
        self.water = Water::of_scene(&self.scene, rows.fluid);
        self.clock.fluid_speed = fastest(&fluid.velocity[..rows.fluid]);
        self.clock.fluid_acceleration = self.scene.gravity.length();
        self.clock.node_speed = fastest(&nodes.velocity[..rows.nodes]);
        self.clock.body_speed = fastest_body(&bodies.states.0);
        if self.params.fluid.incompressible.is_some() {
            // Nothing carries the weight along an axis without walls.
            let held = Vec3::select(self.scene.periodic().into(), Vec3::ZERO, self.scene.gravity);
            self.clock.fluid_pressure = column_pressure(&fluid.position[..rows.fluid], held);
        }
    }
}

impl Begin {
    /// What a scene begins with that commands have changed.
    fn of(origin: Option<Origin>) -> Self {
        let Some(Origin { cut_by, has_dynamics, .. }) = origin else { return Self::default() };
        Self { cut_by, has_dynamics, ..Self::default() }
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
