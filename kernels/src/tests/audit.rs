//! Declared = actual: a kernel writes the columns that it says, and reads no others.
//!
//! Undeclared writes are found by comparing all other columns before and after. Undeclared reads are found by
//! poisoning all columns that are not declared as read, and demanding the same output. A written column that is
//! not read is poisoned as well.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::{
    levels::words,
    scene::{CHANNEL, FULL, Options, Scene, best},
};
use crate::{
    KERNELS,
    columns::{Column, Columns},
    cpu::Cpu,
    kernel_named,
};

/// What is wrong with a declaration, if anything.
fn audit(
    run: fn(&Cpu, &crate::params::Params, &mut Columns),
    reads: &[Column],
    writes: &[Column],
    before: &Scene,
) -> Result<(), String> {
    let cpu = best();
    let mut after = before.columns.clone();
    run(&cpu, &before.params, &mut after);
    for column in Column::ALL.iter().filter(|column| !writes.contains(column)) {
        if words(&after, *column) != words(&before.columns, *column) {
            return Err(format!("writes {}", column.name()));
        }
    }
    let mut poisoned = before.columns.clone();
    for column in Column::ALL.iter().filter(|column| !reads.contains(column)) {
        poisoned.data_mut(*column).poison();
    }
    // A poisoned index may well panic: that is a read as well.
    let outcome = catch_unwind(AssertUnwindSafe(|| run(&cpu, &before.params, &mut poisoned)));
    if outcome.is_err() {
        return Err("panics without the columns that it does not read".to_owned());
    }
    let differs = |column: &&Column| words(&after, **column) != words(&poisoned, **column);
    match writes.iter().find(differs) {
        Some(column) => Err(format!("reads more than declared for {}", column.name())),
        None => Ok(()),
    }
}

/// With everything that kernels may read.
const WETTED: Options = Options { wetting: true, ..FULL };

fn scenes() -> Vec<Options> {
    vec![
        WETTED,
        FULL,
        Options { fluid: 200, bounded: false, ..FULL },
        CHANNEL,
        Options { fluid: 9, walls: false, ..FULL },
    ]
}

fn without(columns: &[Column], column: Column) -> Vec<Column> {
    columns.iter().copied().filter(|other| *other != column).collect()
}

#[test]
fn kernels_read_and_write_what_they_declare() {
    let mut failures = Vec::new();
    for options in scenes() {
        for kernel in KERNELS {
            let before = Scene::new(options.suiting(kernel)).before(kernel.name, &best());
            // Without sponges there are no columns that a kernel of theirs could be seen to read.
            if !options.sponges && !before.has_work(kernel) {
                continue;
            }
            if let Err(error) = audit(kernel.cpu, kernel.reads, kernel.writes, &before) {
                failures.push(format!("{} {error} in {options:?}", kernel.name));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn every_declared_column_is_needed() {
    let mut superfluous = Vec::new();
    for kernel in KERNELS {
        // A round may need a column only because it is the first.
        let scene = Scene::new(WETTED.suiting(kernel));
        let scenes = [scene.before_place(kernel.name, &best(), 0), scene.before(kernel.name, &best())];
        let is_ok = |reads: &[Column], writes: &[Column]| {
            scenes.iter().all(|before| audit(kernel.cpu, reads, writes, before).is_ok())
        };
        for column in kernel.reads {
            if is_ok(&without(kernel.reads, *column), kernel.writes) {
                superfluous.push(format!("{} does not read {}", kernel.name, column.name()));
            }
        }
        for column in kernel.writes {
            if is_ok(kernel.reads, &without(kernel.writes, *column)) {
                superfluous.push(format!("{} does not write {}", kernel.name, column.name()));
            }
        }
    }
    assert!(superfluous.is_empty(), "{}", superfluous.join("\n"));
}

#[test]
fn lies_are_found() {
    let kernel = kernel_named("sph::density").expect("there is one");
    let before = Scene::new(FULL.suiting(kernel)).before(kernel.name, &best());
    let audit = |reads: &[Column], writes: &[Column]| audit(kernel.cpu, reads, writes, &before);
    assert_eq!(audit(kernel.reads, kernel.writes), Ok(()));
    let lie = audit(&without(kernel.reads, Column::FluidPosition), kernel.writes);
    assert_eq!(lie, Err("reads more than declared for fluid.density".to_owned()));
    let lie = audit(&without(kernel.reads, Column::FluidNeighbors), kernel.writes);
    assert_eq!(lie, Err("panics without the columns that it does not read".to_owned()));
    let lie = audit(kernel.reads, &[]);
    assert_eq!(lie, Err("writes fluid.density".to_owned()));
}
