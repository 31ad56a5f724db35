//! Runs a case and times it.

use std::time::Instant;

use crate::{
    case::{Backends, Case, Failure, Figure, Setting, Verdict},
    known::{KnownMiss, known},
};

/// Result of a case.
#[derive(Debug)]
pub struct Outcome {
    /// The case.
    pub case: &'static Case,
    /// Names of its solvers.
    pub solver: String,
    /// Backends of its worlds.
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
            Err(failure) => self.known_failure(failure).is_some(),
        }
    }

    /// Why a figure is known to miss its bound.
    #[must_use]
    pub fn known(&self, figure: &str) -> Option<&'static KnownMiss> {
        known(self.case.name, &self.solver, figure)
    }

    /// Why a case is known to give no figures. A world that could not be built is no fault of its models.
    #[must_use]
    pub fn known_failure(&self, failure: &Failure) -> Option<&'static KnownMiss> {
        matches!(failure, Failure::Step(_) | Failure::Nothing(_)).then(|| self.known("")).flatten()
    }
}

/// Runs a case.
#[must_use]
pub fn run(case: &'static Case, setting: &Setting) -> Outcome {
    let start = Instant::now();
    // Only those of the case: the setting may have run others.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CASES;

    #[test]
    fn a_world_that_cannot_be_built_is_no_known_miss() {
        let case = CASES.iter().find(|case| case.name == "rest").expect("there is one");
        let setting = Setting { changes: vec!["fluid.spacing=-1".to_owned()], ..Setting::new() };
        let mut outcome = run(case, &setting);
        assert!(matches!(outcome.figures, Err(Failure::Scene(_))), "{outcome:?}");
        assert!(!outcome.holds_but_for_known());
        // Negative control: a run without figures is a known miss of this case.
        outcome.figures = Err(Failure::Nothing("no motion".to_owned()));
        assert!(outcome.holds_but_for_known());
    }
}
