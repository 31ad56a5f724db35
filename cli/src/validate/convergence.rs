//! `sorb validate --convergence`: the errors of cases at three resolutions, with the observed order.

use serde_json::json;
use sorb_validation::{
    Case, Outcome, Setting,
    convergence::{Convergence, FACTORS, Trend},
};

use super::{jobs, number};
use crate::{error::CliError, output};

const HEADING: [&str; 8] = ["case", "solver", "figure", "coarse", "error", "fine", "order", "errors"];

/// Runs cases at three resolutions each, and prints a row for every figure.
///
/// # Errors
/// An error that does not fall with the spacing; where known misses are allowed, one that has no known cause.
pub(crate) fn run(
    jobs: u8,
    runs: &[(&'static Case, Setting)],
    known: bool,
    json: bool,
) -> Result<(), CliError> {
    let at = |(case, setting): &(&'static Case, Setting)| {
        let (case, setting) = (*case, setting.clone());
        FACTORS.map(|factor| (case, Setting { resolution: factor * setting.resolution, ..setting.clone() }))
    };
    let all: Vec<_> = runs.iter().flat_map(at).collect();
    let (mut waiting, mut rows, mut broken) = (Vec::new(), Vec::new(), Vec::new());
    if !json {
        output::print(&line(&HEADING.map(str::to_owned)))?;
    }
    jobs::in_order(jobs, &all, |outcome| {
        waiting.push(outcome);
        let outcomes = match <[Outcome; 3]>::try_from(std::mem::take(&mut waiting)) {
            Ok(outcomes) => outcomes,
            Err(fewer) => {
                waiting = fewer;
                return Ok(());
            }
        };
        let [_, middle, _] = &outcomes;
        let (case, solver) = (middle.case.name, &middle.solver);
        let Some(figures) = Convergence::of(&outcomes) else {
            broken.push(format!("{case} ({solver}), which failed"));
            return if json { Ok(()) } else { output::print(&format!("{case}  {solver}  FAILED\n")) };
        };
        for figure in figures {
            let trend = figure.trend();
            let is_known = known && middle.known(&figure.figure).is_some();
            if trend == Trend::DoesNotFall && !is_known {
                broken.push(format!("{case} ({solver}): {}", figure.figure));
            }
            if json {
                rows.push(
                    json!({ "case": case, "solver": solver, "convergence": figure, "order": figure.order(),
                    "trend": trend }),
                );
            } else {
                output::print(&line(&cells(case, solver, &figure)))?;
            }
        }
        Ok(())
    })?;
    if json {
        output::print(&format!("{}\n", serde_json::to_string_pretty(&rows)?))?;
    }
    if broken.is_empty() {
        return Ok(());
    }
    Err(CliError::CheckFailed(format!("errors that do not fall: {}", broken.join("; "))))
}

fn cells(case: &str, solver: &str, figure: &Convergence) -> [String; 8] {
    let [coarse, middle, fine] = figure.errors.map(number);
    let order = figure.order().map_or_else(String::new, |order| format!("{order:.1}"));
    let trend = match figure.trend() {
        Trend::Falls => "fall",
        Trend::Small => "are small",
        Trend::DoesNotFall => "DO NOT FALL",
    };
    let name = figure.figure.clone();
    [case.to_owned(), solver.to_owned(), name, coarse, middle, fine, order, trend.to_owned()]
}

fn line([case, solver, figure, coarse, middle, fine, order, trend]: &[String; 8]) -> String {
    format!(
        "{case:<16}  {solver:<14}  {figure:<72}  {coarse:>9}  {middle:>9}  {fine:>9}  {order:>5}  {trend}\n"
    )
}
