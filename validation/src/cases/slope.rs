//! Water on a rough slope: it flows, however little it is inclined.

use sorb::{
    World,
    glam::Vec3,
    scene::{Body, Fluid, FluidBlock, Scene, ShapeKind},
};

use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    norms::mean,
};

/// A slope without ends.
pub(super) static CASE: Case = Case {
    name: "slope",
    title: "ten centimetres of water over a ribbed bed that is inclined, by a few stresses on the bed up to those of 1 %",
    source: "u = g s t until friction is felt: nothing else holds the water above the ribs",
    subject: Subject::Water,
    control: "no slope",
    run,
};

/// Water above the ribs \[m\].
const DEPTH: f64 = 0.1;
/// Layers of particles over it.
const LAYERS: u32 = 20;
/// Height and width of a rib, their distance, and width of what repeats across, in spacings.
const RIB: [f64; 2] = [3.0, 4.0];
const APART: f64 = 16.0;
const ACROSS: f64 = 8.0;
/// Stresses of the water's weight along the slope on the ribs \[Pa\]; the last is that of a slope of 1 %.
const STRESSES: [f64; 3] = [0.5, 2.0, 9.81];
/// Lack of speed over that of a frictionless slope that is in bounds.
const BOUND: f64 = 0.2;
/// Stress that may hold the water \[Pa\].
const YIELD: f64 = 0.5;
/// Time that is watched \[s\], long against that in which the lattice that the water begins with bends, short against drag.
const TIME: f64 = 1.0;
const GRAVITY: f64 = 9.81;

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let spacing = DEPTH / f64::from(setting.count(setting.pick(LAYERS, LAYERS / 2)));
    let mut figures = Vec::new();
    let mut resisting = 0.0_f64;
    for stress in setting.pick(&STRESSES[..], &[STRESSES[0], STRESSES[2]]) {
        let slope = stress / (1000.0 * GRAVITY * DEPTH);
        let share = flow(setting, spacing, slope)?;
        figures.push(Figure {
            name: format!("speed at a stress of {stress} Pa, over that without friction"),
            unit: "1",
            reference: 1.0,
            measured: share,
            error: (1.0 - share).abs(),
            bound: BOUND,
        });
        resisting = resisting.max(stress * (1.0 - share));
    }
    figures.push(Figure::error("resisting stress, largest", "Pa", resisting, YIELD));
    Ok(figures)
}

/// Mean speed of the upper half of the water at the end, over that of a frictionless slope.
fn flow(setting: &Setting, spacing: f64, slope: f64) -> Result<f64, Failure> {
    let mut world = setting.world(&scene(setting, spacing, slope))?;
    let mut speeds = Vec::new();
    while world.clock().time < TIME {
        setting.advance(&mut world)?;
        // The pool breathes as it settles: a tenth of a second evens that out.
        if world.clock().time > TIME - 0.1 {
            speeds.push(
                upper_speed(&world, RIB[0] * spacing + 0.5 * DEPTH) / (GRAVITY * slope * world.clock().time),
            );
        }
    }
    Ok(mean(speeds))
}

fn upper_speed(world: &World, above: f64) -> f64 {
    let rows = world.particle_positions().iter().zip(world.particle_velocities());
    mean(rows.filter(|(x, _)| f64::from(x[1]) > above).map(|(_, v)| f64::from(v[0])))
}

fn scene(setting: &Setting, spacing: f64, slope: f64) -> Scene {
    let half = Vec3::new((0.5 * APART * spacing) as f32, 0.0, (0.5 * ACROSS * spacing) as f32);
    let rib =
        Vec3::new((0.5 * RIB[1] * spacing) as f32, (0.5 * RIB[0] * spacing) as f32, half.z + spacing as f32);
    let level = (DEPTH + RIB[0] * spacing) as f32;
    let fluid = Fluid {
        spacing: spacing as f32,
        blocks: vec![FluidBlock::new(-half, half + Vec3::Y * level)],
        ..Fluid::default()
    };
    let along = setting.planted(slope, 0.0);
    let gravity = Vec3::new((GRAVITY * along) as f32, -GRAVITY as f32, 0.0);
    Scene { gravity, ..Scene::new("slope") }
        .in_box(-half, half + Vec3::Y * 1.4 * level)
        .repeating([true, false, true])
        .with_fluid(fluid)
        .with_body(Body::fixed("rib", ShapeKind::Cuboid { half_extents: rib }, Vec3::Y * rib.y))
}
