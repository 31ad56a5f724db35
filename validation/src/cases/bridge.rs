//! Water between two plates, without gravity: its surface draws them together.

use std::f64::consts::PI;

use sorb::{
    World,
    glam::Vec3,
    scene::{Axis, BlockShape, Body, Domain, Fluid, FluidBlock, Scene, ShapeKind, Time},
};

use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    norms::mean,
};

/// A capillary bridge.
pub(super) static CASE: Case = Case {
    name: "bridge",
    title: "a round bridge of water between two plates without gravity: what the plates feel, and the pressure inside",
    source: "2 pi R sigma of the line less pi R^2 (sigma / R) of the pressure (Laplace), at a contact angle of 90 degrees",
    subject: Subject::Water,
    control: "half the surface tension",
    run,
};

/// Particles over the radius.
const PARTICLES: u32 = 10;
/// Radius of the bridge and distance of the plates \[m\]: shorter than its circumference, it does not break.
const RADIUS: f64 = 0.008;
const GAP: f64 = 0.008;
const TENSION: f64 = 0.0728;
/// Viscosities \[Pa s\]. Neither pull nor pressure depends on them. A thick liquid comes to rest, water does not.
const WATER: f32 = 1e-3;
const THICK: f32 = 0.1;
/// Half extents of a plate \[m\].
const PLATE: Vec3 = Vec3::new(0.02, 0.004, 0.02);

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let mut figures = Vec::new();
    for (name, viscosity) in [("", WATER), ("thick liquid: ", THICK)] {
        figures.extend(of_a_liquid(setting, name, viscosity)?);
    }
    Ok(figures)
}

fn of_a_liquid(setting: &Setting, name: &str, viscosity: f32) -> Result<[Figure; 2], Failure> {
    let spacing = RADIUS / f64::from(setting.count(setting.pick(PARTICLES, PARTICLES * 4 / 5)));
    let mut world = setting.world(&scene(setting, spacing, viscosity))?;
    let radius = (world.particle_ids().len() as f64 * spacing.powi(3) / (PI * GAP)).sqrt();
    let (mut pulls, mut pressures) = (Vec::new(), Vec::new());
    let (begin, end) = setting.pick((0.2, 0.5), (0.1, 0.25));
    while world.clock().time < end {
        setting.advance(&mut world)?;
        if world.clock().time > begin {
            pulls.push(pull(&world));
            pressures.push(pressure(&world));
        }
    }
    let (pull, pressure) = (PI * radius * TENSION, TENSION / radius);
    Ok([
        Figure::relative(format!("{name}pull on a plate"), "N", pull, mean(pulls), 0.1),
        Figure::relative(format!("{name}pressure in the middle"), "Pa", pressure, mean(pressures), 0.1),
    ])
}

/// Force that draws the plates together, mean of both \[N\].
fn pull(world: &World) -> f64 {
    match world.body_fluid_forces()[..] {
        [below, above] => 0.5 * (below.y - above.y),
        _ => f64::NAN,
    }
}

/// Mean within half of the radius, away from the plates \[Pa\].
fn pressure(world: &World) -> f64 {
    let rows = world.particle_positions().iter().zip(world.particle_pressures());
    let inner = rows.filter(|(row, _)| {
        let [x, y, z] = [0, 1, 2].map(|axis| f64::from(row[axis]));
        x * x + z * z < 0.25 * RADIUS * RADIUS && (y - 0.5 * GAP).abs() < 0.25 * GAP
    });
    mean(inner.map(|(_, pressure)| f64::from(pressure)))
}

fn scene(setting: &Setting, spacing: f64, viscosity: f32) -> Scene {
    let (radius, gap) = (RADIUS as f32, GAP as f32);
    let cylinder = FluidBlock {
        shape: BlockShape::Cylinder { axis: Axis::Y },
        ..FluidBlock::new(Vec3::new(-radius, 0.0, -radius), Vec3::new(radius, gap, radius))
    };
    let fluid = Fluid {
        spacing: spacing as f32,
        viscosity,
        surface_tension: setting.planted(TENSION, 0.5 * TENSION) as f32,
        blocks: vec![cylinder],
        ..Fluid::default()
    };
    let plate = |name: &str, height: f32| {
        Body::fixed(name, ShapeKind::Cuboid { half_extents: PLATE }, Vec3::Y * height)
    };
    Scene {
        gravity: Vec3::ZERO,
        domain: Domain::Open,
        time: Time { frame_rate: 200.0, ..Time::default() },
        ..Scene::new("bridge")
    }
    .with_fluid(fluid)
    .with_body(plate("below", -PLATE.y))
    .with_body(plate("above", gap + PLATE.y))
}
