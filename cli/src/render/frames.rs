//! States to draw: of a scene that runs, of a recording, of a save.

use std::{
    fs::File,
    io::BufReader,
    path::{Path, PathBuf},
};

use sorb::{Options, Player, Recording, Save, World, scene::Scene};

use super::Arguments;
use crate::{choice::Changes, error::CliError};

/// Duration of the orbit around a save by default \[s\].
const TURN: f32 = 6.0;

/// What states come from.
#[derive(Debug)]
pub(crate) enum Source {
    Scene(Box<Scene>),
    Recording(PathBuf, Box<Recording>),
    Save(PathBuf, Box<Save>),
}

/// Which states are drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plan {
    /// First and last simulated frame.
    first: u64,
    last: u64,
    /// Simulated frames from one picture to the next.
    every: u64,
    /// Simulated frames a second.
    frame_rate: f32,
    /// Pictures a second of the film.
    pub(super) rate: f32,
    pub(super) count: u32,
}

impl Source {
    /// Opens a source. A scene gets a frame for every picture: `pictures` in a simulated second.
    ///
    /// # Errors
    /// It is neither a scene nor a readable recording or save.
    pub(crate) fn open(name: &str, changes: &Changes, pictures: f32) -> Result<Self, CliError> {
        let path = Path::new(name);
        let is_text = path.extension().is_some_and(|ending| ending == "toml" || ending == "json");
        if is_text || !path.is_file() {
            let mut scene = changes.load(name)?;
            // More frames than the scene has make more pictures in slow motion.
            scene.time.frame_rate = scene.time.frame_rate.max(pictures.min(1e3));
            return Ok(Self::Scene(Box::new(scene)));
        }
        let open = || File::open(path).map(BufReader::new).map_err(CliError::read(path));
        if let Ok(recording) = Recording::read(open()?) {
            return Ok(Self::Recording(path.to_owned(), Box::new(recording)));
        }
        let save = Save::read(open()?).map_err(CliError::state(path))?;
        Ok(Self::Save(path.to_owned(), Box::new(save)))
    }

    /// The file of the film by default.
    pub(super) fn file(&self, ending: &str) -> PathBuf {
        let name = match self {
            Self::Scene(scene) => PathBuf::from(&scene.name),
            Self::Recording(path, _) | Self::Save(path, _) => {
                PathBuf::from(path.file_stem().unwrap_or(path.as_os_str()))
            }
        };
        name.with_extension(ending)
    }

    /// Which states are drawn.
    ///
    /// # Errors
    /// There are none between start and end.
    pub(super) fn plan(&self, arguments: &Arguments, is_still: bool) -> Result<Plan, CliError> {
        if let Self::Save(..) = self {
            let length = arguments.end.unwrap_or(if arguments.orbit == 0.0 { 0.0 } else { TURN });
            let count = if is_still { 1 } else { (length * arguments.rate).round().max(1.0) as u32 };
            return Ok(Plan { first: 0, last: 0, every: 1, frame_rate: 1.0, rate: arguments.rate, count });
        }
        let (frame_rate, frames) = match self {
            Self::Scene(scene) => {
                let frames = scene.time.duration * scene.time.frame_rate;
                (scene.time.frame_rate, frames.round() as u64)
            }
            Self::Recording(path, recording) => {
                let scene = recording.scene().map_err(CliError::state(path))?;
                (scene.time.frame_rate, recording.ticks())
            }
            Self::Save(..) => (1.0, 0),
        };
        let every = (frame_rate / (arguments.rate * arguments.slow)).round().max(1.0) as u64;
        let frame = |time: f32| (time * frame_rate).round() as u64;
        let first = frame(arguments.start);
        let end = arguments.end.map_or(frames, frame);
        let last = if is_still { first } else { end };
        let is_scene = matches!(self, Self::Scene(_));
        if last < first || (!is_scene && last > frames) {
            let text = format!(
                "no pictures from {} to {} s: the film has {} s",
                arguments.start,
                last as f32 / frame_rate,
                frames as f32 / frame_rate
            );
            return Err(CliError::Usage(text));
        }
        let count = u32::try_from((last - first) / every + 1).unwrap_or(u32::MAX);
        let rate = frame_rate / every as f32 / arguments.slow;
        Ok(Plan { first, last, every, frame_rate, rate, count })
    }

    /// Calls `draw` with every state and its simulated time \[s\].
    ///
    /// # Errors
    /// The simulation diverged, a recording differs, or drawing failed.
    pub(super) fn play(
        &self,
        options: &Options,
        plan: &Plan,
        draw: &mut dyn FnMut(&World, f32) -> Result<(), CliError>,
    ) -> Result<(), CliError> {
        let is_due = |frame: u64| frame >= plan.first && (frame - plan.first).is_multiple_of(plan.every);
        let time = |frame: u64| frame as f32 / plan.frame_rate;
        match self {
            Self::Save(path, save) => {
                let world = save.world(options).map_err(CliError::state(path))?;
                let start = save.time() as f32;
                (0..plan.count).try_for_each(|picture| draw(&world, start + picture as f32 / plan.rate))
            }
            Self::Scene(scene) => {
                let mut world = World::with_options(scene, options)?;
                for frame in 0..=plan.last {
                    if frame > 0 {
                        world.advance_frame().map_err(CliError::Step)?;
                    }
                    if is_due(frame) {
                        draw(&world, time(frame))?;
                    }
                }
                Ok(())
            }
            Self::Recording(path, recording) => {
                let mut player = Player::new(recording, options).map_err(CliError::replay(path))?;
                player.seek(plan.first).map_err(CliError::replay(path))?;
                for frame in plan.first..=plan.last {
                    if is_due(frame) {
                        draw(player.world(), time(frame))?;
                    }
                    if frame < plan.last && !player.play().map_err(CliError::replay(path))? {
                        break;
                    }
                }
                Ok(())
            }
        }
    }
}
