//! `sorb run`: results and files.

use std::{collections::BTreeSet, fs::File, io::BufReader};

use crate::support::{Answer, Scratch, sorb};

const KEYS: [&str; 21] = [
    "backend",
    "backend_reason",
    "digest",
    "diverged",
    "frame_ms_median",
    "frames",
    "measures",
    "nodes",
    "particle_steps_per_s",
    "particles",
    "phases",
    "picture_s",
    "resolution",
    "scene",
    "simd",
    "simulated_s",
    "step_ms_median",
    "steps",
    "tets",
    "threads",
    "wall_s",
];

/// A short run of a small scene.
fn run(scratch: &Scratch, scene: &str, more: &[&str]) -> Answer {
    let out = scratch.path("out");
    sorb(&[&["run", scene, "--resolution", "0.3", "--out", &out], more].concat())
}

#[test]
fn json_is_one_object_with_all_keys_and_nothing_else() {
    let scratch = Scratch::new("json");
    let answer = run(&scratch, "ball_drop", &["--frames", "3", "--json"]);
    assert_eq!((answer.code, answer.err.as_str()), (Some(0), ""));
    let json = answer.json();
    let keys: Vec<_> = json.as_object().expect("an object").keys().map(String::as_str).collect();
    assert_eq!(keys, KEYS);
    assert!(answer.out.starts_with("{\n  \"scene\""), "the order is for people");
    assert_eq!(answer.out, scratch.read("out/summary.json"));
    assert_eq!((&json["frames"], &json["backend"]), (&3.into(), &"cpu".into()));
    assert!((json["simulated_s"].as_f64().expect("a number") - 0.05).abs() < 1e-6);
    assert!(json["measures"]["water_mass_kg"].as_f64().expect("a number") > 0.1);
    let phases = json["phases"].as_array().expect("an array");
    let names: BTreeSet<_> = phases.iter().map(|phase| phase["name"].as_str()).collect();
    assert_eq!(names.len(), phases.len(), "every phase once");
    for phase in phases {
        assert_eq!(phase["skipped"], phase["why"].is_string(), "{phase}");
        assert_eq!(phase["skipped"], phase["calls"] == 0, "{phase}");
    }
}

#[test]
fn the_table_has_a_row_for_every_frame() {
    let scratch = Scratch::new("table");
    let answer = run(&scratch, "dry", &["--time", "0.1"]);
    assert_eq!(answer.code, Some(0));
    let table = scratch.read("out/measures.csv");
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 1 + 7, "the heading, time zero, six frames");
    for (frame, row) in rows[1..].iter().enumerate() {
        assert_eq!((row.len(), row[0]), (rows[0].len(), frame.to_string().as_str()));
        let time: f64 = row[1].parse().expect("a number");
        assert!((time - frame as f64 / 60.0).abs() < 1e-6, "{row:?}");
    }
    assert!(!answer.out.contains('\u{1b}') && answer.err.is_empty(), "no progress bar in a pipe");
}

/// A ball of half the density of water that is held under it by nothing, and one that is fixed there.
const BALLS: &str = r#"
version = 1
name = "balls"
title = "Two balls under water"
[domain]
kind = "box"
minimum = [0.0, 0.0, 0.0]
maximum = [0.16, 0.16, 0.08]
[fluid]
spacing = 0.008
[[fluid.blocks]]
minimum = [0.0, 0.0, 0.0]
maximum = [0.16, 0.104, 0.08]
[[bodies]]
name = "fixed"
kind = "fixed"
position = [0.04, 0.05, 0.04]
shape = { kind = "sphere", radius = 0.02 }
[[bodies]]
name = "free"
density = 500.0
position = [0.12, 0.05, 0.04]
shape = { kind = "sphere", radius = 0.02 }
"#;

#[test]
fn bodies_have_a_row_in_every_frame() {
    let scratch = Scratch::new("bodies");
    let (scene, out) = (scratch.write("balls.toml", BALLS), scratch.path("out"));
    let answer = sorb(&["run", &scene, "--frames", "12", "--out", &out]);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    assert!(answer.out.contains("measures.csv, bodies.csv, summary.json\n"), "{answer:?}");
    let table = scratch.read("out/bodies.csv");
    let mut lines = table.lines();
    assert_eq!(
        lines.next(),
        Some(
            "frame,time_s,body,x_m,y_m,z_m,qx,qy,qz,qw,vx_m_per_s,vy_m_per_s,vz_m_per_s,\
             fluid_force_x_N,fluid_force_y_N,fluid_force_z_N"
        )
    );
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 13 * 2, "time zero and every frame");
    let number = |row: &[&str], column: usize| row[column].parse::<f64>().expect("a number");
    for (index, row) in rows.iter().enumerate() {
        assert_eq!((row.len(), row[0]), (16, (index / 2).to_string().as_str()));
        assert_eq!(row[2], ["fixed", "free"][index % 2]);
        let turn: f64 = (6..10).map(|column| number(row, column).powi(2)).sum();
        assert!((turn - 1.0).abs() < 1e-5, "{row:?}");
        assert_eq!(
            row[13..].iter().all(|force| force.is_empty()),
            index < 2,
            "forces from the first frame on"
        );
    }
    // The fixed ball stays and bears what it displaces; the free one rises as fast as its places say.
    let buoyancy = 9.81 * 1000.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.02_f64.powi(3);
    let lifts = rows[8..].iter().step_by(2).map(|row| number(row, 14)).collect::<Vec<_>>();
    let lift = lifts.iter().sum::<f64>() / lifts.len() as f64;
    assert!((lift / buoyancy - 1.0).abs() < 0.15, "{lift} {buoyancy}");
    assert!(rows.iter().step_by(2).all(|row| number(row, 4) == number(&rows[0], 4)));
    let (last, before) = (&rows[9], &rows[7]);
    let speed = (number(last, 4) - number(before, 4)) * 60.0;
    let mean = 0.5 * (number(last, 11) + number(before, 11));
    assert!(speed > 0.05 && (speed - mean).abs() < 0.1 * mean, "{speed} {mean}");
    // A scene without bodies has no such table, and does not keep that of another run.
    let answer = run(&scratch, "water", &["--frames", "1"]);
    assert_eq!(answer.code, Some(0));
    assert!(!std::path::Path::new(&scratch.path("out/bodies.csv")).exists());
}

#[test]
fn quiet_prints_nothing() {
    let scratch = Scratch::new("quiet");
    let answer = run(&scratch, "empty", &["--frames", "2", "--quiet"]);
    assert_eq!((answer.code, answer.out.as_str(), answer.err.as_str()), (Some(0), "", ""));
    assert!(scratch.read("out/summary.json").contains("\"frames\": 2"));
}

#[test]
fn pictures_exist_and_the_animation_decodes() {
    let scratch = Scratch::new("pictures");
    let small = ["--pictures", "--animation", "--size", "64x48", "--frames"];
    let answer = run(&scratch, "ball_drop", &[&small[..], &["7"]].concat());
    assert_eq!(answer.code, Some(0), "{answer:?}");
    assert_eq!(
        decoded(&scratch.path("out/animation.png")),
        ((64, 48), 4),
        "every second frame, and time zero"
    );
    if cfg!(feature = "film") {
        let film = std::fs::read(scratch.path("out/film.mp4")).expect("the film is there");
        assert!(film.len() > 500 && film[4..8] == *b"ftyp");
    }
    for picture in ["00000", "00003"] {
        assert_eq!(decoded(&scratch.path(&format!("out/frames/{picture}.png"))), ((64, 48), 1));
    }
    // A shorter run does not keep pictures of the longer one.
    let answer = run(&scratch, "ball_drop", &[&small[..], &["2", "--view", "fast"]].concat());
    assert_eq!(answer.code, Some(0), "{answer:?}");
    let pictures = std::fs::read_dir(scratch.path("out/frames")).expect("the folder is there");
    assert_eq!(pictures.count(), 2);
}

/// Size, and number of frames that can be read to their end.
fn decoded(path: &str) -> ((u32, u32), u32) {
    let file = BufReader::new(File::open(path).expect("the file is there"));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG file");
    let info = reader.info();
    let (size, frames) = (info.size(), info.animation_control().map_or(1, |control| control.num_frames));
    let mut buffer = vec![0; reader.output_buffer_size().expect("a size that fits")];
    for _ in 0..frames {
        reader.next_frame(&mut buffer).expect("a whole frame");
    }
    assert!(reader.next_frame(&mut buffer).is_err(), "no more frames than declared");
    (size, frames)
}

#[test]
fn a_run_that_diverges_exits_with_3_and_leaves_what_it_has() {
    let scratch = Scratch::new("diverges");
    // Water in free fall accelerates, until the speed bound requires a step that is not allowed.
    let sets = [
        ["--set", "domain={kind=\"open\"}"],
        ["--set", "fluid.solver=wcsph"],
        ["--set", "time.minimum_step=0.0005"],
    ]
    .concat();
    let answer = run(
        &scratch,
        "water",
        &[&sets[..], &["--frames", "60", "--pictures", "--animation", "--size", "32x32"]].concat(),
    );
    assert_eq!(answer.code, Some(3), "{answer:?}");
    assert!(answer.err.contains("time.minimum_step"), "{}", answer.err);
    let rows = scratch.read("out/measures.csv").lines().count();
    let summary: serde_json::Value = serde_json::from_str(&scratch.read("out/summary.json")).expect("JSON");
    assert!(rows > 3 && rows < 60, "{rows}");
    assert_eq!(summary["frames"], rows - 2);
    assert!(summary["diverged"].as_str().is_some_and(|why| why.contains("courant")), "{summary}");
    assert!(decoded(&scratch.path("out/animation.png")).1 > 1);
}

#[test]
fn digests_do_not_depend_on_threads_and_simd_level() {
    let scratch = Scratch::new("digests");
    let digest = |more: &[&str]| {
        let answer = run(&scratch, "standing", &[&["--frames", "5", "--json"], more].concat());
        assert_eq!(answer.code, Some(0), "{answer:?}");
        answer.json()["digest"].as_str().expect("text").to_owned()
    };
    let first = digest(&["--threads", "1", "--simd", "fallback"]);
    assert_eq!(first.len(), 16);
    assert_eq!(first, digest(&["--threads", "2"]));
    assert_eq!(first, digest(&["--threads", "1", "--simd", "auto"]));
    assert_ne!(first, digest(&["--set", "sponges.sponge.permeability=2e-9"]), "the digest sees the state");
}

#[test]
fn a_quality_is_another_state_but_for_the_defaults() {
    let scratch = Scratch::new("qualities");
    let digest = |more: &[&str]| {
        let answer = run(&scratch, "standing", &[&["--frames", "5", "--json"], more].concat());
        assert_eq!(answer.code, Some(0), "{answer:?}");
        answer.json()["digest"].as_str().expect("text").to_owned()
    };
    let defaults = digest(&[]);
    assert_eq!(defaults, digest(&["--quality", "balanced"]));
    let fast = digest(&["--quality", "fast"]);
    assert_ne!(defaults, fast);
    // `--set` comes after the quality.
    let back = ["time.courant=0.25", "fluid.support=2", "sponges[0].iterations=4"];
    let by_hand: Vec<&str> = back.iter().flat_map(|change| ["--set", *change]).collect();
    assert_eq!(defaults, digest(&[&["--quality", "fast"], &by_hand[..]].concat()));
    assert_ne!(fast, digest(&["--quality", "accurate"]));
}
