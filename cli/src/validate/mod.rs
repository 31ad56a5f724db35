//! `sorb validate`: compares the simulator with analytic, experimental and converged references.

mod convergence;
mod jobs;
mod precision;

use std::{fmt::Write as _, path::PathBuf};

use serde_json::{Value, json};
use sorb::{Offload, Options, scene::Quality};
use sorb_validation::{
    Backends, CASES, Case, Outcome, Setting, SolverKind, Solvers, Stopwatch, Subject, Verdict,
};

use crate::{error::CliError, output};

/// Arguments of `sorb validate`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Names of cases (see --list); all by default
    #[arg(value_name = "CASE")]
    cases: Vec<String>,
    /// Lists the cases instead of running them
    #[arg(long)]
    list: bool,
    /// Solver of the water or of the sponge, or all; by default the defaults of scenes; may be repeated
    #[arg(long, value_name = "NAME")]
    solver: Vec<String>,
    /// Refines the cases, 0.25 to 8; the bounds are meant for 1
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = resolution)]
    resolution: f64,
    /// Coarser and shorter runs, two minutes in all on one core
    #[arg(long)]
    quick: bool,
    /// Trade-off between precision and run time: fast, balanced or accurate; by default the keys of the cases
    #[arg(long, value_name = "QUALITY", conflicts_with = "work_precision")]
    quality: Option<Quality>,
    /// Changes one key of every scene, as in `--set sponges[0].iterations=4`; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Where to run: cpu, gpu or auto
    #[arg(long, value_name = "BACKEND", default_value = "cpu")]
    backend: Offload,
    /// Number of threads, 1 to 1024, by default one per core; results do not depend on it
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// Cases that run at the same time, 1 to 64. They share the threads; the times of cases are those beside each other
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=64))]
    #[arg(conflicts_with = "work_precision")]
    jobs: u8,
    /// Plants the fault of each case, which must then miss a bound
    #[arg(long)]
    control: bool,
    /// Accepts misses with a known cause
    #[arg(long)]
    allow_known: bool,
    /// Runs cases at 0.7, 1 and 1.4 times the resolution; an error that does not fall with the spacing fails
    #[arg(long, conflicts_with_all = ["list", "control", "work_precision"])]
    convergence: bool,
    /// Runs cases at many settings, and writes a report of run time against error: ten minutes, or half a minute with
    /// --quick
    #[arg(long, conflicts_with_all = ["list", "solver", "control", "allow_known", "json"])]
    work_precision: bool,
    /// Folder for that report
    #[arg(long, value_name = "DIR", default_value = "out/precision", requires = "work_precision")]
    out: PathBuf,
    /// Remark about the machine in that report, beside its processor
    #[arg(long, value_name = "TEXT", requires = "work_precision")]
    note: Option<String>,
    /// Prints a JSON array instead of a table
    #[arg(long)]
    json: bool,
}

/// Runs the cases.
///
/// # Errors
/// A case or solver does not exist, or a case is out of its bounds.
pub(crate) fn run(arguments: &Arguments) -> Result<(), CliError> {
    if arguments.work_precision {
        return precision::run(&precision::Request {
            cases: &arguments.cases,
            setting: arguments.setting(Solvers::default(), arguments.options()),
            out: arguments.out.clone(),
            note: arguments.note.as_deref(),
        });
    }
    let cases = chosen(&arguments.cases)?;
    if arguments.list {
        return list(&cases, arguments.json);
    }
    let solvers = Choices::new(&arguments.solver)?;
    let options = arguments.options();
    let mut runs = Vec::new();
    for case in cases {
        let settings = solvers.of(case.subject).into_iter();
        runs.extend(settings.map(|solvers| (case, arguments.setting(solvers, options.clone()))));
    }
    if arguments.convergence {
        return convergence::run(arguments.jobs, &runs, arguments.allow_known, arguments.json);
    }
    let (mut rows, mut broken) = (Vec::new(), Vec::new());
    if !arguments.json {
        output::print(&line(&HEADING.map(str::to_owned)))?;
    }
    jobs::in_order(arguments.jobs, &runs, |outcome| {
        if arguments.json {
            rows.push(row_json(&outcome));
        } else {
            output::print(&text(&outcome, arguments.control))?;
        }
        if !arguments.accepts(&outcome) {
            broken.push(format!("{} ({})", outcome.case.name, outcome.solver));
        }
        Ok(())
    })?;
    if arguments.json {
        output::print(&format!("{}\n", serde_json::to_string_pretty(&rows)?))?;
    }
    if broken.is_empty() {
        return Ok(());
    }
    let what = if arguments.control { "in bounds in spite of the fault" } else { "out of bounds" };
    Err(CliError::CheckFailed(format!("{what}: {}", broken.join(", "))))
}

impl Arguments {
    fn setting(&self, solvers: Solvers, options: Options) -> Setting {
        Setting {
            solvers,
            resolution: self.resolution,
            quick: self.quick,
            fault: self.control,
            changes: self.set.clone(),
            options,
            quality: self.quality,
            stopwatch: Stopwatch::default(),
            backends: Backends::default(),
        }
    }

    /// Options of all cases: one device, whose pipelines are compiled once.
    fn options(&self) -> Options {
        Options {
            threads: self.threads.or_else(|| jobs::threads_of_each(self.jobs)),
            offload: self.backend.clone(),
            // If there is none, the first world reports why.
            #[cfg(feature = "gpu")]
            gpu: self
                .backend
                .wants_gpu()
                .then(sorb::gpu::Gpu::new)
                .and_then(Result::ok)
                .map(std::sync::Arc::new),
            ..Options::default()
        }
    }

    fn accepts(&self, outcome: &Outcome) -> bool {
        if self.control {
            !outcome.holds()
        } else if self.allow_known {
            outcome.holds_but_for_known()
        } else {
            outcome.holds()
        }
    }
}

/// The solvers to run.
struct Choices {
    water: Vec<Option<String>>,
    sponge: Vec<Option<String>>,
}

impl Choices {
    fn new(names: &[String]) -> Result<Self, CliError> {
        let (water, sponge) = (SolverKind::Water.names(), SolverKind::Sponge.names());
        let all = names.iter().any(|name| name == "all");
        let known = |name: &&String| *name != "all" && !water.contains(name) && !sponge.contains(name);
        if let Some(name) = names.iter().find(known) {
            let all = [&water[..], &sponge[..]].concat().join(", ");
            return Err(CliError::Usage(format!("no solver `{name}`; there are: all, {all}")));
        }
        let pick = |kind: &[String]| {
            let picked: Vec<_> =
                kind.iter().filter(|name| all || names.contains(name)).cloned().map(Some).collect();
            if picked.is_empty() { vec![None] } else { picked }
        };
        Ok(Self { water: pick(&water), sponge: pick(&sponge) })
    }

    /// All combinations that matter to a case.
    fn of(&self, subject: Subject) -> Vec<Solvers> {
        let one = [None];
        let (water, sponge) = match subject {
            Subject::Water => (&self.water[..], &one[..]),
            Subject::Sponge => (&one[..], &self.sponge[..]),
            Subject::Coupling => (&self.water[..], &self.sponge[..]),
        };
        let with = |water: &Option<String>| {
            let water = water.clone();
            sponge.iter().map(move |sponge| Solvers { water: water.clone(), sponge: sponge.clone() })
        };
        water.iter().flat_map(with).collect()
    }
}

fn chosen(names: &[String]) -> Result<Vec<&'static Case>, CliError> {
    if names.is_empty() {
        return Ok(CASES.to_vec());
    }
    let find = |name: &String| {
        CASES.iter().find(|case| case.name == name).copied().ok_or_else(|| {
            let all: Vec<_> = CASES.iter().map(|case| case.name).collect();
            CliError::Usage(format!("no case `{name}`; there are: {}", all.join(", ")))
        })
    };
    names.iter().map(find).collect()
}

fn list(cases: &[&Case], json: bool) -> Result<(), CliError> {
    if json {
        let rows: Vec<_> = cases
            .iter()
            .map(|case| {
                json!({ "name": case.name, "title": case.title, "source": case.source, "control": case.control })
            })
            .collect();
        return output::print(&format!("{}\n", serde_json::to_string_pretty(&rows)?));
    }
    let mut rows = vec![["name", "what", "reference"].map(str::to_owned)];
    rows.extend(cases.iter().map(|case| [case.name, case.title, case.source].map(str::to_owned)));
    output::print(&output::table(&rows, [false, false, false]))
}

const HEADING: [&str; 10] =
    ["case", "solver", "on", "figure", "reference", "measured", "error", "bound", "time", "verdict"];
const WIDTHS: [usize; 9] = [13, 8, 3, 44, 10, 10, 9, 9, 7];

fn line(cells: &[String; 10]) -> String {
    let mut line = String::new();
    for (index, (cell, width)) in cells.iter().zip(WIDTHS).enumerate() {
        // Numbers are on the right.
        let _ = if index < 4 { write!(line, "{cell:<width$}  ") } else { write!(line, "{cell:>width$}  ") };
    }
    line + &cells[9] + "\n"
}

/// Four significant digits.
fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        size if (0.01..1e4).contains(&size) => format!("{value:.4}"),
        _ => format!("{value:.2e}"),
    }
}

/// Lines of a case; with a planted fault, no miss counts as known.
fn text(outcome: &Outcome, control: bool) -> String {
    let head = [outcome.case.name.to_owned(), outcome.solver.clone(), outcome.backends.names()];
    let time = format!("{:.1} s", outcome.wall);
    let known = |figure: &str| outcome.known(figure).filter(|_| !control);
    let verdict = |known: Option<&sorb_validation::KnownMiss>, otherwise: &str| {
        known.map_or_else(|| otherwise.to_owned(), |miss| format!("known miss: {}", miss.cause))
    };
    let [name, solver, backend] = head;
    match &outcome.figures {
        Ok(figures) => figures
            .iter()
            .map(|figure| {
                let verdict = match figure.verdict() {
                    Verdict::Ok => "ok".to_owned(),
                    Verdict::Miss => verdict(known(&figure.name), "MISS"),
                };
                line(&[
                    name.clone(),
                    solver.clone(),
                    backend.clone(),
                    format!("{} [{}]", figure.name, figure.unit),
                    number(figure.reference),
                    number(figure.measured),
                    number(figure.error),
                    number(figure.bound),
                    time.clone(),
                    verdict,
                ])
            })
            .collect(),
        Err(failure) => {
            let empty = String::new;
            let known = outcome.known_failure(failure).filter(|_| !control);
            let verdict = verdict(known, "FAILED");
            line(&[
                name,
                solver,
                backend,
                failure.to_string(),
                empty(),
                empty(),
                empty(),
                empty(),
                time,
                verdict,
            ])
        }
    }
}

fn row_json(outcome: &Outcome) -> Value {
    let (figures, failure) = match &outcome.figures {
        Ok(figures) => {
            let with_verdict = |figure: &sorb_validation::Figure| {
                json!({
                    "figure": figure,
                    "verdict": figure.verdict(),
                    "known": outcome.known(&figure.name).map(|miss| miss.cause),
                })
            };
            (figures.iter().map(with_verdict).collect(), None)
        }
        Err(failure) => (Vec::new(), Some(failure.to_string())),
    };
    json!({
        "case": outcome.case.name,
        "solver": outcome.solver,
        "backend": outcome.backends.names(),
        "backend_reason": outcome.backends.reasons(),
        "figures": figures,
        "failure": failure,
        "wall_s": outcome.wall,
    })
}

fn resolution(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|value| (0.25..=8.0).contains(value));
    number.ok_or_else(|| "expected a number from 0.25 to 8".to_owned())
}
