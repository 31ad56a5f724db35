//! `sorb check`: reports every mistake of scenes.

use sorb::{
    Options, World,
    scene::{Scene, SceneError},
};

use crate::{choice, error::CliError, output};

/// Arguments of `sorb check`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Scene files (.toml or .json), or names of scenes that come with the program
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<String>,
}

/// Checks all scenes, and reports all invalid ones.
///
/// # Errors
/// [`CliError::CheckFailed`] when a scene is invalid, [`CliError::Scene`] when there is no such scene.
pub(crate) fn run(arguments: &Arguments) -> Result<(), CliError> {
    let mut complaints = Vec::new();
    for name in &arguments.scenes {
        match check(name) {
            Ok(text) => output::print(&text)?,
            Err(CliError::CheckFailed(complaint)) => complaints.push(complaint),
            Err(error) => return Err(error),
        }
    }
    if complaints.is_empty() { Ok(()) } else { Err(CliError::CheckFailed(complaints.join("\n"))) }
}

/// Checks one scene and returns its size in words.
fn check(name: &str) -> Result<String, CliError> {
    let scene = choice::named(name).map_err(|error| match error {
        SceneError::Syntax { .. } | SceneError::Invalid { .. } => CliError::CheckFailed(error.to_string()),
        other => CliError::Scene(other),
    })?;
    // Only the set-up finds some errors, such as a hull without volume. Water cannot fail there, and may be large.
    World::with_options(&without_water(&scene), &Options { threads: Some(1), ..Options::default() })
        .map_err(|error| CliError::CheckFailed(format!("{name}: {error}")))?;
    let size = scene.estimate();
    Ok(format!(
        "{name}: ok, about {} particles, {} nodes, {} tets, {} bodies\n",
        size.particles,
        size.nodes,
        size.tets,
        scene.bodies.len()
    ))
}

fn without_water(scene: &Scene) -> Scene {
    let mut dry = Scene { fluid: None, emitters: Vec::new(), drains: Vec::new(), ..scene.clone() };
    for sponge in &mut dry.sponges {
        sponge.saturation = 0.0;
    }
    dry
}
