//! `sorb doctor`: what this machine and this build offer.

use std::env::consts::{ARCH, OS};

use serde_json::json;
use sorb::SimdLevel;

use crate::{error::CliError, output};

/// Arguments of `sorb doctor`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Prints a JSON object instead of text
    #[arg(long)]
    json: bool,
}

/// The features of the library that the command is built with.
const FEATURES: [&str; 4] = ["threads", "rigid", "serde", "render"];

/// Prints what there is.
///
/// # Errors
/// Standard output cannot be written.
pub(crate) fn run(arguments: &Arguments) -> Result<(), CliError> {
    let names = |wanted: bool| {
        let levels = SimdLevel::ALL.into_iter().filter(|level| level.is_supported() == wanted);
        levels.map(SimdLevel::name).collect::<Vec<_>>()
    };
    let best = SimdLevel::best().name();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let version = env!("CARGO_PKG_VERSION");
    let text = if arguments.json {
        let report = json!({
            "version": version,
            "platform": format!("{ARCH}-{OS}"),
            "threads": cores,
            "simd": { "auto": best, "supported": names(true), "missing": names(false) },
            "features": FEATURES,
            "gpu": null,
        });
        format!("{}\n", serde_json::to_string_pretty(&report)?)
    } else {
        format!(
            "sorb      {version} on {ARCH}-{OS}\n\
             threads   {cores} by default (--threads 1 to 1024)\n\
             SIMD      {best} by default; supported: {}; missing: {}\n\
             features  {}\n\
             GPU       not built in\n",
            names(true).join(", "),
            names(false).join(", "),
            FEATURES.join(", ")
        )
    };
    output::print(&text)
}
