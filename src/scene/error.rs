//! Errors of scenes. Their messages name the file, the key, the value and the range.

use std::fmt;

use super::number::{number_text, with_unit};

/// Why a scene could not be read, changed, written or used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The file cannot be read.
    #[error("{file}: cannot read: {source}")]
    Read {
        /// The file.
        file: String,
        /// The message of the system.
        source: std::io::Error,
    },
    /// The file name ends in neither `.toml` nor `.json`.
    #[error("{file}: unknown kind of scene file; expected a name that ends in `.toml` or `.json`")]
    Extension {
        /// The file.
        file: String,
    },
    /// The text is not TOML or JSON.
    #[error("{file}:{line}:{column}: {message}")]
    Syntax {
        /// The file.
        file: String,
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// What the parser expected.
        message: String,
    },
    /// Keys or values are wrong. Has all problems that were found, not only the first.
    #[error("{}", list(file, problems))]
    Invalid {
        /// The file, or `scene NAME` for one built in code.
        file: String,
        /// At least one problem.
        problems: Vec<Problem>,
    },
    /// An override such as `fluid.spacing=0.01` cannot be understood.
    #[error("override `{text}`: {message}")]
    Override {
        /// The override as given.
        text: String,
        /// What is wrong with it.
        message: String,
    },
    /// No preset has this name.
    #[error("unknown preset `{name}`{}; presets: {}", hint(nearest.as_deref()), known.join(", "))]
    UnknownPreset {
        /// The name as given.
        name: String,
        /// The most similar name, if one is similar.
        nearest: Option<String>,
        /// All names.
        known: Vec<String>,
    },
    /// A scene cannot be scaled by this factor.
    #[error("resolution = {} is out of range {minimum} to {maximum}", number_text(*value))]
    Resolution {
        /// The factor as given.
        value: f32,
        /// Smallest factor.
        minimum: f32,
        /// Largest factor.
        maximum: f32,
    },
    /// The scene cannot be written as text.
    #[error("cannot write the scene: {message}")]
    Write {
        /// The message of the writer.
        message: String,
    },
}

impl SceneError {
    /// The problems of an invalid scene; empty for the other errors.
    #[must_use]
    pub fn problems(&self) -> &[Problem] {
        match self {
            Self::Invalid { problems, .. } => problems,
            _ => &[],
        }
    }
}

/// One problem of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// The key, such as `sponges[0].permeability`.
    pub key: String,
    /// The value as it would be written in a file; `None` where there is none.
    pub value: Option<String>,
    /// What is wrong.
    pub defect: Defect,
    /// Line and column, from 1; known for problems in a TOML file.
    pub place: Option<(usize, usize)>,
}

/// Kinds of problems.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Defect {
    /// The table has no such key.
    UnknownKey {
        /// The most similar key, if one is similar.
        nearest: Option<String>,
        /// All keys of the table.
        known: Vec<String>,
    },
    /// A required key is absent.
    MissingKey,
    /// The value is of another type.
    WrongType {
        /// Such as "a number".
        expected: String,
        /// Such as "text".
        found: &'static str,
    },
    /// The word is none of the choices.
    UnknownChoice {
        /// The most similar choice, if one is similar.
        nearest: Option<String>,
        /// All choices.
        known: Vec<String>,
    },
    /// The number is outside its range, or not finite.
    OutOfRange {
        /// Smallest value.
        minimum: f32,
        /// Largest value.
        maximum: f32,
        /// SI unit, "1" for pure numbers.
        unit: &'static str,
    },
    /// The format has another version.
    Version {
        /// The version that this library reads.
        supported: u32,
    },
    /// The value breaks a rule that involves more than its range.
    Rule(
        /// The rule.
        String,
    ),
}

impl Problem {
    /// Problem of a key with a value.
    pub(super) fn new(key: impl Into<String>, value: impl Into<String>, defect: Defect) -> Self {
        Self { key: key.into(), value: Some(value.into()), defect, place: None }
    }

    /// Value that breaks a rule.
    pub(super) fn rule(key: impl Into<String>, value: impl Into<String>, rule: impl Into<String>) -> Self {
        Self::new(key, value, Defect::Rule(rule.into()))
    }

    /// Key that should be there.
    #[cfg(feature = "serde")]
    pub(super) fn missing(key: impl Into<String>) -> Self {
        Self { key: key.into(), value: None, defect: Defect::MissingKey, place: None }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let key = &self.key;
        let assignment = match &self.value {
            Some(value) => format!("`{key}` = {value}"),
            None => format!("`{key}`"),
        };
        match &self.defect {
            Defect::UnknownKey { nearest, known } => {
                let hint = hint(nearest.as_deref());
                write!(out, "unknown key `{key}`{hint}; keys here: {}", known.join(", "))
            }
            Defect::MissingKey => write!(out, "missing key {assignment}"),
            Defect::WrongType { expected, found } => {
                write!(out, "{assignment} is {found}; expected {expected}")
            }
            Defect::UnknownChoice { nearest, known } => {
                let hint = hint(nearest.as_deref());
                write!(out, "{assignment} is not a choice here{hint}; choices: {}", known.join(", "))
            }
            Defect::OutOfRange { minimum, maximum, unit } => {
                let range = format!("{} to {}", number_text(*minimum), number_text(*maximum));
                write!(out, "{assignment} is out of range {}", with_unit(&range, unit))
            }
            Defect::Version { supported } => {
                write!(
                    out,
                    "{assignment} is an unknown version of the scene format; this library reads {supported}"
                )
            }
            Defect::Rule(rule) => write!(out, "{assignment}: {rule}"),
        }
    }
}

/// All problems, one per line, each with its file and place.
fn list(file: &str, problems: &[Problem]) -> String {
    let line = |problem: &Problem| match problem.place {
        Some((line, column)) => format!("{file}:{line}:{column}: {problem}"),
        None => format!("{file}: {problem}"),
    };
    problems.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// The proposal at the end of "unknown ...".
fn hint(nearest: Option<&str>) -> String {
    nearest.map(|name| format!("; did you mean `{name}`?")).unwrap_or_default()
}

/// The candidate most similar to a word, if it is similar enough to be a typing error.
#[cfg(feature = "serde")]
pub(super) fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let word = word.to_lowercase();
    let mut best: Option<(f64, &str)> = None;
    for candidate in candidates {
        let similarity = strsim::normalized_damerau_levenshtein(&word, candidate)
            .max(0.9 * strsim::jaro_winkler(&word, candidate));
        // The first of equal candidates wins, so that the answer depends on the order of the keys only.
        if best.is_none_or(|(record, _)| similarity > record) {
            best = Some((similarity, candidate));
        }
    }
    best.filter(|(similarity, _)| *similarity >= 0.6).map(|(_, candidate)| candidate.to_owned())
}
