//! Undisturbed scenes come to rest.

use sorb::{
    World,
    scene::{Scene, preset, presets},
};

use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    norms::mean,
};

/// The scenes that come with the library.
pub(super) static CASE: Case = Case {
    name: "rest",
    title: "every scene of the library is left undisturbed for ten seconds",
    source: "rest",
    subject: Subject::Coupling,
    control: "only a third of a second",
    run,
};

/// Largest final speed \[m/s\]: of all as a root mean square, and of the fastest, which is an extreme of thousands.
const STILL: f64 = 1e-3;
/// Factor on the resolution of the scenes.
const RESOLUTION: f64 = 0.5;

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let mut figures = Vec::new();
    for preset in presets() {
        let skipped = setting.quick && !["dry", "standing"].contains(&preset.name);
        if preset.name != "empty" && !skipped {
            figures.extend(rest(setting, preset.name)?);
        }
    }
    Ok(figures)
}

fn rest(setting: &Setting, name: &str) -> Result<[Figure; 2], Failure> {
    let resolution = (RESOLUTION * setting.resolution).max(0.1) as f32;
    let scene = preset(name)?.scaled(resolution)?;
    let mut world = setting.world(&scene)?;
    let seconds = setting.planted(last_motion(&scene) + setting.pick(10.0, 3.0), 0.3);
    let (mut before, mut end) = (0.0_f64, 0.0_f64);
    let mut squares = Vec::new();
    while world.clock().time < seconds {
        let report = setting.advance(&mut world)?;
        let speed = f64::from(report.maximum_speed);
        if world.clock().time > seconds - 0.5 {
            end = end.max(speed);
            squares.push(mean_square(&world));
        } else if world.clock().time > seconds - 1.0 {
            before = before.max(speed);
        }
    }
    let falls = if end <= before { "falling" } else { "not falling" };
    let speed = if end <= before || end <= 0.1 * STILL { end } else { end.max(1.01 * STILL) };
    let rms = mean(squares).sqrt();
    Ok([
        Figure::error(format!("rms of {name}"), "m/s", rms, STILL),
        Figure {
            name: format!("fastest of {name}, {falls}"),
            unit: "m/s",
            reference: 0.0,
            measured: end,
            error: speed,
            bound: STILL,
        },
    ])
}

/// Mean of the squared speeds of all particles and nodes \[m^2/s^2\].
fn mean_square(world: &World) -> f64 {
    let rows = world.particle_velocities().iter().chain(world.node_velocities());
    mean(rows.map(|row| row[..3].iter().map(|v| f64::from(*v).powi(2)).sum::<f64>()))
}

/// When the last body stops \[s\].
fn last_motion(scene: &Scene) -> f64 {
    let motions = scene.bodies.iter().flat_map(|body| &body.motions);
    motions.map(|motion| f64::from(motion.interval().1)).fold(0.0, f64::max)
}
