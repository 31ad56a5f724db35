//! Runs a case and times it.

use std::time::Instant;

use crate::{
    case::{Backends, Case, Failure, Figure, Setting, Verdict},
    known::{KnownMiss, known},
};

/// What became of a case.
#[derive(Debug)]
pub struct Outcome {
    /// The case.
    pub case: &'static Case,
    /// Names of its solvers.
    pub solver: String,
    /// Where its worlds ran.
    pub backends: Backends,
    /// The figures, or why there are none.
    pub figures: Result<Vec<Figure>, Failure>,
    /// Real time of the run \[s\].
    pub wall: f64,
}

impl Outcome {
    /// Whether every figure is in bounds.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.figures
            .as_ref()
            .is_ok_and(|figures| figures.iter().all(|figure| figure.verdict() == Verdict::Ok))
    }

    /// Whether every figure is in bounds or a known miss.
    #[must_use]
    pub fn holds_but_for_known(&self) -> bool {
        match &self.figures {
            Ok(figures) => figures
                .iter()
                .all(|figure| figure.verdict() == Verdict::Ok || self.known(&figure.name).is_some()),
            Err(_) => self.known("").is_some(),
        }
    }

    /// Why a figure is known to miss its bound; the empty name stands for a case that gives no figures.
    #[must_use]
    pub fn known(&self, figure: &str) -> Option<&'static KnownMiss> {
        known(self.case.name, &self.solver, figure)
    }
}

/// Runs a case.
#[must_use]
pub fn run(case: &'static Case, setting: &Setting) -> Outcome {
    let start = Instant::now();
    // Those of the case alone: the setting may have run others.
    let setting = &Setting { backends: Backends::default(), ..setting.clone() };
    let figures = (case.run)(setting);
    Outcome {
        case,
        backends: setting.backends.clone(),
        solver: setting.solvers.label(case.subject),
        figures,
        wall: start.elapsed().as_secs_f64(),
    }
}
