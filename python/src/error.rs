//! Errors of the library as exceptions of the package.

use pyo3::prelude::*;
use sorb::{
    CommandError, QueryError, StateError, StepError, WorldError,
    scene::{Problem, SceneError},
};

/// The exception of a name in `sorb._errors`, with a message and the keys that are wrong.
pub(crate) fn exception(name: &str, message: &str, keys: Vec<String>) -> PyErr {
    let make = |py: Python<'_>| {
        let made = py.import("sorb._errors")?.getattr(name)?.call1((message, keys))?;
        Ok(PyErr::from_value(made))
    };
    Python::attach(|py| make(py).unwrap_or_else(|error: PyErr| error))
}

/// Keys of problems.
fn keys(problems: &[Problem]) -> Vec<String> {
    problems.iter().map(|problem| problem.key.clone()).collect()
}

/// An error of the library with its exception.
pub(crate) trait Raises {
    /// Its exception.
    fn raise(self) -> PyErr;
}

impl Raises for SceneError {
    fn raise(self) -> PyErr {
        exception("SceneError", &self.to_string(), keys(self.problems()))
    }
}

impl Raises for WorldError {
    fn raise(self) -> PyErr {
        match self {
            Self::Scene(error) => error.raise(),
            other => exception("SceneError", &other.to_string(), Vec::new()),
        }
    }
}

impl Raises for CommandError {
    fn raise(self) -> PyErr {
        exception("CommandError", &self.to_string(), keys(&self.problems))
    }
}

impl Raises for StepError {
    fn raise(self) -> PyErr {
        exception("StepError", &self.to_string(), Vec::new())
    }
}

impl Raises for QueryError {
    fn raise(self) -> PyErr {
        let keys = match &self {
            Self::OutOfRange { key, .. } => vec![(*key).to_owned()],
            _ => Vec::new(),
        };
        exception("QueryError", &self.to_string(), keys)
    }
}

impl Raises for StateError {
    fn raise(self) -> PyErr {
        exception("StateError", &self.to_string(), Vec::new())
    }
}

/// Results of the library as those of Python.
pub(crate) trait OrRaise<T> {
    /// The value, or the exception.
    fn or_raise(self) -> PyResult<T>;
}

impl<T, E: Raises> OrRaise<T> for Result<T, E> {
    fn or_raise(self) -> PyResult<T> {
        self.map_err(Raises::raise)
    }
}
