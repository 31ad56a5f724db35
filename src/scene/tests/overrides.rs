use glam::Vec3;

use super::super::*;
use super::full;

fn set(text: &str) -> Scene {
    let mut scene = full();
    scene.set(text).unwrap_or_else(|error| panic!("{error}"));
    scene
}

fn refused(text: &str) -> String {
    let mut scene = full();
    let error = scene.set(text).expect_err(text);
    assert_eq!(scene, full(), "a refused override changes nothing");
    error.to_string()
}

#[test]
fn keys_can_be_written_in_three_ways() {
    for key in ["sponges.0.permeability", "sponges[0].permeability", "sponges.sponge.permeability"] {
        let scene = set(&format!("{key}=1e-10"));
        assert_eq!(scene.sponges[0].permeability, 1e-10);
        assert_eq!(scene.sponges[0].edge, full().sponges[0].edge, "nothing else changes");
    }
    assert_eq!(set("gravity.1 = -1.6").gravity.y, -1.6);
    assert_eq!(
        set("fluid.blocks[0].maximum=[0.1, 0.02, 0.1]").fluid.expect("kept").blocks[0].maximum.y,
        0.02
    );
}

#[test]
fn absent_keys_are_added_and_tables_replaced() {
    assert_eq!(set("fluid.sound_speed=12").fluid.expect("kept").sound_speed, Some(12.0));
    assert_eq!(set("camera.eye=[1, 1, 1]").camera.map(|camera| camera.eye), Some(Vec3::ONE));
    assert_eq!(set("domain={kind=\"open\"}").domain, Domain::Open);
    assert_eq!(set("title=A new title").title, "A new title");
    assert_eq!(
        set("fluid.equation_of_state=linear").fluid.expect("kept").equation_of_state,
        EquationOfState::Linear
    );
}

#[test]
fn bad_overrides_are_refused() {
    for (text, expected) in [
        ("fluid.spacing", "override `fluid.spacing`: expected KEY=VALUE"),
        ("sponges..edge=1", "expected a key such as"),
        ("sponges.0.permeabilty=1e-9", "unknown key `sponges[0].permeabilty`; did you mean `permeability`?"),
        ("fluyd.spacing=0.01", "unknown key `fluyd`; did you mean `fluid`?"),
        ("sponges.3.edge=1", "`sponges` has 1 elements, numbered from 0"),
        ("sponges.sponje.edge=1", "`sponges` has no element named `sponje`; did you mean `sponge`?"),
        ("time.courant.x=1", "`time.courant` is a single value and has no `x`"),
        ("fluid.spacing=[1", "the value is not TOML"),
        ("fluid.spacing=", "the value is not TOML"),
        ("fluid.spacing=0.004\nfluid.support=2", "expected one value"),
        ("time.courant=0.2\nx = 1", "expected one value"),
        ("fluid.spacing=wide", "`fluid.spacing` = \"wide\" is text; expected a number"),
        ("fluid.spacing=3", "`fluid.spacing` = 3 is out of range 1e-4 to 1 m"),
    ] {
        let error = refused(text);
        assert!(error.contains(expected), "{text}\n{error}\n{expected}");
    }
}

#[test]
fn several_overrides_only_need_a_valid_result() {
    let scene = full();
    let moved = ["domain.minimum=[1, 1, 1]", "domain.maximum=[3, 3, 3]"];
    assert!(scene.with_overrides(moved).is_err(), "the water is no longer inside");
    let shifted =
        scene.with_overrides(["time.minimum_step=0.05", "time.maximum_step=0.06"]).expect("valid together");
    assert_eq!(shifted.time.minimum_step, 0.05);
    assert!(scene.with_overrides(["time.minimum_step=0.05"]).is_err(), "but not alone");
}
