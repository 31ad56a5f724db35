//! What a program without a feature refuses, and how it says where the feature is.
//!
//! A program that has the feature is no subject of these tests. There they ask for one that lacks it: the variable
//! `SORB_WITHOUT_FEATURES` has its path.

use std::path::Path;

use crate::support::{Answer, Scratch, run};

fn refused(arguments: &[&str]) -> Answer {
    let other = std::env::var_os("SORB_WITHOUT_FEATURES");
    let program = other.as_deref().map_or(Path::new(env!("CARGO_BIN_EXE_sorb")), Path::new);
    let answer = run(program, arguments);
    assert_eq!(answer.code, Some(2), "{answer:?}");
    answer
}

#[cfg_attr(feature = "gpu", ignore = "needs SORB_WITHOUT_FEATURES")]
#[test]
fn a_gpu() {
    for backend in ["gpu", "from:sph::kick"] {
        let answer = refused(&["run", "water", "--frames", "0", "--backend", backend]);
        for part in [backend, "built without the feature"] {
            assert!(answer.err.contains(part), "{part} is not in {}", answer.err);
        }
    }
}

#[cfg_attr(feature = "view", ignore = "needs SORB_WITHOUT_FEATURES")]
#[test]
fn the_window() {
    let answer = refused(&["view", "standing", "--paused"]);
    assert!(answer.err.contains("--features view -- view standing --paused"), "{answer:?}");
}

#[cfg_attr(feature = "validation", ignore = "needs SORB_WITHOUT_FEATURES")]
#[test]
fn the_references() {
    let answer = refused(&["validate", "--quick", "dam_break"]);
    assert!(answer.err.contains("--features validation -- validate --quick dam_break"), "{answer:?}");
}

#[cfg_attr(feature = "surface", ignore = "needs SORB_WITHOUT_FEATURES")]
#[test]
fn meshes_of_water() {
    let scratch = Scratch::new("no_surface");
    let out = scratch.path("out");
    let answer = refused(&["run", "dry", "--frames", "0", "--out", &out, "--export", "surface"]);
    assert!(answer.err.contains("--features surface"), "{}", answer.err);
    assert!(!Path::new(&out).exists(), "a refused run leaves nothing");
}
