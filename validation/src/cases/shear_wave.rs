//! A shear wave in a pool: the viscosity and the yield stress that water has by numerics.

use sorb::{
    World,
    glam::Vec3,
    scene::{Fluid, FluidBlock, Scene},
};

use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    norms::{first_crossing, line},
};

/// A shear wave under pressure.
pub(super) static CASE: Case = Case {
    name: "shear_wave",
    title: "layers of a pool without ends slide over each other: effective viscosity and resisting stress at three spacings",
    source: "u = U cos(k y) exp(-nu k^2 t), on a floor without friction",
    subject: Subject::Water,
    control: "a viscosity of 50 Pa s",
    run,
};

/// Depth of the pool \[m\]: half a wave.
const DEPTH: f64 = 0.1;
/// Layers of particles over the depth.
const LAYERS: [u32; 3] = [10, 20, 40];
/// Particles along the axes that repeat.
const ACROSS: f64 = 8.0;
/// Speed of the floor and of the surface at first \[m/s\].
const SPEED: f64 = 0.05;
/// Kinematic viscosity of the fluid \[m^2/s\], and that up to which it is small.
const VISCOSITY: f64 = 1e-6;
const BOUND: f64 = 1e-5;
/// Stress below which water must flow \[Pa\].
const YIELD: f64 = 0.5;
const GRAVITY: f64 = 9.81;

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let (mut figures, mut viscosities) = (Vec::new(), Vec::new());
    for layers in setting.pick(&LAYERS[..], &LAYERS[..2]) {
        let spacing = DEPTH / f64::from(setting.count(*layers));
        let samples = decay(setting, spacing)?;
        let (viscosity, stress) = found(&samples);
        let name = |what: &str| format!("{layers} layers: {what}");
        figures.push(Figure::over(
            name("effective kinematic viscosity"),
            "m^2/s",
            (VISCOSITY, viscosity),
            1.0,
            BOUND,
        ));
        figures.push(Figure::error(name("resisting stress"), "Pa", stress, YIELD));
        viscosities.push((libm::log(spacing), libm::log((viscosity - VISCOSITY).abs())));
    }
    if !setting.quick {
        // As the first power at least; below the bound it does not matter.
        let (order, is_small) =
            (line(&viscosities).0, figures.iter().step_by(2).all(|own| own.error < 0.1 * BOUND));
        let lack = if is_small { 0.0 } else { (1.0 - order).max(0.0) };
        figures.push(Figure {
            name: "order of the viscosity in the spacing, what lacks of 1".to_owned(),
            unit: "1",
            reference: 1.0,
            measured: order,
            error: lack,
            bound: 0.3,
        });
    }
    Ok(figures)
}

/// Amplitude of the wave over time, over that at first.
fn decay(setting: &Setting, spacing: f64) -> Result<Vec<(f64, f64)>, Failure> {
    let wave = std::f64::consts::PI / DEPTH;
    let mut world = setting.world(&scene(setting, spacing))?;
    world.set_particle_velocities(|at| Vec3::X * (SPEED * libm::cos(wave * f64::from(at.y))) as f32)?;
    let amplitude = |world: &World| {
        let rows = world.particle_positions().iter().zip(world.particle_velocities());
        let parts = rows.map(|(x, v)| (libm::cos(wave * f64::from(x[1])), f64::from(v[0])));
        let (sum, square) = parts.fold((0.0, 0.0), |(sum, square), (c, v)| (sum + c * v, square + c * c));
        sum / square / SPEED
    };
    let mut samples = vec![(0.0, amplitude(&world))];
    while world.clock().time < setting.pick(2.0, 1.0) {
        setting.advance(&mut world)?;
        samples.push((world.clock().time, amplitude(&world)));
    }
    Ok(samples)
}

/// Viscosity with which half of the speed is lost in the same time, and the stress of a material that resists alike at any speed.
/// If less than half is lost, what is. With a stress of one sign over the depth, `dA/dt = -4 tau / (rho H)`.
fn found(samples: &[(f64, f64)]) -> (f64, f64) {
    let wave = std::f64::consts::PI / DEPTH;
    let last = samples[samples.len() - 1];
    let (time, left) = first_crossing(samples, 0.5).map_or(last, |time| (time, 0.5));
    let viscosity = -libm::log(left) / (wave * wave * time);
    (viscosity, 1000.0 * DEPTH * SPEED * (1.0 - left) / (4.0 * time))
}

fn scene(setting: &Setting, spacing: f64) -> Scene {
    let half = (0.5 * ACROSS * spacing) as f32;
    let minimum = Vec3::new(-half, 0.0, -half);
    let fluid = Fluid {
        spacing: spacing as f32,
        viscosity: setting.planted(1000.0 * VISCOSITY, 50.0) as f32,
        blocks: vec![FluidBlock::new(minimum, Vec3::new(half, DEPTH as f32, half))],
        ..Fluid::default()
    };
    Scene { gravity: Vec3::new(0.0, -GRAVITY as f32, 0.0), ..Scene::new("shear_wave") }
        .in_box(minimum, Vec3::new(half, 1.5 * DEPTH as f32, half))
        .repeating([true, false, true])
        .with_fluid(fluid)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_viscous_and_a_plastic_decay_are_told_by_their_numbers() {
        let wave = std::f64::consts::PI / DEPTH;
        let times = || (0..=100).map(|index| f64::from(index) * 0.01);
        let viscous: Vec<_> = times().map(|t| (t, libm::exp(-1e-3 * wave * wave * t))).collect();
        assert!((found(&viscous).0 / 1e-3 - 1.0).abs() < 1e-3);
        let plastic: Vec<_> =
            times().map(|t| (t, (1.0 - 4.0 * 0.7 * t / (1000.0 * DEPTH * SPEED)).max(0.0))).collect();
        assert!((found(&plastic).1 / 0.7 - 1.0).abs() < 1e-3);
        // The control: what does not decay has neither.
        let steady: Vec<_> = times().map(|t| (t, 1.0)).collect();
        assert!(found(&steady).0.abs() < 1e-12 && found(&steady).1.abs() < 1e-12);
    }
}
