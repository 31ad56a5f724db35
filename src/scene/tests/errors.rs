use std::fs;

use super::super::*;

const SPONGE: &str = "version = 1\n\n[[sponges]]\nname = \"block\"\n";

fn message(text: &str) -> String {
    Scene::from_toml(text, "bath.toml").expect_err(text).to_string()
}

#[test]
fn syntax_errors_have_line_and_column() {
    let text = message("version = 1\n[fluid]\nspacing = = 2\n");
    assert!(text.starts_with("bath.toml:3:11: "), "{text}");
    let text = message("version = 1\nversion = 1\n");
    assert!(text.starts_with("bath.toml:2:1: duplicate key"), "{text}");
    let text = Scene::from_json("{\n  \"version\": 1,,\n}", "bath.json").expect_err("two commas").to_string();
    assert!(text.starts_with("bath.json:2:16: "), "{text}");
}

#[test]
fn unknown_keys_propose_the_nearest_key() {
    let text = message(&format!("{SPONGE}permeabilty = 1e-9\n"));
    let start = "bath.toml:5:1: unknown key `sponges[0].permeabilty`; did you mean `permeability`?; keys here: added, cells, ";
    assert!(text.starts_with(start), "{text}");
    let text = message("version = 1\n[fluid]\nspaceing = 1\n[time]\ncurrant = 1\n");
    assert_eq!(text.lines().count(), 2, "all unknown keys at once: {text}");
    assert!(text.contains("did you mean `spacing`?") && text.contains("did you mean `courant`?"), "{text}");
    let text = message("version = 1\nzzz = 1\n");
    assert!(text.contains("unknown key `zzz`; keys here:"), "nothing is similar: {text}");
    let text = message(&format!("{SPONGE}shape = {{ kind = \"cylinder\", axis = \"y\", radius = 1 }}\n"));
    assert!(text.contains("unknown key `sponges[0].shape.radius`"), "{text}");
}

#[test]
fn wrong_types_are_named_by_their_key() {
    for (line, expected) in [
        ("edge = \"wide\"", "`sponges[0].edge` = \"wide\" is text; expected a number"),
        ("cells = [8, 8]", "`sponges[0].cells` = [8, 8] is an array; expected an array of 3 numbers"),
        (
            "cells = [8, 8.5, 8]",
            "`sponges[0].cells[1]` = 8.5 is a number with decimals; expected a whole number from 2 to 1024",
        ),
        (
            "cells = [8, -8, 8]",
            "`sponges[0].cells[1]` = -8 is a whole number; expected a whole number from 2 to 1024",
        ),
        ("position = 3", "`sponges[0].position` = 3 is a whole number; expected an array of 3 numbers"),
        (
            "shape = \"block\"",
            "`sponges[0].shape` = \"block\" is text; expected a table with a `kind` of block, ellipsoid, cylinder, mesh",
        ),
        ("edge = 1979-05-27", "`sponges[0].edge` = 1979-05-27 is a date; expected a number"),
    ] {
        let text = message(&format!("{SPONGE}{line}\n"));
        assert!(text.starts_with("bath.toml:5:"), "{text}");
        assert!(text.ends_with(expected), "{text}\n{expected}");
    }
    let text = message("version = 1\nfluid = [1]\n");
    assert!(text.ends_with("`fluid` = [1] is an array; expected a table"), "{text}");
    let text = Scene::from_json("7", "bath.json").expect_err("no table").to_string();
    assert!(text.starts_with("bath.json: `scene` = 7 is a"), "{text}");
}

#[test]
fn unknown_choices_propose_the_nearest_choice() {
    let text = message(&format!("{SPONGE}shape = {{ kind = \"elipsoid\" }}\n"));
    let end = "`sponges[0].shape.kind` = \"elipsoid\" is not a choice here; did you mean `ellipsoid`?; \
        choices: block, ellipsoid, cylinder, mesh";
    assert!(text.ends_with(end), "{text}");
    let text = message("version = 1\n[fluid]\nequation_of_state = \"tate\"\n");
    assert!(text.ends_with("did you mean `tait`?; choices: tait, linear"), "{text}");
}

#[test]
fn missing_keys_are_named() {
    assert_eq!(message("name = \"bath\"\n"), "bath.toml: missing key `version`");
    let text = message("version = 1\n[[bodies]]\nname = \"ball\"\n[bodies.shape]\nkind = \"sphere\"\n");
    assert!(text.ends_with("missing key `bodies[0].shape.radius`"), "{text}");
    let text = message("version = 1\n[domain]\nminimum = [0, 0, 0]\n");
    assert!(text.ends_with("missing key `domain.kind`"), "{text}");
    let text = message("version = 1\n[domain]\nkind = \"open\"\nperiodic = [true, true, true]\n");
    assert!(text.contains("unknown key `domain.periodic`"), "{text}");
    let corners = "version = 1\n[domain]\nkind = \"box\"\nminimum = [0, 0, 0]\nmaximum = [1, 1, 1]\n";
    let text = message(&format!("{corners}periodic = [\"x\"]\n"));
    assert!(text.ends_with("is an array; expected an array of 3, each true or false"), "{text}");
    let text = message(&format!("{corners}periodic = [true, 1, true]\n"));
    assert!(text.ends_with("`domain.periodic[1]` = 1 is a whole number; expected true or false"), "{text}");
}

#[test]
fn ranges_are_checked_in_files() {
    let text = message(&format!("{SPONGE}porosity = 1.5\n\n[time]\ncourant = nan\n"));
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "bath.toml:8:1: `time.courant` = NaN is out of range 0.01 to 1");
    assert_eq!(lines[1], "bath.toml:5:1: `sponges[0].porosity` = 1.5 is out of range 0.05 to 0.99");
    let text = message(&format!("{SPONGE}density = 1e300\n"));
    assert!(text.ends_with("`sponges[0].density` = inf is out of range 1 to 5000 kg/m^3"), "{text}");
    let text = message(&format!("{SPONGE}position = [0, -inf, 0]\n"));
    assert!(text.starts_with("bath.toml:5:16: `sponges[0].position[1]` = -inf"), "{text}");
}

#[test]
fn another_version_is_refused_before_its_keys_are_read() {
    let text = message("version = 2\nnew_key = 1\n");
    let end = "`version` = 2 is an unknown version of the scene format; this library reads 1";
    assert_eq!(text, format!("bath.toml:1:1: {end}"));
    assert!(message("version = \"1\"\n").contains("expected a whole number from 1 to 1"));
}

#[test]
fn json_has_the_same_errors() {
    let error = |text: &str| Scene::from_json(text, "bath.json").expect_err(text).to_string();
    let text = error(r#"{"version": 1, "sponges": [{"name": "block", "permeabilty": 1e-9}]}"#);
    assert!(text.starts_with("bath.json: unknown key `sponges[0].permeabilty`; did you mean"), "{text}");
    let text = error(r#"{"version": 1, "fluid": {"spacing": 5}}"#);
    assert_eq!(text, "bath.json: `fluid.spacing` = 5 is out of range 1e-4 to 1 m");
    assert_eq!(error("null"), "bath.json: missing key `version`");
    let text = error("{\"version\": 1,\n \"time\": {\"courant\": 0.1, \"courant\": 0.2}}");
    assert!(text.starts_with("bath.json:2:") && text.contains("key `courant` is given twice"), "{text}");
}

#[test]
fn files_that_cannot_be_read_are_named() {
    let missing = Scene::from_path("no/such/scene.toml").expect_err("no such file");
    assert!(matches!(missing, SceneError::Read { .. }));
    assert!(missing.to_string().starts_with("no/such/scene.toml: cannot read: "), "{missing}");
    let extension = Scene::from_path("scene.yaml").expect_err("not a scene file");
    assert!(extension.to_string().starts_with("scene.yaml: unknown kind of scene file"), "{extension}");

    let folder = std::env::temp_dir();
    let file = folder.join(format!("sorb-scene-{}.json", std::process::id()));
    fs::write(&file, r#"{"version": 1, "name": "tiny"}"#).expect("writable folder");
    let scene = Scene::from_path(&file);
    fs::remove_file(&file).expect("just written");
    assert_eq!(scene.expect("valid").name, "tiny");
}

#[test]
fn no_text_makes_the_reader_panic() {
    let whole = presets().iter().find(|preset| preset.name == "wring").expect("exists").text;
    for end in (0..whole.len()).step_by(7).filter(|end| whole.is_char_boundary(*end)) {
        let _ = Scene::from_toml(&whole[..end], "cut.toml");
    }
    for text in
        ["", "\u{feff}version = 1", "version = 99999999999", "[[sponges]]", "sponges = [[]]", "a.b.c = 1"]
    {
        let _ = Scene::from_toml(text, "odd.toml");
    }
    let deep = format!("{}1{}", "[".repeat(10_000), "]".repeat(10_000));
    assert!(Scene::from_json(&deep, "deep.json").is_err());
    assert!(Scene::from_toml(&format!("version = {deep}"), "deep.toml").is_err());
}
