//! The command `sorb`: runs, checks and draws sponge scenes.

mod check;
mod choice;
mod diff;
mod doctor;
mod error;
mod export;
#[cfg(not(all(feature = "validation", feature = "view")))]
mod left_out;
mod machine;
mod output;
mod plan;
mod record;
mod render;
mod replay;
mod run;
mod scenes;
mod schema;
mod sweep;
#[cfg(feature = "validation")]
mod validate;
#[cfg(feature = "view")]
mod view;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
#[cfg(not(feature = "validation"))]
use left_out::validate;
#[cfg(not(feature = "view"))]
use left_out::view;

/// Meaning of the exit codes, at the end of the help.
const EXIT_CODES: &str =
    "Exit codes: 0 ok, 1 a check failed, 2 wrong usage or scene, 3 the simulation diverged.";

/// Simulates absorbent sponges, the water they drink and the bodies that squeeze them.
#[derive(Debug, Parser)]
#[command(name = "sorb", version, about, after_help = EXIT_CODES)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Lists the scenes that come with the program
    Scenes(scenes::Arguments),
    /// Reports every mistake of a scene
    Check(check::Arguments),
    /// Prints the JSON schema of scene files
    Schema,
    /// Shows what a step of a scene runs, and what it skips and why
    Plan(plan::Arguments),
    /// Simulates a scene and writes measures and pictures
    Run(Box<run::Arguments>),
    /// Runs a scene with many settings, alone or in parts, and writes a table
    Sweep(Box<sweep::Arguments>),
    /// Draws films and stills of a scene, a recording or a save
    Render(Box<render::Arguments>),
    /// Shows a scene or a recording in a window, and lets the mouse act on it
    View(Box<view::Arguments>),
    /// Records a scene: a digest of every frame, and key frames
    Record(Box<record::Arguments>),
    /// Plays a recording, and compares every frame
    Replay(Box<replay::Arguments>),
    /// Says where two saves differ first
    Diff(diff::Arguments),
    /// Compares the simulator with analytic, experimental and converged references
    Validate(validate::Arguments),
    /// Shows the features of this machine and this build
    Doctor(doctor::Arguments),
}

fn main() -> ExitCode {
    let outcome = match Cli::parse().command {
        None => scenes::welcome(),
        Some(Command::Scenes(arguments)) => scenes::run(&arguments),
        Some(Command::Check(arguments)) => check::run(&arguments),
        Some(Command::Schema) => schema::run(),
        Some(Command::Plan(arguments)) => plan::run(&arguments),
        Some(Command::Run(arguments)) => run::run(&arguments),
        Some(Command::Sweep(arguments)) => sweep::run(&arguments),
        Some(Command::Render(arguments)) => render::run(&arguments),
        Some(Command::View(arguments)) => view::run(&arguments),
        Some(Command::Record(arguments)) => record::run(&arguments),
        Some(Command::Replay(arguments)) => replay::run(&arguments),
        Some(Command::Diff(arguments)) => diff::run(&arguments),
        Some(Command::Validate(arguments)) => validate::run(&arguments),
        Some(Command::Doctor(arguments)) => doctor::run(&arguments),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            output::complain(&error.to_string());
            ExitCode::from(error.code())
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn arguments_are_consistent() {
        super::Cli::command().debug_assert();
    }
}
