//! `sorb record`, `sorb replay`, `sorb diff`, and runs that continue from a save.

use std::{
    fs,
    path::Path,
    process::{Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use crate::support::{Answer, Scratch, sorb};

fn is_ok(answer: &Answer) {
    assert_eq!((answer.code, answer.err.as_str()), (Some(0), ""), "{answer:?}");
}

fn digest(text: &str) -> &str {
    text.split("digest ").nth(1).map_or("", |rest| &rest[..16])
}

#[test]
fn every_scene_is_recorded_and_replayed_on_other_threads_and_levels() {
    let scratch = Scratch::new("record");
    for preset in sorb::scene::presets() {
        let file = scratch.path(preset.name);
        let record =
            ["record", preset.name, "--resolution", "0.4", "--frames", "6", "--every", "3", "--out", &file];
        let recorded = sorb(&record);
        is_ok(&recorded);
        assert!(recorded.out.contains("6 frames, 0 commands, 2 key frames"), "{}", recorded.out);
        let played = sorb(&["replay", &file, "--verify", "--threads", "1", "--simd", "fallback"]);
        is_ok(&played);
        assert!(played.out.contains("frame 6") && played.out.contains("as recorded"), "{}", played.out);
        assert_eq!(digest(&played.out), digest(&recorded.out), "{}", preset.name);
    }
}

#[test]
fn commands_of_a_file_are_recorded_and_what_differs_is_named() {
    let scratch = Scratch::new("commands");
    let push = r#"[{"frame": 2, "command": {"velocity": {"body": 0, "linear_velocity": [0, 1, 0], "angular_velocity": [0, 0, 0]}}}]"#;
    let (file, commands) = (scratch.path("pushed"), scratch.write("commands.json", push));
    let record = ["record", "ball_drop", "--resolution", "0.4", "--frames", "6", "--out", &file];
    let pushed = sorb(&[&record[..], &["--commands", &commands, "--every", "2"]].concat());
    is_ok(&pushed);
    is_ok(&sorb(&["replay", &file, "--verify"]));
    let sought = sorb(&["replay", &file, "--seek", "0.0667"]);
    is_ok(&sought);
    assert!(sought.out.contains("frame 4"), "{}", sought.out);
    let beyond = sorb(&["replay", &file, "--seek", "9"]);
    assert_eq!(beyond.code, Some(2));
    assert!(beyond.err.contains("frame 540 is out of range 0 to 6"), "{}", beyond.err);
    // Bad commands are refused as keys of scenes are.
    let bad = scratch.write("bad.json", &push.replace("[0, 1, 0]", "[0, 1000, 0]"));
    let refused = sorb(&[&record[..], &["--commands", &bad]].concat());
    assert_eq!(refused.code, Some(2));
    assert!(
        refused.err.contains("`velocity.linear_velocity` = 1000 is out of range -100 to 100 m/s"),
        "{}",
        refused.err
    );
    // One bit of the file.
    let mut bytes = fs::read(&file).expect("the recording is there");
    let last = bytes.len() - 1;
    bytes[last] ^= 1;
    fs::write(&file, bytes).expect("it can be written");
    let altered = sorb(&["replay", &file, "--verify"]);
    assert_eq!(altered.code, Some(2));
    assert!(altered.err.contains("altered"), "{}", altered.err);
}

/// Arguments of a run of half a second that saves ten times a second.
fn run(scratch: &Scratch, out: &str) -> Vec<String> {
    let out = scratch.path(out);
    let words = ["run", "life", "--resolution", "0.5", "--time", "1", "--save-every", "0.1", "--out", &out];
    words.map(str::to_owned).to_vec()
}

fn words(words: &[String]) -> Vec<&str> {
    words.iter().map(String::as_str).collect()
}

#[test]
fn a_killed_run_continues_from_its_last_save_with_the_same_bits() {
    let scratch = Scratch::new("killed");
    let straight = sorb(&words(&run(&scratch, "straight")));
    is_ok(&straight);
    let mut child = Command::new(env!("CARGO_BIN_EXE_sorb"))
        .args(run(&scratch, "killed"))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .spawn()
        .expect("the command starts");
    let (save, start) = (scratch.path("killed/state.sorb"), Instant::now());
    while !Path::new(&save).exists() && start.elapsed() < Duration::from_secs(60) {
        thread::sleep(Duration::from_millis(2));
    }
    child.kill().expect("it can be killed");
    child.wait().expect("it ends");
    let rows = |name: &str| scratch.read(name).lines().count();
    assert!(rows("killed/measures.csv") < rows("straight/measures.csv"), "it was killed too late");
    let done = rows("killed/measures.csv");
    let out = scratch.path("killed");
    let left = 60 - (sorb::Save::read(fs::File::open(&save).expect("it is there")).expect("a save").frames());
    let left = left.to_string();
    let continued = sorb(&[
        "run",
        "--from",
        &save,
        "--frames",
        &left,
        "--threads",
        "1",
        "--save-every",
        "0.1",
        "--out",
        &out,
    ]);
    is_ok(&continued);
    assert_eq!(digest(&continued.out), digest(&straight.out));
    assert!(rows("killed/measures.csv") > done);
    for table in ["measures.csv", "bodies.csv"] {
        let (killed, straight) = (format!("killed/{table}"), format!("straight/{table}"));
        assert_eq!(scratch.read(&killed), scratch.read(&straight), "{table}");
    }
    let diff = sorb(&["diff", &save, &scratch.path("straight/state.sorb")]);
    is_ok(&diff);
    assert!(diff.out.starts_with("equal: 1.000 s"), "{}", diff.out);
}

#[test]
fn two_saves_differ_in_a_column_a_row_and_values() {
    let scratch = Scratch::new("diff");
    let other = [&run(&scratch, "other")[..], &["--frames".to_owned(), "6".to_owned()]].concat();
    let other: Vec<String> = other.into_iter().filter(|word| word != "--time" && word != "1").collect();
    is_ok(&sorb(&words(&other)));
    let first = scratch.path("other/state.sorb");
    let kept = scratch.path("kept.sorb");
    fs::copy(&first, &kept).expect("it can be copied");
    is_ok(&sorb(&[
        "run",
        "--from",
        &kept,
        "--frames",
        "6",
        "--save-every",
        "0.1",
        "--out",
        &scratch.path("other"),
    ]));
    let diff = sorb(&["diff", &kept, &first]);
    assert_eq!(diff.code, Some(1));
    assert!(diff.err.contains("fluid.position row 0 x: "), "{}", diff.err);
    let nothing = sorb(&["diff", &kept, &scratch.path("other/measures.csv")]);
    assert_eq!(nothing.code, Some(2));
    assert!(nothing.err.contains("this is no save of sorb"), "{}", nothing.err);
}
