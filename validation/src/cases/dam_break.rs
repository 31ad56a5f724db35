//! A column of water collapses, compared with the film of Martin and Moyce.

use sorb::{
    World,
    glam::Vec3,
    scene::{Fluid, FluidBlock, Scene, Time},
};

use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    level::heights,
    norms::{interpolated, mean, minimum, root_mean_square},
    references::martin_moyce::{BASE, FRONT, HEIGHT},
};

/// Martin and Moyce's column.
pub(super) static CASE: Case = Case {
    name: "dam_break",
    title: "a column twice as high as wide collapses",
    source: "Martin and Moyce 1952, Tables 2 and 6",
    subject: Subject::Water,
    control: "gravity at two thirds",
    run,
};

/// Particles over the base of the column.
const BASE_PARTICLES: u32 = 16;
/// Particles across the channel.
const ACROSS: u32 = 6;
/// Length of the channel over the base: the front does not reach the end.
const CHANNEL: f64 = 9.0;
/// Gravity that the reference assumes \[m/s^2\].
const GRAVITY: f64 = 9.81;
/// Longest time over which the gate may open, in units of `sqrt(a / 2 g)`.
const GATE: f64 = 0.5;

/// One sample in time.
struct Sample {
    time: f64,
    /// Position of the front over the base.
    front: f64,
    /// Height at the wall over that at the start.
    height: f64,
}

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let spacing = BASE / f64::from(setting.count(setting.pick(BASE_PARTICLES, BASE_PARTICLES / 2)));
    let mut world = setting.world(&scene(setting, spacing))?;
    let mut samples = vec![Sample::of(&world, spacing)];
    let mut density = 0.0_f64;
    while world.clock().time < 0.28 {
        setting.advance(&mut world)?;
        samples.push(Sample::of(&world, spacing));
        density = density.max(world.measures().mean_density_error);
    }
    // The gate of the experiment opened in a finite time, which is not recorded.
    let fronts: Vec<_> = samples.iter().map(|s| (s.time * (2.0 * GRAVITY / BASE).sqrt(), s.front)).collect();
    let shift = minimum((0.0, GATE), |shift| front_error(&fronts, shift));
    let heights: Vec<_> = samples
        .iter()
        .map(|s| (s.time * (GRAVITY / BASE).sqrt() + shift / f64::sqrt(2.0), s.height))
        .collect();
    let height = root_mean_square(HEIGHT.iter().map(|(tau, h)| interpolated(&heights, *tau) - h));
    let last = FRONT[FRONT.len() - 1];
    Ok(vec![
        Figure {
            name: format!("front Z, RMSE over {} times, gate {shift:.2}", FRONT.len()),
            unit: "1",
            reference: last.1,
            measured: interpolated(&fronts, last.0 - shift),
            error: front_error(&fronts, shift),
            bound: 0.15,
        },
        Figure {
            name: format!("height at the wall, RMSE over {} times", HEIGHT.len()),
            unit: "1",
            reference: HEIGHT[HEIGHT.len() - 1].1,
            measured: interpolated(&heights, HEIGHT[HEIGHT.len() - 1].0),
            error: height,
            bound: 0.05,
        },
        Figure::error("change of volume, largest of the means", "1", density, 5e-3),
    ])
}

/// Root mean square error of the front at all times of the table, with the delay of the gate.
fn front_error(fronts: &[(f64, f64)], shift: f64) -> f64 {
    root_mean_square(FRONT.iter().map(|(time, front)| interpolated(fronts, time - shift) - front))
}

fn scene(setting: &Setting, spacing: f64) -> Scene {
    let base = BASE as f32;
    let width = (f64::from(ACROSS) * spacing) as f32;
    let fluid = Fluid {
        spacing: spacing as f32,
        blocks: vec![FluidBlock::new(Vec3::ZERO, Vec3::new(base, 2.0 * base, width))],
        ..Fluid::default()
    };
    let gravity = -GRAVITY * setting.planted(1.0, 2.0 / 3.0);
    Scene {
        gravity: Vec3::new(0.0, gravity as f32, 0.0),
        time: Time { frame_rate: 250.0, ..Time::default() },
        ..Scene::new("martin_moyce")
    }
    .in_box(Vec3::ZERO, Vec3::new(CHANNEL as f32 * base, 4.0 * base, width))
    .with_fluid(fluid)
}

impl Sample {
    /// The front is that of the outermost row of particles across the channel, so that single drops do not count. The height
    /// is that of the water two spacings from the wall: a film on the wall is no column.
    fn of(world: &World, spacing: f64) -> Self {
        let mut along: Vec<_> = world.particle_positions().iter().map(|p| f64::from(p[0])).collect();
        along.sort_by(f64::total_cmp);
        let front =
            along.len().checked_sub(ACROSS as usize).map_or(0.0, |index| along[index] + 0.5 * spacing);
        let middle = 0.5 * f64::from(ACROSS) * spacing;
        let at_wall = heights(world, &[-0.5, 0.0, 0.5].map(|z| (2.0 * spacing, middle + z * spacing)));
        Self {
            time: world.clock().time,
            front: front / BASE,
            height: if at_wall.is_empty() { 0.0 } else { mean(at_wall) / (2.0 * BASE) },
        }
    }
}
