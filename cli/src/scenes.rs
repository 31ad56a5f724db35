//! `sorb scenes`, and `sorb` alone: lists the scenes.

use serde_json::json;
use sorb::scene::{self, Estimate, Preset, SceneError};

use crate::{error::CliError, output};

/// Arguments of `sorb scenes`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Prints a JSON array instead of a table
    #[arg(long)]
    json: bool,
}

/// Lists the scenes.
///
/// # Errors
/// Standard output cannot be written.
pub(crate) fn run(arguments: &Arguments) -> Result<(), CliError> {
    if !arguments.json {
        return output::print(&list()?);
    }
    let mut rows = Vec::new();
    for (preset, size) in sized()? {
        rows.push(json!({
            "name": preset.name,
            "title": preset.title,
            "particles": size.particles,
            "nodes": size.nodes,
            "tets": size.tets,
        }));
    }
    output::print(&format!("{}\n", serde_json::to_string_pretty(&rows)?))
}

/// Lists the scenes and shows how to run one.
///
/// # Errors
/// Standard output cannot be written.
pub(crate) fn welcome() -> Result<(), CliError> {
    let text = format!(
        "sorb simulates absorbent sponges, water and rigid bodies. Scenes:\n\n{}\n\
         Run one and take pictures:  sorb run ball_drop --pictures\n\
         Change it:                  sorb run ball_drop --set sponges.sponge.permeability=1e-10\n\
         Everything else:            sorb --help, sorb run --help\n",
        list()?
    );
    output::print(&text)
}

fn list() -> Result<String, CliError> {
    let heading = ["name", "particles", "nodes", "title"].map(str::to_owned);
    let mut rows = vec![heading];
    for (preset, size) in sized()? {
        rows.push([
            preset.name.to_owned(),
            size.particles.to_string(),
            size.nodes.to_string(),
            preset.title.to_owned(),
        ]);
    }
    Ok(output::table(&rows, [false, true, true, false]))
}

fn sized() -> Result<Vec<(&'static Preset, Estimate)>, SceneError> {
    let size = |preset: &'static Preset| Ok((preset, scene::preset(preset.name)?.estimate()));
    scene::presets().iter().map(size).collect()
}
