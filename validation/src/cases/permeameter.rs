//! Water sinks through a plug of sponge: Darcy's law with a falling head.

use super::duct::{Duct, pores};
use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    norms::line,
    references::darcy::Pores,
};

/// Falling head.
pub(super) static CASE: Case = Case {
    name: "permeameter",
    title: "a column of water sinks through a soaked plug, at three permeabilities",
    source: "ln(h + L) falls by K rho g / (mu L) (Darcy)",
    subject: Subject::Coupling,
    control: "a permeability 1.3 times as high",
    run,
};

/// Length of the plug in cells of full resolution.
const CELLS: u32 = 4;
/// Height of the water above the plug, and space below it \[m\].
const HEAD: f64 = 0.06;
const BELOW: f64 = 0.05;
/// Gravity \[m/s^2\].
const GRAVITY: f64 = 9.81;

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let duct = Duct::new(setting, CELLS);
    let mut figures = Vec::new();
    for permeability in setting.pick(&[1e-8, 3e-9, 1e-9][..], &[3e-9][..]) {
        let found = measured(setting, &duct, *permeability)?;
        let name = format!("permeability for {permeability:.0e}");
        figures.push(Figure::relative(name, "m^2", *permeability, found, 0.02));
    }
    Ok(figures)
}

fn measured(setting: &Setting, duct: &Duct, permeability: f64) -> Result<f64, Failure> {
    let pores = pores(permeability, 0.0);
    let given = Pores { permeability: setting.planted(1.0, 1.3) * permeability, ..pores };
    let top = duct.top();
    let water = [(top, top + HEAD)];
    let mut scene = duct.scene(setting, &given, GRAVITY, (-BELOW, top + HEAD + 0.02), &water)?;
    scene.sponges[0].saturation = 1.0;
    scene.time.frame_rate = 200.0;
    let mut world = setting.world(&scene)?;
    let decay = permeability * pores.density * GRAVITY / (pores.viscosity * duct.length());
    let particle = duct.spacing.powi(3) / duct.area();
    // From four fifths of the head to a quarter of it, so that the start does not matter.
    let mut points = Vec::new();
    let limit = 3.0 / decay;
    while world.clock().time < limit {
        setting.advance(&mut world)?;
        let above = world.particle_positions().iter().filter(|row| f64::from(row[1]) > top).count();
        let head = particle * above as f64;
        if head < 0.25 * HEAD {
            break;
        }
        if head < 0.8 * HEAD {
            points.push((world.clock().time, libm::log(head + duct.length())));
        }
    }
    if points.len() < 5 {
        return Err(Failure::Nothing(format!("the head does not fall evenly at {permeability:e}")));
    }
    Ok(pores.from_falling_head(GRAVITY, duct.length(), -line(&points).0))
}
