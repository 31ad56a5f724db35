//! `sorb replay`: plays a recording, and compares every frame.

use std::{fs::File, io::BufReader, path::PathBuf};

use sorb::{Player, Recording, ReplayError};

use crate::{
    error::CliError,
    machine::Machine,
    output,
    run::{folder::Folder, options::Drawing, pictures::Pictures},
};

/// Arguments of `sorb replay`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The recording
    file: PathBuf,
    /// Compares every frame with its digest; the first that differs is named with its column, its row and both values
    #[arg(long)]
    verify: bool,
    /// Plays up to this time in s, from the nearest key frame before it, and stops there
    #[arg(long, value_name = "SECONDS", conflicts_with_all = ["verify", "pictures"])]
    seek: Option<f64>,
    #[command(flatten)]
    machine: Machine,
    #[command(flatten)]
    drawing: Drawing,
    /// Folder for the pictures, by default out/SCENE
    #[arg(long, value_name = "DIR", requires = "pictures")]
    out: Option<PathBuf>,
    /// Prints nothing
    #[arg(long)]
    quiet: bool,
}

/// Plays.
///
/// # Errors
/// The file is no recording, a frame differs, the simulation diverged, or pictures cannot be written.
pub(crate) fn run(arguments: &Arguments) -> Result<(), CliError> {
    let path = &arguments.file;
    let file = File::open(path).map_err(CliError::read(path))?;
    let recording = Recording::read(BufReader::new(file)).map_err(CliError::state(path))?;
    let mut player = Player::new(&recording, &arguments.machine.options()).map_err(CliError::replay(path))?;
    let scene = player.world().scene().clone();
    if let Some(time) = arguments.seek {
        let frame = frame_at(time, scene.time.frame_rate);
        player.seek(frame).map_err(CliError::replay(path))?;
        return report(arguments, &player, "");
    }
    let mut pictures = None;
    if arguments.drawing.pictures {
        let folder = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out").join(&scene.name));
        let frames = u32::try_from(recording.ticks()).unwrap_or(u32::MAX);
        let folder = Folder::create(&folder, true)?;
        let mut own = Pictures::create(&folder, &arguments.drawing, &scene, 0..=frames)?;
        own.frame(player.world(), 0)?;
        pictures = Some(own);
    }
    while play(arguments, &mut player).map_err(CliError::replay(path))? {
        if let Some(pictures) = &mut pictures {
            pictures.frame(player.world(), player.frame() as usize)?;
        }
    }
    if let Some(pictures) = pictures {
        pictures.finish()?;
    }
    report(arguments, &player, if arguments.verify { ", as recorded" } else { "" })
}

fn play(arguments: &Arguments, player: &mut Player<'_>) -> Result<bool, ReplayError> {
    if arguments.verify { player.advance() } else { player.play() }
}

/// Number of frames up to a time \[s\].
fn frame_at(time: f64, frame_rate: f32) -> u64 {
    (time * f64::from(frame_rate)).round().max(0.0) as u64
}

fn report(arguments: &Arguments, player: &Player<'_>, verdict: &str) -> Result<(), CliError> {
    if arguments.quiet {
        return Ok(());
    }
    let world = player.world();
    output::print(&format!(
        "{}: frame {}, {:.3} s, {} steps on {} threads, {}: digest {:016x}{verdict}\n",
        world.scene().name,
        player.frame(),
        world.clock().time,
        world.clock().steps,
        world.cpu().threads(),
        world.cpu().simd().name(),
        world.digest()
    ))
}
