//! `sorb record`: a scene with its commands, a digest of every frame, and key frames.

use std::{
    fs::{self, File},
    io::{BufWriter, Write},
    path::{Path, PathBuf},
};

use serde::Deserialize;
use sorb::{Command, Recorder, World};

use crate::{choice::Choice, error::CliError, machine::Machine, output, run::options::Length};

/// Arguments of `sorb record`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    choice: Choice,
    #[command(flatten)]
    length: Length,
    #[command(flatten)]
    machine: Machine,
    /// Frames from one key frame to the next; by default those of a second
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    every: Option<u32>,
    /// Commands for the world as JSON: a list of `{\"frame\": 60, \"command\": {\"gravity\": {\"gravity\": [0, 0, 0]}}}`, where
    /// a frame is the number of those before it
    #[arg(long, value_name = "FILE")]
    commands: Option<PathBuf>,
    /// The recording
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Prints nothing
    #[arg(long)]
    quiet: bool,
}

/// A command and the number of frames before it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Due {
    frame: u32,
    command: Command,
}

/// Records.
///
/// # Errors
/// The scene, the commands or the options are invalid, the simulation diverged, or the file cannot be written.
pub(crate) fn run(arguments: &Arguments) -> Result<(), CliError> {
    let scene = arguments.choice.load()?;
    let frames = arguments.length.frames(&scene);
    let due = arguments.commands.as_deref().map(commands).transpose()?.unwrap_or_default();
    if let Some(late) = due.iter().find(|due| due.frame >= frames) {
        let text = format!("a command before frame {} of {frames}: there is no such frame", late.frame);
        return Err(CliError::Usage(text));
    }
    let mut world = World::with_options(&scene, &arguments.machine.options())?;
    let every = arguments.every.unwrap_or(scene.time.frame_rate.round().max(1.0) as u32);
    let mut recorder = Recorder::new(&world, Some(every)).map_err(CliError::state(&arguments.out))?;
    let mut failure = None;
    for frame in 0..frames {
        for command in due.iter().filter(|due| due.frame == frame).map(|due| &due.command) {
            let refused = |error| CliError::Usage(format!("before frame {frame}: {error}"));
            recorder.push(&mut world, command.clone()).map_err(refused)?;
        }
        if let Err(error) = recorder.advance_frame(&mut world) {
            failure = Some(error);
            break;
        }
    }
    let recording = recorder.into_recording();
    let file = File::create(&arguments.out).map_err(CliError::write(&arguments.out))?;
    let mut out = BufWriter::new(file);
    recording.write(&mut out).map_err(CliError::state(&arguments.out))?;
    out.flush().map_err(CliError::write(&arguments.out))?;
    if let Some(error) = failure {
        return Err(CliError::Diverged { error, folder: arguments.out.clone() });
    }
    if arguments.quiet {
        return Ok(());
    }
    let bytes = fs::metadata(&arguments.out).map_err(CliError::read(&arguments.out))?.len();
    output::print(&format!(
        "{}: {} frames, {} commands, {} key frames, digest {:016x}: {bytes} bytes in {}\n",
        scene.name,
        recording.ticks(),
        recording.commands().count(),
        recording.key_frames().count(),
        world.digest(),
        arguments.out.display()
    ))
}

/// Reads commands.
fn commands(path: &Path) -> Result<Vec<Due>, CliError> {
    let text = fs::read_to_string(path).map_err(CliError::read(path))?;
    serde_json::from_str(&text).map_err(|error| CliError::Usage(format!("{}: {error}", path.display())))
}
