//! Scenes and options by their texts.

use std::path::Path;

use pyo3::prelude::*;
use sorb::{
    Options, SimdLevel,
    scene::{self, Quality, Scene},
};

use crate::error::{OrRaise, exception};

/// Names and titles of the scenes that come with the library.
#[pyfunction]
pub(crate) fn presets() -> Vec<(&'static str, &'static str)> {
    scene::presets().iter().map(|preset| (preset.name, preset.title)).collect()
}

/// Reads a scene and changes it: of a `kind` "name" (a scene of the library, or a file) or "json". Gives it as JSON.
#[pyfunction]
pub(crate) fn read_scene(
    kind: &str,
    text: &str,
    quality: Option<&str>,
    overrides: Vec<String>,
    resolution: f32,
) -> PyResult<String> {
    scene_of((kind, text), quality, &overrides, resolution)?.to_json().or_raise()
}

/// The scene of such arguments.
pub(crate) fn scene_of(
    (kind, text): (&str, &str),
    quality: Option<&str>,
    overrides: &[String],
    resolution: f32,
) -> PyResult<Scene> {
    let mut scene = match kind {
        "json" => Scene::from_json(text, "scene"),
        _ => named(text),
    }
    .or_raise()?;
    if let Some(name) = quality {
        let quality: Quality = name.parse().map_err(|message: String| {
            exception("SceneError", &format!("quality: {message}"), vec!["quality".to_owned()])
        })?;
        scene = scene.with_quality(quality).or_raise()?;
    }
    if !overrides.is_empty() {
        scene = scene.with_overrides(overrides.iter().map(String::as_str)).or_raise()?;
    }
    scene.scaled(resolution).or_raise()
}

/// The scene of that name, or in that file.
fn named(name: &str) -> Result<Scene, scene::SceneError> {
    let is_preset = scene::presets().iter().any(|preset| preset.name == name);
    let looks_like_file = name.contains(['.', '/', '\\']) || Path::new(name).exists();
    if !is_preset && looks_like_file { Scene::from_path(name) } else { scene::preset(name) }
}

/// What a world runs on.
pub(crate) fn options(threads: Option<usize>, simd: Option<&str>, backend: &str) -> PyResult<Options> {
    let refused = |key: &str, message: String| exception("SceneError", &message, vec![key.to_owned()]);
    let level = |name: &str| {
        let known = SimdLevel::ALL.map(SimdLevel::name).join(", ");
        let message = format!("simd = \"{name}\" is no level; levels: {known}");
        SimdLevel::from_name(name).ok_or_else(|| refused("simd", message))
    };
    Ok(Options {
        threads,
        simd: simd.map(level).transpose()?,
        offload: backend
            .parse()
            .map_err(|error: sorb::OffloadError| refused("backend", error.to_string()))?,
        ..Options::default()
    })
}
