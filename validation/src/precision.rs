//! Work and precision: the error of a case over the real time that it takes, for all that can be turned.

use std::fmt::Write as _;

use crate::{
    case::{Case, Setting, Subject},
    cases::CASES,
    run::run,
    solver::{SolverKind, Solvers},
};

/// A case, and which of its figures says how precise it is.
struct Sweep {
    case: &'static str,
    figure: usize,
    resolutions: &'static [f64],
    /// Name of a solver, and changes of keys to try with it; each joined by blanks.
    changes: &'static [(&'static str, &'static [&'static str])],
}

/// What is swept: everything that a user would turn to trade precision for time.
const SWEEPS: &[Sweep] = &[
    Sweep {
        case: "hydrostatic",
        figure: 0,
        resolutions: &[0.5, 1.0],
        changes: &[
            ("wcsph", &["", "time.courant=0.125", "fluid.support=2.5", "fluid.sound_speed=56"]),
            ("dfsph", &["", "time.maximum_step=0.0005", "fluid.density_tolerance=1e-4", "fluid.support=2.5"]),
        ],
    },
    Sweep {
        case: "dam_break",
        figure: 0,
        resolutions: &[0.5, 1.0, 1.5],
        changes: &[
            ("wcsph", &["", "time.courant=0.125", "fluid.support=2.5"]),
            ("dfsph", &["", "time.maximum_step=0.0005", "fluid.density_tolerance=1e-4", "fluid.support=2.5"]),
        ],
    },
    Sweep {
        case: "cantilever",
        figure: 0,
        resolutions: &[0.5, 1.0],
        changes: &[
            (
                "sbd",
                &[
                    "",
                    "sponges[0].iterations=2",
                    "sponges[0].iterations=8",
                    "time.maximum_step=3e-5",
                    "sponges[0].damping_time=0.0001",
                ],
            ),
            ("vbd", &["", "sponges[0].iterations=4", "time.maximum_step=0.0005"]),
            ("xpbd_neo_hookean", &["", "sponges[0].iterations=4", "time.maximum_step=0.0005"]),
        ],
    },
];

/// One run.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Point {
    /// Name of the case.
    pub case: &'static str,
    /// Name of the solver.
    pub solver: String,
    /// Resolution.
    pub resolution: f64,
    /// Changes of keys; empty for the defaults.
    pub changes: &'static str,
    /// The error; not a number for a run that failed.
    pub error: f64,
    /// Real time \[s\].
    pub wall: f64,
    /// Whether no other run of the case has both a smaller error and a shorter time.
    pub on_front: bool,
}

/// Runs everything that the names of cases and the quick form leave; calls `done` after each run.
#[must_use]
pub fn sweep(names: &[String], setting: &Setting, mut done: impl FnMut(&Point)) -> Vec<Point> {
    let mut points = Vec::new();
    for sweep in SWEEPS.iter().filter(|sweep| names.is_empty() || names.iter().any(|name| name == sweep.case))
    {
        let Some(case) = CASES.iter().find(|case| case.name == sweep.case).copied() else { continue };
        let first = points.len();
        for (solver, changes) in sweep.changes {
            let Some(solvers) = solvers(case, solver) else { continue };
            for resolution in sweep.resolutions.iter().take(setting.pick(usize::MAX, 1)) {
                for changes in changes.iter().take(setting.pick(usize::MAX, 2)) {
                    let point = point(sweep, case, setting, (&solvers, *resolution, changes));
                    done(&point);
                    points.push(point);
                }
            }
        }
        mark_front(&mut points[first..]);
    }
    points
}

/// The solver of that name, if there is one.
fn solvers(case: &Case, name: &str) -> Option<Solvers> {
    let (kind, solvers) = match case.subject {
        Subject::Sponge => {
            (SolverKind::Sponge, Solvers { sponge: Some(name.to_owned()), ..Solvers::default() })
        }
        _ => (SolverKind::Water, Solvers { water: Some(name.to_owned()), ..Solvers::default() }),
    };
    kind.names().iter().any(|known| known == name).then_some(solvers)
}

fn point(
    sweep: &Sweep,
    case: &'static Case,
    setting: &Setting,
    (solvers, resolution, changes): (&Solvers, f64, &'static str),
) -> Point {
    let setting = Setting {
        solvers: solvers.clone(),
        resolution: resolution * setting.resolution,
        changes: changes.split_whitespace().map(str::to_owned).collect(),
        ..setting.clone()
    };
    let outcome = run(case, &setting);
    let figure = outcome.figures.ok().and_then(|figures| figures.get(sweep.figure).cloned());
    Point {
        case: case.name,
        solver: outcome.solver,
        resolution,
        changes,
        error: figure.map_or(f64::NAN, |figure| figure.error),
        wall: outcome.wall,
        on_front: false,
    }
}

fn mark_front(points: &mut [Point]) {
    let all: Vec<(f64, f64)> = points.iter().map(|point| (point.error, point.wall)).collect();
    for point in points {
        let is_beaten = |other: &(f64, f64)| other.0 < point.error && other.1 < point.wall;
        point.on_front = point.error.is_finite() && !all.iter().any(is_beaten);
    }
}

/// The points as comma-separated values, with a heading.
#[must_use]
pub fn table(points: &[Point]) -> String {
    let mut text = "case,solver,resolution,changes,error,wall_s,on_front\n".to_owned();
    for point in points {
        let Point { case, solver, resolution, changes, error, wall, on_front } = point;
        // Writing to a string does not fail.
        let _ = writeln!(text, "{case},{solver},{resolution},{changes},{error:.4e},{wall:.3},{on_front}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(error: f64, wall: f64) -> Point {
        let solver = "wcsph".to_owned();
        Point { case: "a", solver, resolution: 1.0, changes: "", error, wall, on_front: false }
    }

    #[test]
    fn the_front_is_what_nothing_beats_in_both() {
        let mut points = vec![at(0.1, 1.0), at(0.2, 0.5), at(0.2, 2.0), at(f64::NAN, 0.1), at(0.05, 9.0)];
        mark_front(&mut points);
        let front: Vec<bool> = points.iter().map(|point| point.on_front).collect();
        assert_eq!(front, [true, true, false, false, true]);
        assert!(table(&points).lines().count() == 6);
    }

    #[test]
    fn sweeps_name_cases_that_there_are() {
        assert!(SWEEPS.iter().all(|sweep| CASES.iter().any(|case| case.name == sweep.case)));
    }
}
