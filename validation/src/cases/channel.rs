//! Flow between no-slip plates: Poiseuille and Couette.

use sorb::{
    World,
    glam::Vec3,
    scene::{Body, Fluid, FluidBlock, Motion, Scene, ShapeKind, Time},
};

use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    norms::root_mean_square,
    references::channel::{returning, sheared},
};

/// Two plates move along a periodic channel.
///
/// Where they move the same way, gravity drives as much water back as they move. In a frame that moves with them this is a
/// Poiseuille flow.
pub(super) static CASE: Case = Case {
    name: "channel",
    title: "two plates move along a periodic channel, the same way and opposite ways: velocity of the fluid",
    source: "Poiseuille: u = U (1 - 6 y (1 - y)); Couette: u = U (2 y - 1)",
    subject: Subject::Water,
    control: "free slip at the plates",
    run,
};

/// Particles between the plates.
const PARTICLES: u32 = 40;
/// Height of the lattice of particles, and thickness of the plates \[m\].
const GAP: f64 = 0.02;
const PLATE: f64 = 0.004;
/// Free height between the plates over that of the lattice of particles, where particles jam in a full box.
const ROOM: f64 = 0.01;
/// Period along the channel, over the distance of the plates.
const LENGTH: f64 = 1.0;
/// Particles across the channel, along the periodic axis without motion: pairs reach two spacings.
const LAYERS: f64 = 6.0;
/// Speed of the plates \[m/s\].
const SPEED: f64 = 0.02;
const VISCOSITY: f64 = 1.0;
const DENSITY: f64 = 1000.0;

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let spacing = GAP / f64::from(setting.count(setting.pick(PARTICLES, PARTICLES / 2)));
    let poiseuille = error(setting, spacing, 1.0, returning)?;
    let couette = error(setting, spacing, -1.0, sheared)?;
    Ok(vec![
        Figure::error(
            "plates the same way (Poiseuille), L2 of layers over their speed",
            "1",
            poiseuille,
            0.02,
        ),
        Figure::error("plates opposite ways (Couette), L2 of layers over their speed", "1", couette, 0.02),
    ])
}

/// Error of the velocity along the channel, over the speed of the plates; `lower` is the direction of the lower one.
fn error(setting: &Setting, spacing: f64, lower: f64, profile: fn(f64) -> f64) -> Result<f64, Failure> {
    let full = scene(setting, spacing, (lower, GAP));
    let width = if setting.jams(&full)? { GAP * (1.0 + ROOM) } else { GAP };
    let mut world = setting.world(&scene(setting, spacing, (lower, width)))?;
    // In the time in which viscosity crosses the channel, the slowest mode decays by e^-9.9, which leaves the parabola.
    let end = 0.6 * GAP * GAP * DENSITY / VISCOSITY;
    let mut layers = vec![(0.0, 0.0); (GAP / spacing).round() as usize];
    while world.clock().time < end {
        setting.advance(&mut world)?;
        if world.clock().time > 0.8 * end {
            add_deviations(&world, (profile, width), &mut layers);
        }
    }
    Ok(root_mean_square(layers.into_iter().map(|(sum, count)| sum / count)))
}

/// Sums, by layers along the plates, the deviations of particles from the velocity of the profile.
fn add_deviations(world: &World, (profile, width): (fn(f64) -> f64, f64), layers: &mut [(f64, f64)]) {
    let rows = world.particle_positions().iter().zip(world.particle_velocities());
    for (x, v) in rows {
        let place = (f64::from(x[1]) / width).clamp(0.0, 1.0);
        let layer = ((place * layers.len() as f64) as usize).min(layers.len() - 1);
        layers[layer].0 += f64::from(v[0]) / SPEED - profile(place);
        layers[layer].1 += 1.0;
    }
}

/// The plates are `width` \[m\] apart.
fn scene(setting: &Setting, spacing: f64, (lower, width): (f64, f64)) -> Scene {
    let half = Vec3::new((0.5 * LENGTH * GAP) as f32, (0.5 * GAP) as f32, (0.5 * LAYERS * spacing) as f32);
    let centre = Vec3::Y * half.y;
    let fluid = Fluid {
        spacing: spacing as f32,
        rest_density: DENSITY as f32,
        viscosity: VISCOSITY as f32,
        artificial_viscosity: Some(0.0),
        blocks: vec![FluidBlock::new(centre - half, centre + half)],
        ..Fluid::default()
    };
    let (reach, room) = (Vec3::Y * PLATE as f32, Vec3::Y * (width - GAP) as f32);
    let plate = |name: &str, y: f64, way: f64| {
        let half_extents = Vec3::new(half.x + GAP as f32, 0.5 * PLATE as f32, half.z + GAP as f32);
        let motion =
            Motion::Linear { velocity: Vec3::X * (SPEED * way) as f32, start: 0.0, end: 1.0, ease: 0.0 };
        let shape = ShapeKind::Cuboid { half_extents };
        let body = Body::kinematic(name, shape, Vec3::Y * y as f32, vec![motion]);
        Body { no_slip: !setting.fault, ..body }
    };
    // Acceleration that drives a mean velocity of that of the plates back, between plates at rest; zero where they move
    // opposite ways.
    let back = 6.0 * VISCOSITY / DENSITY * SPEED * (1.0 + lower) / (width * width);
    Scene {
        gravity: Vec3::NEG_X * back as f32,
        time: Time { frame_rate: 1000.0, ..Time::default() },
        ..Scene::new("channel")
    }
    .in_box(centre - half - reach, centre + half + reach + room)
    .repeating([true, false, true])
    .with_fluid(fluid)
    .with_body(plate("lower", -0.5 * PLATE, lower))
    .with_body(plate("upper", width + 0.5 * PLATE, 1.0))
}
