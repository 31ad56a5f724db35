//! Decay of a vortex in a box, compared with that by viscosity.

use sorb::{
    World,
    glam::Vec3,
    scene::{Fluid, FluidBlock, FluidSolver, Scene, Time, ViscosityForm},
};

use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    norms::line,
    references::taylor_green::Vortex,
};

/// Taylor and Green's vortex.
pub(super) static CASE: Case = Case {
    name: "taylor_green",
    title: "a vortex between free-slip walls decays, at a Reynolds number of 100",
    source: "u decays as exp(-2 nu (pi / L)^2 t) (Taylor and Green 1937)",
    subject: Subject::Water,
    control: "a viscosity twice as high",
    run,
};

/// Side of the square \[m\] and largest initial speed \[m/s\].
const SIDE: f64 = 0.1;
const SPEED: f64 = 0.1;
/// Side times speed over viscosity.
const REYNOLDS: f64 = 100.0;
/// Particles along the side.
const PARTICLES: u32 = 50;
/// Layers of particles along the periodic axis without motion.
const LAYERS: u32 = 8;
/// Free width beside the layers, over theirs, where particles jam in a full box. Elsewhere there is none: viscosity counts what a particle
/// has of neighbours.
const ROOM: f64 = 0.07;
/// Times of the fit, in units of the side over the speed. Before that, the initial lattice breaks up.
const FIT: [f64; 2] = [0.5, 2.5];

/// One sample in time.
struct Sample {
    time: f64,
    /// Logarithm of the largest speed over the initial one.
    speed: f64,
    /// Logarithm of the kinetic energy over the initial one.
    energy: f64,
}

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let mut figures = Vec::new();
    let forms = [(ViscosityForm::Morris, "morris"), (ViscosityForm::Monaghan, "monaghan")];
    for (form, name) in setting.pick(&forms[..], &forms[..1]) {
        let numerical = [0.0, Fluid::default().numerical_viscosity(FluidSolver::Dfsph)];
        for numerical in setting.pick(&numerical[..], &numerical[..1]) {
            figures.extend(decays(setting, *form, *numerical, name)?);
        }
    }
    Ok(figures)
}

fn decays(
    setting: &Setting,
    form: ViscosityForm,
    numerical: f32,
    name: &str,
) -> Result<Vec<Figure>, Failure> {
    let vortex = Vortex { side: SIDE, speed: SPEED, viscosity: SIDE * SPEED / REYNOLDS };
    let spacing = SIDE / f64::from(setting.count(setting.pick(PARTICLES, PARTICLES / 2)));
    let full = scene(setting, &vortex, spacing, (form, numerical));
    let mut world = setting.world(&if setting.jams(&full)? { with_room(full) } else { full })?;
    world.set_particle_velocities(|at| {
        let [x, y] = vortex.velocity([f64::from(at.x), f64::from(at.y)], 0.0);
        Vec3::new(x as f32, y as f32, 0.0)
    })?;
    let [start, end] = FIT.map(|turns| turns * SIDE / SPEED);
    let mut samples = Vec::new();
    while world.clock().time < end {
        setting.advance(&mut world)?;
        if world.clock().time >= start {
            samples.push(Sample::of(&world, &vortex));
        }
    }
    let rate = |of: fn(&Sample) -> f64| -line(&samples.iter().map(|s| (s.time, of(s))).collect::<Vec<_>>()).0;
    let name = |what: &str| format!("{name}, alpha {numerical}: {what}");
    Ok(vec![
        Figure::relative(name("decay of the largest speed"), "1/s", vortex.rate(), rate(|s| s.speed), 0.1),
        Figure::relative(name("decay of the energy"), "1/s", 2.0 * vortex.rate(), rate(|s| s.energy), 0.1),
    ])
}

fn scene(
    setting: &Setting,
    vortex: &Vortex,
    spacing: f64,
    (viscosity_form, artificial_viscosity): (ViscosityForm, f32),
) -> Scene {
    let corner = Vec3::new(SIDE as f32, SIDE as f32, (f64::from(LAYERS) * spacing) as f32);
    let rest_density = Fluid::default().rest_density;
    let fluid = Fluid {
        spacing: spacing as f32,
        viscosity: setting.planted(1.0, 2.0) * vortex.viscosity as f32 * rest_density,
        viscosity_form: Some(viscosity_form),
        artificial_viscosity: Some(artificial_viscosity),
        // Ten times the largest speed, which the scene cannot derive.
        sound_speed: Some(10.0 * SPEED as f32),
        blocks: vec![FluidBlock::new(Vec3::ZERO, corner)],
        ..Fluid::default()
    };
    Scene {
        gravity: Vec3::ZERO,
        time: Time { frame_rate: 25.0, ..Time::default() },
        ..Scene::new("taylor_green")
    }
    .in_box(Vec3::ZERO, corner)
    .repeating([false, false, true])
    .with_fluid(fluid)
}

/// The same in a box that is wider along the periodic axis.
fn with_room(scene: Scene) -> Scene {
    let width = LAYERS as f32 * scene.fluid.as_ref().map_or(0.0, |fluid| fluid.spacing);
    scene.in_box(Vec3::ZERO, Vec3::new(SIDE as f32, SIDE as f32, width * (1.0 + ROOM as f32)))
}

impl Sample {
    fn of(world: &World, vortex: &Vortex) -> Self {
        let (mut fastest, mut energy, mut first) = (0.0_f64, 0.0, 0.0);
        for (at, velocity) in world.particle_positions().iter().zip(world.particle_velocities()) {
            let square: f64 = velocity[..3].iter().map(|v| f64::from(*v).powi(2)).sum();
            fastest = fastest.max(square.sqrt());
            energy += square;
            let [x, y] = vortex.velocity([f64::from(at[0]), f64::from(at[1])], 0.0);
            first += x * x + y * y;
        }
        Self {
            time: world.clock().time,
            speed: libm::log(fastest / vortex.speed),
            energy: libm::log(energy / first),
        }
    }
}
