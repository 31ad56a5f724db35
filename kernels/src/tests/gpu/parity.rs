//! Every kernel on the GPU against its body for the CPU.

use glam::Vec3;

use super::{
    super::{
        compare::{errors_of, image_error},
        oracles,
        periodic::ACROSS,
        scene::{CHANNEL, FULL, Options, Scene, TORUS, best},
    },
    after_on, after_on_all, gpu,
};
use crate::{
    KERNELS,
    columns::{Column, Columns},
    gpu::sponge_parts,
    grid::neighbors::Neighbors,
    kernel::Kernel,
    kernel_named,
    oracle::apart,
    params::EquationOfState,
};

/// Rounding of a value that a kernel adds to, in units in the last place of the largest value of its column. Adapters
/// may fuse a product with the sum, and divide within 2.5 units.
const ULPS: f64 = 4.0;

/// Sizes around those of a vector, of a group and of two lines of groups.
const SIZES: [usize; 7] = [0, 1, 63, 64, 65, 1000, 65_537];

/// The columns after a kernel on the CPU.
pub(super) fn on_cpu(kernel: &Kernel, before: &Scene) -> Columns {
    let mut after = before.clone();
    after.run(&best(), &[kernel.name]);
    after.columns
}

/// Pairs of particles or controls that only one of two lists has, farther from the radius than rounding.
fn list_error(column: Column, before: &Scene, found: &Columns, expected: &Columns) -> Option<f64> {
    fn pairs(columns: &Columns, column: Column) -> (&Neighbors, usize, usize, bool, bool) {
        let (fluid, nodes) = (columns.rows.fluid, columns.rows.nodes);
        match column {
            Column::FluidNeighbors => (&columns.fluid.neighbors, fluid, fluid, true, true),
            Column::FluidControls => (&columns.fluid.controls, fluid, nodes, true, false),
            _ => (&columns.controls.fluid, nodes, fluid, false, true),
        }
    }
    let radius = match column {
        Column::FluidNeighbors => before.params.fluid.smoothing.support_radius,
        Column::FluidControls | Column::ControlFluid => before.params.coupling.support_radius,
        _ => return None,
    };
    let all = |columns: &Columns| {
        let (lists, queries, targets, of_fluid, to_fluid) = pairs(columns, column);
        let (fluid, controls) = (&columns.fluid, &columns.controls);
        let identity = |row: usize, is_fluid: bool| if is_fluid { fluid.id[row] } else { controls.node[row] };
        let place =
            |row: usize, is_fluid: bool| if is_fluid { fluid.position[row] } else { controls.position[row] };
        let mut all = Vec::new();
        for query in 0..queries {
            for target in lists.of(query, targets) {
                let (a, b) = (place(query, of_fluid), place(target as usize, to_fluid));
                let [a, b] = [a, b].map(|[x, y, z, _]| Vec3::new(x, y, z).as_dvec3());
                let square = apart(&before.params, a, b).length_squared();
                let ratio = square / f64::from(radius).powi(2);
                if (ratio - 1.0).abs() > 1e-6 {
                    all.push((identity(query, of_fluid), identity(target as usize, to_fluid)));
                }
            }
        }
        all.sort_unstable();
        all
    };
    Some(if all(found) == all(expected) { 0.0 } else { f64::INFINITY })
}

/// Errors of everything that a kernel writes and a device holds.
pub(super) fn gpu_errors(
    kernel: &Kernel,
    before: &Scene,
    found: &Columns,
    expected: &Columns,
) -> Vec<(Column, f64)> {
    let held: Vec<_> = kernel.writes.iter().copied().filter(|column| !column.is_on_host_only()).collect();
    let mut all = errors_of(kernel, &held, ULPS, &before.params, &before.columns, found, expected);
    for (column, error) in &mut all {
        if *column == Column::FluidImages {
            *error = image_error(found, expected);
        }
        if let Some(list) = list_error(*column, before, found, expected) {
            *error = list;
        }
    }
    all
}

fn scenes() -> Vec<Options> {
    let mut all: Vec<_> = SIZES.map(|fluid| Options { fluid, ..FULL }).to_vec();
    all.push(Options { bodies: false, bounded: false, equation_of_state: EquationOfState::Linear, ..FULL });
    all.push(Options { walls: false, bounded: false, ..FULL });
    all.push(Options { sponges: false, ..FULL });
    all.push(Options { wetting: true, ..FULL });
    all.push(Options { compound: true, ..FULL });
    all.push(Options { compound: true, sponges: false, ..FULL });
    all.push(Options { wetting: true, fluid: 65, walls: false, ..FULL });
    all.extend([CHANNEL, TORUS]);
    all
}

#[test]
#[expect(clippy::print_stdout, reason = "how far apart they are is worth reading in a test that passes")]
fn twins_agree_with_the_cpu() {
    let (mut failures, mut worst) = (Vec::new(), vec![0.0_f64; KERNELS.len()]);
    for options in scenes() {
        for (index, kernel) in KERNELS.iter().enumerate() {
            let before = Scene::new(options.suiting(kernel)).before(kernel.name, &best());
            if !before.has_work(kernel) {
                continue;
            }
            let expected = on_cpu(kernel, &before);
            let found = after_on(gpu(), kernel, &before);
            for (column, error) in gpu_errors(kernel, &before, &found, &expected) {
                worst[index] = worst[index].max(error);
                if error > kernel.twin_bound || error.is_nan() {
                    failures.push(format!("{} {}: {error:.1e} in {options:?}", kernel.name, column.name()));
                }
            }
        }
    }
    for (kernel, worst) in KERNELS.iter().zip(worst) {
        println!("{:26} {worst:.1e} of {:.0e}", kernel.name, kernel.twin_bound);
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Nodes of large sponges are summed up in parts.
#[test]
fn momenta_of_large_sponges_agree_with_the_cpu() {
    let kernel = kernel_named("pbd::momentum").expect("there is one");
    let before = Scene::new(Options { fine: true, ..FULL }.suiting(kernel)).before(kernel.name, &best());
    assert!(sponge_parts(before.columns.rows.nodes) > 1, "{} nodes", before.columns.rows.nodes);
    let expected = on_cpu(kernel, &before);
    let worst = |before: &Scene| {
        let found = after_on(gpu(), kernel, before);
        let errors = gpu_errors(kernel, before, &found, &expected);
        errors.into_iter().map(|(_, error)| error).fold(0.0, f64::max)
    };
    let error = worst(&before);
    assert!(error <= kernel.twin_bound, "{error:.1e}");
    // Negative control: drag on the last nodes alone, which are in the last part.
    let mut altered = before.clone();
    let drag = &mut altered.columns.nodes.drag[..before.columns.rows.nodes];
    drag.iter_mut().rev().take(200).for_each(|row| row[0] += 1e-3);
    assert!(worst(&altered) > kernel.twin_bound);
}

/// Columns that a kernel reads and that its twin computes beside what it sums up.
const COMPUTED: &[(&str, Column)] = &[("couple::drag_impulse", Column::FluidInterior)];

#[test]
fn a_small_fault_in_what_a_twin_reads_is_noticed() {
    let mut overlooked = Vec::new();
    for kernel in KERNELS.iter().filter(|kernel| !kernel.reads.is_empty()) {
        let before = Scene::new(FULL.suiting(kernel)).before(kernel.name, &best());
        let expected = on_cpu(kernel, &before);
        let mut planted = 0;
        let is_held = |column: &Column| {
            column.element().bytes() > 0 && !column.is_on_host_only() || *column == Column::BodyStates
        };
        for column in kernel.reads.iter().copied().filter(is_held) {
            let mut altered = before.clone();
            let factor = oracles::fault_in(kernel, column);
            if !oracles::scale(&mut altered.columns, column, factor)
                || oracles::CARRIED.contains(&(kernel.name, column))
                || COMPUTED.contains(&(kernel.name, column))
            {
                continue;
            }
            planted += 1;
            let found = after_on(gpu(), kernel, &altered);
            let errors = gpu_errors(kernel, &before, &found, &expected);
            if !errors.iter().any(|(_, error)| *error > kernel.twin_bound) {
                overlooked.push(format!("{} does not notice {}: {errors:?}", kernel.name, column.name()));
            }
        }
        assert!(planted > 0, "{} reads no numbers", kernel.name);
    }
    assert!(overlooked.is_empty(), "{}", overlooked.join("\n"));
}

/// The control of what tets stand for: a twin that does not know differs from the CPU.
#[test]
fn a_twin_that_forgets_weights_is_noticed() {
    for name in oracles::WEIGHED {
        let kernel = kernel_named(name).expect("there is one");
        let before = Scene::new(FULL.suiting(kernel)).before(name, &best());
        let expected = on_cpu(kernel, &before);
        let found = after_on(gpu(), kernel, &oracles::without_weights(&before));
        let errors = gpu_errors(kernel, &before, &found, &expected);
        let is_noticed = errors.iter().any(|(_, error)| *error > 10.0 * kernel.twin_bound);
        assert!(is_noticed, "{name} does not notice: {errors:?}");
    }
}

/// The control of what repeats: a twin that does not know differs from the CPU.
#[test]
fn a_twin_that_does_not_look_across_is_noticed() {
    for kernel in KERNELS.iter().filter(|kernel| ACROSS.contains(&kernel.name)) {
        let mut before = Scene::new(CHANNEL.suiting(kernel)).before(kernel.name, &best());
        // Some particles leave the box in the step.
        before.columns.fluid.velocity.iter_mut().for_each(|row| row[0] *= 10.0);
        let expected = on_cpu(kernel, &before);
        let mut altered = before.clone();
        altered.params.periodic = None;
        let found = after_on(gpu(), kernel, &altered);
        let errors = gpu_errors(kernel, &before, &found, &expected);
        let is_noticed = errors.iter().any(|(_, error)| *error > kernel.twin_bound);
        assert!(is_noticed, "{} does not notice: {errors:?}", kernel.name);
    }
}

#[test]
fn the_search_sums_up_the_density() {
    for options in scenes() {
        let search = kernel_named("grid::fluid_neighbors").expect("there is one");
        let density = kernel_named("sph::density").expect("there is one");
        let before = Scene::new(options).before(density.name, &best());
        if !before.has_work(density) {
            continue;
        }
        let expected = on_cpu(density, &before);
        let found = after_on_all(gpu(), &[search, density], &before);
        for (column, error) in gpu_errors(density, &before, &found, &expected) {
            assert!(error <= density.twin_bound, "{}: {error:.1e} in {options:?}", column.name());
        }
    }
}

/// The control of the comparison of images: one entry of a list that is forgotten.
#[test]
fn a_list_of_images_that_lacks_an_entry_is_noticed() {
    let images = kernel_named("divergence::images").expect("there is one");
    let before = Scene::new(FULL.suiting(images)).before(images.name, &best());
    let expected = on_cpu(images, &before);
    assert!(image_error(&expected, &expected) == 0.0);
    let lists = |columns: &mut Columns| {
        let images = &mut columns.fluid.images;
        [std::mem::take(&mut images.pairs.0), std::mem::take(&mut images.particle_pairs.0)]
    };
    for which in 0..2 {
        let mut found = expected.clone();
        let mut values = lists(&mut found);
        let all = values[which].iter_mut().flatten().flatten();
        let typical = all.map(|value| *value).fold(0.0, f32::max) * 0.05;
        let one = values[which].iter_mut().flatten().flatten().find(|value| **value > typical);
        *one.expect("there is an entry") = 0.0;
        let [pairs, particle_pairs] = values;
        (found.fluid.images.pairs.0, found.fluid.images.particle_pairs.0) = (pairs, particle_pairs);
        let error = image_error(&found, &expected);
        assert!(error > 10.0 * images.twin_bound, "{which}: {error:.1e}");
    }
}
