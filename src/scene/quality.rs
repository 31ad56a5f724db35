//! How much work a scene puts into its precision: lists of key changes, chosen by measurement (docs/precision).

use std::{fmt, str::FromStr};

use super::error::nearest;
use super::{FluidSolver, Scene, SceneError, Solver};

/// How much work goes into precision; what it changes is in [`Quality::changes`].
///
/// It changes solvers' settings only. What a picture shows, and most of the error of water in sponges, depends on the
/// resolution: [`Scene::scaled`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// Less run time: fewer neighbours, longer steps and fewer sweeps, but no looser pressure: from a tolerance of 3e-3 on,
    /// fine water comes off its walls.
    Fast,
    /// The defaults of all keys.
    #[default]
    Balanced,
    /// Most precision that these settings give.
    Accurate,
}

/// Keys of the time, of water that `dfsph` solves, and of sponges that `vbd` solves, with their values.
struct Changes {
    time: &'static [(&'static str, &'static str)],
    fluid: &'static [(&'static str, &'static str)],
    sponge: &'static [(&'static str, &'static str)],
}

impl Quality {
    /// All of them, from the fastest on.
    pub const ALL: [Self; 3] = [Self::Fast, Self::Balanced, Self::Accurate];

    /// Name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Fast => "fast",
            Self::Balanced => "balanced",
            Self::Accurate => "accurate",
        }
    }

    fn keys(self) -> Changes {
        match self {
            Self::Fast => Changes {
                time: &[("maximum_step", "0.004"), ("courant", "0.4")],
                fluid: &[("support", "1.8"), ("density_tolerance", "1e-3"), ("rounds", "200")],
                sponge: &[("iterations", "2")],
            },
            Self::Balanced => Changes {
                time: &[("maximum_step", "0.004"), ("courant", "0.25")],
                fluid: &[("support", "2"), ("density_tolerance", "1e-3"), ("rounds", "200")],
                sponge: &[("iterations", "4")],
            },
            Self::Accurate => Changes {
                time: &[("maximum_step", "0.001"), ("courant", "0.25")],
                fluid: &[("support", "2"), ("density_tolerance", "1e-4"), ("rounds", "400")],
                sponge: &[("iterations", "8")],
            },
        }
    }

    /// What it changes in a scene, as [`Scene::with_overrides`] takes it.
    ///
    /// Other solvers than `dfsph` and `vbd` keep what the scene says: their iterations change the material.
    #[must_use]
    pub fn changes(self, scene: &Scene) -> Vec<String> {
        let Changes { time, fluid, sponge } = self.keys();
        let mut changes: Vec<String> =
            time.iter().map(|(key, value)| format!("time.{key}={value}")).collect();
        if scene.fluid.as_ref().is_some_and(|fluid| fluid.solver == FluidSolver::Dfsph) {
            changes.extend(fluid.iter().map(|(key, value)| format!("fluid.{key}={value}")));
        }
        let solved = |index: &usize| scene.sponges[*index].solver == Solver::Vbd;
        for index in (0..scene.sponges.len()).filter(solved) {
            changes.extend(sponge.iter().map(|(key, value)| format!("sponges[{index}].{key}={value}")));
        }
        changes
    }
}

impl fmt::Display for Quality {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

impl FromStr for Quality {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let names = || Self::ALL.into_iter().map(Self::name);
        Self::ALL.into_iter().find(|quality| quality.name() == name).ok_or_else(|| {
            let hint = nearest(name, names()).map(|near| format!("; did you mean `{near}`?"));
            format!(
                "no quality `{name}`{}; there are: {}",
                hint.unwrap_or_default(),
                names().collect::<Vec<_>>().join(", ")
            )
        })
    }
}

impl Scene {
    /// The scene at a quality: the keys of [`Quality::changes`] are set, whatever the scene says about them.
    ///
    /// # Errors
    /// As [`Scene::with_overrides`], for example where `time.minimum_step` is above the longest step of the quality.
    pub fn with_quality(&self, quality: Quality) -> Result<Self, SceneError> {
        let changes = quality.changes(self);
        self.with_overrides(changes.iter().map(String::as_str))
    }
}
