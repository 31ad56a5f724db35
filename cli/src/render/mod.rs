//! `sorb render`: films and stills of a scene, a recording or a save.

pub(crate) mod camera;
pub(crate) mod frames;
pub(crate) mod sink;

use std::{
    io::{self, IsTerminal},
    path::PathBuf,
};

use indicatif::{ProgressBar, ProgressStyle};
use sorb::{
    World,
    render::{self, Steady},
};

use crate::{
    choice::Changes,
    error::CliError,
    machine::Machine,
    output,
    run::options::{Picture, number},
};
use camera::{Flight, Key};
use frames::Source;
use sink::Sink;

const EXAMPLES: &str = "\
Examples:
  sorb render ball_drop                                 ball_drop.mp4, at the speed of the simulated world
  sorb render life --slow 4 --start 3 --end 4 squeeze.mp4   a second in four
  sorb render life --start 3.7 squeezed.png             a still
  sorb render out/life/state.sorb --orbit 360 turn.mp4  around a save
  sorb render recorded --view cutaway --key 0:0.3,0.2,0.4:0,0.05,0 --key 2:0.1,0.1,0.2:0,0.05,0 inside.mp4";

/// Arguments of `sorb render`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// Name of a scene, path of a scene (.toml, .json), a recording of `sorb record` or a save
    source: String,
    /// The film (.mp4) or picture (.png, animated where there is more than one), by default SOURCE.mp4
    file: Option<PathBuf>,
    #[command(flatten)]
    picture: Picture,
    /// Pictures a second
    #[arg(long, value_name = "RATE", default_value_t = 30.0, value_parser = rate)]
    rate: f32,
    /// Slow motion: seconds of the film for a second of the scene, 0.01 to 1000
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = factor)]
    slow: f32,
    /// Where the film starts, in simulated s
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = time)]
    start: f32,
    /// Where it ends, in simulated s; by default the end of the scene or recording. The orbit around a save takes this long
    #[arg(long, value_name = "SECONDS", value_parser = time)]
    end: Option<f32>,
    /// Angle that the camera goes around its target during the film, in degrees
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, value_parser = angle, allow_hyphen_values = true)]
    orbit: f32,
    /// The camera at a time, as TIME:EYE:TARGET in s and m; more than one make a flight
    #[arg(long = "key", value_name = "KEY", allow_hyphen_values = true)]
    keys: Vec<Key>,
    #[command(flatten)]
    changes: Changes,
    #[command(flatten)]
    machine: Machine,
    /// Prints neither progress nor a final report
    #[arg(long)]
    quiet: bool,
}

/// Draws.
///
/// # Errors
/// The source cannot be read or used, the simulation diverged, or the pictures cannot be written.
pub(crate) fn run(arguments: &Arguments) -> Result<(), CliError> {
    let options = arguments.machine.options();
    let source = Source::open(&arguments.source, &arguments.changes, arguments.rate * arguments.slow)?;
    let path = arguments.file.clone().unwrap_or_else(|| source.file(sink::FILM));
    let is_still = path.extension().is_some_and(|ending| ending == "png") && arguments.end.is_none();
    let plan = source.plan(arguments, is_still)?;
    let size = (arguments.picture.size.0, arguments.picture.size.1);
    let mut sink = Sink::create(&path, size, plan.rate, plan.count)?;
    let bar = progress(&path.display().to_string(), plan.count, arguments.quiet);
    let (mut count, view) = (0, arguments.picture.view.into());
    let mut steady = arguments.picture.steady.then(Steady::default);
    source.play(&options, &plan, &mut |world: &World, time: f32| {
        let flight = Flight::new(world.scene().viewpoint().into(), arguments.keys.clone(), arguments.orbit);
        let share = count as f32 / (plan.count.max(2) - 1) as f32;
        let camera = flight.at(time, share);
        let image = match &mut steady {
            Some(steady) => steady.draw_world(world, &camera, view, size.0, size.1),
            None => render::draw_world(world, &camera, view, size.0, size.1),
        };
        sink.append(&image)?;
        count += 1;
        bar.inc(1);
        Ok(())
    })?;
    bar.finish_and_clear();
    sink.finish()?;
    if arguments.quiet {
        return Ok(());
    }
    let length = if count > 1 {
        format!("{count} pictures, {:.2} s", count as f32 / plan.rate)
    } else {
        "a picture".to_owned()
    };
    output::print(&format!("{}: {length} of {} x {} pixels\n", path.display(), size.0, size.1))
}

/// A bar on standard error with the time that is left; none where that is no terminal.
fn progress(name: &str, count: u32, quiet: bool) -> ProgressBar {
    let hidden = quiet || !io::stderr().is_terminal();
    let bar = if hidden { ProgressBar::hidden() } else { ProgressBar::new(count.into()) };
    let style = ProgressStyle::with_template("{prefix} {bar:30} {pos} of {len} pictures  {eta} left");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()).progress_chars("=> "));
    bar.set_prefix(name.to_owned());
    bar
}

fn rate(text: &str) -> Result<f32, String> {
    number(text, 0.1, 1e3, "1/s")
}

fn factor(text: &str) -> Result<f32, String> {
    number(text, 0.01, 1e3, "")
}

fn time(text: &str) -> Result<f32, String> {
    number(text, 0.0, 1e5, "s")
}

fn angle(text: &str) -> Result<f32, String> {
    number(text, -36_000.0, 36_000.0, "degrees")
}
