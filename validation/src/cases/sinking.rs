//! Spheres and cuboids a little lighter and heavier than water rise and sink: added mass, drag, and that they arrive.

use sorb::{
    World,
    glam::Vec3,
    scene::{Body, Fluid, FluidBlock, Scene, ShapeKind},
};

use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    norms::{first_crossing, interpolated},
    references::sinking::{Path, Setup, Shape},
};

/// Bodies that sink and rise.
pub(super) static CASE: Case = Case {
    name: "sinking",
    title: "spheres and cuboids of six densities near that of water sink and rise from rest",
    source: "weight, buoyancy, added mass between walls, floor and surface (potential flow), drag of Clift and Gauvin (1971)",
    subject: Subject::Water,
    control: "the body twice as far from the density of water, on its other side",
    run,
};

/// Radius of the sphere \[m\], and half extents of the cuboid.
const RADIUS: f64 = 0.03;
const HALF: [f64; 3] = [0.03, 0.025, 0.03];
/// Particles over the radius.
const PARTICLES: u32 = 6;
/// Width of the square tank and depth of the water \[m\].
const TANK: (f64, f64) = (0.15, 0.18);
/// Height of the centre at first \[m\].
const START: f64 = 0.09;
/// Densities over that of water.
const DENSITIES: [f64; 6] = [0.9, 0.98, 1.02, 1.05, 1.12, 1.3];
const GRAVITY: f64 = 9.81;
/// Time over which paths are compared \[s\], or less if the reference is that much of its way earlier.
const COMPARED: f64 = 0.3;
const WAY: f64 = 0.7;
/// Gap at which a body has arrived, in spacings: at first water is pushed out from under it, or it comes through the surface.
const ARRIVED: f64 = 2.0;
/// Longest time over that of the reference that a body is waited for, and what is added \[s\].
const PATIENCE: (f64, f64) = (1.5, 0.5);

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let spacing = RADIUS / f64::from(setting.count(setting.pick(PARTICLES, PARTICLES * 2 / 3)));
    let sphere = ("sphere", Shape::Sphere(RADIUS), setting.pick(&DENSITIES[..], &[1.12]));
    let cuboid = ("cuboid", Shape::Cuboid(HALF), setting.pick(&DENSITIES[..], &[1.3]));
    let mut figures = Vec::new();
    for (name, shape, densities) in [sphere, cuboid] {
        let reference = Setup { shape, width: TANK.0, depth: TANK.1, gravity: GRAVITY, viscosity: 1e-6 };
        let added = reference.added_mass();
        for density in densities {
            let path = reference.path(*density, START, &added);
            figures.extend(compare(
                setting,
                (shape, *density),
                &format!("{name} of {density}"),
                spacing,
                &path,
            )?);
        }
    }
    Ok(figures)
}

fn compare(
    setting: &Setting,
    (shape, density): (Shape, f64),
    name: &str,
    spacing: f64,
    path: &Path,
) -> Result<Vec<Figure>, Failure> {
    let mut world = setting.world(&scene(setting, (shape, density), spacing))?;
    let (sinks, half) = (density > 1.0, shape.half_height());
    // Where it has arrived.
    let goal = if sinks { half + ARRIVED * spacing } else { TANK.1 - half - ARRIVED * spacing };
    let arrival = path.time_at(goal);
    let end = PATIENCE.0 * arrival + PATIENCE.1;
    let mut heights = vec![(0.0, START)];
    while world.clock().time < end {
        setting.advance(&mut world)?;
        heights.push((world.clock().time, height(&world)));
    }
    let compared = COMPARED.min(path.time_at(START + WAY * (goal - START)));
    let way = (path.height(compared) - START, interpolated(&heights, compared) - START);
    let last = heights[heights.len() - 1].1;
    let mut figures = vec![
        Figure::relative(format!("{name}: path in {compared:.2} s"), "m", way.0, way.1, 0.15),
        // One that never arrives took for ever.
        Figure::relative(
            format!("{name}: time to {}", if sinks { "the floor" } else { "the surface" }),
            "s",
            arrival,
            first_crossing(&heights, goal).unwrap_or(f64::INFINITY),
            0.25,
        ),
    ];
    if sinks {
        let gap = last - half;
        figures.push(Figure::over(
            format!("{name}: gap to the floor in the end"),
            "m",
            (0.0, gap),
            spacing,
            1.0,
        ));
    }
    Ok(figures)
}

fn height(world: &World) -> f64 {
    f64::from(world.bodies()[0].state.position.y)
}

fn scene(setting: &Setting, (shape, density): (Shape, f64), spacing: f64) -> Scene {
    let half = (0.5 * TANK.0) as f32;
    let minimum = Vec3::new(-half, 0.0, -half);
    let fluid = Fluid {
        spacing: spacing as f32,
        blocks: vec![FluidBlock::new(minimum, Vec3::new(half, TANK.1 as f32, half))],
        ..Fluid::default()
    };
    let kind = match shape {
        Shape::Sphere(radius) => ShapeKind::Sphere { radius: radius as f32 },
        Shape::Cuboid(half) => ShapeKind::Cuboid { half_extents: Vec3::from_array(half.map(|x| x as f32)) },
    };
    let density = setting.planted(density, 1.0 - 2.0 * (density - 1.0));
    let body = Body::dynamic("body", kind, Vec3::new(0.0, START as f32, 0.0), (1000.0 * density) as f32);
    Scene { gravity: Vec3::new(0.0, -GRAVITY as f32, 0.0), ..Scene::new("sinking") }
        .in_box(minimum, Vec3::new(half, 1.4 * TANK.1 as f32, half))
        .with_fluid(fluid)
        .with_body(body)
}
