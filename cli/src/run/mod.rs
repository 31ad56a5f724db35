//! `sorb run`: simulates a scene, and writes measures and pictures.

mod bodies;
mod folder;
mod options;
mod pictures;
mod progress;
mod summary;
mod table;

use std::time::{Duration, Instant};

use sorb::{FrameReport, Measures, Options, StepError, World};

use crate::{error::CliError, output};
use bodies::Bodies;
use folder::Folder;
pub(crate) use options::Arguments;
use pictures::Pictures;
use progress::Progress;
use summary::Summary;
use table::Table;

/// Times and measures of the frames so far.
#[derive(Debug, Default)]
struct Record {
    /// Real time of the simulation alone.
    wall: Duration,
    /// Real time of drawing and writing pictures.
    picture: Duration,
    /// Real time of every frame in the simulation \[ms\].
    frames_ms: Vec<f64>,
    /// The last row of the table.
    measures: Measures,
}

/// Simulates.
///
/// # Errors
/// The scene or the options are invalid, results cannot be written, or the simulation diverged.
pub(crate) fn run(arguments: &Arguments) -> Result<(), CliError> {
    let scene = arguments.choice.load()?;
    let frames = arguments.frames(&scene);
    let options = Options {
        threads: arguments.threads,
        simd: arguments.simd.0,
        offload: arguments.backend.clone(),
        #[cfg(feature = "gpu")]
        gpu_times: arguments.gpu_times,
        ..Options::default()
    };
    let mut world = World::with_options(&scene, &options)?;
    let folder = Folder::create(&arguments.folder(&scene))?;
    let mut tables = Tables {
        measures: Table::create(&folder.table())?,
        bodies: if scene.bodies.is_empty() { None } else { Some(Bodies::create(&folder.bodies())?) },
    };
    let mut pictures = None;
    if arguments.pictures {
        pictures = Some(Pictures::create(&folder, arguments, &scene, frames)?);
    }
    let progress = Progress::new(&scene, frames, arguments.quiet);
    let mut record = Record::default();
    record.frame(&world, None, &mut tables, pictures.as_mut())?;
    let mut failure = None;
    for _ in 0..frames {
        let start = Instant::now();
        match world.advance_frame() {
            Ok(report) => {
                record.advanced(start.elapsed());
                record.frame(&world, Some(&report), &mut tables, pictures.as_mut())?;
                progress.frame(&report, start.elapsed());
            }
            Err(error) => {
                record.wall += start.elapsed();
                failure = Some(error);
                break;
            }
        }
    }
    progress.finish();
    if let Some(pictures) = pictures {
        pictures.finish()?;
    }
    finish(arguments, &world, &record, &folder, failure)
}

/// What gets a row in every frame.
#[derive(Debug)]
struct Tables {
    measures: Table,
    /// None in a scene without bodies.
    bodies: Option<Bodies>,
}

impl Record {
    /// Records the time of a frame.
    fn advanced(&mut self, time: Duration) {
        self.wall += time;
        self.frames_ms.push(time.as_secs_f64() * 1e3);
    }

    /// Writes the rows of a frame, and its picture if it is due; no report for the state at time zero.
    fn frame(
        &mut self,
        world: &World,
        report: Option<&FrameReport>,
        tables: &mut Tables,
        pictures: Option<&mut Pictures>,
    ) -> Result<(), CliError> {
        self.measures = world.measures();
        tables.measures.row(self.frames_ms.len(), &self.measures, report)?;
        if let Some(bodies) = &mut tables.bodies {
            bodies.rows(self.frames_ms.len(), world)?;
        }
        let start = Instant::now();
        if let Some(pictures) = pictures {
            pictures.frame(world, self.frames_ms.len())?;
        }
        self.picture += start.elapsed();
        Ok(())
    }
}

/// Writes the summary, and prints the final report.
fn finish(
    arguments: &Arguments,
    world: &World,
    record: &Record,
    folder: &Folder,
    failure: Option<StepError>,
) -> Result<(), CliError> {
    let summary = Summary::new(world, record, arguments.choice.resolution, failure.as_ref());
    let mut json = serde_json::to_string_pretty(&summary)?;
    json.push('\n');
    std::fs::write(folder.summary(), &json).map_err(CliError::write(folder.summary()))?;
    if arguments.json {
        output::print(&json)?;
    } else if !arguments.quiet {
        let path = folder.path().display();
        let contents = Folder::contents(!world.scene().bodies.is_empty(), arguments.pictures);
        output::print(&format!("{summary}results in {path}: {contents}\n"))?;
    }
    match failure {
        None => Ok(()),
        Some(error @ StepError::Gpu(_)) => Err(CliError::Gpu { error, folder: folder.path().to_owned() }),
        Some(error) => Err(CliError::Diverged { error, folder: folder.path().to_owned() }),
    }
}
