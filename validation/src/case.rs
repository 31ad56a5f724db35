//! A case, its settings and its results.

use std::{
    collections::BTreeMap,
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicU64, Ordering},
    },
    time::{Duration, Instant},
};

use sorb::{
    FrameReport, Options, StepError, World, WorldError,
    scene::{FluidSolver, Quality, Scene, SceneError},
};

use crate::solver::Solvers;

/// One comparison with a reference.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Name on the command line.
    pub name: &'static str,
    /// What is compared with what.
    pub title: &'static str,
    /// Where the reference comes from.
    pub source: &'static str,
    /// The solvers that matter to it.
    pub subject: Subject,
    /// The fault that [`Setting::fault`] plants.
    pub control: &'static str,
    /// Builds, runs and compares.
    pub run: fn(&Setting) -> Result<Vec<Figure>, Failure>,
}

/// The solvers that a case depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// The solver of the water.
    Water,
    /// The solver of the sponge.
    Sponge,
    /// Both.
    Coupling,
}

/// Settings of a run of a case.
#[derive(Clone, Debug, Default)]
pub struct Setting {
    /// The solvers to run.
    pub solvers: Solvers,
    /// Factor on the number of particles or cells along a length. The bounds are meant for 1. Range 0.25 to 8.
    pub resolution: f64,
    /// Fewer, shorter and coarser runs.
    pub quick: bool,
    /// Plants the fault of the case, which must push it out of its bounds.
    pub fault: bool,
    /// Quality of every scene; none keeps the keys of the scene.
    pub quality: Option<Quality>,
    /// Changes of keys of every scene, after the quality, as `KEY=VALUE`; see [`Scene::set`].
    pub changes: Vec<String>,
    /// Threads, SIMD level and backend.
    pub options: Options,
    /// Real time in the simulator, summed over all worlds of the case; clones share it.
    pub stopwatch: Stopwatch,
    /// Backends of the worlds of the case; clones share it.
    pub backends: Backends,
}

/// Sums real time.
#[derive(Clone, Debug, Default)]
pub struct Stopwatch(Arc<AtomicU64>);

impl Stopwatch {
    /// Time so far \[s\].
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.0.load(Ordering::Relaxed) as f64 * 1e-9
    }

    fn add(&self, time: Duration) {
        self.0.fetch_add(u64::try_from(time.as_nanos()).unwrap_or(u64::MAX), Ordering::Relaxed);
    }
}

/// Backends of worlds, and the reason for each.
#[derive(Clone, Debug, Default)]
pub struct Backends(Arc<Mutex<BTreeMap<&'static str, String>>>);

impl Backends {
    /// `cpu`, `gpu`, or both if there were worlds on either; empty if there were none.
    #[must_use]
    pub fn names(&self) -> String {
        self.found().keys().copied().collect::<Vec<_>>().join("+")
    }

    /// For each backend the adapter of the last world, or why there is none; empty if no GPU was requested.
    #[must_use]
    pub fn reasons(&self) -> String {
        let found = self.found();
        let given: Vec<_> = found.values().map(String::as_str).filter(|reason| !reason.is_empty()).collect();
        given.join("; ")
    }

    fn add(&self, world: &World) {
        let placement = world.plan().placement();
        let on_gpu = placement.is_some_and(|placement| !placement.on_gpu.is_empty());
        let reason = placement.map(|placement| placement.reason.clone()).unwrap_or_default();
        self.found().insert(if on_gpu { "gpu" } else { "cpu" }, reason);
    }

    /// A panic elsewhere leaves the table intact.
    fn found(&self) -> std::sync::MutexGuard<'_, BTreeMap<&'static str, String>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Setting {
    /// The defaults at full length.
    #[must_use]
    pub fn new() -> Self {
        Self { resolution: 1.0, ..Self::default() }
    }

    /// One of two values: the second in a quick run.
    #[must_use]
    pub fn pick<T>(&self, full: T, quick: T) -> T {
        if self.quick { quick } else { full }
    }

    /// One of two values: the second with the fault.
    #[must_use]
    pub fn planted<T>(&self, sound: T, faulty: T) -> T {
        if self.fault { faulty } else { sound }
    }

    /// A number of cells or particles along a length, at the setting's resolution, at least 2.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the cast saturates, and scenes have limits of their own"
    )]
    #[expect(clippy::cast_sign_loss, reason = "at least 2")]
    pub fn count(&self, full: u32) -> u32 {
        (f64::from(full) * self.resolution).round().max(2.0) as u32
    }

    /// Whether the water of a scene jams in a full box. It does where the solve keeps the density: flowing particles take more room than a
    /// lattice.
    ///
    /// # Errors
    /// The scene refuses the solvers of the setting.
    pub fn jams(&self, scene: &Scene) -> Result<bool, Failure> {
        Ok(self.solvers.applied(scene)?.fluid_solver() != Some(FluidSolver::Divergence))
    }

    /// The world of a scene, with the solvers, the quality and the changes of the setting.
    ///
    /// # Errors
    /// The scene is invalid, or the machine lacks a requested feature.
    pub fn world(&self, scene: &Scene) -> Result<World, Failure> {
        let mut scene = self.solvers.applied(scene)?;
        if let Some(quality) = self.quality {
            scene = scene.with_quality(quality)?;
        }
        if !self.changes.is_empty() {
            scene = scene.with_overrides(self.changes.iter().map(String::as_str))?;
        }
        let world = World::with_options(&scene, &self.options)?;
        self.backends.add(&world);
        Ok(world)
    }

    /// Advances a world by a frame, on the stopwatch.
    ///
    /// # Errors
    /// As [`World::advance_frame`].
    pub fn advance(&self, world: &mut World) -> Result<FrameReport, StepError> {
        let start = Instant::now();
        let report = world.advance_frame();
        self.stopwatch.add(start.elapsed());
        report
    }
}

/// Why a case gives no figures.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Failure {
    /// The scene cannot be built.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The world cannot be built.
    #[error(transparent)]
    World(#[from] WorldError),
    /// The simulation diverged.
    #[error("diverged: {0}")]
    Step(#[from] StepError),
    /// The reference cannot be computed.
    #[error("reference: {0}")]
    Reference(String),
    /// The run has nothing to measure.
    #[error("nothing to measure: {0}")]
    Nothing(String),
}

/// A measured value against its reference.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Figure {
    /// What was measured, with the norm.
    pub name: String,
    /// SI unit of reference and measured; "1" for pure numbers.
    pub unit: &'static str,
    /// The expected value.
    pub reference: f64,
    /// The measured value.
    pub measured: f64,
    /// The error, in the norm that the name states.
    pub error: f64,
    /// Largest error that is in bounds.
    pub bound: f64,
}

impl Figure {
    /// A value whose error is relative to its reference.
    #[must_use]
    pub fn relative(
        name: impl Into<String>,
        unit: &'static str,
        reference: f64,
        measured: f64,
        bound: f64,
    ) -> Self {
        let error = ((measured - reference) / reference).abs();
        Self { name: name.into(), unit, reference, measured, error, bound }
    }

    /// A value whose error is relative to a given scale.
    #[must_use]
    pub fn over(
        name: impl Into<String>,
        unit: &'static str,
        (reference, measured): (f64, f64),
        scale: f64,
        bound: f64,
    ) -> Self {
        let error = ((measured - reference) / scale).abs();
        Self { name: name.into(), unit, reference, measured, error, bound }
    }

    /// An error in a norm, whose reference is zero.
    #[must_use]
    pub fn error(name: impl Into<String>, unit: &'static str, error: f64, bound: f64) -> Self {
        Self { name: name.into(), unit, reference: 0.0, measured: error, error, bound }
    }

    /// Whether the error is in bounds. An error that is not a number is out of bounds.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        if self.error <= self.bound { Verdict::Ok } else { Verdict::Miss }
    }
}

/// Whether a figure is in bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// In bounds.
    Ok,
    /// Out of bounds.
    Miss,
}
