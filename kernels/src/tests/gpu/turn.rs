//! A turn of the container on a device against the CPU, and the CPU against its equation in f64.

use glam::{DVec3, Mat3, Vec3};

use super::{
    super::scene::{FULL, Scene},
    LIMITS, gpu,
};
use crate::{
    columns::{Column, Columns, lane},
    gpu::{GpuError, Resident},
    turn::Turn,
};

fn turn() -> Turn {
    let coriolis = Mat3::from_axis_angle(Vec3::new(0.6, 0.0, 0.8), 0.02);
    Turn::new(coriolis, Mat3::from_cols(Vec3::X * 0.3, Vec3::new(0.1, -0.2, 4.0), Vec3::NEG_Y * 5.0))
}

/// A scene in which a body holds the first nodes.
fn scene() -> Scene {
    let mut scene = Scene::new(FULL);
    scene.columns.nodes.position[..5]
        .iter_mut()
        .for_each(|row| row[lane::nodes::position::INVERSE_MASS] = 0.0);
    scene
}

fn on_device(scene: &Scene, turn: &Turn, sorted: bool) -> Columns {
    let fail = |error: GpuError| -> ! { panic!("{error}") };
    let mut columns = scene.columns.clone();
    let mut resident =
        Resident::new(gpu(), &columns, &scene.params, LIMITS).unwrap_or_else(|error| fail(error));
    let state = [Column::FluidPosition, Column::FluidVelocity, Column::NodePosition, Column::NodeVelocity];
    resident.upload(&mut columns, &state, sorted).unwrap_or_else(|error| fail(error));
    resident.turn(turn).unwrap_or_else(|error| fail(error));
    resident.download(&mut columns, &state).unwrap_or_else(|error| fail(error));
    columns
}

/// Largest difference of velocities, over the largest speed.
fn apart(found: &Columns, expected: &Columns) -> f64 {
    let rows = |columns: &Columns| {
        let (fluid, nodes) =
            (&columns.fluid.velocity[..columns.rows.fluid], &columns.nodes.velocity[..columns.rows.nodes]);
        fluid.iter().chain(nodes).copied().collect::<Vec<_>>()
    };
    let vector = |row: &[f32; 4]| DVec3::new(row[0].into(), row[1].into(), row[2].into());
    let (found, expected) = (rows(found), rows(expected));
    let largest = expected.iter().map(|row| vector(row).length()).fold(0.0, f64::max);
    let pairs = found.iter().zip(&expected);
    let error = |(found, expected): (&[f32; 4], &[f32; 4])| {
        assert_eq!(found[3].to_bits(), expected[3].to_bits(), "the fourth lane");
        vector(found).distance(vector(expected)) / largest
    };
    pairs.map(error).fold(0.0, f64::max)
}

#[test]
fn twins_turn_velocities_as_the_cpu_does() {
    let scene = scene();
    let mut expected = scene.columns.clone();
    turn().apply(&mut expected);
    for sorted in [false, true] {
        let error = apart(&on_device(&scene, &turn(), sorted), &expected);
        assert!(error < 1e-6, "sorted {sorted}: {error:.1e}");
    }
    // The controls: a turn without the part that depends on the place, and one of held nodes as well.
    let [coriolis, _] = turn().matrices();
    let error = apart(&on_device(&scene, &Turn::new(coriolis, Mat3::ZERO), false), &expected);
    assert!(error > 1e-3, "{error:.1e}");
    let mut free = scene.clone();
    free.columns.nodes.position[..5].copy_from_slice(&Scene::new(FULL).columns.nodes.position[..5]);
    let error = apart(&on_device(&free, &turn(), false), &expected);
    assert!(error > 1e-4, "{error:.1e}");
}

#[test]
fn the_cpu_turns_velocities_by_the_equation() {
    let scene = scene();
    let mut found = scene.columns.clone();
    turn().apply(&mut found);
    let [coriolis, field] = turn().matrices().map(|matrix| matrix.as_dmat3());
    let row = |row: &[f32; 4]| DVec3::new(row[0].into(), row[1].into(), row[2].into());
    let fluid = &scene.columns.fluid;
    for index in 0..scene.columns.rows.fluid {
        let expected = coriolis * row(&fluid.velocity[index]) + field * row(&fluid.position[index]);
        assert!(row(&found.fluid.velocity[index]).distance(expected) < 1e-6 * (1.0 + expected.length()));
    }
    let held = &found.nodes.velocity[..5];
    assert_eq!(held, &scene.columns.nodes.velocity[..5], "held nodes move with their body");
    assert_ne!(&found.nodes.velocity[5..10], &scene.columns.nodes.velocity[5..10], "the control");
}
