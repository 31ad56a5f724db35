//! Errors of a case at three resolutions, and the order at which they fall.

use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

use libm::log;

use crate::{case::Figure, norms, run::Outcome};

/// Factors on the resolution, a root of two from one to the next: a scene in space has 2.8 times as many particles.
pub const FACTORS: [f64; 3] = [FRAC_1_SQRT_2, 1.0, SQRT_2];

/// Share of its bound below which an error need not fall: what is left there does not come from the resolution alone.
pub const SMALL: f64 = 0.2;

/// A figure at the three resolutions of [`FACTORS`].
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Convergence {
    /// What was measured, by its name at the middle one: some names contain a fitted value.
    pub figure: String,
    /// Its errors, coarsest first. What a case states in spacings is here in those of the middle resolution: a spacing is no measure of
    /// itself.
    pub errors: [f64; 3],
    /// The bound of the error at the middle one.
    pub bound: f64,
}

/// How the errors go with the resolution.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Trend {
    /// They fall.
    Falls,
    /// All are below a fifth of the bound.
    Small,
    /// They do not fall, or one is not a number.
    DoesNotFall,
}

impl Convergence {
    /// Of the outcomes of one case. Nothing if one of them has no figures, or others.
    #[must_use]
    pub fn of(outcomes: &[Outcome; 3]) -> Option<Vec<Self>> {
        let [coarse, middle, fine] = outcomes.each_ref().map(|outcome| outcome.figures.as_deref().ok());
        let (coarse, middle, fine) = (coarse?, middle?, fine?);
        let alike = coarse.len() == middle.len() && middle.len() == fine.len();
        let rows = coarse.iter().zip(middle).zip(fine);
        alike.then(|| rows.map(|((coarse, middle), fine)| Self::between(coarse, middle, fine)).collect())
    }

    fn between(coarse: &Figure, middle: &Figure, fine: &Figure) -> Self {
        let mut errors = [coarse, middle, fine].map(|figure| figure.error);
        if middle.name.contains("over spacings") {
            errors.iter_mut().zip(FACTORS).for_each(|(error, factor)| *error /= factor);
        }
        Self { figure: middle.name.clone(), errors, bound: middle.bound }
    }

    /// Observed order: the exponent p of errors proportional to the spacing to the power p, by least squares. Nothing where an error is
    /// zero or not a number.
    #[must_use]
    pub fn order(&self) -> Option<f64> {
        let points: Vec<_> =
            FACTORS.iter().zip(self.errors).map(|(factor, error)| (log(*factor), log(error))).collect();
        points.iter().all(|(_, error)| error.is_finite()).then(|| -norms::line(&points).0)
    }

    /// How the errors go with the resolution.
    #[must_use]
    pub fn trend(&self) -> Trend {
        if self.errors.iter().all(|error| *error <= SMALL * self.bound) {
            return Trend::Small;
        }
        // An error that is gone has no logarithm.
        let [coarse, _, fine] = self.errors;
        let falls = self.order().map_or(fine < coarse, |order| order > 0.0);
        if falls { Trend::Falls } else { Trend::DoesNotFall }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn convergence(errors: [f64; 3]) -> Convergence {
        Convergence { figure: "speed".to_owned(), errors, bound: 0.05 }
    }

    #[test]
    fn errors_of_second_order_have_the_order_two() {
        let found = convergence(FACTORS.map(|factor| 0.03 * factor.powi(-2)));
        assert!(found.order().is_some_and(|order| (order - 2.0).abs() < 1e-12), "{found:?}");
        assert_eq!(found.trend(), Trend::Falls);
    }

    #[test]
    fn errors_that_grow_do_not_fall() {
        let found = convergence([0.02, 0.03, 0.04]);
        assert!(found.order().is_some_and(|order| order < 0.0), "{found:?}");
        assert_eq!(found.trend(), Trend::DoesNotFall);
        // Below a fifth of the bound they may.
        assert_eq!(convergence([0.002, 0.003, 0.004]).trend(), Trend::Small);
    }

    #[test]
    fn a_constant_number_of_spacings_is_of_first_order() {
        let figure = |name: &str| Figure::error(name, "m", 0.3, 0.5);
        let of = |name: &str| Convergence::between(&figure(name), &figure(name), &figure(name)).order();
        assert!(of("draft, error over spacings").is_some_and(|order| (order - 1.0).abs() < 1e-12));
        assert!(of("draft, error over its height").is_some_and(|order| order.abs() < 1e-12));
    }

    #[test]
    fn an_error_without_a_logarithm_has_no_order() {
        assert_eq!(convergence([0.03, 0.02, 0.0]).order(), None);
        assert_eq!(convergence([0.03, 0.02, 0.0]).trend(), Trend::Falls);
        assert_eq!(convergence([0.03, f64::NAN, 0.01]).order(), None);
        assert_eq!(convergence([0.03, 0.02, f64::NAN]).trend(), Trend::DoesNotFall);
        assert_eq!(convergence([f64::NAN, 0.02, 0.01]).trend(), Trend::DoesNotFall);
    }
}
