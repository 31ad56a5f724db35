//! Parses any text as an override of one key of a scene: an error that repeats the text, or a valid scene.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use sorb::scene::{self, Scene, SceneError};

/// The scene of the library that uses most keys.
static SCENE: LazyLock<Scene> = LazyLock::new(|| scene::preset("life").expect("a scene of the library"));

fuzz_target!(|text: &str| {
    match SCENE.with_overrides([text]) {
        Ok(scene) => assert!(scene.problems().is_empty()),
        Err(SceneError::Override { text: given, message }) => assert!(given == text && !message.is_empty()),
        Err(SceneError::Invalid { problems, .. }) => {
            assert!(!problems.is_empty() && problems.iter().all(|problem| !problem.key.is_empty()));
        }
        Err(other) => panic!("{other}"),
    }
});
