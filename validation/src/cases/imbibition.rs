//! A dry sponge absorbs water, without gravity and from a bath.

use sorb::{
    World,
    glam::{DVec3, UVec3, Vec3},
    scene::{Body, Fluid, FluidBlock, Scene, ShapeKind, Sponge, Time},
};

use super::duct::{Duct, STIFF, pores, surface};
use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    level::heights,
    norms::{line, mean, minimum},
    references::darcy::{Pores, curve_error},
};

/// At constant pressure.
///
/// Without tension the reservoir does not follow the water that leaves it: a weak acceleration pushes it. The weight of the
/// water in the duct adds to the pressure at the front, and hardly changes as water moves.
pub(super) static WASHBURN: Case = Case {
    name: "washburn",
    title: "a dry sponge in a duct absorbs water under constant pressure",
    source: "h = sqrt(2 K p t / (phi mu)), p = p_e and the push (Lucas, Washburn)",
    subject: Subject::Coupling,
    control: "a third of the entry pressure",
    run: washburn,
};

/// From a bath.
pub(super) static BATH: Case = Case {
    name: "imbibition",
    title: "a dry sponge hangs into a bath and absorbs water, at three permeabilities",
    source: "phi dz/dt = (K rho g / mu) (H - x) / x with the level of a finite bath; H = p_e / (rho g)",
    subject: Subject::Coupling,
    control: "a third of the entry pressure",
    run: bath,
};

/// Acceleration that pushes \[m/s^2\].
const PUSH: f64 = 1.0;
/// Depth of the reservoir \[m\].
const RESERVOIR: f64 = 0.07;
/// Length of the sponge of the duct \[m\], and cells across it at full resolution.
const LENGTH: f64 = 0.08;
const ACROSS: u32 = 4;

fn washburn(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let duct = Duct::new(setting, LENGTH, ACROSS);
    let mut figures = Vec::new();
    for permeability in setting.pick(&[2e-9, 5e-10][..], &[2e-9][..]) {
        let pores = pores(*permeability, 500.0);
        let given = Pores { entry_pressure: setting.planted(1.0, 1.0 / 3.0) * pores.entry_pressure, ..pores };
        let driven =
            Pores { entry_pressure: pores.entry_pressure + pores.density * PUSH * RESERVOIR, ..pores };
        let ends = (-RESERVOIR, duct.top() + duct.edge);
        let scene = duct.scene(setting, &given, -PUSH, ends, &[(-RESERVOIR, 0.0)])?;
        let mut world = setting.world(&scene)?;
        let seconds = driven.time(setting.pick(0.75, 0.55) * duct.top());
        let mut curve = Vec::new();
        while world.clock().time < seconds {
            setting.advance(&mut world)?;
            curve.push((world.clock().time, duct.surface(&world)?));
        }
        let reference: Vec<_> =
            (0..=400).map(|i| 1.2 * seconds * f64::from(i) / 400.0).map(|t| (t, driven.front(t))).collect();
        let delay = minimum((0.0, 0.2 * seconds), |delay| curve_error(&reference, &curve, delay));
        // Beyond two edges, where neither the start nor the smoothing of the suction matters.
        let points: Vec<_> = curve
            .iter()
            .filter(|(time, front)| *front > 2.0 * duct.edge && *time > delay)
            .map(|(time, front)| (libm::log(time - delay), libm::log(*front)))
            .collect();
        let exponent = if points.len() > 4 { line(&points).0 } else { f64::NAN };
        figures.push(Figure::error(
            format!("front at K {permeability:.0e}, L2, {:.0} ms late", 1e3 * delay),
            "1",
            curve_error(&reference, &curve, delay),
            0.05,
        ));
        figures.push(Figure::over(
            format!("exponent of time at K {permeability:.0e}"),
            "1",
            (0.5, exponent),
            1.0,
            0.03,
        ));
    }
    Ok(figures)
}

/// Cells of the sponge in the bath, at full resolution.
const BLOCK: [u32; 3] = [4, 7, 4];
/// Half of the width of the bath, height of the sponge above its floor, and depth of the water \[m\].
const BATH_SIZE: (f64, f64, f64) = (0.04, 0.01, 0.02);
/// Gravity \[m/s^2\].
pub(super) const GRAVITY: f64 = 9.81;

fn bath(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let mut figures = Vec::new();
    for permeability in setting.pick(&[1e-8, 4e-9, 1e-9][..], &[4e-9][..]) {
        let pores = pores(*permeability, 400.0);
        let given = Pores { entry_pressure: setting.planted(1.0, 1.0 / 3.0) * pores.entry_pressure, ..pores };
        let (cells, edge) = block_cells(setting);
        let mut world = setting.world(&bath_scene(setting, &given, cells, edge)?)?;
        let seconds = setting.pick(2.5, 1.0);
        let mut curve = Vec::new();
        while world.clock().time < seconds {
            setting.advance(&mut world)?;
            curve.push((world.clock().time, rise(&world, cells, edge)?));
        }
        let side = f64::from(cells.x) * edge;
        let outside = 4.0 * BATH_SIZE.0 * BATH_SIZE.0 - side * side;
        let reference = pores.bath(GRAVITY, pores.porosity * side * side / outside, seconds);
        // The part below the level starts dry as well.
        let delay = minimum((0.0, 0.3), |delay| curve_error(&reference, &curve, delay));
        figures.push(Figure::error(
            format!("front at K {permeability:.0e}, L2, {:.0} ms late", 1e3 * delay),
            "1",
            curve_error(&reference, &curve, delay),
            0.05,
        ));
        let last = mean(curve.iter().rev().take(20).map(|point| point.1));
        if *permeability >= 1e-8 {
            let spacing = 0.5 * edge;
            figures.push(Figure::over(
                format!("final height at K {permeability:.0e}, error over spacings"),
                "m",
                (pores.rise(GRAVITY), last),
                spacing,
                0.5,
            ));
        }
    }
    Ok(figures)
}

/// Cells of the sponge in the bath, and their edge \[m\].
pub(super) fn block_cells(setting: &Setting) -> (UVec3, f64) {
    let cells = UVec3::from_array(BLOCK.map(|cells| setting.count(cells)));
    (cells, 0.01 * f64::from(BLOCK[0]) / f64::from(cells.x))
}

pub(super) fn bath_scene(
    setting: &Setting,
    pores: &Pores,
    cells: UVec3,
    edge: f64,
) -> Result<Scene, Failure> {
    let (half, above, depth) = BATH_SIZE;
    let size = cells.as_dvec3() * edge;
    let sponge = Sponge {
        edge: edge as f32,
        cells,
        permeability: pores.permeability as f32,
        porosity: pores.porosity as f32,
        entry_pressure: pores.entry_pressure as f32,
        saturation_gain: 0.0,
        ..Sponge::new("block", DVec3::new(-0.5 * size.x, above, -0.5 * size.z).as_vec3())
    };
    let corner = DVec3::new(-half, 0.0, -half).as_vec3();
    let fluid = Fluid {
        spacing: (0.5 * edge) as f32,
        viscosity: pores.viscosity as f32,
        blocks: vec![FluidBlock::new(corner, DVec3::new(half, depth, half).as_vec3())],
        ..Fluid::default()
    };
    let top = above + size.y;
    let shape = ShapeKind::Cuboid { half_extents: DVec3::new(half, 0.1 * edge, half).as_vec3() };
    let hanger = Body { grip: true, ..Body::fixed("hanger", shape, Vec3::Y * top as f32) };
    let scene = Scene {
        gravity: Vec3::new(0.0, -GRAVITY as f32, 0.0),
        time: Time { frame_rate: 100.0, ..Time::default() },
        ..Scene::new("bath")
    }
    .in_box(corner, DVec3::new(half, top + edge, half).as_vec3())
    .with_fluid(fluid)
    .with_sponge(sponge)
    .with_body(hanger);
    Ok(STIFF.applied(&scene, &setting.solvers)?)
}

/// Height of the front on the axis of the sponge above the level half way between sponge and walls \[m\].
pub(super) fn rise(world: &World, cells: UVec3, edge: f64) -> Result<f64, Failure> {
    let inner = 0.5 * f64::from(cells.x) * edge;
    let front = surface(world, inner - edge)?;
    let side = 0.5 * (inner + BATH_SIZE.0);
    let along = |index: i32| side * f64::from(index) / 4.0;
    let points: Vec<_> = (-4..=4)
        .flat_map(|i| [(along(i), side), (along(i), -side), (side, along(i)), (-side, along(i))])
        .collect();
    let outside = heights(world, &points);
    Ok(front - if outside.is_empty() { 0.0 } else { mean(outside) })
}
