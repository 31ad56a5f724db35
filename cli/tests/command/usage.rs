//! Wrong usage: exit code 2, and a message with the correct usage.

use crate::support::{Scratch, sorb};

/// Fails unless `run` with these arguments is refused with these words.
fn refused(arguments: &[&str], words: &[&str]) {
    let scratch = Scratch::new(&format!("refused_{}", words.join("_").replace(['/', '`', ' '], "-")));
    let out = scratch.path("out");
    let all = [&["run"], arguments, &["--frames", "1", "--out", &out]].concat();
    let answer = sorb(&all);
    assert_eq!(answer.code, Some(2), "{answer:?}");
    assert_eq!(answer.out, "");
    for word in words {
        assert!(answer.err.contains(word), "{word} is not in {}", answer.err);
    }
    assert!(!std::path::Path::new(&out).exists(), "a refused run leaves nothing");
}

#[test]
fn an_unknown_scene_suggests_a_near_one() {
    refused(&["bal_drop"], &["bal_drop", "did you mean `ball_drop`"]);
}

#[test]
fn a_bad_change_names_the_key() {
    refused(&["water", "--set", "fluid.spaceing=0.01"], &["fluid.spaceing", "did you mean `spacing`"]);
    refused(&["water", "--set", "fluid.spacing=-3"], &["fluid.spacing", "out of range"]);
    refused(&["water", "--set", "fluid.spacing"], &["fluid.spacing", "KEY=VALUE"]);
}

#[test]
fn an_unknown_quality_names_those_there_are() {
    refused(&["water", "--quality", "fats"], &["fats", "did you mean `fast`", "balanced, accurate"]);
}

#[test]
fn an_unknown_or_missing_simd_level_names_those_there_are() {
    refused(&["water", "--simd", "avx3"], &["avx3", "fallback", "auto"]);
    let missing = if cfg!(target_arch = "x86_64") { "neon" } else { "sse4.2" };
    refused(&["water", "--simd", missing], &[missing, "supported: fallback"]);
}

#[test]
fn an_unknown_backend_names_those_there_are() {
    refused(&["water", "--backend", "cuda"], &["cuda", "cpu, gpu, auto, from:KERNEL"]);
    refused(&["water", "--backend", "from:sph::nothing"], &["sph::nothing", "from:KERNEL"]);
    refused(&["water", "--backend", "each:sph=cuda"], &["each:sph=cuda", "each:NAME=PLACE"]);
}

#[test]
fn numbers_out_of_range_are_refused() {
    refused(&["water", "--threads", "0"], &["0 threads", "1 to 1024"]);
    refused(&["water", "--threads", "100000"], &["100000 threads", "1 to 1024"]);
    refused(&["water", "--resolution", "0"], &["resolution", "0.1 to 8"]);
    refused(&["water", "--resolution", "nan"], &["resolution", "NaN", "0.1 to 8"]);
    refused(&["water", "--size", "10x10"], &["10x10", "1280x720"]);
    refused(&["water", "--picture-rate", "0"], &["picture-rate", "0.1 to 1000"]);
}

#[test]
fn frames_and_time_exclude_each_other() {
    refused(&["water", "--time", "1"], &["--time", "--frames"]);
}

#[test]
fn an_out_folder_that_cannot_be_made_is_named() {
    let scratch = Scratch::new("not_a_folder");
    let file = scratch.write("file", "");
    let inside = format!("{file}/out");
    let answer = sorb(&["run", "empty", "--frames", "1", "--out", &inside]);
    assert_eq!(answer.code, Some(2));
    assert!(answer.err.contains(&inside), "{answer:?}");
}

#[cfg(unix)]
#[test]
fn a_reader_that_stops_reading_is_no_error() {
    use std::process::{Command, Stdio};

    let mut child = Command::new(env!("CARGO_BIN_EXE_sorb"))
        .arg("schema")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("the command ends");
    assert_eq!((output.status.code(), output.stderr), (Some(0), Vec::new()));
}
