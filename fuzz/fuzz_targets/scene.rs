//! Parses any text as a scene file, TOML and JSON. The result is an error with a key or a line, or a valid scene that is
//! the same after writing and reading it again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sorb::scene::{Scene, SceneError};

fuzz_target!(|text: &str| {
    for parse in [Scene::from_toml, Scene::from_json] {
        match parse(text, "fuzz") {
            Ok(scene) => {
                assert!(scene.problems().is_empty());
                let again = scene.to_toml().and_then(|text| Scene::from_toml(&text, "again"));
                assert_eq!(again.as_ref().ok(), Some(&scene));
                let again = scene.to_json().and_then(|text| Scene::from_json(&text, "again"));
                assert_eq!(again.as_ref().ok(), Some(&scene));
            }
            Err(SceneError::Syntax { line, .. }) => assert!(line >= 1),
            Err(SceneError::Invalid { problems, .. }) => {
                // `scene` is the key of errors that only serde detects.
                assert!(problems.iter().all(|problem| !problem.key.is_empty() && problem.key != "scene"));
                assert!(!problems.is_empty());
            }
            Err(other) => panic!("{other}"),
        }
    }
});
