//! `sorb run`: simulates a scene, and writes measures and pictures.

mod bodies;
pub(crate) mod folder;
pub(crate) mod options;
pub(crate) mod pictures;
mod progress;
mod saves;
mod summary;
mod table;

use std::time::{Duration, Instant};

use sorb::{FrameReport, Measures, StepError, World, scene::Scene};

use crate::{
    error::CliError,
    export::{self, Exports},
    output,
};
use bodies::Bodies;
use folder::Folder;
pub(crate) use options::Arguments;
use pictures::Pictures;
use progress::Progress;
use saves::Saves;
pub(crate) use saves::read_save;
use summary::Summary;
use table::Table;

/// Times and measures of the frames so far.
#[derive(Debug, Default)]
struct Record {
    /// Frames before the first state.
    first: usize,
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
    export::check(&arguments.export)?;
    let (mut world, done) = begin(arguments)?;
    let scene = world.scene().clone();
    let frames = arguments.frames(&scene, done);
    let folder = Folder::create(&arguments.folder(&scene), done > 0)?;
    let mut outputs = Outputs::create(arguments, &folder, &scene, [done, frames])?;
    let progress = Progress::new(&scene, frames, arguments.quiet);
    let mut saves = arguments.save_every.map(|every| Saves::new(&folder, &world, every));
    let mut record = Record { first: done as usize, ..Record::default() };
    record.frame(&world, None, &mut outputs)?;
    let mut failure = None;
    for _ in 0..frames {
        let start = Instant::now();
        match world.advance_frame() {
            Ok(report) => {
                record.advanced(start.elapsed());
                record.frame(&world, Some(&report), &mut outputs)?;
                progress.frame(&report, start.elapsed());
                if let Some(saves) = &mut saves {
                    saves.frame(&world)?;
                }
            }
            Err(error) => {
                record.wall += start.elapsed();
                failure = Some(error);
                break;
            }
        }
    }
    progress.finish();
    outputs.finish()?;
    finish(arguments, &world, &record, &folder, failure)
}

/// The world in its first state, and the frames before that.
fn begin(arguments: &Arguments) -> Result<(World, u32), CliError> {
    let options = arguments.machine.options();
    if let Some(path) = &arguments.from {
        let save = read_save(path)?;
        let world = save.world(&options).map_err(CliError::state(path))?;
        return Ok((world, u32::try_from(save.frames()).unwrap_or(u32::MAX)));
    }
    let scene =
        arguments.load()?.ok_or_else(|| CliError::Usage("name a scene, or a save with --from".to_owned()))?;
    Ok((World::with_options(&scene, &options)?, 0))
}

/// What gets a row in every frame.
#[derive(Debug)]
struct Tables {
    measures: Table,
    /// None in a scene without bodies.
    bodies: Option<Bodies>,
}

/// Everything that is written on the way.
#[derive(Debug)]
struct Outputs {
    tables: Tables,
    pictures: Option<Pictures>,
    exports: Option<Exports>,
}

impl Outputs {
    fn create(
        arguments: &Arguments,
        folder: &Folder,
        scene: &Scene,
        frames: [u32; 2],
    ) -> Result<Self, CliError> {
        let [done, frames] = frames;
        let bodies =
            if scene.bodies.is_empty() { None } else { Some(Bodies::create(&folder.bodies(), done)?) };
        let tables = Tables { measures: Table::create(&folder.table(), done)?, bodies };
        let mut pictures = None;
        if arguments.drawing.pictures {
            pictures = Some(Pictures::create(folder, &arguments.drawing, scene, done..=done + frames)?);
        }
        let mut exports = None;
        if !arguments.export.is_empty() {
            let how = (&arguments.export[..], arguments.export_every);
            exports = Some(Exports::create(folder.export(), how, scene.time.frame_rate)?);
        }
        Ok(Self { tables, pictures, exports })
    }

    fn finish(self) -> Result<(), CliError> {
        if let Some(pictures) = self.pictures {
            pictures.finish()?;
        }
        self.exports.map_or(Ok(()), |exports| exports.finish())
    }
}

impl Record {
    /// Records the time of a frame.
    fn advanced(&mut self, time: Duration) {
        self.wall += time;
        self.frames_ms.push(time.as_secs_f64() * 1e3);
    }

    /// Writes the rows of a frame, its picture and its exports if they are due; no report for the state at time zero.
    fn frame(
        &mut self,
        world: &World,
        report: Option<&FrameReport>,
        outputs: &mut Outputs,
    ) -> Result<(), CliError> {
        self.measures = world.measures();
        let frame = self.first + self.frames_ms.len();
        // The run that left a save has written the rows of its frame.
        if report.is_some() || self.first == 0 {
            outputs.tables.measures.row(frame, &self.measures, report)?;
            if let Some(bodies) = &mut outputs.tables.bodies {
                bodies.rows(frame, world)?;
            }
        }
        let start = Instant::now();
        if let Some(pictures) = &mut outputs.pictures {
            pictures.frame(world, frame)?;
        }
        self.picture += start.elapsed();
        match &outputs.exports {
            Some(exports) => exports.frame(frame, world),
            None => Ok(()),
        }
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
    let summary = Summary::new(world, record, arguments.changes.resolution, failure.as_ref());
    let mut json = serde_json::to_string_pretty(&summary)?;
    json.push('\n');
    std::fs::write(folder.summary(), &json).map_err(CliError::write(folder.summary()))?;
    if arguments.json {
        output::print(&json)?;
    } else if !arguments.quiet {
        let path = folder.path().display();
        let drawing = &arguments.drawing;
        let contents =
            Folder::contents(!world.scene().bodies.is_empty(), drawing.pictures, drawing.animation);
        output::print(&format!("{summary}results in {path}: {contents}\n"))?;
    }
    match failure {
        None => Ok(()),
        Some(error @ StepError::Gpu(_)) => Err(CliError::Gpu { error, folder: folder.path().to_owned() }),
        Some(error) => Err(CliError::Diverged { error, folder: folder.path().to_owned() }),
    }
}
