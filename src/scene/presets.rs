//! The scenes that come with the library.

use super::error::nearest;
use super::{Scene, SceneError};

/// A scene that comes with the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preset {
    /// Name for [`preset`].
    pub name: &'static str,
    /// What it shows, in one line.
    pub title: &'static str,
    /// The commented TOML file.
    pub text: &'static str,
}

macro_rules! presets {
    ($($name:literal: $title:literal;)+) => {
        &[$(Preset {
            name: $name,
            title: $title,
            text: include_str!(concat!("../../scenes/", $name, ".toml")),
        }),+]
    };
}

const PRESETS: &[Preset] = presets! {
    "standing": "A dry sponge stands in shallow water and drinks";
    "ball_drop": "A heavy ball falls on a saturated sponge";
    "squish": "Two plates squeeze a saturated sponge and let it recover";
    "dam_break": "A breaking dam drags a sponge along";
    "wring": "Two grips wring a saturated sponge bar";
    "life": "Dropped dry into water, squeezed by a ball, let go";
    "stack": "A plate presses a dry sponge onto a wet one";
    "bobbing": "Bodies of 0.3 to 2.5 times the density of water fall into a pool";
    "water": "Control: the breaking dam without the sponge";
    "dry": "Control: the ball and the sponge without water";
    "empty": "Control: nothing at all";
};

/// The scenes that come with the library, in the order of the documentation.
#[must_use]
pub fn presets() -> &'static [Preset] {
    PRESETS
}

/// Reads a scene that comes with the library.
///
/// # Errors
/// [`SceneError::UnknownPreset`] with the most similar name.
pub fn preset(name: &str) -> Result<Scene, SceneError> {
    let names = || PRESETS.iter().map(|preset| preset.name);
    match PRESETS.iter().find(|preset| preset.name == name) {
        Some(preset) => Scene::from_toml(preset.text, &format!("preset {name}")),
        None => Err(SceneError::UnknownPreset {
            name: name.to_owned(),
            nearest: nearest(name, names()),
            known: names().map(str::to_owned).collect(),
        }),
    }
}
