//! The force by pressures is the transpose of the divergence, with images and bodies: it keeps energy and both momenta.

use glam::{DVec3, Vec3};

use super::scene::{CHANNEL, FULL, Options, Scene, TORUS, best};
use crate::{columns::lane, divergence::image_rows::Images, grid::neighbors::Neighbors, testing::Random};

/// Without sponges.
const WATER: Options = Options { sponges: false, ..FULL };

fn vector(row: [f32; 4]) -> DVec3 {
    DVec3::new(f64::from(row[0]), f64::from(row[1]), f64::from(row[2]))
}

fn random_row(random: &mut Random, scale: f32) -> [f32; 4] {
    let mut next = || scale * (random.unit() - 0.5);
    [next(), next(), next(), 0.0]
}

/// What a fault does to a scene between the force and the divergence.
type Fault = fn(&mut Scene);

/// `sum P div v - sum a . v - sum f . u` over the sum of the magnitudes, for random pressures, velocities and motions of bodies.
fn imbalance(options: Options, fault: Fault) -> f64 {
    let kernel = crate::kernel_named("divergence::acceleration").expect("there is one");
    let mut scene = Scene::new(options.suiting(kernel)).before("divergence::acceleration", &best());
    let mut random = Random(7);
    let count = scene.columns.rows.fluid;
    let fluid = &mut scene.columns.fluid;
    for row in 0..count {
        let is_dense = fluid.renormalisation[row][lane::fluid::renormalisation::DENSITY] >= 0.75;
        fluid.predicted[row][lane::fluid::predicted::PRESSURE] = if is_dense { random.unit() } else { 0.0 };
    }
    for (row, source) in fluid.image_predicted.0.iter_mut().zip(&fluid.images.source) {
        row[3] = fluid.predicted[*source as usize][lane::fluid::predicted::PRESSURE];
    }
    fluid.velocity.iter_mut().for_each(|row| row[..3].fill(0.0));
    let store = &mut scene.columns.bodies;
    store.expected.fill([0.0; 4]);
    store.expected_spin.fill([0.0; 4]);
    scene.run(&best(), &["divergence::acceleration"]);
    let step = f64::from(scene.params.step);
    let a: Vec<DVec3> = scene.columns.fluid.correction.iter().map(|row| vector(*row) / step).collect();
    // Any field of velocities, and any motion of bodies.
    let spacing = scene.params.fluid.spacing;
    let fluid = &mut scene.columns.fluid;
    fluid.correction.iter_mut().take(count).for_each(|row| *row = random_row(&mut random, 1.0));
    fluid.factors.iter_mut().for_each(|row| row[lane::fluid::factors::TARGET] = 0.0);
    let store = &mut scene.columns.bodies;
    store.solved.iter_mut().for_each(|row| *row = random_row(&mut random, 1.0));
    store.solved_spin.iter_mut().for_each(|row| *row = random_row(&mut random, 0.1 / spacing));
    let motions: Vec<_> =
        store.solved.iter().zip(&store.solved_spin).map(|(u, w)| (vector(*u), vector(*w))).collect();
    fault(&mut scene);
    scene.run(&best(), &["divergence::residual"]);
    let (fluid, store) = (&scene.columns.fluid, &scene.columns.bodies);
    let (mut sum, mut size) = (0.0, 0.0);
    let mut add = |term: f64| {
        sum += term;
        size += term.abs();
    };
    for (row, a) in a.iter().enumerate().take(count) {
        let pressure = f64::from(fluid.predicted[row][lane::fluid::predicted::PRESSURE]);
        let closing = f64::from(fluid.pressure_rows[row][lane::fluid::pressure_rows::COMPRESSION]) / step;
        add(-pressure * closing);
        add(-a.dot(vector(fluid.correction[row])));
    }
    let momentum = f64::from(scene.params.fluid.particle_mass) * step;
    for (body, (linear, angular)) in motions.iter().enumerate() {
        let given = store.pressure_wrenches.total(body, motions.len());
        add(-given.impulse.dot(*linear) / momentum);
        add(-given.angular_impulse.dot(*angular) / momentum);
    }
    sum.abs() / size
}

#[test]
fn the_force_by_pressures_is_the_transpose_of_the_divergence() {
    for options in
        [WATER, CHANNEL, TORUS, Options { walls: false, ..WATER }, Options { bodies: false, ..WATER }]
    {
        let found = imbalance(options, |_| ());
        assert!(found < 2e-7, "{found:.1e} in {options:?}");
    }
}

#[test]
fn faults_of_images_and_bodies_are_noticed() {
    let faults: [(&str, Fault); 4] = [
        ("images in bodies without their volume", |scene| {
            let Images { near, pairs, position, source, .. } = &mut scene.columns.fluid.images;
            let count = source.len();
            let stored = pairs.clone();
            pairs.fill(near, |row, image| {
                let ratio = if image < count { position[image][3] } else { 1.0 };
                let own = near.of(row, count).position(|other| other as usize == image);
                own.map_or(0.0, |place| stored.of(near, row, place) / ratio)
            });
        }),
        ("reflection instead of the map of fluxes", |scene| {
            let images = &mut scene.columns.fluid.images;
            for (along, between) in images.along.iter_mut().zip(&mut images.between) {
                along[..3].fill(1.0);
                between[..3].fill(0.0);
            }
        }),
        ("bodies outside of the solve", |scene| {
            scene.columns.bodies.solved.fill([0.0; 4]);
            scene.columns.bodies.solved_spin.fill([0.0; 4]);
        }),
        ("walls that do not mirror", |scene| {
            scene.columns.fluid.images.axes.fill(0);
        }),
    ];
    for (name, fault) in faults {
        let found = imbalance(WATER, fault);
        assert!(found > 1e-4, "{name} is not noticed: {found:.1e}");
    }
}

#[test]
fn a_common_motion_of_water_and_bodies_has_no_divergence() {
    let kernel = crate::kernel_named("divergence::residual").expect("there is one");
    let largest = |bodies_move: bool| {
        // Walls do not move with the water.
        let mut scene = Scene::new(Options { walls: false, ..WATER }.suiting(kernel));
        scene = scene.before("divergence::residual", &best());
        let motion = Vec3::new(1.0, -2.0, 0.5).extend(0.0).to_array();
        let fluid = &mut scene.columns.fluid;
        fluid.correction.fill(motion);
        fluid.factors.iter_mut().for_each(|row| row[lane::fluid::factors::TARGET] = 0.0);
        scene.columns.bodies.solved.fill(if bodies_move { motion } else { [0.0; 4] });
        scene.columns.bodies.solved_spin.fill([0.0; 4]);
        scene.run(&best(), &["divergence::residual"]);
        let left = |row: &[f32; 4]| row[lane::fluid::pressure_rows::COMPRESSION].abs();
        scene.columns.fluid.pressure_rows.iter().map(left).fold(0.0, f32::max)
    };
    let (found, control) = (largest(true), largest(false));
    assert!(found < 1e-5 * control, "{found:.1e} of {control:.1e}");
}

/// What nodes do in a round, by smoothed and by barycentric weights.
const OF_NODES: [[&str; 2]; 2] =
    [["couple::solid_response", "couple::solid_velocity"], ["tets::response", "tets::velocity"]];

/// How much the answer to one field of pressures, weighed by another, differs from the other way round, in water with sponges at rest.
fn asymmetry([response, velocity]: [&str; 2], fault: Fault) -> f64 {
    let kernel = crate::kernel_named(velocity).expect("there is one");
    let before = Scene::new(FULL.suiting(kernel)).before(velocity, &best());
    let count = before.columns.rows.fluid;
    let mut random = Random(11);
    let is_dense =
        |row: usize| before.columns.fluid.renormalisation[row][lane::fluid::renormalisation::DENSITY] >= 0.75;
    let mut pressures =
        || -> Vec<f32> { (0..count).map(|row| if is_dense(row) { random.unit() } else { 0.0 }).collect() };
    let fields = [pressures(), pressures()];
    let answers = fields.each_ref().map(|field| {
        let mut scene = before.clone();
        let columns = &mut scene.columns;
        let fluid = &mut columns.fluid;
        for (row, pressure) in fluid.predicted.iter_mut().zip(field) {
            row[lane::fluid::predicted::PRESSURE] = *pressure;
        }
        for (row, source) in fluid.image_predicted.0.iter_mut().zip(&fluid.images.source) {
            row[3] = field[*source as usize];
        }
        fluid.velocity.iter_mut().for_each(|row| row[..3].fill(0.0));
        fluid.factors.iter_mut().for_each(|row| row[lane::fluid::factors::TARGET] = 0.0);
        for rows in [&mut columns.controls.material, &mut columns.controls.expected] {
            rows.iter_mut().for_each(|row| row[..3].fill(0.0));
        }
        columns.bodies.expected.fill([0.0; 4]);
        columns.bodies.expected_spin.fill([0.0; 4]);
        fault(&mut scene);
        scene.run(&best(), &["divergence::acceleration", response, velocity, "divergence::residual"]);
        let left = |row: &[f32; 4]| f64::from(row[lane::fluid::pressure_rows::COMPRESSION]);
        scene.columns.fluid.pressure_rows.iter().map(left).collect::<Vec<_>>()
    });
    let product = |field: &[f32], answer: &[f64]| -> f64 {
        field.iter().zip(answer).map(|(pressure, left)| f64::from(*pressure) * left).sum()
    };
    let (one, other) = (product(&fields[0], &answers[1]), product(&fields[1], &answers[0]));
    (one - other).abs() / (one.abs() + other.abs())
}

#[test]
fn the_system_with_sponges_is_symmetric() {
    for kernels in OF_NODES {
        let found = asymmetry(kernels, |_| ());
        assert!(found < 1e-6, "{kernels:?}: {found:.1e}");
    }
}

#[test]
fn faults_of_drag_and_material_are_noticed() {
    let [smoothed, barycentric] = OF_NODES;
    let faults: [([&str; 2], &str, Fault); 6] = [
        (barycentric, "nodes that feel the particles of others", |scene| {
            let (count, all) = (scene.columns.rows.nodes, 4 * scene.columns.rows.fluid);
            let corners = &mut scene.columns.controls.corners;
            let lists: Vec<Vec<u32>> =
                (0..count).rev().map(|control| corners.of(control, all).collect()).collect();
            *corners = Neighbors::from_lists(&lists, all as u32);
        }),
        (barycentric, "corners that particles take for others", |scene| {
            scene.columns.fluid.corners.0.iter_mut().for_each(|corners| corners.rotate_left(1));
        }),
        (barycentric, "material that moves with particles by another volume", |scene| {
            scene.columns.fluid.pushed.iter_mut().for_each(|row| row[0] *= 1.5);
        }),
        (smoothed, "drag that nodes do not feel", |scene| {
            scene.columns.fluid.held.fill([0.0; 4]);
        }),
        (smoothed, "drag that particles do not feel", |scene| {
            scene.columns.fluid.mobility.iter_mut().for_each(|row| row[0] = 1.0);
        }),
        (smoothed, "material of another volume on one side", |scene| {
            for row in &mut scene.columns.controls.material {
                row[lane::controls::material::VOLUME] = 0.0;
            }
            for (row, compliance) in scene.columns.controls.compliance.iter_mut().enumerate() {
                compliance[lane::controls::compliance::VOLUME] *= if row % 2 == 0 { 1.5 } else { 1.0 };
            }
        }),
    ];
    for (kernels, name, fault) in faults {
        let found = asymmetry(kernels, fault);
        assert!(found > 1e-5, "{name} is not noticed: {found:.1e}");
    }
}
