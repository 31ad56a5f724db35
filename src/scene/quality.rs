//! Qualities of a scene: lists of key changes, chosen by measurement (docs/precision).

use std::{fmt, str::FromStr};

use super::error::nearest;
use super::{FluidSolver, Scene, SceneError, Solver};

/// Trade-off between precision and run time; [`Quality::changes`] lists what it changes.
///
/// It changes settings of the solvers only. Pictures, and most of the error of water in sponges, depend on the resolution:
/// [`Scene::scaled`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// Less run time: longer steps and fewer sweeps. The support radius is not smaller: at 1.8 spacings the pressure of water at rest is
    /// 3.7 instead of 0.3 % off. The tolerance of the pressure is not looser: from 3e-3 on, fine water separates from its walls.
    Fast,
    /// The defaults of all keys.
    #[default]
    Balanced,
    /// Highest precision that these settings give.
    Accurate,
}

/// Keys and values for time, water with a pressure solve and sponges solved by `vbd`.
struct Changes {
    time: &'static [(&'static str, &'static str)],
    fluid: &'static [(&'static str, &'static str)],
    sponge: &'static [(&'static str, &'static str)],
}

impl Quality {
    /// All qualities, from the fastest on.
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
                fluid: &[("support", "2"), ("density_tolerance", "1e-3"), ("rounds", "200")],
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

    /// The changes for a scene, as [`Scene::with_overrides`] takes them.
    ///
    /// Solvers other than `divergence`, `dfsph` and `vbd` keep the keys of the scene: their iterations change the material.
    #[must_use]
    pub fn changes(self, scene: &Scene) -> Vec<String> {
        let Changes { time, fluid, sponge } = self.keys();
        let mut changes: Vec<String> =
            time.iter().map(|(key, value)| format!("time.{key}={value}")).collect();
        let is_solved = |solver| matches!(solver, FluidSolver::Dfsph | FluidSolver::Divergence);
        if scene.fluid_solver().is_some_and(is_solved) {
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
    /// The scene at a quality: sets the keys of [`Quality::changes`], whatever their values in the scene.
    ///
    /// # Errors
    /// As [`Scene::with_overrides`], for example where `time.minimum_step` is above the longest step of the
    /// quality.
    pub fn with_quality(&self, quality: Quality) -> Result<Self, SceneError> {
        let changes = quality.changes(self);
        self.with_overrides(changes.iter().map(String::as_str))
    }
}
