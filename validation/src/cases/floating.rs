//! Slabs of five densities float: Archimedes, and the period of heave.

use sorb::{
    World,
    glam::Vec3,
    scene::{Body, Fluid, FluidBlock, Scene, ShapeKind},
};

use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    level::heights,
    norms::{mean, upward_crossings},
    references::floating::heave_period,
};

/// Floating slabs.
///
/// Half as high as wide: a homogeneous cube floats upright only below 0.21 and above 0.79 of the density of water.
pub(super) static CASE: Case = Case {
    name: "floating",
    title: "a square slab half as high as wide floats, at five densities",
    source: "draft = L_y rho_b / rho; heave 2 pi sqrt((m + m_a) / (rho g A)), m_a by DNV-RP-C205",
    subject: Subject::Water,
    control: "a slab 1.5 times as heavy",
    run,
};

/// Side of the slab \[m\].
const SIDE: f64 = 0.1;
/// Its height \[m\].
const HEIGHT: f64 = 0.05;
/// Least side of the tank and depth of the water without the slab \[m\].
const TANK: (f64, f64) = (0.24, 0.12);
/// Particles over the side of the slab.
const PARTICLES: u32 = 12;
/// Density of the slab over that of water.
const DENSITIES: [f64; 5] = [0.01, 0.1, 0.3, 0.5, 0.9];
/// Gravity \[m/s^2\].
const GRAVITY: f64 = 9.81;

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let spacing = SIDE / f64::from(setting.count(setting.pick(PARTICLES, PARTICLES * 2 / 3)));
    let densities = setting.pick(&DENSITIES[..], &DENSITIES[3..4]);
    let mut figures = Vec::new();
    for density in densities {
        figures.extend(float(setting, *density, spacing)?);
    }
    Ok(figures)
}

fn float(setting: &Setting, density: f64, spacing: f64) -> Result<Vec<Figure>, Failure> {
    let mut world = setting.world(&scene(setting, density, spacing))?;
    let seconds = setting.pick(2.5, 1.5);
    let (mut heave, mut drafts) = (Vec::new(), Vec::new());
    while world.clock().time < seconds {
        setting.advance(&mut world)?;
        let bottom = f64::from(world.bodies()[0].state.position.y) - 0.5 * HEIGHT;
        heave.push((world.clock().time, bottom));
        if world.clock().time > seconds - 0.5 {
            drafts.push(level(&world, spacing)? - bottom);
        }
    }
    let draft = HEIGHT * density;
    let mut figures = vec![Figure::over(
        format!("draft at {density}, error over spacings"),
        "m",
        (draft, mean(drafts)),
        spacing,
        0.5,
    )];
    // The lightest slab has a draft below a spacing, and the heaviest one submerges.
    if !(0.2..0.8).contains(&density) {
        return Ok(figures);
    }
    let settled = mean(heave.iter().rev().take(30).map(|sample| sample.1));
    let crossings = upward_crossings(&heave, settled);
    // The first fall is no part of an oscillation: the water below settles as well.
    let period = match crossings[..] {
        [first, second, ..] => second - first,
        _ => f64::NAN,
    };
    figures.push(Figure::relative(
        format!("period of heave at {density}"),
        "s",
        heave_period(SIDE, draft, GRAVITY),
        period,
        0.1,
    ));
    Ok(figures)
}

/// The slab starts a fifth of its height above its draft.
fn scene(setting: &Setting, density: f64, spacing: f64) -> Scene {
    let half = (0.5 * tank(spacing)) as f32;
    let minimum = Vec3::new(-half, 0.0, -half);
    let fluid = Fluid {
        spacing: spacing as f32,
        blocks: vec![FluidBlock::new(minimum, Vec3::new(half, TANK.1 as f32, half))],
        ..Fluid::default()
    };
    let half_extents = Vec3::new(0.5 * SIDE as f32, 0.5 * HEIGHT as f32, 0.5 * SIDE as f32);
    let centre = TANK.1 + HEIGHT * (0.5 - density + 0.2);
    let mass = setting.planted(1.0, 1.5);
    let body = Body::dynamic(
        "slab",
        ShapeKind::Cuboid { half_extents },
        Vec3::new(0.0, centre as f32, 0.0),
        (1000.0 * density * mass) as f32,
    );
    Scene { gravity: Vec3::new(0.0, -GRAVITY as f32, 0.0), ..Scene::new("floating") }
        .in_box(minimum, Vec3::new(half, 2.0 * TANK.1 as f32, half))
        .with_fluid(fluid)
        .with_body(body)
}

/// Side of the tank: a whole number of spacings \[m\].
///
/// A block of water leaves what is less than a spacing free. With 0.8 spacings of it the level beside the slab is half a spacing below that
/// which the volume of the water gives.
fn tank(spacing: f64) -> f64 {
    (TANK.0 / spacing - 1e-6).ceil() * spacing
}

/// Mean level on a square half way between slab and walls.
fn level(world: &World, spacing: f64) -> Result<f64, Failure> {
    let side = (0.25 * (SIDE + tank(spacing))).max(0.5 * SIDE + 2.0 * spacing);
    let along = |index: i32| side * f64::from(index) / 4.0;
    let points: Vec<_> = (-4..=4)
        .flat_map(|i| [(along(i), side), (along(i), -side), (side, along(i)), (-side, along(i))])
        .collect();
    let found = heights(world, &points);
    if found.is_empty() {
        return Err(Failure::Nothing("no water beside the slab".to_owned()));
    }
    Ok(mean(found))
}
