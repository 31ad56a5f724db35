//! A world that runs, or a recording that plays.

use std::{
    collections::BTreeMap,
    fs::File,
    io::{BufWriter, Write as _},
    path::Path,
};

use sorb::{Bound, Command, FrameReport, Options, Player, Recorder, ReplayError, StateError, World};

use crate::{Source, ViewError};

/// A world that runs, or a recording that plays.
#[derive(Debug)]
pub struct Session<'a> {
    source: &'a Source,
    options: Options,
    /// File of the recording that is made.
    record: Option<&'a Path>,
    acts: Acts<'a>,
    /// Commands that the world took, by their names.
    commands: BTreeMap<&'static str, u64>,
}

/// Who steps the world.
#[derive(Debug)]
enum Acts<'a> {
    /// The window; a recorder takes all that it does.
    Live(Box<World>, Option<Box<Recorder>>),
    /// A recording.
    Played(Box<Player<'a>>),
}

/// What a frame or a step took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Advance {
    /// Steps; 0 where everything sleeps.
    pub steps: u64,
    /// Shortest step \[s\]; infinite without one.
    pub shortest: f32,
    /// What bound most of them.
    pub bound: Option<Bound>,
    /// Largest speed of particles and nodes \[m/s\].
    pub speed: f32,
}

impl<'a> Session<'a> {
    /// Builds the first state. `record` is the file of a recording of all that happens.
    ///
    /// # Errors
    /// The scene cannot be built, the recording or the save is not usable, or the state cannot be recorded in that file.
    pub fn new(source: &'a Source, options: &Options, record: Option<&'a Path>) -> Result<Self, ViewError> {
        if let Some(path) = record {
            // A file that cannot be written is told before anything happens that it should hold.
            let opened = File::options().create(true).append(true).open(path);
            opened.map_err(|source| ViewError::Write { path: path.to_owned(), source })?;
        }
        let acts = begin(source, options, record, &[])?;
        Ok(Self { source, options: options.clone(), record, acts, commands: BTreeMap::new() })
    }

    /// Goes back to the first state. `changes` are those of a scene, as in [`Scene::with_overrides`](sorb::scene::Scene::with_overrides);
    /// recordings and saves have none. A recording that is made begins anew.
    ///
    /// # Errors
    /// As [`Self::new`]; then nothing has changed.
    pub fn reset(&mut self, changes: &[String]) -> Result<(), ViewError> {
        if matches!(self.acts, Acts::Played(_)) {
            return self.seek(0);
        }
        self.acts = begin(self.source, &self.options, self.record, changes)?;
        Ok(())
    }

    /// The present state.
    #[must_use]
    pub fn world(&self) -> &World {
        match &self.acts {
            Acts::Live(world, _) => world,
            Acts::Played(player) => player.world(),
        }
    }

    /// The present frame of a recording that plays, and its last one.
    #[must_use]
    pub fn played(&self) -> Option<(u64, u64)> {
        match (&self.acts, self.source) {
            (Acts::Played(player), Source::Recording(_, recording)) => {
                Some((player.frame(), recording.ticks()))
            }
            _ => None,
        }
    }

    /// What it was made of.
    #[must_use]
    pub fn source(&self) -> &'a Source {
        self.source
    }

    /// Commands that worlds took since the beginning, by their names.
    #[must_use]
    pub fn commands(&self) -> &BTreeMap<&'static str, u64> {
        &self.commands
    }

    /// Whether changes of the scene are possible at a reset.
    #[must_use]
    pub fn has_scene(&self) -> bool {
        matches!(self.source, Source::Scene(_))
    }

    /// Pushes a command.
    ///
    /// # Errors
    /// The world refuses it, or a recording plays.
    pub fn push(&mut self, command: Command) -> Result<(), ViewError> {
        let name = name(&command);
        match &mut self.acts {
            Acts::Live(world, Some(recorder)) => recorder.push(world, command)?,
            Acts::Live(world, None) => world.push(command)?,
            Acts::Played(_) => return Err(ViewError::Plays),
        }
        *self.commands.entry(name).or_default() += 1;
        Ok(())
    }

    /// Takes a frame. None at the end of a recording.
    ///
    /// # Errors
    /// The world failed, or a frame is not as it was recorded.
    pub fn advance(&mut self) -> Result<Option<Advance>, ViewError> {
        let before = self.world().clock().steps;
        let report = match &mut self.acts {
            Acts::Live(world, Some(recorder)) => recorder.advance_frame(world)?,
            Acts::Live(world, None) => world.advance_frame()?,
            Acts::Played(player) => {
                if !player.advance().map_err(replay(self.source))? {
                    return Ok(None);
                }
                let steps = self.world().clock().steps - before;
                return Ok(Some(Advance { steps, shortest: f32::INFINITY, bound: None, speed: 0.0 }));
            }
        };
        let FrameReport { steps, shortest_step, bound, maximum_speed, .. } = report;
        let steps = u64::from(steps);
        Ok(Some(Advance { steps, shortest: shortest_step, bound: Some(bound), speed: maximum_speed }))
    }

    /// Takes a single step; of a recording, a frame.
    ///
    /// # Errors
    /// As [`Self::advance`].
    pub fn step(&mut self) -> Result<Option<Advance>, ViewError> {
        let report = match &mut self.acts {
            Acts::Live(world, Some(recorder)) => recorder.step(world)?,
            Acts::Live(world, None) => world.step()?,
            Acts::Played(_) => return self.advance(),
        };
        let (shortest, bound, speed) = (report.step, Some(report.bound), report.maximum_speed);
        Ok(Some(Advance { steps: 1, shortest, bound, speed }))
    }

    /// Goes to a frame of a recording; nothing happens without one.
    ///
    /// # Errors
    /// A key frame is not usable, or the world failed.
    pub fn seek(&mut self, frame: u64) -> Result<(), ViewError> {
        let Some((_, last)) = self.played() else { return Ok(()) };
        match &mut self.acts {
            Acts::Played(player) => player.seek(frame.min(last)).map_err(replay(self.source)),
            Acts::Live(..) => Ok(()),
        }
    }

    /// Writes the recording, if one is made.
    ///
    /// # Errors
    /// A key frame is missing, or the file cannot be written.
    pub fn finish(self) -> Result<(), ViewError> {
        let (Some(path), Acts::Live(_, Some(recorder))) = (self.record, self.acts) else { return Ok(()) };
        let failed = |source| ViewError::Write { path: path.to_owned(), source };
        let mut out = BufWriter::new(File::create(path).map_err(failed)?);
        recorder.into_recording().write(&mut out).map_err(state(path))?;
        out.flush().map_err(failed)
    }
}

/// Name of a command, as in files of commands.
fn name(command: &Command) -> &'static str {
    match command {
        Command::Grip { .. } => "grip",
        Command::Release { .. } => "release",
        Command::Pose { .. } => "pose",
        Command::Force { .. } => "force",
        Command::Pour { .. } => "pour",
        Command::AddBody { .. } => "add_body",
        Command::RemoveBody { .. } => "remove_body",
        Command::Material { .. } => "material",
        Command::Gravity { .. } => "gravity",
        _ => "other",
    }
}

fn begin<'a>(
    source: &'a Source,
    options: &Options,
    record: Option<&Path>,
    changes: &[String],
) -> Result<Acts<'a>, ViewError> {
    let world = match source {
        Source::Scene(scene) if changes.is_empty() => World::with_options(scene, options)?,
        Source::Scene(scene) => {
            World::with_options(&scene.with_overrides(changes.iter().map(String::as_str))?, options)?
        }
        Source::Save(path, save) => save.world(options).map_err(state(path))?,
        Source::Recording(_, recording) => {
            let player = Player::new(recording, options).map_err(replay(source))?;
            return Ok(Acts::Played(Box::new(player)));
        }
    };
    let Some(path) = record else { return Ok(Acts::Live(Box::new(world), None)) };
    // A key frame a second.
    let every = world.scene().time.frame_rate.round().max(1.0) as u32;
    let recorder = Recorder::new(&world, Some(every)).map_err(state(path))?;
    Ok(Acts::Live(Box::new(world), Some(Box::new(recorder))))
}

fn state(path: &Path) -> impl FnOnce(StateError) -> ViewError {
    let path = path.to_owned();
    |source| ViewError::State { path, source: Box::new(source) }
}

fn replay(source: &Source) -> impl FnOnce(ReplayError) -> ViewError {
    let path = match source {
        Source::Recording(path, _) | Source::Save(path, _) => path.clone(),
        Source::Scene(_) => Default::default(),
    };
    |source| ViewError::Replay { path, source: Box::new(source) }
}
