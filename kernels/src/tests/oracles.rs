//! Every kernel against its oracle in f64.

use glam::Vec3;

use super::{
    compare::errors,
    scene::{FULL, Options, Scene, all_options, best},
};
use crate::{
    KERNELS,
    column::{FAR, PlainMut},
    columns::{Column, Columns},
    grid::{cells::Domain, neighbors::ListValues},
    kernel::Kernel,
    kernel_named,
    pbd::stars::Stars,
};

/// The columns after the oracle.
pub(super) fn expected(kernel: &Kernel, before: &Scene) -> Columns {
    let mut columns = before.columns.clone();
    (kernel.oracle)(&before.params, &mut columns);
    columns
}

#[test]
fn kernels_agree_with_their_oracles() {
    let mut failures = Vec::new();
    for options in all_options() {
        for kernel in KERNELS {
            let before = Scene::new(options.suiting(kernel)).before(kernel.name, &best());
            if !before.has_work(kernel) {
                continue;
            }
            let oracle = expected(kernel, &before);
            let mut found = before.clone();
            found.run(&best(), &[kernel.name]);
            for (column, error) in errors(kernel, &before.params, &before.columns, &found.columns, &oracle) {
                if error > kernel.bound || error.is_nan() {
                    failures.push(format!("{} {}: {error:.1e} in {options:?}", kernel.name, column.name()));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn points_outside_of_the_domain_are_found_too() {
    let mut scene = Scene::new(FULL);
    scene.params.domain = Domain::Bounded { minimum: Vec3::splat(0.018), maximum: Vec3::splat(0.025) };
    for name in ["grid::sort_fluid", "grid::fluid_neighbors", "couple::controls"] {
        let kernel = kernel_named(name).expect("there is one");
        let before = scene.before(name, &best());
        let oracle = expected(kernel, &before);
        let mut found = before.clone();
        found.run(&best(), &[name]);
        for (column, error) in errors(kernel, &before.params, &before.columns, &found.columns, &oracle) {
            assert!(error == 0.0, "{name} {}", column.name());
        }
    }
}

/// Contact of sponges is a small part of the forces on few nodes, and has labels beside them. Places at rest only tell where
/// neighbours are.
const HARDLY_FELT: [Column; 4] =
    [Column::NodeTouch, Column::NodeTouchStiffness, Column::NodeTouchBetween, Column::NodeRest];

/// Factor of a fault that is not to be overlooked.
pub(super) fn fault_in(kernel: &Kernel, column: Column) -> f32 {
    match column {
        _ if kernel.name == "sph::sweep" => 1.05,
        // The target is a small part of what remains.
        Column::FluidFactors if kernel.name == "divergence::residual" => 1.05,
        // It only asks which particles are in pores.
        Column::FluidMoment if ["divergence::residual", "divergence::retention"].contains(&kernel.name) => {
            0.01
        }
        // It only asks which particles are at a surface.
        Column::FluidRenormalisation if kernel.name == "divergence::shift" => 0.5,
        // Water lies between sponges that touch: only what is below 1 counts.
        Column::ControlSaturation if kernel.name == "couple::contact_suction" => 0.4,
        // Drag, its moments about the nodes, and contact are a small part of what a sponge lacks. Wetness is a part of what makes a tet.
        Column::NodeDragMoment | Column::NodeWetting => 1.5,
        Column::NodeReaction | Column::NodeDrag => 1.01,
        // Nearly nothing in a neighbourhood that is nearly a lattice.
        Column::FluidRenormalisationBetween => 1.05,
        _ => 1.001,
    }
}

/// Scales a column of numbers; false if it has none.
pub(super) fn scale(columns: &mut Columns, column: Column, factor: f32) -> bool {
    if HARDLY_FELT.contains(&column) {
        return false;
    }
    match columns.data_mut(column).plain_mut() {
        Some(PlainMut::Rows(rows)) => {
            // Padding rows stay where they are.
            let used = rows.iter_mut().filter(|row| row[0].abs() < FAR);
            used.flatten().for_each(|value| *value *= factor);
            return !rows.is_empty();
        }
        Some(PlainMut::Values(values)) => {
            values.iter_mut().for_each(|value| *value *= factor);
            return !values.is_empty();
        }
        Some(PlainMut::Words(_)) => return false,
        None => {}
    }
    match column {
        Column::FluidControlWeights | Column::ControlFluidWeights | Column::FluidPairs => {
            let ListValues(chunks) = match column {
                Column::FluidPairs => &mut columns.fluid.pairs,
                Column::FluidControlWeights => &mut columns.fluid.control_weights,
                _ => &mut columns.controls.fluid_weights,
            };
            // Of every other entry: some kernels only know weights over their sum.
            chunks.iter_mut().flatten().step_by(2).flatten().for_each(|value| *value *= factor);
        }
        Column::FluidShares => {
            columns
                .fluid
                .shares
                .0
                .as_flattened_mut()
                .as_flattened_mut()
                .iter_mut()
                .for_each(|value| *value *= factor);
        }
        Column::FluidExtremes => {
            columns.fluid.extremes.0.iter_mut().for_each(|chunk| chunk.acceleration_squared *= factor);
        }
        Column::BodyStates => {
            for body in &mut columns.bodies.states.0 {
                body.state.position *= factor;
                body.state.linear_velocity *= factor;
            }
        }
        _ => return false,
    }
    true
}

/// Columns of which a kernel only keeps what it does not overwrite: the scalar beside a vector.
pub(super) const CARRIED: &[(&str, Column)] =
    &[("pbd::velocity", Column::NodeVelocity), ("couple::exchange", Column::NodeVelocity)];

#[test]
fn a_small_fault_in_any_column_that_a_kernel_reads_is_noticed() {
    let mut overlooked = Vec::new();
    for kernel in KERNELS {
        let before = Scene::new(Options { wetting: true, ..FULL }.suiting(kernel));
        let before = before.before(kernel.name, &best());
        let oracle = expected(kernel, &before);
        for column in kernel.reads.iter().copied() {
            let mut faulty = before.clone();
            let factor = fault_in(kernel, column);
            if !scale(&mut faulty.columns, column, factor) || CARRIED.contains(&(kernel.name, column)) {
                continue;
            }
            faulty.run(&best(), &[kernel.name]);
            let errors = errors(kernel, &before.params, &before.columns, &faulty.columns, &oracle);
            let worst = errors.iter().map(|(_, error)| *error).fold(0.0, f64::max);
            if worst <= kernel.bound || worst.is_nan() {
                overlooked.push(format!("{} does not notice {}: {worst:.1e}", kernel.name, column.name()));
            }
        }
    }
    assert!(overlooked.is_empty(), "{}", overlooked.join("\n"));
}

/// Kernels that know what tets stand for.
pub(super) const WEIGHED: &[&str] = &["pbd::vbd", "pbd::reaction", "pbd::xpbd_neo_hookean", "couple::pores"];

/// The scene with tets that stand for their own volume only.
pub(super) fn without_weights(scene: &Scene) -> Scene {
    let mut plain = scene.clone();
    let nodes = &mut plain.columns.nodes;
    assert!(nodes.topology.weights.iter().any(|weight| *weight > 1.1), "nothing to forget");
    nodes.topology.weights.fill(1.0);
    // The places that tell where neighbours are, from those at rest.
    nodes.stars = Stars::new(&nodes.topology, &nodes.rest, &nodes.sponge);
    plain
}

#[test]
fn weights_that_are_forgotten_on_one_side_are_noticed() {
    for name in WEIGHED {
        let kernel = kernel_named(name).expect("there is one");
        let before = Scene::new(FULL.suiting(kernel)).before(name, &best());
        let oracle = expected(kernel, &before);
        let mut faulty = without_weights(&before);
        faulty.run(&best(), &[name]);
        let errors = errors(kernel, &before.params, &before.columns, &faulty.columns, &oracle);
        let worst = errors.iter().map(|(_, error)| *error).fold(0.0, f64::max);
        assert!(worst > 10.0 * kernel.bound, "{name} does not notice: {worst:.1e}");
        // Negative control: forgotten on both sides, nothing is.
        let plain = without_weights(&before);
        let oracle = expected(kernel, &plain);
        let errors =
            super::compare::errors(kernel, &before.params, &before.columns, &faulty.columns, &oracle);
        assert!(errors.iter().all(|(_, error)| *error <= kernel.bound), "{name}");
    }
}

#[test]
fn a_small_fault_in_the_parameters_is_noticed() {
    let mut faulty = Scene::new(FULL).before("sph::density", &best());
    let density = kernel_named("sph::density").expect("there is one");
    let (before, oracle) = (faulty.clone(), expected(density, &faulty));
    faulty.params.fluid.particle_mass *= 1.001;
    faulty.run(&best(), &["sph::density"]);
    let errors = errors(density, &before.params, &before.columns, &faulty.columns, &oracle);
    assert!(errors[0].1 > 5e-4);

    let mut faulty = Scene::new(FULL).before("pbd::gravity", &best());
    let gravity = kernel_named("pbd::gravity").expect("there is one");
    let (before, oracle) = (faulty.clone(), expected(gravity, &faulty));
    faulty.params.gravity.y *= 1.001;
    faulty.run(&best(), &["pbd::gravity"]);
    let errors = super::compare::errors(gravity, &before.params, &before.columns, &faulty.columns, &oracle);
    assert!(errors[0].1 > 5e-4);
}
