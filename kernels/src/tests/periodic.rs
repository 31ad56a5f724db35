//! Space that repeats: a lattice that has no end, momentum across the sides of the box, and no place that is special.

use glam::{DVec3, Vec3};

use super::{
    compare::errors,
    oracles::expected,
    scene::{CHANNEL, Options, Scene, TORUS, best},
};
use crate::{
    KERNELS,
    columns::{Columns, lane},
    oracle::apart,
};

/// The whole block: as many particles as fill the box.
const FILLED: Options = Options { fluid: super::scene::BLOCK, ..TORUS };

fn vector(row: [f32; 4]) -> DVec3 {
    Vec3::new(row[0], row[1], row[2]).as_dvec3()
}

/// A lattice at rest that fills the box, under the pressure of a density that is a hundredth too high.
fn lattice(options: Options) -> Scene {
    let mut scene = Scene::new(options);
    scene.params.gravity = Vec3::ZERO;
    scene.params.fluid.particle_mass *= 1.01;
    let spacing = scene.params.fluid.spacing;
    let fluid = &mut scene.columns.fluid;
    for row in fluid.position.iter_mut().take(options.fluid) {
        (0..3).for_each(|axis| row[axis] = ((row[axis] / spacing).floor() + 0.5) * spacing);
    }
    fluid.velocity.fill([0.0; 4]);
    let search = ["grid::sort_fluid", "grid::fluid_neighbors", "sph::density"];
    scene.run(&best(), &[&search[..], &["sph::pressure", "sph::forces", "sph::surface_tension"]].concat());
    scene
}

/// Spread of the density over its mean, and the largest acceleration over that by the pressure on one side.
fn unevenness(scene: &Scene) -> (f64, f64) {
    let (fluid, count) = (&scene.columns.fluid, scene.columns.rows.fluid);
    let density: Vec<f64> = fluid.density[..count].iter().map(|density| f64::from(*density)).collect();
    let (low, high) = density.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), d| (l.min(*d), h.max(*d)));
    let largest = fluid.acceleration[..count].iter().map(|row| vector(*row).length()).fold(0.0, f64::max);
    let pressure =
        f64::from(fluid.position[0][lane::fluid::position::PRESSURE_OVER_SQUARED_DENSITY] * fluid.density[0]);
    (high / low - 1.0, largest * f64::from(scene.params.fluid.spacing) / pressure)
}

#[test]
fn a_lattice_that_fills_a_box_that_repeats_has_no_end() {
    let (spread, acceleration) = unevenness(&lattice(FILLED));
    // Rounding of places: 1.2e-6 of the density, and 3.7e-5 of what the pressure does on one side.
    assert!(spread < 4e-6 && acceleration < 1e-4, "{spread:.1e} {acceleration:.1e}");
    // Negative control: along one axis it ends.
    let (spread, acceleration) = unevenness(&lattice(Options { periodic: [true, true, false], ..FILLED }));
    assert!(spread > 0.1 && acceleration > 0.1, "{spread:.1e} {acceleration:.1e}");
}

/// Sum of vectors over the sum of their lengths.
fn imbalance(rows: &[[f32; 4]]) -> f64 {
    let sum: DVec3 = rows.iter().map(|row| vector(*row)).sum();
    sum.length() / rows.iter().map(|row| vector(*row).length()).sum::<f64>()
}

#[test]
fn pairs_across_the_sides_of_the_box_keep_momentum() {
    let solved = Options { incompressible: true, cohesion: true, ..FILLED };
    for (name, options) in [("sph::forces", FILLED), ("sph::cohesion", solved)] {
        let mut scene = Scene::new(options).before(name, &best());
        scene.params.gravity = Vec3::ZERO;
        let count = scene.columns.rows.fluid;
        scene.columns.fluid.acceleration.fill([0.0; 4]);
        // The same number for all would push nobody.
        scene.columns.fluid.deficit.iter_mut().enumerate().for_each(|(row, lacks)| *lacks = (row % 7) as f32);
        scene.run(&best(), &[name]);
        let acceleration = &mut scene.columns.fluid.acceleration;
        assert!(imbalance(&acceleration[..count]) < 1e-6, "{name}");
        // Negative control: one particle of a thousand that feels double.
        (0..3).for_each(|axis| acceleration[500][axis] *= 2.0);
        assert!(imbalance(&acceleration[..count]) > 1e-5, "{name}");
    }
    let mut scene = Scene::new(solved).before("sph::pressure_acceleration", &best());
    scene.run(&best(), &["sph::pressure_acceleration"]);
    let (count, correction) = (scene.columns.rows.fluid, &mut scene.columns.fluid.correction);
    assert!(imbalance(&correction[..count]) < 1e-6, "{:.1e}", imbalance(&correction[..count]));
    (0..3).for_each(|axis| correction[500][axis] *= 2.0);
    assert!(imbalance(&correction[..count]) > 1e-5);
}

/// Rows by identity.
fn by_id(columns: &Columns, rows: &[[f32; 4]]) -> Vec<DVec3> {
    let mut pairs: Vec<(u32, [f32; 4])> =
        columns.fluid.id.iter().copied().zip(rows.iter().copied()).take(columns.rows.fluid).collect();
    pairs.sort_by_key(|(id, _)| *id);
    pairs.into_iter().map(|(_, row)| vector(row)).collect()
}

/// Positions and velocities after a step that begins with everything moved by `offset`; and put back.
fn moved(options: Options, offset: Vec3, fault: f32) -> (Scene, Vec<DVec3>, Vec<DVec3>) {
    let mut scene = Scene::new(options);
    let periodic = scene.params.periodic.expect("the scene repeats");
    for row in scene.columns.fluid.position.iter_mut().take(options.fluid) {
        (0..3).for_each(|axis| row[axis] += offset[axis]);
        periodic.wrap(row);
    }
    scene.columns.fluid.position[300][0] += fault;
    scene.step(&best());
    let columns = &scene.columns;
    let back = |x: DVec3| x - offset.as_dvec3();
    let positions = by_id(columns, &columns.fluid.position).into_iter().map(back).collect();
    let velocities = by_id(columns, &columns.fluid.velocity);
    (scene, positions, velocities)
}

/// Largest difference of a step from that of the scene as it is: positions over the spacing, velocities over the largest.
fn change(options: Options, offset: Vec3, fault: f32) -> (f64, f64) {
    let (scene, places, speeds) = moved(options, Vec3::ZERO, 0.0);
    let (_, other_places, other_speeds) = moved(options, offset, fault);
    let distance = |(a, b): (&DVec3, &DVec3)| apart(&scene.params, *a, *b).length();
    let farthest = places.iter().zip(&other_places).map(distance).fold(0.0, f64::max);
    let fastest = speeds.iter().map(|v| v.length()).fold(0.0, f64::max);
    let slip = speeds.iter().zip(&other_speeds).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    (farthest / f64::from(scene.params.fluid.spacing), slip / fastest)
}

#[test]
fn no_place_of_a_box_that_repeats_is_special() {
    let offset = Vec3::new(0.0237, 0.0119, 0.0401);
    for incompressible in [false, true] {
        let options = Options { incompressible, ..FILLED };
        let (farthest, slip) = change(options, offset, 0.0);
        assert!(farthest < 1e-4 && slip < 1e-4, "{farthest:.1e} {slip:.1e}");
        // Negative control: a particle that is a hundredth of a spacing elsewhere.
        let (farthest, slip) = change(options, offset, 5e-5);
        assert!(farthest > 1e-3 && slip > 1e-3, "{farthest:.1e} {slip:.1e}");
    }
}

/// Kernels in which pairs see each other across, and that which brings particles back.
pub(super) const ACROSS: &[&str] = &[
    "grid::fluid_neighbors",
    "sph::density",
    "sph::forces",
    "sph::spin",
    "sph::strain_rate",
    "sph::surface_tension",
    "sph::deficit",
    "sph::cohesion",
    "sph::viscosity_spin",
    "sph::viscosity_strain",
    "sph::viscosity_begin",
    "sph::viscosity_product",
    "sph::factors",
    "sph::pressure_acceleration",
    "sph::pressure_residual",
    "divergence::approach",
    "divergence::damping",
    "divergence::images",
    "divergence::moments",
    "divergence::hydrostatic",
    "divergence::acceleration",
    "divergence::residual",
    "sph::advect",
];

/// The control of the comparison with the oracles: a kernel that does not know that space repeats differs from its oracle.
#[test]
fn a_kernel_that_does_not_look_across_is_noticed() {
    for kernel in KERNELS.iter().filter(|kernel| ACROSS.contains(&kernel.name)) {
        let mut before = Scene::new(CHANNEL.suiting(kernel)).before(kernel.name, &best());
        // Some particles leave the box in the step.
        before.columns.fluid.velocity.iter_mut().for_each(|row| row[0] *= 10.0);
        let oracle = expected(kernel, &before);
        let worst = |periodic| {
            let mut found = before.clone();
            found.params.periodic = periodic;
            found.run(&best(), &[kernel.name]);
            let errors = errors(kernel, &before.params, &before.columns, &found.columns, &oracle);
            errors.iter().map(|(_, error)| *error).fold(0.0, f64::max)
        };
        let (right, wrong) = (worst(before.params.periodic), worst(None));
        assert!(right <= kernel.bound, "{} differs: {right:.1e}", kernel.name);
        assert!(wrong > kernel.bound, "{} does not notice: {wrong:.1e}", kernel.name);
    }
}

#[test]
fn everything_finite_is_put_into_the_box() {
    let periodic = Scene::new(CHANNEL).params.periodic.expect("the scene repeats");
    let (low, high) = periodic.corners();
    for x in [-1e30, -7.3, -1e-9, 0.0, 0.03, 0.065, 0.0651, 19.7, 3e38] {
        let mut row = [x, 5.0, x, 1.0];
        periodic.wrap(&mut row);
        assert!((low.x..=high.x).contains(&row[0]) && (low.z..=high.z).contains(&row[2]), "{x}: {row:?}");
        assert_eq!((row[1], row[3]), (5.0, 1.0));
    }
    for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut row = [x; 4];
        periodic.wrap(&mut row);
        assert!(!row[0].is_finite());
    }
}
