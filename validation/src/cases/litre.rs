//! A litre of water weighs a kilogram, and stands as high as it should in tanks of any size.

use sorb::{
    World,
    glam::Vec3,
    scene::{Fluid, FluidBlock, Scene},
};

use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    level::heights,
    norms::mean,
};

/// Mass and level.
pub(super) static CASE: Case = Case {
    name: "litre",
    title: "mass of a litre of water, and its level in tanks that are no multiples of the spacing wide",
    source: "mass over density and area",
    subject: Subject::Water,
    control: "blocks a tenth higher",
    run,
};

/// Side of the litre, and spacing \[m\].
const SIDE: f64 = 0.1;
const PARTICLES: u32 = 20;
/// Widths of tanks in spacings; the first is filled exactly.
const WIDTHS: [f64; 4] = [20.0, 15.25, 15.5, 15.75];
/// Depth of the water in the others, in spacings.
const LAYERS: f64 = 13.0;
/// Mass of a litre \[kg\].
const MASS: f64 = 1.0;
const DENSITY: f64 = 1000.0;
const GRAVITY: f64 = 9.81;

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let spacing = SIDE / f64::from(setting.count(setting.pick(PARTICLES, PARTICLES / 2)));
    let mut figures = Vec::new();
    for (index, width) in setting.pick(&WIDTHS[..], &WIDTHS[..2]).iter().enumerate() {
        // Quick runs have half as many particles over a side.
        let width = if index == 0 { SIDE } else { width * spacing };
        let depth = if index == 0 { SIDE } else { LAYERS * spacing };
        let mut world = setting.world(&scene(setting, width, depth, spacing))?;
        let mass = world.measures().water_mass;
        if index == 0 {
            figures.push(Figure::relative("mass of a litre", "kg", MASS, mass, 2e-3));
        }
        for _ in 0..setting.pick(60, 30) {
            setting.advance(&mut world)?;
        }
        // What was asked for, less what does not fill a row.
        let rows = |length: f64| (length / spacing + 0.01).floor() * spacing;
        let expected = rows(width) * rows(width) * rows(depth) / (width * width);
        figures.push(Figure::over(
            format!("level in a tank of {:.2} spacings, error over spacings", width / spacing),
            "m",
            (expected, level(&world, width, spacing)?),
            spacing,
            0.3,
        ));
    }
    Ok(figures)
}

fn level(world: &World, width: f64, spacing: f64) -> Result<f64, Failure> {
    let half = 0.5 * width - 2.0 * spacing;
    let at = |index: i32| half * f64::from(index) / 4.0;
    let points: Vec<_> = (-4..=4).flat_map(|x| (-4..=4).map(move |z| (at(x), at(z)))).collect();
    let found = heights(world, &points);
    if found.is_empty() {
        return Err(Failure::Nothing("no water above the floor".to_owned()));
    }
    Ok(mean(found))
}

fn scene(setting: &Setting, width: f64, depth: f64, spacing: f64) -> Scene {
    let half = (0.5 * width) as f32;
    let minimum = Vec3::new(-half, 0.0, -half);
    let depth = depth * setting.planted(1.0, 1.1);
    let fluid = Fluid {
        spacing: spacing as f32,
        rest_density: DENSITY as f32,
        blocks: vec![FluidBlock::new(minimum, Vec3::new(half, depth as f32, half))],
        ..Fluid::default()
    };
    Scene { gravity: Vec3::new(0.0, -GRAVITY as f32, 0.0), ..Scene::new("litre") }
        .in_box(minimum, Vec3::new(half, 1.5 * depth as f32, half))
        .with_fluid(fluid)
}
