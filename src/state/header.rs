//! What a saved file says before its bytes.

use serde::{Deserialize, Serialize};
use sorb_kernels::{asleep::Asleep, params::Params};
use xxhash_rust::xxh3::xxh3_64;

use super::error::StateError;
use crate::{scene::Scene, world::World};

/// Version of the library.
pub(super) const LIBRARY: &str = env!("CARGO_PKG_VERSION");

/// The header of a save.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Header {
    /// Version of the library that wrote it.
    pub(super) library: String,
    /// The scene as JSON.
    pub(super) scene: String,
    /// Digest of the parameters that the library derived from it.
    pub(super) parameters: u64,
    /// Digest of the state.
    pub(super) digest: u64,
    /// Simulated time \[s\], steps and frames.
    pub(super) clock: (f64, u64, u64),
    /// Name and bytes of every section.
    pub(super) sections: Vec<(String, u64)>,
    /// Whether the sections are one block of lz4.
    pub(super) is_compressed: bool,
    /// Bytes of the sections as they are in the file.
    pub(super) stored: u64,
}

/// What tells scenes apart: the text of the scene, and the digest of its parameters.
#[derive(Clone, Debug)]
pub(crate) struct Identity {
    pub(crate) scene: String,
    pub(crate) parameters: u64,
}

impl World {
    /// The identity of the scene, computed once.
    pub(crate) fn identity(&self) -> Result<&Identity, StateError> {
        if let Some(identity) = self.identity.get() {
            return Ok(identity);
        }
        let scene = text_of(&self.scene)?;
        let step = self.scene.time.maximum_step;
        let (gravity, asleep) = (self.scene.gravity, Asleep::default());
        let params = Params { step, gravity, asleep, ..self.params.clone() };
        let parameters = xxh3_64(format!("{params:?}").as_bytes());
        Ok(self.identity.get_or_init(|| Identity { scene, parameters }))
    }
}

impl World {
    /// Refuses parameters that a version of the library derived from the same scene, if they are not those of this one.
    pub(crate) fn check_parameters(&self, parameters: u64, library: &str) -> Result<(), StateError> {
        if self.identity()?.parameters == parameters {
            return Ok(());
        }
        Err(StateError::Parameters { library: library.to_owned(), here: LIBRARY })
    }
}

/// A scene as text.
pub(super) fn text_of(scene: &Scene) -> Result<String, StateError> {
    scene.to_json().map_err(|error| StateError::Text(Box::new(error)))
}

/// The scene of a text.
pub(crate) fn scene_of(text: &str) -> Result<Scene, StateError> {
    Scene::from_json(text, "the scene in the file").map_err(|error| StateError::Text(Box::new(error)))
}
