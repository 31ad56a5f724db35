//! `measures.csv`: a row for every frame.

use std::{
    fmt::Write as _,
    fs::File,
    io::Write as _,
    path::{Path, PathBuf},
};

use serde::{Serialize, Serializer};
use sorb::{FrameReport, Measures};

use crate::error::CliError;

/// A column of measures: its name, and its value.
type Column = (&'static str, fn(&Measures) -> f64);

/// The measures, in the order of the table and of the summary.
const COLUMNS: [Column; 22] = [
    ("time_s", |m| m.time),
    ("water_mass_kg", |m| m.water_mass),
    ("absorbed_mass_kg", |m| m.absorbed_mass),
    ("free_mass_kg", |m| m.water_mass - m.absorbed_mass),
    ("saturation", |m| m.saturation),
    ("wicking_height_m", |m| m.wicking_height),
    ("sponge_volume_m3", |m| m.sponge_volume),
    ("sponge_centre_x_m", |m| m.sponge_centre.x),
    ("sponge_centre_y_m", |m| m.sponge_centre.y),
    ("sponge_centre_z_m", |m| m.sponge_centre.z),
    ("momentum_x_kg_m_per_s", |m| m.linear_momentum.x),
    ("momentum_y_kg_m_per_s", |m| m.linear_momentum.y),
    ("momentum_z_kg_m_per_s", |m| m.linear_momentum.z),
    ("angular_momentum_x_kg_m2_per_s", |m| m.angular_momentum.x),
    ("angular_momentum_y_kg_m2_per_s", |m| m.angular_momentum.y),
    ("angular_momentum_z_kg_m2_per_s", |m| m.angular_momentum.z),
    ("kinetic_J", |m| m.kinetic_energy),
    ("potential_J", |m| m.potential_energy),
    ("elastic_J", |m| m.elastic_energy),
    ("maximum_speed_m_per_s", |m| m.maximum_speed),
    ("mean_density_error", |m| m.mean_density_error),
    ("maximum_density_error", |m| m.maximum_density_error),
];

/// The table while it is written. Every row is written to the file at once, so that a killed run leaves all of them.
#[derive(Debug)]
pub(super) struct Table {
    path: PathBuf,
    file: File,
}

impl Table {
    /// Creates the file with its heading. For a run that continues after some frames, it keeps the rows of these if the file
    /// has them.
    ///
    /// # Errors
    /// The file cannot be read or written.
    pub(super) fn create(path: &Path, done: u32) -> Result<Self, CliError> {
        let names = COLUMNS.map(|(name, _)| name).join(",");
        let begin = begin(path, &format!("frame,{names},steps,shortest_step_s,bound\n"), done)?;
        let file = File::create(path).map_err(CliError::write(path))?;
        let mut table = Self { path: path.to_owned(), file };
        table.line(&begin)?;
        Ok(table)
    }

    /// Writes the row of a frame; no report for the state at time zero.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(super) fn row(
        &mut self,
        frame: usize,
        measures: &Measures,
        report: Option<&FrameReport>,
    ) -> Result<(), CliError> {
        let mut line = frame.to_string();
        for (_, value) in COLUMNS {
            // Shortest digits that read back as the same number, with an exponent where that is shorter.
            let _ = write!(line, ",{:?}", value(measures));
        }
        line += &match report {
            // A frame in which everything sleeps has no step.
            Some(report) if report.steps == 0 => format!(",0,,{}\n", report.bound.name()),
            Some(report) => format!(",{},{:?},{}\n", report.steps, report.shortest_step, report.bound.name()),
            None => ",0,,\n".to_owned(),
        };
        self.line(&line)
    }

    fn line(&mut self, line: &str) -> Result<(), CliError> {
        self.file.write_all(line.as_bytes()).map_err(CliError::write(&self.path))
    }
}

/// How a table begins: its heading, and the rows of the frames that are done, from the file of the run that did them.
///
/// # Errors
/// The file is there, and cannot be read.
pub(super) fn begin(path: &Path, heading: &str, done: u32) -> Result<String, CliError> {
    let mut text = heading.to_owned();
    if done > 0 && path.exists() {
        let earlier = std::fs::read_to_string(path).map_err(CliError::read(path))?;
        let is_done = |row: &&str| {
            row.split(',').next().is_some_and(|frame| frame.parse().is_ok_and(|frame: u32| frame <= done))
        };
        // A row without an end was not completed.
        let rows = earlier.split_inclusive('\n').filter(|row| row.ends_with('\n')).filter(is_done);
        rows.for_each(|row| text.push_str(row));
    }
    Ok(text)
}

/// Measures as a JSON object with the names of the table.
#[derive(Debug)]
pub(super) struct Named(pub(super) Measures);

impl Serialize for Named {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(COLUMNS.iter().map(|(name, value)| (name, value(&self.0))))
    }
}
