//! Scenes as TOML and JSON.

use std::fs;
use std::path::Path;

use toml::Value;

use super::check::{check, value_text};
use super::error::{Defect, Problem};
use super::json::Tree;
use super::locate::{line_and_column, locate};
use super::{Scene, SceneError, VERSION};

impl Scene {
    /// Reads a scene from TOML; `file` is the name for messages.
    ///
    /// # Errors
    /// [`SceneError::Syntax`] with line and column, or [`SceneError::Invalid`] with all problems and their places.
    pub fn from_toml(text: &str, file: &str) -> Result<Self, SceneError> {
        let table: toml::Table = toml::from_str(text).map_err(|error| {
            let (line, column) = line_and_column(text, error.span().map_or(0, |span| span.start));
            let message = error.message().trim().to_owned();
            SceneError::Syntax { file: file.to_owned(), line, column, message }
        })?;
        Self::from_value(Value::Table(table), file).map_err(|error| match error {
            SceneError::Invalid { file, mut problems } => {
                for problem in &mut problems {
                    problem.place = locate(text, &problem.key);
                }
                SceneError::Invalid { file, problems }
            }
            other => other,
        })
    }

    /// Reads a scene from JSON; `file` is the name for messages. `null` means an absent key.
    ///
    /// # Errors
    /// [`SceneError::Syntax`] with line and column, or [`SceneError::Invalid`] with all problems.
    pub fn from_json(text: &str, file: &str) -> Result<Self, SceneError> {
        let Tree(tree) = serde_json::from_str(text).map_err(|error| SceneError::Syntax {
            file: file.to_owned(),
            line: error.line(),
            column: error.column(),
            message: error.to_string(),
        })?;
        // `null` at the top is an empty table, which lacks its version.
        Self::from_value(tree.unwrap_or(Value::Table(toml::Table::new())), file)
    }

    /// Reads a scene from a file whose name ends in `.toml` or `.json`.
    ///
    /// # Errors
    /// [`SceneError::Extension`], [`SceneError::Read`], and those of [`Scene::from_toml`] and [`Scene::from_json`].
    pub fn from_path(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        let path = path.as_ref();
        let file = path.display().to_string();
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        let parse = match extension.to_str() {
            Some("toml") => Self::from_toml,
            Some("json") => Self::from_json,
            _ => return Err(SceneError::Extension { file }),
        };
        match fs::read_to_string(path) {
            Ok(text) => parse(&text, &file),
            Err(source) => Err(SceneError::Read { file, source }),
        }
    }

    /// The scene as TOML, which [`Scene::from_toml`] reads back to an equal scene.
    ///
    /// # Errors
    /// [`SceneError::Write`] if the writer refuses a value; it accepts all values of a valid scene.
    pub fn to_toml(&self) -> Result<String, SceneError> {
        toml::to_string(self).map_err(|error| SceneError::Write { message: error.to_string() })
    }

    /// The scene as indented JSON, which [`Scene::from_json`] reads back to an equal scene.
    ///
    /// # Errors
    /// [`SceneError::Write`] if the writer refuses a value; it accepts all values of a valid scene.
    pub fn to_json(&self) -> Result<String, SceneError> {
        serde_json::to_string_pretty(self).map_err(|error| SceneError::Write { message: error.to_string() })
    }

    /// Checks a value against the schema, converts it and validates the result.
    pub(super) fn from_value(value: Value, file: &str) -> Result<Self, SceneError> {
        let invalid = |problems| SceneError::Invalid { file: file.to_owned(), problems };
        // Before anything else: another version may have other keys, and errors about those would mislead.
        if let Some(version) = value.get("version").filter(|version| version.is_integer())
            && version.as_integer() != Some(VERSION.into())
        {
            let defect = Defect::Version { supported: VERSION };
            return Err(invalid(vec![Problem::new("version", value_text(version), defect)]));
        }
        let mut problems = check(&value);
        if !problems.is_empty() {
            // Problems of the whole file have no key.
            for problem in problems.iter_mut().filter(|problem| problem.key.is_empty()) {
                "scene".clone_into(&mut problem.key);
            }
            return Err(invalid(problems));
        }
        let mut scene: Self = value.try_into().map_err(|error: toml::de::Error| {
            // The schema accepted it, so that only the message of serde tells what is wrong.
            let defect = Defect::Rule(error.message().to_owned());
            invalid(vec![Problem { key: "scene".to_owned(), value: None, defect, place: None }])
        })?;
        scene.read_meshes(Path::new(file).parent().unwrap_or(Path::new(""))).map_err(invalid)?;
        let problems = scene.problems();
        if problems.is_empty() { Ok(scene) } else { Err(invalid(problems)) }
    }
}
