//! The scene of a command.

use std::path::Path;

use sorb::scene::{self, Quality, Scene, SceneError};

/// A scene with changes.
#[derive(Debug, clap::Args)]
pub(crate) struct Choice {
    /// Name of a scene that comes with the program (see `sorb scenes`), or path of a .toml or .json file
    scene: String,
    #[command(flatten)]
    pub(crate) changes: Changes,
}

/// Changes of a scene.
#[derive(Debug, clap::Args)]
pub(crate) struct Changes {
    /// Trade-off between precision and run time: fast, balanced (the defaults) or accurate; by default the keys of the
    /// scene. `--set` comes after it
    #[arg(long, value_name = "QUALITY")]
    quality: Option<Quality>,
    /// Changes one key of the scene, as in `--set sponges.sponge.permeability=1e-10`; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Refines the scene, 0.1 to 8: twice the resolution has 8 times the particles and nodes
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    pub(crate) resolution: f32,
}

impl Choice {
    /// Reads the scene and changes it.
    ///
    /// # Errors
    /// As [`Changes::load`].
    pub(crate) fn load(&self) -> Result<Scene, SceneError> {
        self.changes.load(&self.scene)
    }
}

impl Changes {
    /// Reads the scene, applies the quality, changes it, then refines it.
    ///
    /// # Errors
    /// As [`named`], [`Scene::with_quality`], [`Scene::with_overrides`] and [`Scene::scaled`].
    pub(crate) fn load(&self, name: &str) -> Result<Scene, SceneError> {
        let mut scene = named(name)?;
        if let Some(quality) = self.quality {
            scene = scene.with_quality(quality)?;
        }
        if !self.set.is_empty() {
            scene = scene.with_overrides(self.set.iter().map(String::as_str))?;
        }
        scene.scaled(self.resolution)
    }
}

/// The preset of that name, or the scene in that file.
///
/// # Errors
/// The file cannot be read or is not a valid scene, or there is neither a preset nor a file of that name.
pub(crate) fn named(name: &str) -> Result<Scene, SceneError> {
    let is_preset = scene::presets().iter().any(|preset| preset.name == name);
    let looks_like_file = name.contains(['.', '/', '\\']) || Path::new(name).exists();
    if !is_preset && looks_like_file { Scene::from_path(name) } else { scene::preset(name) }
}
