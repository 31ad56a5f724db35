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

/// Hands the names of all presets, and others behind them, to a macro: `for_every_preset!(tests)`.
///
/// The one list of them, in the order of the documentation. **Without any promise**, for tests of this project.
#[doc(hidden)]
#[macro_export]
macro_rules! for_every_preset {
    ($macro:ident $($other:ident)*) => {
        $macro! {
            standing ball_drop squish dam_break wring wipe life stack bobbing tap cup water dry empty $($other)*
        }
    };
}

macro_rules! presets {
    ($($name:ident)+) => {
        &[$(Preset::of(
            stringify!($name),
            include_str!(concat!("../../scenes/", stringify!($name), ".toml")),
        )),+]
    };
}

const PRESETS: &[Preset] = for_every_preset!(presets);

impl Preset {
    const fn of(name: &'static str, text: &'static str) -> Self {
        Self { name, title: quoted_after(text, b"\ntitle = \""), text }
    }
}

/// What stands between the end of a key and the next quotation mark. Without the key the build fails.
const fn quoted_after(text: &'static str, key: &[u8]) -> &'static str {
    let bytes = text.as_bytes();
    let mut start = 0;
    let mut matched = 0;
    while matched < key.len() {
        matched = if bytes[start] == key[matched] { matched + 1 } else { 0 };
        start += 1;
    }
    let mut end = start;
    while bytes[end] != b'"' {
        end += 1;
    }
    text.split_at(end).0.split_at(start).1
}

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
