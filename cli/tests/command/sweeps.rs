//! `sorb sweep`: plans, shards, tables.

use std::{fs, fs::File, path::Path};

use crate::support::{Answer, Scratch, sorb};

/// Four runs of some hundred particles.
const PLAN: &str = r#"
scene = "ball_drop"
frames = 2
measures = ["absorbed_mass", "sponge_centre"]
set = ["fluid.viscosity=0.002"]
[grid]
bodies.ball.density = [2000, 5000]
resolution = [0.2, 0.3]
"#;

/// Runs a plan in a folder of the scratch, without a word.
fn sweep(scratch: &Scratch, plan: &str, out: &str, more: &[&str]) -> Answer {
    let out = scratch.path(out);
    sorb(&[&["sweep", plan, "--out", &out, "--quiet"][..], more].concat())
}

/// The table without the times of the runs.
fn table(scratch: &Scratch, out: &str) -> Vec<Vec<String>> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_path(scratch.path(&format!("{out}/table.csv")))
        .expect("the table is there");
    let rows: Result<Vec<_>, _> = reader.records().collect();
    let rows = rows.expect("rows as long as the heading");
    let time = rows[0].iter().position(|name| name == "wall_seconds").expect("a column of times");
    let without = |row: &csv::StringRecord| {
        row.iter().enumerate().filter(|(at, _)| *at != time).map(|(_, cell)| cell.to_owned()).collect()
    };
    rows.iter().map(without).collect()
}

fn assert_good(answer: &Answer) {
    assert_eq!((answer.code, answer.out.as_str(), answer.err.as_str()), (Some(0), "", ""));
}

#[test]
fn shards_leave_the_table_of_one_process() {
    let scratch = Scratch::new("sweep_shards");
    let plan = scratch.write("plan.toml", PLAN);
    assert_good(&sweep(&scratch, &plan, "whole", &[]));
    let whole = table(&scratch, "whole");
    let heading = "run bodies.ball.density resolution absorbed_mass sponge_centre_x sponge_centre_y sponge_centre_z digest error";
    assert_eq!(whole[0].join(" "), heading);
    assert_eq!(
        whole[1..].iter().map(|row| row[..3].join(" ")).collect::<Vec<_>>(),
        ["0 2000 0.2", "1 2000 0.3", "2 5000 0.2", "3 5000 0.3"]
    );

    // A run has the digest of the same scene by `sorb run`.
    let set = ["--set", "fluid.viscosity=0.002", "--set", "bodies.ball.density=5000"];
    let out = scratch.path("run");
    let run = ["run", "ball_drop", "--frames", "2", "--resolution", "0.3", "--json", "--out", &out];
    let summary = sorb(&[&run[..], &set].concat());
    assert_eq!(summary.json()["digest"].as_str(), Some(whole[4][7].as_str()));
    assert!(summary.out.contains(&format!("\"absorbed_mass_kg\": {},", whole[4][3])), "{}", summary.out);

    // What is missing is named, and there is no table until it is there.
    assert_good(&sweep(&scratch, &plan, "parts", &["--shard", "1/3"]));
    let early = sweep(&scratch, &plan, "parts", &["--collect"]);
    assert_eq!(early.code, Some(1));
    assert!(early.err.contains("3 of 4 runs are missing: 0, 2, 3"), "{}", early.err);
    assert_good(&sweep(&scratch, &plan, "parts", &["--shard", "2/3", "--threads", "1"]));
    assert!(!Path::new(&scratch.path("parts/table.csv")).exists());
    assert_good(&sweep(&scratch, &plan, "parts", &["--shard", "0/3", "--simd", "fallback"]));
    assert_eq!(table(&scratch, "parts"), whole);
    // Shards of another number find what is there: nothing is twice.
    let before = scratch.read("parts/table.csv");
    assert_good(&sweep(&scratch, &plan, "parts", &["--shard", "0/2"]));
    fs::remove_file(scratch.path("parts/table.csv")).expect("the table can be removed");
    assert_good(&sweep(&scratch, &plan, "parts", &["--collect"]));
    assert_eq!(scratch.read("parts/table.csv"), before);
}

#[test]
fn a_sweep_continues_where_it_was_killed() {
    let scratch = Scratch::new("sweep_restart");
    let plan = scratch.write("plan.toml", PLAN);
    assert_good(&sweep(&scratch, &plan, "out", &[]));
    let whole = table(&scratch, "out");
    let part = "out/part_0_of_1.jsonl";
    let lines: Vec<String> = scratch.read(part).lines().map(str::to_owned).collect();
    // The first run is marked, the second one was being written.
    let marked = lines[1].replace("\"measures\":[\"", "\"measures\":[\"7.5\",\"");
    scratch.write(part, &format!("{}\n{marked}\n{}", lines[0], &lines[2][..40]));
    assert_good(&sweep(&scratch, &plan, "out", &[]));
    let again = table(&scratch, "out");
    assert_eq!((again[1][3].as_str(), &again[2..]), ("7.5", &whole[2..]));
    assert_eq!(scratch.read(part).lines().count(), 5);

    // The parts are of this plan alone, and of one process at a time.
    let other = scratch.write("plan.toml", &PLAN.replace("frames = 2", "frames = 1"));
    let refused = sweep(&scratch, &other, "out", &[]);
    assert_eq!(refused.code, Some(2));
    assert!(refused.err.contains("part_0_of_1.jsonl: is of another plan"), "{}", refused.err);
    let plan = scratch.write("plan.toml", PLAN);
    let file = File::options().append(true).open(scratch.path(part)).expect("the part is there");
    file.try_lock().expect("nobody else has it");
    let refused = sweep(&scratch, &plan, "out", &[]);
    assert!(refused.code == Some(2) && refused.err.contains("another process"), "{}", refused.err);
    drop(file);
    assert_good(&sweep(&scratch, &plan, "out", &[]));
    // A machine that computes otherwise is found.
    scratch.write(
        "out/part_1_of_2.jsonl",
        &format!("{}\n{}\n", lines[0], lines[2].replace("\"digest\":\"", "\"digest\":\"f")),
    );
    let differs = sweep(&scratch, &plan, "out", &["--collect"]);
    assert!(differs.code == Some(1) && differs.err.contains("run 1 has two results"), "{}", differs.err);
}

#[test]
fn a_run_that_fails_is_a_row_with_its_error() {
    let scratch = Scratch::new("sweep_failure");
    // Water in free fall asks for a step below the second bound.
    let text = "scene = \"water\"\nframes = 2\nresolution = 0.4\nmeasures = [\"time\"]\n\
                set = ['domain={kind=\"open\"}', \"fluid.solver=wcsph\"]\n\
                grid.time.minimum_step = [1e-6, 0.0005]\n";
    let plan = scratch.write("plan.toml", text);
    for _ in 0..2 {
        let answer = sweep(&scratch, &plan, "out", &[]);
        assert_eq!(answer.code, Some(1));
        assert!(answer.err.contains("1 of 2 runs failed, the first is run 1: "), "{}", answer.err);
        assert!(answer.err.contains("time.minimum_step"), "{}", answer.err);
    }
    let rows = table(&scratch, "out");
    assert_eq!(rows[1][1], "1e-6");
    assert!(!rows[1][3].is_empty() && rows[1][4].is_empty());
    assert!(rows[2][2].is_empty() && rows[2][3].is_empty() && rows[2][4].contains("time.minimum_step"));
    // It was run again, and the good one was not.
    assert_eq!(scratch.read("out/part_0_of_1.jsonl").lines().count(), 4);
}

#[test]
fn wrong_plans_are_found_before_anything_runs() {
    let scratch = Scratch::new("sweep_wrong");
    for (text, expected) in [
        ("scene = \"bal_drop\"\ngrid = {}", vec!["did you mean `ball_drop`"]),
        (
            "scene = \"dry\"\ngrid = { resolution = [1, 100] }",
            vec!["plan.toml: run 1 (resolution = 100)", "resolution"],
        ),
        (
            "scene = \"dry\"\ngrid.sponges.sponge.edge = [0.01, -1]",
            vec!["plan.toml: run 1", "sponges[0].edge", "out of range"],
        ),
        ("scene = \"dry\"\ngrid = { quality = [\"best\"] }", vec!["plan.toml: run 0", "quality", "best"]),
        (
            "scene = \"dry\"\ngrid = { resolution = [\"fine\"] }",
            vec!["plan.toml: run 0", "`resolution` = \"fine\" is a string"],
        ),
        (
            "scene = \"dry\"\nset = [\"sponges.spong.edge=1\"]\ngrid = {}",
            vec!["plan.toml: run 0", "did you mean `sponge`"],
        ),
        ("scene = \"dry\"\nframe = 3\ngrid = {}", vec!["plan.toml", "line 2", "unknown field `frame`"]),
        ("scene = \"dry\"\n[grid\n", vec!["plan.toml", "line 2"]),
    ] {
        let plan = scratch.write("plan.toml", text);
        let answer = sweep(&scratch, &plan, "out", &[]);
        assert_eq!(answer.code, Some(2), "{text}: {}", answer.err);
        for part in expected {
            assert!(answer.err.contains(part), "{text}: {}", answer.err);
        }
    }
    // That of the documents has no mistake: nothing of it has run.
    let example = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/permeability.toml");
    let answer = sweep(&scratch, example, "", &["--collect"]);
    assert!(answer.err.contains("6 of 6 runs are missing"), "{}", answer.err);
    let plan = scratch.path("none.toml");
    assert!(sweep(&scratch, &plan, "out", &[]).err.contains("none.toml"));
    assert!(!Path::new(&scratch.path("out")).exists());
    let plan = scratch.write("plan.toml", PLAN);
    for wrong in [&["--shard", "2/2"][..], &["--shard", "0/2", "--collect"]] {
        assert_eq!(sweep(&scratch, &plan, "out", wrong).code, Some(2), "{wrong:?}");
    }
    // The control: without a mistake it runs. A scene that is a file lies beside its plan.
    scratch.write("own.toml", "version = 1\nname = \"own\"\n[time]\nduration = 0.05\n");
    let plan = scratch
        .write("plan.toml", "scene = \"own.toml\"\nmeasures = [\"time\"]\ngrid.gravity = [[0, -9.81, 0]]\n");
    assert_good(&sweep(&scratch, &plan, "out", &[]));
    let rows = table(&scratch, "out");
    let time: f64 = rows[1][2].parse().expect("a number");
    assert!(rows[1][1] == "[0,-9.81,0]" && (time - 0.05).abs() < 1e-6, "{rows:?}");
}
