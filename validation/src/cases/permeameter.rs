//! Water seeps through a plug of sponge: Darcy's law with a falling head, and the drag of fast water.

use super::duct::{Duct, pores};
use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    norms::{line, mean},
    references::darcy::{Forchheimer, Pores},
};

/// Falling head.
pub(super) static CASE: Case = Case {
    name: "permeameter",
    title: "a column of water sinks through a soaked plug, at three permeabilities",
    source: "ln(h + L) falls by K rho g / (mu L) (Darcy); -grad p = mu q / K + rho c q^2 / sqrt(K) (Forchheimer)",
    subject: Subject::Coupling,
    control: "a permeability 1.3 times as high",
    run,
};

/// Length of the plug \[m\], and cells across it at full resolution and in a quick run.
///
/// A face of the plug is as wide as the smoothing of its nodes. Water in the lower half of the lower face seeps without
/// pressure, as if the plug ended there. The flow is too large by a share that falls with the number of cells.
const LENGTH: f64 = 0.04;
const ACROSS: (u32, u32) = (10, 4);
/// Height of the water above the plug, and space below it \[m\].
const HEAD: f64 = 0.06;
const BELOW: f64 = 0.05;
/// Gravity \[m/s^2\].
const GRAVITY: f64 = 9.81;

/// Permeability \[m^2\] and Forchheimer coefficient at which most of the drag is inertial.
const INERTIAL: (f64, f64) = (1e-8, 0.5);
/// Heads at which its drag is measured, over the initial one, and the range around them.
const HEADS: [f64; 3] = [0.7, 0.5, 0.3];
const AROUND: f64 = 0.1;

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let duct = Duct::new(setting, LENGTH, setting.pick(ACROSS.0, ACROSS.1));
    let mut figures = Vec::new();
    for permeability in setting.pick(&[1e-8, 3e-9, 1e-9][..], &[3e-9][..]) {
        let found = slow(setting, &duct, *permeability)?;
        let name = format!("permeability for {permeability:.0e}");
        figures.push(Figure::relative(name, "m^2", *permeability, found, 0.02));
    }
    figures.extend(fast(setting, &duct)?);
    Ok(figures)
}

/// Permeability by the falling head, without inertial drag.
fn slow(setting: &Setting, duct: &Duct, permeability: f64) -> Result<f64, Failure> {
    let pores = pores(permeability, 0.0);
    // From four fifths of the head to a quarter of it, so that the start does not matter.
    let heads = heads(setting, duct, &pores, 0.0)?
        .into_iter()
        .filter(|point| (0.25 * HEAD..0.8 * HEAD).contains(&point.1));
    let columns: Vec<_> = heads.map(|(time, head)| (time, head + duct.top())).collect();
    enough(&columns, permeability)?;
    let logarithms: Vec<_> = columns.iter().map(|(time, column)| (*time, libm::log(*column))).collect();
    let column = mean(columns.iter().map(|point| point.1));
    Ok(pores.from_falling_head(GRAVITY, duct.top(), column, -line(&logarithms).0))
}

/// Drag over speed of fast water, at some heads.
fn fast(setting: &Setting, duct: &Duct) -> Result<Vec<Figure>, Failure> {
    let (permeability, coefficient) = INERTIAL;
    let forchheimer = Forchheimer { pores: pores(permeability, 0.0), coefficient };
    let heads = heads(setting, duct, &forchheimer.pores, coefficient)?;
    let length = duct.top();
    let figure = |share: &f64| {
        let near = |point: &&(f64, f64)| (point.1 / HEAD - share).abs() < AROUND;
        let around: Vec<_> = heads.iter().filter(near).copied().collect();
        enough(&around, permeability)?;
        let (flow, head) = (-line(&around).0, share * HEAD);
        let measured = forchheimer.pores.density * GRAVITY * (head + length) / (length * flow);
        let reference = forchheimer.drag(forchheimer.flow(GRAVITY, length, head));
        let name = format!("drag over speed, Forchheimer {coefficient}, head {:.0} mm", 1e3 * head);
        Ok(Figure::relative(name, "Pa s/m^2", reference, measured, 0.05))
    };
    HEADS.iter().map(figure).collect()
}

fn enough(points: &[(f64, f64)], permeability: f64) -> Result<(), Failure> {
    if points.len() < 5 {
        return Err(Failure::Nothing(format!("the head does not fall evenly at {permeability:e}")));
    }
    Ok(())
}

/// Time and height of the water above the plug, down to a fifth of that at first \[s, m\].
fn heads(
    setting: &Setting,
    duct: &Duct,
    pores: &Pores,
    forchheimer: f64,
) -> Result<Vec<(f64, f64)>, Failure> {
    let given = Pores { permeability: setting.planted(1.0, 1.3) * pores.permeability, ..*pores };
    let top = duct.top();
    let water = [(top, top + HEAD)];
    let mut scene = duct.scene(setting, &given, GRAVITY, (-BELOW, top + HEAD + 0.02), &water)?;
    scene.sponges[0].saturation = 1.0;
    scene.sponges[0].forchheimer = forchheimer as f32;
    scene.time.frame_rate = 200.0;
    let mut world = setting.world(&scene)?;
    // Three times as long as without inertial drag, or with it at the mean head.
    let flow = Forchheimer { pores: *pores, coefficient: forchheimer }.flow(GRAVITY, duct.top(), 0.5 * HEAD);
    let limit = 3.0 * (HEAD + duct.top()) / flow;
    let particle = duct.spacing.powi(3) / duct.area();
    let mut points = Vec::new();
    while world.clock().time < limit {
        setting.advance(&mut world)?;
        let above = world.particle_positions().iter().filter(|row| f64::from(row[1]) > top).count();
        let head = particle * above as f64;
        if head < 0.2 * HEAD {
            break;
        }
        points.push((world.clock().time, head));
    }
    Ok(points)
}
