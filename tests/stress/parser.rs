//! Any text as a scene file: an error with a key or a line, or a scene that can be built; never a panic.

use proptest::{
    collection::vec,
    prelude::{Strategy, any},
    test_runner::TestCaseError,
};
use sorb::{
    World,
    scene::{self, Scene, SceneError},
};

use crate::{common::busy, pick, random::runner};

/// Tokens that are inserted in wrong places.
const TOKENS: [&str; 30] = [
    "nan",
    "-inf",
    "-1",
    "0",
    "1e40",
    "-1e-40",
    "9223372036854775807",
    "-9223372036854775808",
    "1e-4",
    "1000",
    "[]",
    "{}",
    "[[]]",
    "[",
    "]",
    "{",
    "}",
    "=",
    "\"",
    "'''",
    "\n",
    "\u{0}",
    "\u{feff}",
    "true",
    "1979-05-27",
    "\"wet\"",
    "kind = \"box\"",
    ".",
    "[sponges]\n",
    "[[bodies]]\n",
];

/// A change of a text: place, kind and token.
type Change = (f64, u8, usize);

/// A scene of the library with some changes.
fn changed(text: &str, changes: &[Change]) -> String {
    let mut text = text.to_owned();
    for (place, how, token) in changes {
        let mut at = (place * text.len() as f64) as usize;
        while !text.is_char_boundary(at) {
            at -= 1;
        }
        let rest = &text[at..];
        let line_end = at + rest.find('\n').map_or(rest.len(), |end| end + 1);
        let line = rest[..line_end - at].to_owned();
        // The end of the number or word that starts here.
        let word = |c: char| c.is_ascii_alphanumeric() || "_.-+".contains(c);
        let word_end = at + rest.find(|c| !word(c)).unwrap_or(rest.len());
        let token = TOKENS[token % TOKENS.len()];
        match how % 5 {
            0 => text.insert_str(at, token),
            1 => text.replace_range(at..word_end, token),
            2 => text.replace_range(at..line_end, ""),
            3 => text.insert_str(at, &line),
            _ => text.truncate(at),
        }
    }
    text
}

/// The defect of an error of the parser; none if it has a place.
fn vague(error: &SceneError) -> Option<String> {
    match error {
        SceneError::Syntax { line, message, .. } if *line >= 1 && !message.is_empty() => None,
        // `scene` is the key of errors that only serde detects, and is no place; except for a file without a table.
        SceneError::Invalid { problems, .. } if !problems.is_empty() => {
            let is_whole = |problem: &scene::Problem| problem.to_string().ends_with("expected a table");
            let nameless = |problem: &&scene::Problem| {
                problem.key.is_empty() || problem.key == "scene" && !is_whole(problem)
            };
            problems.iter().find(nameless).map(ToString::to_string)
        }
        other => Some(other.to_string()),
    }
}

/// Reads a text, and uses the result as a host would.
fn read(text: &str, parse: fn(&str, &str) -> Result<Scene, SceneError>) -> Result<(), TestCaseError> {
    let fail = |what: String| Err(TestCaseError::fail(format!("{what}\n{text}")));
    let scene = match parse(text, "changed") {
        Ok(scene) => scene,
        Err(error) => {
            return match vague(&error) {
                Some(what) => fail(format!("neither key nor line: {what}")),
                None => Ok(()),
            };
        }
    };
    if !scene.problems().is_empty() {
        return fail(format!("accepted with {:?}", scene.problems()));
    }
    match scene.to_toml().map(|again| Scene::from_toml(&again, "again")) {
        Ok(Ok(again)) if again == scene => {}
        other => return fail(format!("does not come back: {other:?}")),
    }
    let estimate = scene.estimate();
    if estimate.particles + estimate.nodes < 3000
        && let Ok(mut world) = World::new(&scene)
    {
        // A refused step has a reason; the test is that none panics.
        let _ = world.step();
    }
    Ok(())
}

fn texts() -> Vec<String> {
    busy::names().map(|name| busy::scene(name, 0.4).to_toml().unwrap_or_default()).collect()
}

#[test]
fn scenes_with_slips_are_read_or_refused_with_a_place() {
    let texts = texts();
    let changes = vec((0.0..1.0, any::<u8>(), any::<usize>()), 1..5);
    let strategy = (0..texts.len(), changes);
    let result = runner(pick(600, 40_000))
        .run(&strategy, |(index, changes)| read(&changed(&texts[index], &changes), Scene::from_toml));
    assert!(result.is_ok(), "{}", result.err().map(|error| error.to_string()).unwrap_or_default());
}

#[test]
fn json_with_slips_is_read_or_refused_with_a_place() {
    let texts: Vec<String> =
        texts().iter().filter_map(|text| Scene::from_toml(text, "").ok()?.to_json().ok()).collect();
    assert_eq!(texts.len(), busy::names().count());
    let changes = vec((0.0..1.0, any::<u8>(), any::<usize>()), 1..4);
    let strategy = (0..texts.len(), changes);
    let result = runner(pick(600, 40_000))
        .run(&strategy, |(index, changes)| read(&changed(&texts[index], &changes), Scene::from_json));
    assert!(result.is_ok(), "{}", result.err().map(|error| error.to_string()).unwrap_or_default());
}

#[test]
fn any_bytes_are_read_or_refused_with_a_place() {
    let text = vec(any::<u8>(), 0..200).prop_map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    let result = runner(pick(2000, 100_000)).run(&text, |text| {
        read(&text, Scene::from_toml)?;
        read(&text, Scene::from_json)
    });
    assert!(result.is_ok(), "{}", result.err().map(|error| error.to_string()).unwrap_or_default());
}

#[test]
fn deep_nesting_does_not_overflow_the_stack() {
    for (open, close) in [("[", "]"), ("{a=", "}"), ("{\"a\":", "}")] {
        let text = format!("{}1{}", open.repeat(100_000), close.repeat(100_000));
        for parse in [Scene::from_toml, Scene::from_json] {
            for text in [text.clone(), format!("a = {text}"), format!("{}=1", "a.".repeat(100_000) + "a")] {
                let error = parse(&text, "deep").expect_err("no scene");
                assert_eq!(vague(&error), None);
            }
        }
    }
}

#[test]
fn overrides_at_random_are_taken_or_refused() {
    let scene = busy::scene("life", 0.4);
    let part = |index: usize| {
        [
            "sponges",
            "[0]",
            ".edge",
            "fluid",
            ".",
            "bodies",
            "time",
            "[",
            "]",
            "=",
            "[99999999999999999999]",
            "é",
        ][index % 12]
    };
    let result =
        runner(pick(2000, 50_000)).run(&(vec(any::<usize>(), 0..6), any::<usize>()), |(parts, token)| {
            let key: String = parts.into_iter().map(part).collect();
            let text = format!("{key}={}", TOKENS[token % TOKENS.len()]);
            match scene.with_overrides([text.as_str()]) {
                Err(SceneError::Override { text: given, message })
                    if given == text && !message.is_empty() =>
                {
                    Ok(())
                }
                Err(error) if vague(&error).is_none() => Ok(()),
                Ok(scene) if scene.problems().is_empty() => Ok(()),
                other => Err(TestCaseError::fail(format!("{text}: {other:?}"))),
            }
        });
    assert!(result.is_ok(), "{}", result.err().map(|error| error.to_string()).unwrap_or_default());
}

/// Negative controls: errors without a place are detected, and changes do change.
#[test]
fn an_error_without_a_place_is_told() {
    let place = Scene::from_toml("version = ", "bad").expect_err("no value");
    assert_eq!(vague(&place), None);
    let whole = Scene::from_json("0", "bad").expect_err("no table");
    assert_eq!(vague(&whole), None);
    assert!(vague(&SceneError::Write { message: "no".to_owned() }).is_some());
    let text = &texts()[0];
    assert!((0..5).all(|how| changed(text, &[(0.5, how, 2)]) != *text));
    let refused = |how| Scene::from_toml(&changed(text, &[(0.3, how, 17)]), "changed").is_err();
    assert!((0..2).all(refused), "an `=` too many");
}
