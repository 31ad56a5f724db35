//! `sorb`, `scenes`, `check`, `schema`, `plan`, `doctor`.

use serde_json::Value;

use crate::support::{Scratch, sorb};

fn names() -> impl Iterator<Item = &'static str> {
    sorb::scene::presets().iter().map(|preset| preset.name)
}

#[test]
fn scenes_lists_all() {
    let answer = sorb(&["scenes"]);
    let listed: Vec<_> =
        answer.out.lines().skip(1).filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!((answer.code, listed), (Some(0), names().collect()));
    let json = sorb(&["scenes", "--json"]).json();
    let scenes = json.as_array().expect("an array");
    assert_eq!(scenes.len(), names().count());
    let nodes =
        |name: &str| scenes.iter().find(|scene| scene["name"] == name).map(|scene| scene["nodes"] != 0);
    assert_eq!((nodes("ball_drop"), nodes("water")), (Some(true), Some(false)));
}

#[test]
fn no_arguments_say_what_there_is_and_how_to_run_it() {
    let answer = sorb(&[]);
    assert_eq!(answer.code, Some(0));
    assert!(
        answer.out.contains("wring") && answer.out.contains("sorb run ball_drop --pictures"),
        "{answer:?}"
    );
}

#[test]
fn check_accepts_presets_and_good_files() {
    for name in names() {
        let answer = sorb(&["check", name]);
        assert_eq!((answer.code, answer.err.as_str()), (Some(0), ""), "{name}");
    }
    let scratch = Scratch::new("check_good");
    let file = scratch.write("good.json", r#"{"version": 1, "sponges": [{"name": "a"}]}"#);
    let answer = sorb(&["check", &file]);
    assert_eq!(answer.code, Some(0));
    assert!(answer.out.contains("1233 nodes"), "{answer:?}");
    let tap = "version = 1\n[fluid]\n[[emitters]]\nradius = 0.01\n[[drains]]\nrate = 2\n";
    let answer = sorb(&["check", &scratch.write("tap.toml", tap)]);
    assert_eq!((answer.code, answer.err.as_str()), (Some(0), ""));
}

#[test]
fn check_names_every_problem_and_fails_with_1() {
    let scratch = Scratch::new("check_bad");
    let ranges = scratch.write("ranges.toml", "version = 1\n[fluid]\nspacing = -1\nviscosity = 1e9\n");
    let answer = sorb(&["check", &ranges, "dry"]);
    assert_eq!(answer.code, Some(1));
    for part in ["ranges.toml:3:", "fluid.spacing", "ranges.toml:4:", "fluid.viscosity"] {
        assert!(answer.err.contains(part), "{part} is not in {}", answer.err);
    }
    assert!(answer.out.contains("dry: ok"), "{answer:?}");
    let tap = scratch.write("tap.toml", "version = 1\n[fluid]\n[[emitters]]\nradius = 50\n");
    let answer = sorb(&["check", &tap]);
    assert!(answer.code == Some(1) && answer.err.contains("tap.toml:4:"), "{answer:?}");
    let key = scratch.write("key.toml", "version = 1\n[fluid]\nspaceing = 0.01\n");
    let answer = sorb(&["check", &key]);
    assert_eq!(answer.code, Some(1));
    assert!(answer.err.contains("did you mean `spacing`"), "{answer:?}");
    let syntax = scratch.write("syntax.toml", "version = = 1\n");
    assert_eq!(sorb(&["check", &syntax]).code, Some(1));
}

#[test]
fn check_finds_what_only_the_set_up_can_find() {
    let scratch = Scratch::new("check_hull");
    let flat = "version = 1\n[[bodies]]\nname = \"flat\"\n\
                shape = { kind = \"hull\", vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]] }\n";
    let answer = sorb(&["check", &scratch.write("flat.toml", flat)]);
    assert_eq!(answer.code, Some(1));
    assert!(answer.err.contains("flat"), "{answer:?}");
}

#[test]
fn check_of_a_scene_that_is_not_there_is_wrong_usage() {
    assert_eq!(sorb(&["check", "no_such_file.toml"]).code, Some(2));
    assert_eq!(sorb(&["check", "bal_drop"]).code, Some(2));
}

#[test]
fn schema_is_json_with_ranges() {
    let answer = sorb(&["schema"]);
    assert_eq!(answer.code, Some(0));
    assert!(answer.json()["properties"]["version"]["maximum"] == 1);
}

#[test]
fn plan_says_what_is_skipped_and_why() {
    let text = sorb(&["plan", "dry"]);
    assert_eq!(text.code, Some(0));
    assert!(text.out.contains("skip  sph::density: no fluid"), "{}", text.out);
    assert!(text.out.contains("pbd::vbd\n"), "{}", text.out);
    let json = sorb(&["plan", "water", "--json"]).json();
    let phases = json["phases"].as_array().expect("an array");
    let skipped =
        |name: &str| phases.iter().find(|phase| phase["name"] == name).map(|phase| phase["skipped"].clone());
    assert_eq!(skipped("sph::forces"), Some(Value::Bool(false)));
    assert_eq!(skipped("pbd::strain"), Some(Value::Bool(true)));
}

#[test]
fn plan_follows_changes_of_the_scene() {
    let skips = |set: &str| sorb(&["plan", "water", "--set", set]).out.contains("skip  sph::cohesion");
    assert!(skips("fluid.surface_tension=0"));
    assert!(!skips("fluid.surface_tension=0.072"));
}

#[test]
fn doctor_names_the_machine() {
    let answer = sorb(&["doctor"]);
    assert_eq!(answer.code, Some(0));
    let gpu = if cfg!(feature = "gpu") { "GPU" } else { "not built in" };
    for part in ["threads", "fallback", gpu] {
        assert!(answer.out.contains(part), "{part} is not in {}", answer.out);
    }
    let json = sorb(&["doctor", "--json"]).json();
    let supported = json["simd"]["supported"].as_array().expect("an array");
    assert!(supported.contains(&json["simd"]["auto"]), "{json}");
}
