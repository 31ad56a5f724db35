//! A drop without gravity: pressure inside and period of oscillation.

use sorb::{
    World,
    glam::Vec3,
    scene::{Domain, Fluid, FluidBlock, Scene, Time},
};

use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    norms::{mean, upward_crossings},
    references::drop::{laplace_pressure, period},
};

/// A drop of water.
pub(super) static CASE: Case = Case {
    name: "drop",
    title: "a drop without gravity: pressure in its middle, and period of its oscillation",
    source: "Laplace, 2 sigma / R; Rayleigh (1879), omega^2 = 8 sigma / (rho R^3)",
    subject: Subject::Water,
    control: "half the surface tension",
    run,
};

/// Particles across.
const PARTICLES: u32 = 20;
/// Radius of the drop \[m\], and its surface tension \[N/m\].
const RADIUS: f64 = 0.01;
const TENSION: f64 = 0.0728;
const DENSITY: f64 = 1000.0;
/// Elongation of the oscillating drop along its axis, over the radius of the ball.
const STRETCH: f64 = 0.1;

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let spacing = 2.0 * RADIUS / f64::from(setting.count(setting.pick(PARTICLES, PARTICLES * 4 / 5)));
    Ok(vec![pressure(setting, spacing)?, vibration(setting, spacing)?])
}

/// Radius of a ball with the volume of the water \[m\].
fn radius(world: &World, spacing: f64) -> f64 {
    let volume = world.particle_ids().len() as f64 * spacing.powi(3);
    (volume * 0.75 / std::f64::consts::PI).cbrt()
}

fn pressure(setting: &Setting, spacing: f64) -> Result<Figure, Failure> {
    let mut world = setting.world(&scene(setting, spacing, 0.0))?;
    let mut found = Vec::new();
    let (begin, end) = setting.pick((0.25, 0.4), (0.15, 0.25));
    while world.clock().time < end {
        setting.advance(&mut world)?;
        if world.clock().time > begin {
            let rows = world.particle_positions().iter().zip(world.particle_pressures());
            let inner = rows.filter(|(row, _)| place(row).length() < 0.5 * RADIUS as f32);
            found.push(mean(inner.map(|(_, pressure)| f64::from(pressure))));
        }
    }
    let expected = laplace_pressure(TENSION, radius(&world, spacing));
    Ok(Figure::relative("pressure in the middle", "Pa", expected, mean(found), 0.1))
}

fn vibration(setting: &Setting, spacing: f64) -> Result<Figure, Failure> {
    let mut world = setting.world(&scene(setting, spacing, STRETCH))?;
    let expected = period(TENSION, DENSITY, radius(&world, spacing));
    let mut lengths = Vec::new();
    while world.clock().time < setting.pick(3.2, 2.2) * expected {
        setting.advance(&mut world)?;
        let squares = world.particle_positions().iter().map(|row| {
            let [x, y, z] = place(row).as_dvec3().to_array();
            x * x - 0.5 * (y * y + z * z)
        });
        lengths.push((world.clock().time, squares.sum::<f64>()));
    }
    let level = mean(lengths.iter().map(|sample| sample.1));
    let crossings = upward_crossings(&lengths, level);
    let found = match crossings[..] {
        [first, .., last] => (last - first) / (crossings.len() - 1) as f64,
        _ => f64::NAN,
    };
    Ok(Figure::relative("period between long and flat", "s", expected, found, 0.05))
}

fn place(row: &[f32; 4]) -> Vec3 {
    Vec3::new(row[0], row[1], row[2])
}

/// An ellipsoid built from bars of particles along x, with the volume of a ball, longer by `stretch` along x.
fn scene(setting: &Setting, spacing: f64, stretch: f64) -> Scene {
    let (long, wide) = (RADIUS * (1.0 + stretch), RADIUS / (1.0 + stretch).sqrt());
    let reach = (wide / spacing).ceil() as i32;
    let middle = |index: i32| (f64::from(index) + 0.5) * spacing;
    let columns = (-reach..reach).flat_map(|j| (-reach..reach).map(move |k| (middle(j), middle(k))));
    let blocks = columns.filter_map(|(y, z)| {
        let half = long * (1.0 - (y * y + z * z) / (wide * wide)).max(0.0).sqrt();
        let count = (half / spacing).round();
        let corner = |sign: f64| {
            Vec3::new(
                (sign * count * spacing) as f32,
                (y + sign * 0.5 * spacing) as f32,
                (z + sign * 0.5 * spacing) as f32,
            )
        };
        (count > 0.0).then(|| FluidBlock::new(corner(-1.0), corner(1.0)))
    });
    let fluid = Fluid {
        spacing: spacing as f32,
        rest_density: DENSITY as f32,
        surface_tension: setting.planted(TENSION, 0.5 * TENSION) as f32,
        blocks: blocks.collect(),
        ..Fluid::default()
    };
    Scene {
        gravity: Vec3::ZERO,
        domain: Domain::Open,
        time: Time { frame_rate: 200.0, ..Time::default() },
        ..Scene::new("drop")
    }
    .with_fluid(fluid)
}
