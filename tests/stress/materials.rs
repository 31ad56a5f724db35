//! Time steps, and material constants of sponge and water, over all decades.

use sorb::{glam::Vec3, scene::Scene};

use crate::{
    case::{Case, table},
    common, pick,
    scenes::{WAVE, dry, pool, wet, with_ball},
};

/// Powers of ten, all of them in the long form, else some.
fn decades(short: &[i32], all: std::ops::RangeInclusive<i32>) -> Vec<i32> {
    pick(short.to_vec(), all.collect())
}

fn with(scene: &Scene, keys: &[String]) -> Scene {
    let keys: Vec<&str> = keys.iter().map(String::as_str).collect();
    common::with(scene, &keys)
}

#[test]
fn steps_that_are_ten_and_a_hundred_times_too_long() {
    let mut cases = Vec::new();
    for scene in [with_ball(wet(), 500.0, 0.0), with_ball(dry(), 500.0, 0.0), pool()] {
        for (name, step, courant, rate) in [
            ("10 times the longest step", 0.04, 0.25, 60),
            ("longest step and Courant number that a scene may have", 0.1, 1.0, 60),
            ("one frame a second", 0.1, 1.0, 1),
            ("10 000 frames a second", 0.004, 0.25, 10_000),
        ] {
            let keys = [
                format!("time.maximum_step={step}"),
                format!("time.courant={courant:?}"),
                format!("time.frame_rate={rate}"),
            ];
            cases.push(Case::new(format!("{}: {name}", scene.name), with(&scene, &keys), pick(0.3, 3.0)));
        }
    }
    table(cases);
}

#[test]
fn stiffness_over_seven_decades() {
    let mut cases = Vec::new();
    for exponent in decades(&[1, 4, 7], 1..=8) {
        for scene in [wet(), dry()] {
            let name = format!("{}: Young's modulus 1e{exponent} Pa", scene.name);
            let scene =
                with_ball(with(&scene, &[format!("sponges[0].young_modulus=1e{exponent}")]), 500.0, 0.0);
            // Stiff sponges take short steps.
            let seconds = if exponent > 5 { pick(0.05, 0.5) } else { pick(0.3, 2.0) };
            // The softest ones are crushed flat, and water leaves them fast.
            cases.push(Case { fastest: 4.0, ..Case::new(name, scene, seconds) });
        }
    }
    table(cases);
}

#[test]
fn viscosity_over_six_decades() {
    let mut cases = Vec::new();
    for exponent in decades(&[-3, 0, 3], -3..=3) {
        let scene = with(&wet(), &[format!("fluid.viscosity=1e{exponent}")]);
        // The step falls with the viscosity: it is explicit.
        let seconds = if exponent > 1 { pick(0.01, 0.05) } else { pick(0.2, 2.0) };
        cases.push(Case::new(
            format!("wet: viscosity 1e{exponent} Pa s"),
            with_ball(scene, 2000.0, 0.0),
            seconds,
        ));
    }
    table(cases);
}

#[test]
fn implicit_viscosity_over_six_decades() {
    let mut cases = Vec::new();
    for exponent in decades(&[-3, 0, 3], -3..=3) {
        for sticks in [false, true] {
            let scene = with_ball(wet(), 2000.0, 0.0);
            let keys = [
                format!("fluid.viscosity=1e{exponent}"),
                "fluid.viscosity_integration=\"implicit\"".to_owned(),
                format!("fluid.no_slip={sticks}"),
                format!("bodies[0].no_slip={sticks}"),
            ];
            let name = if sticks { ", sticks to walls and ball" } else { "" };
            cases.push(Case::new(
                format!("wet: implicit viscosity 1e{exponent} Pa s{name}"),
                with(&scene, &keys),
                pick(0.1, 2.0),
            ));
        }
    }
    table(cases);
}

#[test]
fn permeability_over_nine_decades() {
    let mut cases = Vec::new();
    for exponent in decades(&[-14, -11, -8, -5], -14..=-5) {
        let scene = with(&wet(), &[format!("sponges[0].permeability=1e{exponent}")]);
        let name = format!("wet: permeability 1e{exponent} m^2");
        let case = Case::new(name, with_ball(scene, 2000.0, 0.0), pick(0.3, 2.0));
        // Where drag does not carry the ball, nodes spring back after it.
        let fastest = if exponent > -8 { 0.5 * WAVE } else { case.fastest };
        cases.push(Case { fastest, ..case });
    }
    table(cases);
}

#[test]
fn gravity_from_everywhere() {
    let mut cases = Vec::new();
    for gravity in [Vec3::Y * 100.0, Vec3::NEG_Y * 100.0, Vec3::new(-100.0, 0.0, 100.0), Vec3::ZERO] {
        let mut scene = wet();
        scene.gravity = gravity;
        // Heights count against gravity and may start below zero: the exchanged energy is that of the fall through the box.
        let case = Case::new(format!("wet: gravity {gravity} m/s^2"), scene, pick(0.2, 2.0));
        cases.push(Case { fastest: WAVE, excess: (gravity.length() < 1.0).then_some(0.05), ..case });
    }
    table(cases);
}
