//! Run time against error of solvers, resolutions, steps and iterations.
//!
//! [`sweep`] runs the cases with the settings that trade precision for time. [`mark_front`] finds the Pareto front of run
//! time and error, and [`recommended`] the fastest run within an error. [`table`], [`diagram`] and [`page`] show them.

mod diagram;
mod page;
mod sweeps;

use std::fmt::Write as _;

pub use diagram::{DiagramError, diagram};
pub use page::{Origin, page};
use sweeps::{SWEEPS, Sweep};

use crate::{
    case::{Case, Figure, Setting},
    cases::CASES,
    run::run,
    solver::{SolverKind, Solvers},
};

/// Allowed errors, as shares of the measured quantity.
pub const BUDGETS: [f64; 4] = [0.1, 0.05, 0.02, 0.01];

/// Short runs are repeated until they have taken this long together \[s\], at most [`REPEATS`] times. The shortest time is
/// the one that other work on the machine disturbed least.
const REPEATS_FOR: f64 = 2.0;
const REPEATS: u32 = 3;

/// Prefix of a change that is a quality instead of a key.
const QUALITY: &str = "quality=";

/// One run.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Point {
    /// Name of the case.
    pub case: &'static str,
    /// Names of the solvers.
    pub solver: &'static str,
    /// Factor on the number of particles or cells along a length.
    pub resolution: f64,
    /// Changes of keys, or `quality=NAME`, joined by blanks; empty for the defaults.
    pub changes: &'static str,
    /// Root of the mean square of the relative errors of the case's figures; not a number for a run that failed.
    pub error: f64,
    /// Real time in the simulator \[s\], without references and measures.
    pub seconds: f64,
    /// Whether no other run of the case is better in one and at least as good in the other.
    pub on_front: bool,
    /// Why there is no error.
    pub failure: Option<String>,
}

impl Point {
    /// Additional arguments of `sorb run SCENE` for it.
    #[must_use]
    pub fn arguments(&self) -> String {
        let mut words = Vec::new();
        let mut name = |kind: SolverKind, key: &str| {
            let known = |name: &&str| kind.names().iter().any(|known| known == name);
            let usual = kind.default_name();
            if let Some(name) = self.solver.split('+').find(known).filter(|name| *name != usual) {
                words.push(format!("--set {key}={name}"));
            }
        };
        name(SolverKind::Water, "fluid.solver");
        name(SolverKind::Sponge, "sponges[0].solver");
        words.extend(self.changes.split_whitespace().map(|change| match change.strip_prefix(QUALITY) {
            Some(quality) => format!("--quality {quality}"),
            None => format!("--set {change}"),
        }));
        if (self.resolution - 1.0).abs() > 1e-9 {
            words.push(format!("--resolution {}", self.resolution));
        }
        if words.is_empty() { "(defaults)".to_owned() } else { words.join(" ") }
    }
}

/// Names of the cases that [`sweep`] knows, in its order.
#[must_use]
pub fn names() -> Vec<&'static str> {
    SWEEPS.iter().map(|sweep| sweep.case).collect()
}

/// Meaning of the error of a case; empty for cases that [`sweep`] does not know.
#[must_use]
pub fn meaning(case: &str) -> &'static str {
    SWEEPS.iter().find(|sweep| sweep.case == case).map_or("", |sweep| sweep.error)
}

/// Number of runs of [`sweep`].
#[must_use]
pub fn count(names: &[String], setting: &Setting) -> usize {
    chosen(names).map(|sweep| sweep.runs(setting.quick).len()).sum()
}

fn chosen(names: &[String]) -> impl Iterator<Item = &'static Sweep> {
    SWEEPS.iter().filter(|sweep| names.is_empty() || names.iter().any(|name| name == sweep.case))
}

/// Runs the named cases, or all of them; calls `done` after each run. The fronts are marked.
#[must_use]
pub fn sweep(names: &[String], setting: &Setting, mut done: impl FnMut(&Point)) -> Vec<Point> {
    let mut points = Vec::new();
    for sweep in chosen(names) {
        let Some(case) = CASES.iter().find(|case| case.name == sweep.case).copied() else { continue };
        let first = points.len();
        for (solver, resolution, changes) in sweep.runs(setting.quick) {
            let point = point(sweep, case, setting, (solver, resolution, changes));
            done(&point);
            points.push(point);
        }
        mark_front(&mut points[first..]);
    }
    points
}

fn point(
    sweep: &Sweep,
    case: &'static Case,
    setting: &Setting,
    (solver, resolution, changes): (&'static str, f64, &'static str),
) -> Point {
    let mut setting =
        Setting { solvers: solvers(solver), resolution: resolution * setting.resolution, ..setting.clone() };
    for change in changes.split_whitespace() {
        match change.strip_prefix(QUALITY).and_then(|name| name.parse().ok()) {
            Some(quality) => setting.quality = Some(quality),
            None => setting.changes.push(change.to_owned()),
        }
    }
    let mut point = Point {
        case: case.name,
        solver,
        resolution,
        changes,
        error: f64::NAN,
        seconds: f64::INFINITY,
        on_front: false,
        failure: None,
    };
    let mut total = 0.0;
    for _ in 0..REPEATS {
        let setting = Setting { stopwatch: crate::case::Stopwatch::default(), ..setting.clone() };
        match run(case, &setting).figures {
            Ok(figures) => point.error = error(sweep, &figures),
            Err(failure) => point.failure = Some(failure.to_string()),
        }
        let seconds = setting.stopwatch.seconds();
        point.seconds = point.seconds.min(seconds);
        total += seconds;
        if total > REPEATS_FOR || point.failure.is_some() {
            break;
        }
    }
    point
}

/// Root of the mean square of the figures that the sweep names, each over its scale.
fn error(sweep: &Sweep, figures: &[Figure]) -> f64 {
    let chosen = |figure: &&Figure| sweep.figures.iter().any(|(name, _)| figure.name.starts_with(name));
    let scale = |figure: &Figure| {
        let of = sweep.figures.iter().find(|(name, _)| figure.name.starts_with(name));
        of.map_or(f64::NAN, |(_, scale)| *scale)
    };
    let errors: Vec<f64> = figures.iter().filter(chosen).map(|figure| figure.error / scale(figure)).collect();
    if errors.is_empty() { f64::NAN } else { crate::norms::root_mean_square(errors) }
}

/// Solvers by their names, joined by `+`.
fn solvers(names: &str) -> Solvers {
    let find = |kind: SolverKind| {
        let known = kind.names();
        names.split('+').find(|name| known.iter().any(|known| known == name)).map(str::to_owned)
    };
    Solvers { water: find(SolverKind::Water), sponge: find(SolverKind::Sponge) }
}

/// Marks the Pareto front: points that no other point beats.
pub fn mark_front(points: &mut [Point]) {
    let all: Vec<(f64, f64)> = points.iter().map(|point| (point.error, point.seconds)).collect();
    for point in points {
        let is_beaten = |other: &(f64, f64)| {
            let (error, seconds) = *other;
            let as_good = error <= point.error && seconds <= point.seconds;
            as_good && (error < point.error || seconds < point.seconds)
        };
        point.on_front = point.error.is_finite() && !all.iter().any(is_beaten);
    }
}

/// The fastest point whose error is within a budget.
#[must_use]
pub fn recommended(points: &[Point], budget: f64) -> Option<&Point> {
    let within = points.iter().filter(|point| point.error <= budget);
    within.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
}

/// The front of a case from the fastest point on; the label of a point is its number, from 1.
#[must_use]
pub fn front(points: &[Point]) -> Vec<&Point> {
    let mut front: Vec<_> = points.iter().filter(|point| point.on_front).collect();
    front.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    front
}

/// The points as comma-separated values, with a heading.
#[must_use]
pub fn table(points: &[Point]) -> String {
    let mut text = "case,solver,resolution,changes,error,run_time_s,on_front\n".to_owned();
    for point in points {
        let Point { case, solver, resolution, changes, error, seconds, on_front, .. } = point;
        // Writing to a string does not fail.
        let _ = writeln!(text, "{case},{solver},{resolution},{changes},{error:.4e},{seconds:.3},{on_front}");
    }
    text
}

#[cfg(test)]
mod tests;
