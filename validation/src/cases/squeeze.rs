//! A soaked sponge is pressed to half its height and released, at four permeabilities.

use sorb::{
    Measures, World,
    glam::{UVec3, Vec3},
    scene::{Body, Fluid, Motion, Scene, ShapeKind, Sponge, Time},
};

use crate::case::{Case, Failure, Figure, Setting, Subject};

/// Squeeze and release.
pub(super) static CASE: Case = Case {
    name: "squeeze",
    title: "a soaked sponge is pressed to half its height and released, at four permeabilities",
    source: "a sponge holds at most its pore volume, and loses the excess",
    subject: Subject::Coupling,
    control: "porosity 0.6 instead of 0.9",
    run,
};

/// Cells of the sponge along each axis, at full resolution.
const CELLS: u32 = 4;
/// Side of the sponge \[m\].
const SIDE: f64 = 0.04;
/// Speed of the plate \[m/s\], and when it starts to move down, stops, and goes up again \[s\].
const PLATE: (f64, [f32; 3]) = (0.08, [0.2, 0.45, 0.6]);
/// Pore volume over volume.
const POROSITY: f64 = 0.9;

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let mut figures = Vec::new();
    for permeability in setting.pick(&[1e-8, 1e-9, 1e-10, 1e-11][..], &[1e-9][..]) {
        figures.extend(squeeze(setting, *permeability)?);
    }
    Ok(figures)
}

fn squeeze(setting: &Setting, permeability: f64) -> Result<Vec<Figure>, Failure> {
    let mut world = setting.world(&scene(setting, permeability))?;
    let soaked = world.measures();
    let start = run_to(setting, &mut world, PLATE.1[0])?;
    let pressed = run_to(setting, &mut world, PLATE.1[1])?;
    let released = run_to(setting, &mut world, PLATE.1[2] + 0.6)?;
    let solid = (1.0 - POROSITY) * rest_volume(&world);
    let water = |measures: &Measures| measures.absorbed_mass / 1000.0;
    let lost = water(&start) - water(&pressed);
    let pores = |measures: &Measures| measures.sponge_volume - solid;
    // What counts as inside a sponge that is full: a tenth less than its pores, by its edges.
    let share = water(&soaked) / pores(&soaked);
    let expected = (water(&start) - share * pores(&pressed)).max(0.0);
    let over = |measures: &Measures| (water(measures) / pores(measures) - 1.0).max(0.0);
    let full = over(&start).max(over(&pressed)).max(over(&released));
    Ok(vec![
        Figure::over(
            format!("water pressed out at K {permeability:.0e}, over what it held"),
            "m^3",
            (expected, lost),
            water(&start),
            0.05,
        ),
        Figure::error(format!("water over pore volume at K {permeability:.0e}, excess"), "1", full, 0.05),
        Figure::relative(
            format!("volume after release at K {permeability:.0e}"),
            "m^3",
            start.sponge_volume,
            released.sponge_volume,
            0.05,
        ),
    ])
}

fn run_to(setting: &Setting, world: &mut World, seconds: f32) -> Result<Measures, Failure> {
    while world.clock().time < f64::from(seconds) - 1e-6 {
        setting.advance(world)?;
    }
    Ok(world.measures())
}

fn rest_volume(world: &World) -> f64 {
    world.lattice().rest_volume(0).unwrap_or(f64::NAN)
}

fn scene(setting: &Setting, permeability: f64) -> Scene {
    let cells = setting.count(CELLS);
    let edge = SIDE / f64::from(cells);
    let half = 0.5 * SIDE as f32;
    let sponge = Sponge {
        edge: edge as f32,
        cells: UVec3::splat(cells),
        permeability: permeability as f32,
        porosity: setting.planted(POROSITY as f32, 0.6),
        entry_pressure: 400.0,
        saturation_gain: 0.0,
        saturation: 1.0,
        ..Sponge::new("sponge", Vec3::new(-half, 0.0, -half))
    };
    let fluid = Fluid { spacing: (0.5 * edge) as f32, ..Fluid::default() };
    let (speed, [start, stop, back]) = PLATE;
    let along = |velocity: f64, start: f32, end: f32| Motion::Linear {
        velocity: Vec3::Y * velocity as f32,
        start,
        end,
        ease: 0.0,
    };
    let plate = Body::kinematic(
        "plate",
        ShapeKind::Cuboid { half_extents: Vec3::new(2.0 * half, 0.005, 2.0 * half) },
        Vec3::Y * (SIDE as f32 + 0.005),
        vec![along(-speed, start, stop), along(speed, back, back + stop - start)],
    );
    Scene { time: Time { frame_rate: 100.0, ..Time::default() }, ..Scene::new("squeeze") }
        .in_box(Vec3::new(-0.05, 0.0, -0.05), Vec3::new(0.05, 0.1, 0.05))
        .with_fluid(fluid)
        .with_sponge(sponge)
        .with_body(plate)
}
