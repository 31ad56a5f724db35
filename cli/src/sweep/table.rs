//! The table of a sweep.

use std::{collections::BTreeMap, path::Path};

use super::{
    jobs::{Job, Row},
    plan::Plan,
};
use crate::error::CliError;

/// Writes the table: a row for every run, in their order.
///
/// # Errors
/// The file cannot be written.
pub(super) fn write(
    path: &Path,
    plan: &Plan,
    jobs: &[Job],
    rows: &BTreeMap<usize, Row>,
) -> Result<(), CliError> {
    let failed = |error: csv::Error| CliError::Write { path: path.to_owned(), source: error.into() };
    let mut table = csv::Writer::from_path(path).map_err(failed)?;
    let columns = plan.columns();
    let mut heading = vec!["run".to_owned()];
    heading.extend(plan.grid.0.iter().map(|(key, _)| key.clone()));
    heading.extend(columns.iter().cloned());
    heading.extend(["digest", "wall_seconds", "error"].map(str::to_owned));
    table.write_record(&heading).map_err(failed)?;
    for (job, row) in jobs.iter().filter_map(|job| Some((job, rows.get(&job.number)?))) {
        let mut cells = vec![row.run.to_string()];
        for value in &job.settings {
            cells.push(cell(value)?);
        }
        // A run that failed has none.
        cells.extend((0..columns.len()).map(|column| row.measures.get(column).cloned().unwrap_or_default()));
        cells.extend([row.digest.clone(), format!("{:?}", row.wall_seconds), row.error.clone()]);
        table.write_record(&cells).map_err(failed)?;
    }
    table.flush().map_err(CliError::write(path))
}

/// A setting: text as it is, all else as JSON.
fn cell(value: &toml::Value) -> Result<String, CliError> {
    match value.as_str() {
        Some(text) => Ok(text.to_owned()),
        None => Ok(serde_json::to_string(value)?),
    }
}
