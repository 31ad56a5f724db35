//! Two plates start to move in a viscous fluid, at steps that explicit viscosity could not take.

use sorb::{
    glam::Vec3,
    scene::{Body, Fluid, FluidBlock, Motion, Scene, ShapeKind, Time, ViscosityIntegration},
};

use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    norms::root_mean_square,
    references::shear::spreading,
};

/// Shear that spreads from two plates.
pub(super) static CASE: Case = Case {
    name: "honey",
    title: "two plates start to move opposite ways in a fluid as viscous as honey, at steps 20 and 100 times as long as explicit \
            viscosity allows: velocity half way",
    source: "starting Couette flow: u = U (z + sum 2 (-1)^n / (n pi) sin(n pi z) exp(-n^2 pi^2 nu t / a^2))",
    subject: Subject::Water,
    control: "a solve of two iterations",
    run,
};

/// Particles between the plates.
const PARTICLES: u32 = 40;
/// Distance of the plates \[m\], and their thickness.
const GAP: f64 = 0.02;
const PLATE: f64 = 0.004;
/// Half of the length of the channel over the distance of the plates.
const HALF_LENGTH: f64 = 2.0;
/// Particles across the channel, along the axis without motion.
const LAYERS: f64 = 4.0;
/// Free width beside them, over theirs.
const ROOM: f64 = 1.0 / 16.0;
/// Speed of the plates \[m/s\].
const SPEED: f64 = 0.02;
/// Time at which the plates start \[s\], twice that in which viscosity crosses half of the gap: until then particles settle.
const REST: f64 = 0.02;
/// Ten thousand times that of water.
const VISCOSITY: f64 = 10.0;
const DENSITY: f64 = 1000.0;

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let spacing = GAP / f64::from(setting.count(setting.pick(PARTICLES, PARTICLES / 2)));
    // Over the time in which viscosity crosses half of the gap.
    let times = [0.1, 0.2, 0.4, 0.8];
    let started = error(setting, spacing, 20.0, &times)?;
    let steady = error(setting, spacing, 100.0, &[3.0])?;
    Ok(vec![
        Figure::error(
            "as it starts, 20 times the explicit step, L2 of layers over the speed",
            "1",
            started,
            // Measured: 0.017, and 0.029 in the quick form.
            setting.pick(0.02, 0.04),
        ),
        Figure::error(
            "in the end, 100 times the explicit step, L2 of layers over the speed",
            "1",
            steady,
            0.02,
        ),
    ])
}

/// Error of the velocity along the channel in its middle at some times, over the speed of the plates. `factor` is the step
/// over the longest one of explicit viscosity.
fn error(setting: &Setting, spacing: f64, factor: f64, times: &[f64]) -> Result<f64, Failure> {
    let support = f64::from(Fluid::default().support) * spacing;
    let kinematic = VISCOSITY / DENSITY;
    let step = factor * 0.0625 * support * support / kinematic;
    let crossing = 0.25 * GAP * GAP / kinematic;
    let mut world = setting.world(&scene(setting, spacing, step))?;
    let mut deviations = Vec::new();
    for time in times {
        while world.clock().time < REST + time * crossing {
            setting.advance(&mut world)?;
        }
        let now = (world.clock().time - REST) / crossing;
        let mut layers = vec![(0.0, 0.0); (GAP / spacing).round() as usize];
        let rows = world.particle_positions().iter().zip(world.particle_velocities());
        for (x, v) in rows.filter(|(x, _)| f64::from(x[0]).abs() < 0.5 * GAP) {
            let place = (f64::from(x[1]) / GAP).clamp(0.0, 1.0);
            let layer = ((place * layers.len() as f64) as usize).min(layers.len() - 1);
            layers[layer].0 += f64::from(v[0]) / SPEED - spreading(place, now);
            layers[layer].1 += 1.0;
        }
        deviations.extend(layers.into_iter().map(|(sum, count)| sum / count));
    }
    Ok(root_mean_square(deviations))
}

fn scene(setting: &Setting, spacing: f64, step: f64) -> Scene {
    let half = Vec3::new((HALF_LENGTH * GAP) as f32, (0.5 * GAP) as f32, (0.5 * LAYERS * spacing) as f32);
    let centre = Vec3::Y * half.y;
    let fluid = Fluid {
        spacing: spacing as f32,
        rest_density: DENSITY as f32,
        viscosity: VISCOSITY as f32,
        viscosity_integration: ViscosityIntegration::Implicit,
        viscosity_rounds: setting.planted(Fluid::default().viscosity_rounds, 2),
        artificial_viscosity: Some(0.0),
        blocks: vec![FluidBlock::new(centre - half, centre + half)],
        ..Fluid::default()
    };
    let reach = Vec3::Y * PLATE as f32;
    let plate = |name: &str, y: f64, way: f64| {
        let half_extents = Vec3::new(half.x + GAP as f32, 0.5 * PLATE as f32, half.z + GAP as f32);
        let motion = Motion::Linear {
            velocity: Vec3::X * (SPEED * way) as f32,
            start: REST as f32,
            end: 1.0,
            ease: 0.0,
        };
        let shape = ShapeKind::Cuboid { half_extents };
        let body = Body::kinematic(name, shape, Vec3::Y * y as f32, vec![motion]);
        Body { no_slip: true, ..body }
    };
    // With free width beside it. In a full box the pressure has no level, and a viscous fluid creeps into room at its end
    // for longer than the run.
    Scene {
        gravity: Vec3::ZERO,
        time: Time { frame_rate: (1.0 / step).min(1e4) as f32, maximum_step: step as f32, ..Time::default() },
        ..Scene::new("honey")
    }
    .in_box(centre - half - reach, centre + half + reach + Vec3::Z * (ROOM * LAYERS * spacing) as f32)
    .with_fluid(fluid)
    .with_body(plate("lower", -0.5 * PLATE, -1.0))
    .with_body(plate("upper", GAP + 0.5 * PLATE, 1.0))
}
