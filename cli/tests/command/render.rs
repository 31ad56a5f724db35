//! `sorb render`: stills, animations and films of scenes, saves and recordings.

use crate::support::{Answer, Scratch, sorb};

const SMALL: [&str; 4] = ["--resolution", "0.3", "--size", "64x48"];

fn is_ok(answer: &Answer) {
    assert_eq!((answer.code, answer.err.as_str()), (Some(0), ""), "{answer:?}");
}

fn bytes(path: &str) -> Vec<u8> {
    std::fs::read(path).expect("the file is there")
}

#[test]
fn a_still_and_an_animation_of_a_scene() {
    let scratch = Scratch::new("render");
    let (still, moving) = (scratch.path("still.png"), scratch.path("moving.png"));
    is_ok(&sorb(&[&["render", "ball_drop", &still, "--start", "0.05"], &SMALL[..]].concat()));
    let answer =
        sorb(&[&["render", "ball_drop", &moving, "--end", "0.1", "--view", "nodes"], &SMALL[..]].concat());
    is_ok(&answer);
    assert!(answer.out.contains("4 pictures, 0.13 s of 64 x 48 pixels"), "{}", answer.out);
    let has = |path: &str, name: &[u8]| bytes(path).windows(4).any(|four| four == name);
    assert!(!has(&still, b"acTL") && has(&moving, b"acTL"));
}

#[cfg(feature = "film")]
#[test]
fn films_of_a_scene_in_slow_motion_of_a_save_and_of_a_recording() {
    let scratch = Scratch::new("films");
    let film = scratch.path("film.mp4");
    let slow = ["render", "ball_drop", &film, "--end", "0.05", "--slow", "4"];
    let answer = sorb(&[&slow[..], &SMALL[..]].concat());
    is_ok(&answer);
    assert!(answer.out.contains("7 pictures, 0.23 s"), "{}", answer.out);
    assert_eq!(bytes(&film)[4..8], *b"ftyp");
    let recording = scratch.path("recorded");
    is_ok(&sorb(&["record", "dry", "--resolution", "0.3", "--frames", "12", "--out", &recording]));
    let size = ["--size", "64x48"];
    let answer = sorb(&[&["render", &recording, &film, "--key", "0:0.2,0.2,0.2:0,0,0"], &size[..]].concat());
    is_ok(&answer);
    assert!(answer.out.contains("7 pictures"), "{}", answer.out);
    let out = scratch.path("out");
    is_ok(&sorb(&[
        "run",
        "dry",
        "--resolution",
        "0.3",
        "--frames",
        "6",
        "--save-every",
        "0.1",
        "--out",
        &out,
        "--quiet",
    ]));
    let save = format!("{out}/state.sorb");
    let turn = ["render", &save, &film, "--orbit", "-90", "--end", "0.2"];
    let answer = sorb(&[&turn[..], &size[..]].concat());
    is_ok(&answer);
    assert!(answer.out.contains("6 pictures, 0.20 s"), "{}", answer.out);
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let scratch = Scratch::new("not_rendered");
    let text = scratch.write("text.sorb", "no save");
    let gif = scratch.path("film.gif");
    for (arguments, word) in [
        (vec!["render", "no_such_scene"], "no_such_scene"),
        (vec!["render", &text, "film.png"], "text.sorb"),
        (vec!["render", "dry", &gif], ".png or .mp4"),
        (vec!["render", "dry", "film.png", "--key", "1:2"], "TIME:EYE:TARGET"),
        (vec!["render", "dry", "film.png", "--slow", "0"], "0.01 to 1000"),
        (vec!["render", "dry", "film.png", "--start", "2", "--end", "1"], "no pictures from 2 to 1 s"),
    ] {
        let answer = sorb(&arguments);
        assert_eq!(answer.code, Some(2), "{arguments:?}: {answer:?}");
        assert!(answer.err.contains(word), "{word} is not in {}", answer.err);
    }
}
