//! Properties that depend on wetness: swelling, softening, relative permeability, receding capillary pressure.

use sorb::{
    World,
    glam::{DVec3, UVec3, Vec3},
    scene::{Body, Fluid, FluidBlock, Scene, ShapeKind, Sponge, Time},
};

use super::{
    duct::{STIFF, pores},
    imbibition::{GRAVITY, bath_scene, block_cells, rise},
};
use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    norms::mean,
};

/// Swelling.
pub(super) static SWELLING: Case = Case {
    name: "swelling",
    title: "a sponge that floats in water swells",
    source: "edges at rest are longer by the swelling; the volume of the material is constant",
    subject: Subject::Coupling,
    control: "half of the swelling",
    run: swelling,
};

/// Softening.
pub(super) static SOFTENING: Case = Case {
    name: "softening",
    title: "a sponge that hangs in still water sags by its weight, with and without softening",
    source: "the sag is inverse to Young's modulus, which is 1 - softening of that of dry material",
    subject: Subject::Coupling,
    control: "three fifths of the softening",
    run: softening,
};

/// Relative permeability.
pub(super) static DRAINAGE: Case = Case {
    name: "drainage",
    title: "water that fills a part of the pores seeps down, at three exponents of the relative permeability",
    source: "v = K S^n rho g / (mu phi S) (Darcy, with the relative permeability of Brooks and Corey)",
    subject: Subject::Coupling,
    control: "an exponent that is one less",
    run: drainage,
};

/// Receding capillary pressure.
pub(super) static RECEDING: Case = Case {
    name: "receding",
    title: "a soaked sponge that hangs into a bath drains",
    source: "the remaining column has the height p_r / (rho g)",
    subject: Subject::Coupling,
    control: "no receding pressure",
    run: receding,
};

/// Elongation of wet material.
const SWELLING_OF_WET: f32 = 0.1;

fn in_still_water(sponge: Sponge, half: f64, depth: f64) -> Scene {
    let corner = DVec3::new(-half, 0.0, -half).as_vec3();
    let fluid = Fluid {
        spacing: 0.5 * sponge.edge,
        blocks: vec![FluidBlock::new(corner, DVec3::new(half, depth, half).as_vec3())],
        ..Fluid::default()
    };
    Scene {
        gravity: Vec3::new(0.0, -GRAVITY as f32, 0.0),
        time: Time { frame_rate: 50.0, ..Time::default() },
        ..Scene::new("still_water")
    }
    .in_box(corner, DVec3::new(half, depth + 0.03, half).as_vec3())
    .with_fluid(fluid)
    .with_sponge(sponge)
}

fn run_for(setting: &Setting, world: &mut World, seconds: f64) -> Result<(), Failure> {
    while world.clock().time < seconds - 1e-6 {
        setting.advance(world)?;
    }
    Ok(())
}

/// Only the water carries the sponge, which has the density of water: nothing else changes its length.
fn swelling(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let cells = setting.count(4);
    let (edge, porosity) = (0.04 / f64::from(cells), 0.9);
    let carried = |edge: f64, porosity: f64, swelling: f32| {
        let sponge = Sponge {
            edge: edge as f32,
            cells: UVec3::splat(cells),
            density: (1000.0 * (1.0 - porosity)) as f32,
            porosity: porosity as f32,
            permeability: 1e-8,
            entry_pressure: 0.0,
            saturation: 1.0,
            swelling,
            ..Sponge::new("sponge", Vec3::ZERO)
        };
        let position = Vec3::Y * 0.045 - 0.5 * sponge.size();
        let spacing = (0.02 / f64::from(cells)) as f32;
        let mut scene = in_still_water(Sponge { position, ..sponge }, 0.04, 0.09);
        scene.fluid = scene.fluid.map(|fluid| Fluid { spacing, ..fluid });
        let mut world = setting.world(&scene)?;
        run_for(setting, &mut world, setting.pick(2.0, 0.6))?;
        let rest = world.lattice().rest_volume(0).unwrap_or(f64::NAN);
        Ok::<_, Failure>((world.measures(), rest))
    };
    let (swollen, rest) = carried(edge, porosity, setting.planted(SWELLING_OF_WET, 0.5 * SWELLING_OF_WET))?;
    let size = 1.0 + f64::from(SWELLING_OF_WET);
    let (made_larger, _) = carried(edge * size, 1.0 - (1.0 - porosity) / (size * size * size), 0.0)?;
    Ok(vec![
        Figure::relative(
            "length over that of the dry sponge",
            "1",
            size,
            (swollen.sponge_volume / rest).cbrt(),
            0.01,
        ),
        Figure::relative(
            "water inside, against that of a sponge made that large",
            "kg",
            made_larger.absorbed_mass,
            swollen.absorbed_mass,
            0.1,
        ),
    ])
}

/// Share of the stiffness that wet material loses.
const SOFTENING_OF_WET: f32 = 0.5;
/// Mass of the hanging sponge over its volume \[kg/m^3\], and its Young's modulus \[Pa\].
const HANGING: (f32, f32) = (500.0, 1e4);

fn softening(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let planted = setting.planted(SOFTENING_OF_WET, 0.6 * SOFTENING_OF_WET);
    let (density, young) = HANGING;
    let stiff = sag(setting, young, 0.0)?;
    let softer = sag(setting, young, planted)?;
    // Less the buoyancy of the material.
    let load = (f64::from(density) - 0.1 * 1000.0) * GRAVITY;
    let expected = 0.5 * load * HANGING_LENGTH * HANGING_LENGTH / f64::from(young);
    let mut figures = vec![
        Figure::relative("sag of the sponge that does not soften", "m", expected, stiff, 0.15),
        Figure::relative("sag over that without softening", "1", 2.0, softer / stiff, 0.05),
    ];
    if !setting.quick {
        let made_softer = sag(setting, young * (1.0 - SOFTENING_OF_WET), 0.0)?;
        let over = softer / made_softer;
        figures.push(Figure::relative("sag over that of a softer sponge", "1", 1.0, over, 0.02));
    }
    Ok(figures)
}

/// Length of the sponge below its hanger \[m\].
const HANGING_LENGTH: f64 = 0.07;

/// Displacement of the lower end of a sponge in still water \[m\].
fn sag(setting: &Setting, young: f32, softening: f32) -> Result<f64, Failure> {
    let across = setting.count(3);
    let edge = 0.03 / f64::from(across);
    let along = setting.count(7);
    let (bottom, half) = (0.02, 0.03);
    let sponge = Sponge {
        edge: edge as f32,
        cells: UVec3::new(across, along, across),
        density: HANGING.0,
        young_modulus: young,
        damping: 0.01,
        permeability: 1e-8,
        entry_pressure: 0.0,
        saturation: 1.0,
        softening,
        ..Sponge::new("sponge", Vec3::new(-0.015, bottom, -0.015))
    };
    let top = f64::from(bottom) + edge * f64::from(along);
    // Water passes the hanger and covers it: a sponge near the surface of the water is not quite full.
    let shape = ShapeKind::Cuboid { half_extents: DVec3::new(0.016, 0.1 * edge, 0.016).as_vec3() };
    let hanger = Body { grip: true, ..Body::fixed("hanger", shape, Vec3::Y * top as f32) };
    let scene = in_still_water(sponge, half, top + 0.03).with_body(hanger);
    let mut world = setting.world(&scene)?;
    let lowest: Vec<usize> = (0..world.node_positions().len())
        .filter(|node| world.node_positions()[*node][1] < bottom + 1e-4)
        .collect();
    let height = |world: &World| mean(lowest.iter().map(|node| f64::from(world.node_positions()[*node][1])));
    let start = height(&world);
    run_for(setting, &mut world, setting.pick(1.5, 0.7))?;
    Ok(start - height(&world))
}

fn drainage(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let mut figures = Vec::new();
    for exponent in setting.pick(&[1, 2, 4][..], &[3][..]) {
        figures.push(seeping(setting, *exponent)?);
    }
    Ok(figures)
}

/// Initial saturation.
const FILLED: f32 = 0.6;
/// Time after which water seeps at its steady speed, and duration of the measurement \[s\].
const SEEPING: (f64, f64) = (0.04, 0.2);

/// Mean speed of the water in the middle of a sponge that fills a duct.
fn seeping(setting: &Setting, exponent: u32) -> Result<Figure, Failure> {
    let pores = pores(4e-9, 0.0);
    let cells = UVec3::new(setting.count(6), setting.count(8), setting.count(6));
    let edge = 0.06 / f64::from(cells.x);
    let (half, top) = (0.03, edge * f64::from(cells.y));
    let sponge = Sponge {
        edge: edge as f32,
        cells,
        permeability: pores.permeability as f32,
        porosity: pores.porosity as f32,
        entry_pressure: 0.0,
        saturation: FILLED,
        relative_permeability_exponent: setting.planted(exponent, exponent.max(2) - 1),
        ..Sponge::new("sponge", DVec3::new(-half, 0.0, -half).as_vec3())
    };
    let fluid = Fluid {
        spacing: (0.5 * edge) as f32,
        viscosity: pores.viscosity as f32,
        surface_tension: 0.0,
        ..Fluid::default()
    };
    let scene = Scene {
        gravity: Vec3::new(0.0, -GRAVITY as f32, 0.0),
        time: Time { frame_rate: 100.0, ..Time::default() },
        ..Scene::new("drainage")
    }
    .in_box(DVec3::new(-half, 0.0, -half).as_vec3(), DVec3::new(half, top + edge, half).as_vec3())
    .with_fluid(fluid)
    .with_sponge(sponge);
    let mut world = setting.world(&STIFF.applied(&scene, &setting.solvers)?)?;
    run_for(setting, &mut world, SEEPING.0)?;
    let middle = |place: f32, low: f64, high: f64| (low..high).contains(&f64::from(place));
    let inside: Vec<u32> = world
        .particle_positions()
        .iter()
        .zip(world.particle_ids())
        .filter(|(x, _)| {
            let across = |axis: usize| middle(x[axis], -0.4 * half, 0.4 * half);
            across(0) && across(2) && middle(x[1], 0.4 * top, 0.65 * top)
        })
        .map(|(_, id)| *id)
        .collect();
    let height = |world: &World| {
        let rows = world.particle_positions().iter().zip(world.particle_ids());
        mean(rows.filter(|(_, id)| inside.contains(id)).map(|(x, _)| f64::from(x[1])))
    };
    let start = height(&world);
    run_for(setting, &mut world, SEEPING.0 + SEEPING.1)?;
    let speed = (start - height(&world)) / SEEPING.1;
    // The saturation of whole numbers of particles.
    let rest = world.lattice().rest_volume(0).unwrap_or(f64::NAN);
    let filled = world.measures().water_mass / (pores.density * pores.porosity * rest);
    let full = pores.permeability * pores.density * GRAVITY / (pores.viscosity * pores.porosity);
    let expected = full * (1..exponent).fold(1.0, |product, _| product * filled);
    Ok(Figure::relative(format!("speed at the exponent {exponent}"), "m/s", expected, speed, 0.05))
}

/// Entry pressure, and pressure against which water leaves \[Pa\].
const PRESSURES: (f64, f64) = (150.0, 400.0);

fn receding(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let (cells, edge) = block_cells(setting);
    let pores = pores(1e-8, PRESSURES.0);
    let mut scene = bath_scene(setting, &pores, cells, edge)?;
    for sponge in &mut scene.sponges {
        sponge.saturation = 1.0;
        sponge.receding_pressure = setting.planted(PRESSURES.1 as f32, 0.0);
    }
    let mut world = setting.world(&scene)?;
    run_for(setting, &mut world, setting.pick(4.0, 2.0))?;
    let mut last = Vec::new();
    for _ in 0..20 {
        setting.advance(&mut world)?;
        last.push(rise(&world, cells, edge)?);
    }
    let reference = PRESSURES.1 / (pores.density * GRAVITY);
    Ok(vec![Figure::over(
        "height of the water that stays, error over spacings",
        "m",
        (reference, mean(last)),
        0.5 * edge,
        1.0,
    )])
}
