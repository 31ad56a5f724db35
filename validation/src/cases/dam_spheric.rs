//! A dam breaks onto a box, compared with the experiment at MARIN of SPHERIC.

use std::f64::consts::PI;

use sorb::{
    World,
    glam::{DVec3, Vec3},
    scene::{Body, Fluid, FluidBlock, Scene, ShapeKind, Time},
};

use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    norms::mean,
    references::kleefsman::{
        ARRIVAL, BOX, DAM, DEPTH, FIRST, H2, H4, HEIGHTS, HIGHEST, INTERVAL, P2, PEAK, TANK,
    },
};

/// The dam break of Kleefsman et al.
pub(super) static CASE: Case = Case {
    name: "dam_spheric",
    title: "a dam breaks onto a box: pressure on its face, heights of the water",
    source: "Kleefsman et al. 2005 (SPHERIC 2): heights of the experiment, pressures quoted in the literature",
    subject: Subject::Water,
    control: "gravity at two thirds",
    run,
};

/// Particles over the depth: 87 thousand in all, 2 cm apart.
const LAYERS: u32 = 28;
/// Gravity that the reference assumes \[m/s^2\].
const GRAVITY: f64 = 9.81;
/// Samples of the pressure per second, each of the step that ends there. No step is longer, so that hardly one is missed.
///
/// One run for each: impacts scatter by a fifth with any difference, so that figures are means of runs with different steps.
const RATES: [f64; 4] = [1000.0, 1050.0, 1100.0, 1150.0];
/// Duration of the run \[s\]: the returning wave has passed H2.
const END: f64 = 2.4;
/// Pressure that counts as arrival, over the peak of the experiment.
const ARRIVED: f64 = 0.1;

/// Time over which the largest height is averaged \[s\]: drops that pass a gauge are no level.
const SWELL: f64 = 0.1;
/// The same for the series \[s\], of which every fiftieth value is known.
const RIPPLE: f64 = 0.02;

/// One sample in time.
struct Sample {
    time: f64,
    /// Pressure \[Pa\] within a support radius of the line through P2 across the face of the box. The sum over the particles
    /// there, over the number that fits.
    pressure: f64,
    /// Depths of the water at H2 and H4, without air in between, as a wire feels them \[m\].
    heights: [f64; 2],
}

/// Result of one run.
struct Outcome {
    window: f64,
    /// Largest pressure over the window, and of single steps \[Pa\].
    peak: f64,
    single: f64,
    arrival: f64,
    highest: f64,
    first: f64,
    /// Root mean square of the errors of both heights \[m\].
    errors: [f64; 2],
}

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let runs: Vec<_> = setting
        .pick(&RATES[..], &RATES[..1])
        .iter()
        .map(|rate| outcome(setting, *rate))
        .collect::<Result<_, _>>()?;
    let of = |part: fn(&Outcome) -> f64| mean(runs.iter().map(part));
    let middle = |(low, high): (f64, f64)| 0.5 * (low + high);
    let window = of(|run| run.window);
    Ok(vec![
        Figure::relative(
            format!("largest pressure at P2, mean of {window:.3} s"),
            "Pa",
            PEAK,
            of(|run| run.peak),
            0.2,
        ),
        Figure::relative("the same of single steps", "Pa", PEAK, of(|run| run.single), 0.2),
        Figure::relative(
            "arrival at P2, a tenth of the peak",
            "s",
            middle(ARRIVAL),
            of(|run| run.arrival),
            0.2,
        ),
        Figure::relative(
            format!("largest height at H2, mean of {SWELL} s"),
            "m",
            HIGHEST,
            of(|run| run.highest),
            0.1,
        ),
        Figure::relative("height at H4 at first", "m", FIRST, of(|run| run.first), 0.1),
        Figure::error("height at H2 over the depth, RMSE", "1", of(|run| run.errors[0]) / DEPTH, 0.06),
        Figure::error("height at H4 over the depth, RMSE", "1", of(|run| run.errors[1]) / DEPTH, 0.03),
    ])
}

fn outcome(setting: &Setting, rate: f64) -> Result<Outcome, Failure> {
    let spacing = DEPTH / f64::from(setting.count(setting.pick(LAYERS, LAYERS * 3 / 7)));
    let mut world = setting.world(&scene(setting, spacing, rate))?;
    let mut samples = vec![Sample::of(&world, spacing)];
    while world.clock().time < END {
        setting.advance(&mut world)?;
        samples.push(Sample::of(&world, spacing));
    }
    // The time in which the front of a dam break (Ritter) crosses the length over which the pressure is averaged.
    let window = 0.5 * support_radius(&world) / (GRAVITY * DEPTH).sqrt();
    let pressure = |sample: &Sample| around(&samples, sample.time, window, |s| s.pressure);
    let height = |sample: &Sample| around(&samples, sample.time, SWELL, |s| s.heights[0]);
    let error = |gauge: usize| {
        let rows = HEIGHTS.iter().enumerate();
        let squares = rows.map(|(row, heights)| {
            let there = around(&samples, INTERVAL * row as f64, RIPPLE, |s| s.heights[gauge]);
            (there - heights[gauge]).powi(2)
        });
        mean(squares).sqrt()
    };
    let largest = |of: &dyn Fn(&Sample) -> f64| samples.iter().map(of).fold(0.0, f64::max);
    let arrival = samples.iter().find(|sample| sample.pressure > ARRIVED * PEAK);
    Ok(Outcome {
        window,
        peak: largest(&pressure),
        single: largest(&|sample| sample.pressure),
        arrival: arrival.ok_or_else(|| Failure::Nothing("no water comes to the box".to_owned()))?.time,
        highest: largest(&height),
        first: samples[0].heights[1],
        errors: [0, 1].map(error),
    })
}

fn support_radius(world: &World) -> f64 {
    world.scene().fluid.as_ref().map_or(0.0, |fluid| f64::from(fluid.support_radius()))
}

/// Mean of a quantity over a window of time around a moment.
fn around(samples: &[Sample], time: f64, window: f64, of: impl Fn(&Sample) -> f64) -> f64 {
    let near = samples.iter().filter(|sample| (sample.time - time).abs() <= 0.5 * window);
    mean(near.map(of))
}

fn scene(setting: &Setting, spacing: f64, rate: f64) -> Scene {
    let [size, low, high] = [TANK, BOX[0], BOX[1]].map(DVec3::from_array);
    let fluid = Fluid {
        spacing: spacing as f32,
        blocks: vec![FluidBlock::new(
            Vec3::new(DAM as f32, 0.0, 0.0),
            Vec3::new(size.x as f32, DEPTH as f32, size.z as f32),
        )],
        ..Fluid::default()
    };
    let shape = ShapeKind::Cuboid { half_extents: (0.5 * (high - low)).as_vec3() };
    let gravity = -GRAVITY * setting.planted(1.0, 2.0 / 3.0);
    Scene {
        gravity: Vec3::new(0.0, gravity as f32, 0.0),
        time: Time { frame_rate: rate as f32, ..Time::default() },
        ..Scene::new("spheric")
    }
    .in_box(Vec3::ZERO, size.as_vec3())
    .with_fluid(fluid)
    .with_body(Body::fixed("box", shape, (0.5 * (low + high)).as_vec3()))
}

impl Sample {
    fn of(world: &World, spacing: f64) -> Self {
        let radius = support_radius(world);
        let along = BOX[0][2] + radius..BOX[1][2] - radius;
        let is_near = |row: &[f32; 4]| {
            let [x, y, z] = [row[0], row[1], row[2]].map(f64::from);
            let (x, y) = (x - P2[0], y - P2[1]);
            x * x + y * y < radius * radius && along.contains(&z)
        };
        let pressures = world.particle_pressures();
        let rows = world.particle_positions().iter().zip(&pressures);
        let sum: f64 = rows.filter(|(row, _)| is_near(row)).map(|(_, pressure)| f64::from(*pressure)).sum();
        // Half a cylinder of water.
        let fit = 0.5 * PI * radius * radius * (along.end - along.start) / spacing.powi(3);
        // Water around the wire, as wide as the smoothing function reaches.
        let height = |along: f64| {
            let is_near = |row: &&[f32; 4]| {
                (f64::from(row[0]) - along).abs() < radius
                    && (f64::from(row[2]) - 0.5 * TANK[2]).abs() < radius
            };
            let near = world.particle_positions().iter().filter(is_near).count();
            near as f64 * spacing.powi(3) / (2.0 * radius).powi(2)
        };
        Self { time: world.clock().time, pressure: sum / fit, heights: [H2, H4].map(height) }
    }
}
