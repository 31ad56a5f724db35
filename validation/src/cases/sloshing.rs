//! Water that sways in a tank: period and decay, deep and shallow.

use sorb::{
    World,
    glam::Vec3,
    scene::{Fluid, FluidBlock, Scene, Time},
};

use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    norms::{line, mean, upward_crossings},
};

/// The first mode of a rectangular tank.
pub(super) static CASE: Case = Case {
    name: "sloshing",
    title: "water sways in a long tank without friction, as deep as long and a fifth as deep: period and decay",
    source: "w^2 = g k tanh(k H), k = pi / L; energy falls as exp(-4 nu k^2 t) (Lamb, Hydrodynamics, 348)",
    subject: Subject::Water,
    control: "gravity twice as strong",
    run,
};

/// Length of the tank \[m\], and particles along it.
const LENGTH: f64 = 0.2;
const PARTICLES: u32 = 40;
/// Depths over the length, by name.
const DEPTHS: [(&str, f64); 2] = [("deep", 1.0), ("shallow", 0.2)];
/// Height of the wave over the shorter of length and depth.
const HEIGHT: f64 = 0.06;
/// Particles across, along the axis that repeats.
const ACROSS: f64 = 6.0;
/// Periods that are watched.
const PERIODS: (f64, f64) = (5.0, 3.0);
/// Bounds: of the period, and of the rate of decay over the angular frequency.
const BOUNDS: (f64, f64) = (0.03, 0.01);
const VISCOSITY: f64 = 1e-6;
const GRAVITY: f64 = 9.81;

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let spacing = LENGTH / f64::from(setting.count(setting.pick(PARTICLES, PARTICLES / 2)));
    let mut figures = Vec::new();
    for (name, depth) in DEPTHS {
        figures.extend(sway(setting, name, depth * LENGTH, spacing)?);
    }
    Ok(figures)
}

fn sway(setting: &Setting, name: &str, depth: f64, spacing: f64) -> Result<Vec<Figure>, Failure> {
    let wave = std::f64::consts::PI / LENGTH;
    let frequency = (GRAVITY * wave * libm::tanh(wave * depth)).sqrt();
    let period = std::f64::consts::TAU / frequency;
    let mut world = setting.world(&scene(setting, depth, spacing))?;
    // Level at first and as fast as it gets: `u = w a cosh(k y) sin(k x) / sinh(k H)`.
    let speed = frequency * HEIGHT * depth.min(LENGTH) / libm::sinh(wave * depth);
    world.set_particle_velocities(|at| {
        let [x, y] = [at.x, at.y].map(|x| wave * f64::from(x));
        let (u, v) = (speed * libm::cosh(y) * libm::sin(x), -speed * libm::sinh(y) * libm::cos(x));
        Vec3::new(u as f32, v as f32, 0.0)
    })?;
    let mut samples = vec![(0.0, centre(&world))];
    while world.clock().time < period * setting.pick(PERIODS.0, PERIODS.1) {
        setting.advance(&mut world)?;
        samples.push((world.clock().time, centre(&world)));
    }
    let (found, decay) = swing(&samples, 0.5 * LENGTH);
    let name = |what: &str| format!("{name}: {what}");
    // Whole waves do not begin at zero exactly: the amplitude falls at half the rate of the energy.
    let reference = 2.0 * VISCOSITY * wave * wave;
    Ok(vec![
        Figure::relative(name("period"), "s", period, found, BOUNDS.0),
        Figure::over(
            name("decay of the height, over the angular frequency"),
            "1/s",
            (reference, decay),
            frequency,
            BOUNDS.1,
        ),
    ])
}

/// Place of the centre of mass along the tank.
fn centre(world: &World) -> f64 {
    mean(world.particle_positions().iter().map(|x| f64::from(x[0])))
}

/// Period, and rate at which the largest deviations from the middle fall; not numbers if there are not two of either.
fn swing(samples: &[(f64, f64)], middle: f64) -> (f64, f64) {
    let deviations: Vec<_> = samples.iter().map(|(t, x)| (*t, x - middle)).collect();
    let crossings = upward_crossings(&deviations, 0.0);
    let whole = crossings.len().saturating_sub(1);
    let period = if whole > 0 { (crossings[whole] - crossings[0]) / whole as f64 } else { f64::NAN };
    // The largest of every half wave between two crossings.
    let mut halves: Vec<Vec<(f64, f64)>> = Vec::new();
    for sample in &deviations {
        match halves.last_mut() {
            Some(half) if half[0].1 * sample.1 > 0.0 => half.push(*sample),
            _ => halves.push(vec![*sample]),
        }
    }
    let peak = |half: &Vec<(f64, f64)>| half.iter().copied().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    let whole = halves.iter().take(halves.len().saturating_sub(1)).filter(|half| half.len() > 2);
    let peaks: Vec<_> = whole.filter_map(peak).map(|(t, x)| (t, libm::log(x.abs()))).collect();
    let decay = if peaks.len() > 1 { -line(&peaks).0 } else { f64::NAN };
    (period, decay)
}

fn scene(setting: &Setting, depth: f64, spacing: f64) -> Scene {
    let corner = Vec3::new(LENGTH as f32, depth as f32, (ACROSS * spacing) as f32);
    let fluid = Fluid {
        spacing: spacing as f32,
        blocks: vec![FluidBlock::new(Vec3::ZERO, corner)],
        ..Fluid::default()
    };
    let gravity = -GRAVITY * setting.planted(1.0, 2.0);
    Scene {
        gravity: Vec3::new(0.0, gravity as f32, 0.0),
        time: Time { frame_rate: 100.0, ..Time::default() },
        ..Scene::new("sloshing")
    }
    .in_box(Vec3::ZERO, corner + Vec3::Y * 0.5 * corner.y)
    .repeating([false, false, true])
    .with_fluid(fluid)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn period_and_decay_of_a_known_swing_are_found() {
        let at = |t: f64| 0.3 + 0.01 * libm::exp(-0.2 * t) * libm::sin(9.0 * t);
        let samples: Vec<_> = (0..400).map(|index| f64::from(index) * 0.01).map(|t| (t, at(t))).collect();
        let (period, decay) = swing(&samples, 0.3);
        assert!(
            (period - std::f64::consts::TAU / 9.0).abs() < 1e-4 && (decay - 0.2).abs() < 4e-3,
            "{period} {decay}"
        );
        // The control: what rests swings in no time.
        assert!(swing(&[(0.0, 0.3), (1.0, 0.3), (2.0, 0.3)], 0.3).0.is_nan());
    }
}
