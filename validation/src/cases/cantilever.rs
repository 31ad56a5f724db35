//! A bar that is held at one end sags and vibrates.

use sorb::glam::{DVec3, UVec3};

use super::bar::{Bar, FOAM, against_elements, even, settled};
use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    fem::{Energy, Model},
    norms::{mean, upward_crossings},
    references::beam::{cantilever_frequency, cantilever_sag},
    solver::Material,
};

/// Sag under the own weight.
pub(super) static CANTILEVER: Case = Case {
    name: "cantilever",
    title: "a bar held at one end sags under its own weight",
    source: "converged elements on the same tets; Timoshenko",
    subject: Subject::Sponge,
    control: "Young's modulus a third too low",
    run: sag,
};

/// Free vibration.
pub(super) static VIBRATION: Case = Case {
    name: "vibration",
    title: "a bar held at one end swings without damping",
    source: "lowest mode of the same tets; Euler and Bernoulli",
    subject: Subject::Sponge,
    control: "Young's modulus a third too low",
    run: swing,
};

/// Cells over the thickness, and length over thickness.
const THICKNESS: u32 = 8;
const SLENDERNESS: u32 = 4;

fn bar(setting: &Setting, gravity: f64) -> Bar {
    let thickness = even(setting, setting.pick(THICKNESS, THICKNESS / 2));
    let young = FOAM.young * setting.planted(1.0, 2.0 / 3.0);
    let material = Material { young, ..FOAM };
    Bar { cells: UVec3::new(SLENDERNESS * thickness, thickness, thickness), gravity, material }
}

fn sag(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    // Weak gravity, so that the sag is small compared with the length at any thickness.
    let bar = bar(setting, -9.81 / f64::from(bar(setting, 0.0).cells.y));
    // Damping does not change the equilibrium. It improves the mean over a remaining vibration.
    let scene = bar.scene("cantilever", setting)?.with_overrides(["sponges[0].damping=0.02"])?;
    let mut world = setting.world(&scene)?;
    let seconds = setting.pick(10.0, 5.0);
    let measured = settled(setting, &mut world, seconds, 0.2 * seconds)?;
    let (model, reference, figure) = against_elements(&world, setting, &FOAM, &measured, |_| [false; 3])?;
    let end = bar.section(&world, bar.size().x);
    let tip = |positions: &[DVec3]| mean(end.iter().map(|node| model.rest[*node].y - positions[*node].y));
    let weight = model.mass.iter().sum::<f64>() * -bar.gravity;
    let beam = cantilever_sag(&FOAM, bar.size().x, bar.size().y, weight);
    Ok(vec![
        figure,
        Figure::relative("sag of the tip against elements", "m", tip(&reference), tip(&measured), 5e-3),
        Figure::relative("sag of the tip against Timoshenko", "m", beam, tip(&measured), 0.05),
    ])
}

fn swing(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let bar = bar(setting, -9.81 / f64::from(bar(setting, 0.0).cells.y));
    let scene = bar.scene("vibration", setting)?.with_overrides(["sponges[0].damping_time=0"])?;
    let mut world = setting.world(&scene)?;
    let model = Model::of(&world, Energy::of(&FOAM, &setting.solvers));
    let end = bar.section(&world, bar.size().x);
    let expected = model.lowest_frequency(&model.rest, DVec3::Y)?;
    let periods = 6.0;
    let mut samples = Vec::new();
    while world.clock().time < periods / expected {
        setting.advance(&mut world)?;
        let height = mean(end.iter().map(|node| f64::from(world.node_positions()[*node][1])));
        samples.push((world.clock().time, height));
    }
    // It starts at the top of its vibration, whose middle is the sag.
    let level = mean(samples.iter().map(|sample| sample.1));
    let crossings = upward_crossings(&samples, level);
    let [first, .., last] = &crossings[..] else {
        return Err(Failure::Nothing("the bar does not swing".to_owned()));
    };
    let frequency = (crossings.len() - 1) as f64 / (last - first);
    let largest = |part: &[(f64, f64)]| part.iter().map(|s| (s.1 - level).abs()).fold(0.0, f64::max);
    let (early, late) = samples.split_at(samples.len() / 3);
    let kept = largest(&late[late.len() / 2..]) / largest(early);
    let mass = model.mass.iter().sum();
    let beam = cantilever_frequency(&FOAM, bar.size().x, bar.size().y, mass);
    Ok(vec![
        Figure::relative("frequency against the lowest mode", "1/s", expected, frequency, 5e-3),
        Figure::relative("frequency against a beam", "1/s", beam, frequency, 0.05),
        Figure::relative("swing that is left after four periods", "1", 1.0, kept, 0.1),
    ])
}
