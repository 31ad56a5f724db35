//! Water in a U-tube swings.

use sorb::{
    World,
    glam::Vec3,
    scene::{Body, Fluid, FluidBlock, Scene, ShapeKind, Time},
};

use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    norms::{interpolated, mean, upward_crossings},
    references::potential::Tank,
};

/// A U-tube.
pub(super) static CASE: Case = Case {
    name: "u_tube",
    title: "water swings between two shafts that a duct joins: period, and place half a period after it was let go",
    source: "w^2 = 2 g C / A, with the flow C of a unit of potential between the surfaces (potential flow)",
    subject: Subject::Water,
    control: "gravity that leans towards the higher surface",
    run,
};

/// Width of the shafts and height of the duct, which is twice as long \[m\].
const WIDTH: f64 = 0.04;
/// Particles over it.
const PARTICLES: u32 = 8;
/// Level at rest, and how much higher and lower it is at first \[m\].
const LEVEL: f64 = 0.13;
const HEIGHT: f64 = 0.01;
/// Particles across, along the axis that repeats.
const ACROSS: f64 = 6.0;
/// Cells of the reference over the width.
const CELLS: usize = 12;
/// Periods that are watched.
const PERIODS: f64 = 2.2;
const GRAVITY: f64 = 9.81;

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let spacing = WIDTH / f64::from(setting.count(setting.pick(PARTICLES, PARTICLES * 3 / 4)));
    let period = std::f64::consts::TAU / (2.0 * GRAVITY * conductance()).sqrt();
    let mut world = setting.world(&scene(setting, spacing))?;
    let mut samples = Vec::new();
    while world.clock().time < PERIODS * period {
        setting.advance(&mut world)?;
        samples.push((world.clock().time, centre(&world) - 2.0 * WIDTH));
    }
    let crossings = upward_crossings(&samples, 0.0);
    let found = match crossings[..] {
        [first, .., last] => (last - first) / (crossings.len() - 1) as f64,
        _ => f64::NAN,
    };
    // It should be as high on the other side then, but for what corners take.
    let swing = interpolated(&samples, 0.5 * period) / -samples[0].1;
    Ok(vec![
        Figure::relative("period", "s", period, found, 0.05),
        Figure::over(
            "height on the other side half a period later, over that at first",
            "1",
            (1.0, swing),
            1.0,
            0.15,
        ),
    ])
}

/// Flow of a unit of potential between the surfaces, over the area of a shaft \[1/m\].
fn conductance() -> f64 {
    let size = WIDTH / CELLS as f64;
    let rows = (LEVEL / size).round() as usize;
    let solid = |[x, y, _]: [f64; 3]| (x - 2.0 * WIDTH).abs() < WIDTH && y > WIDTH;
    let surface = |x: f64| if x < WIDTH { Some(1.0) } else { (x > 3.0 * WIDTH).then_some(0.0) };
    let tank = Tank::new([4 * CELLS, rows + 1, 1], size, solid).with_surface(rows - 1, surface);
    tank.flow(1.0).abs() / (WIDTH * size)
}

fn centre(world: &World) -> f64 {
    mean(world.particle_positions().iter().map(|x| f64::from(x[0])))
}

fn scene(setting: &Setting, spacing: f64) -> Scene {
    let across = ACROSS * spacing;
    let block = |from: [f64; 2], to: [f64; 2]| {
        let corner = |[x, y]: [f64; 2], z: f64| Vec3::new(x as f32, y as f32, z as f32);
        FluidBlock::new(corner(from, 0.0), corner(to, across))
    };
    let fluid = Fluid {
        spacing: spacing as f32,
        blocks: vec![
            block([0.0, 0.0], [WIDTH, LEVEL + HEIGHT]),
            block([WIDTH, 0.0], [3.0 * WIDTH, WIDTH]),
            block([3.0 * WIDTH, 0.0], [4.0 * WIDTH, LEVEL - HEIGHT]),
        ],
        ..Fluid::default()
    };
    let top = 2.0 * LEVEL;
    let half = [WIDTH, 0.5 * (top - WIDTH), 0.5 * across + 4.0 * spacing].map(|x| x as f32);
    let wall = Body::fixed(
        "wall",
        ShapeKind::Cuboid { half_extents: Vec3::from_array(half) },
        Vec3::new(2.0 * WIDTH as f32, (0.5 * (top + WIDTH)) as f32, 0.5 * across as f32),
    );
    let gravity = Vec3::new((-GRAVITY * setting.planted(0.0, 0.4)) as f32, -GRAVITY as f32, 0.0);
    Scene { gravity, time: Time { frame_rate: 100.0, ..Time::default() }, ..Scene::new("u_tube") }
        .in_box(Vec3::ZERO, Vec3::new(4.0 * WIDTH as f32, top as f32, across as f32))
        .repeating([false, false, true])
        .with_fluid(fluid)
        .with_body(wall)
}
