//! `sorb view`: a window on a scene, a recording or a save.

use std::path::PathBuf;

use sorb_view::{Setup, Source};

use crate::{
    choice::Changes,
    error::CliError,
    machine::Machine,
    output,
    render::frames,
    run::options::{Size, ViewName, size},
};

/// Arguments of `sorb view`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Name of a scene, path of a scene (.toml, .json), a recording of `sorb record` or a save
    source: String,
    #[command(flatten)]
    changes: Changes,
    #[command(flatten)]
    machine: Machine,
    /// Size of the window in pixels, each side 16 to 8192
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = size)]
    size: Size,
    /// What the picture shows at first
    #[arg(long, value_name = "VIEW", default_value = "realistic")]
    view: ViewName,
    /// Waits for the key Space instead of running at once
    #[arg(long)]
    paused: bool,
    /// Records all that happens since the last reset, for `sorb replay` and `sorb render`
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Closes after this frame, 0 to 1000000
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(0..=1_000_000))]
    frames: Option<u64>,
    /// Writes a picture of the window (.png) as it closes
    #[arg(long, value_name = "FILE")]
    screenshot: Option<PathBuf>,
    /// Shows the window without a GPU
    #[arg(long)]
    software: bool,
}

/// Shows the window.
///
/// # Errors
/// The source cannot be read or used, there is no display, the simulation diverged, or a file cannot be written.
pub(crate) fn run(arguments: &Arguments) -> Result<(), CliError> {
    let source = match frames::Source::open(&arguments.source, &arguments.changes, 0.0)? {
        frames::Source::Scene(scene) => Source::Scene(scene),
        frames::Source::Recording(path, recording) => Source::Recording(path, recording),
        frames::Source::Save(path, save) => Source::Save(path, save),
    };
    if arguments.record.is_some() && matches!(source, Source::Recording(..)) {
        return Err(CliError::Usage("--record: a recording plays, which cannot be recorded".to_owned()));
    }
    let setup = Setup {
        source,
        options: arguments.machine.options(),
        size: (arguments.size.0, arguments.size.1),
        view: arguments.view.into(),
        paused: arguments.paused,
        record: arguments.record.clone(),
        frames: arguments.frames,
        screenshot: arguments.screenshot.clone(),
        software: arguments.software,
    };
    let report = sorb_view::run(&setup)?;
    output::print(&format!("{report}\n"))?;
    report.failure.map_or(Ok(()), |error| Err(CliError::Step(error)))
}
