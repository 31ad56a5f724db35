//! The same bits on every SIMD level and on any number of threads.

use super::scene::{CHANNEL, FULL, Options, Scene, TORUS, best, orders};
use crate::{
    KERNELS,
    columns::{Column, Columns},
    cpu::Cpu,
    kernel_named,
    lanes::SimdLevel,
};

/// All words of a column, padding rows included.
pub(super) fn words(columns: &Columns, column: Column) -> Vec<u32> {
    let mut words = Vec::new();
    columns.data(column).visit_words(usize::MAX, &mut |word| words.push(word));
    words
}

/// The first column of which two scenes do not hold the same bits.
fn difference(columns: &[Column], left: &Columns, right: &Columns) -> Option<Column> {
    columns.iter().copied().find(|column| words(left, *column) != words(right, *column))
}

#[expect(clippy::print_stdout, reason = "the log of a test says what it did not run")]
fn machines() -> Vec<Cpu> {
    for missing in SimdLevel::ALL.into_iter().filter(|level| !level.is_supported()) {
        println!("SKIPPED: {missing}, which this machine lacks");
    }
    let machine = |level, threads| Cpu::with_threads(level, threads).expect("the level is there");
    let threads = if cfg!(feature = "threads") { &[1, 2, 3, 8][..] } else { &[1] };
    SimdLevel::supported()
        .flat_map(|level| threads.iter().map(move |threads| machine(level, *threads)))
        .collect()
}

fn assert_same_bits(options: Options) {
    let machines = machines();
    assert!(machines.len() > 1, "nothing to compare: the machine has one level and no threads");
    for kernel in KERNELS {
        let before = Scene::new(options.suiting(kernel)).before(kernel.name, &best());
        let mut first: Option<Scene> = None;
        for machine in &machines {
            let mut after = before.clone();
            after.run(machine, &[kernel.name]);
            let first = first.get_or_insert_with(|| after.clone());
            let different = difference(kernel.writes, &first.columns, &after.columns);
            assert_eq!(different.map(Column::name), None, "{} on {machine:?}", kernel.name);
        }
    }
}

#[test]
fn every_kernel_gives_the_same_bits_on_every_level_and_number_of_threads() {
    assert_same_bits(FULL);
}

#[test]
fn unbounded_domains_and_full_last_groups_give_the_same_bits_too() {
    assert_same_bits(Options { fluid: 1000, bounded: false, walls: false, ..FULL });
}

#[test]
fn what_repeats_gives_the_same_bits_too() {
    assert_same_bits(CHANNEL);
    assert_same_bits(TORUS);
}

#[test]
fn wet_sponges_give_the_same_bits_too() {
    assert_same_bits(Options { wetting: true, ..FULL });
}

#[test]
fn a_single_bit_in_a_column_is_noticed() {
    let scene = Scene::new(FULL).before("sph::advect", &best());
    let mut altered = scene.clone();
    assert_eq!(difference(Column::ALL, &scene.columns, &altered.columns), None);
    let value = &mut altered.columns.fluid.velocity[700][1];
    *value = f32::from_bits(value.to_bits() ^ 1);
    let found = difference(Column::ALL, &scene.columns, &altered.columns);
    assert_eq!(found, Some(Column::FluidVelocity));
}

#[test]
fn kernels_without_work_do_no_harm() {
    let empty = Options { fluid: 0, sponges: false, bodies: false, walls: false, ..FULL };
    for options in [empty, Options { fluid: 9, ..empty }, Options { sponges: true, ..empty }] {
        let mut scene = Scene::new(options);
        for name in orders(FULL).concat() {
            let kernel = kernel_named(name).expect("a name of the table");
            (kernel.cpu)(&best(), &scene.params, &mut scene.columns);
        }
        let finite = |rows: &[[f32; 4]]| rows.iter().flatten().all(|value| value.is_finite());
        let columns = &scene.columns;
        assert!(finite(&columns.fluid.position) && finite(&columns.fluid.velocity), "{options:?}");
        assert!(finite(&columns.nodes.position) && finite(&columns.nodes.velocity), "{options:?}");
    }
}
