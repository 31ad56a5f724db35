//! What steps, snapshots and roll backs allocate.

#[path = "../common/mod.rs"]
mod common;

use std::{
    alloc::{GlobalAlloc, Layout, System},
    cell::Cell,
};

use common::busy;
use sorb::{Options, Snapshot, World, rigid::BodyKind};

/// Counts what a thread allocates: how often, and how many bytes it holds.
struct Counting;

thread_local! {
    static COUNT: Cell<u64> = const { Cell::new(0) };
    static BYTES: Cell<i64> = const { Cell::new(0) };
}

fn count(number: u64, bytes: i64) {
    COUNT.with(|counter| counter.set(counter.get() + number));
    BYTES.with(|counter| counter.set(counter.get() + bytes));
}

#[expect(unsafe_code, reason = "an allocator is unsafe by its interface")]
// SAFETY: everything is passed to the allocator of the system as it is.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(1, layout.size() as i64);
        // SAFETY: as above.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count(0, -(layout.size() as i64));
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(1, size as i64 - layout.size() as i64);
        // SAFETY: as above.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Allocations of some work, and the bytes that it leaves.
fn allocations<R>(work: impl FnOnce() -> R) -> (u64, i64) {
    let before = (COUNT.get(), BYTES.get());
    let result = work();
    let found = (COUNT.get() - before.0, BYTES.get() - before.1);
    drop(result);
    found
}

/// A busy scene after some steps, on the thread that counts.
fn world(name: &str) -> World {
    let options = Options { threads: Some(1), ..Options::default() };
    let world = World::with_options(&busy::scene(name, 0.6), &options);
    let mut world = world.unwrap_or_else(|error| panic!("{name}: {error}"));
    common::steps(&mut world, 60);
    world
}

#[test]
fn snapshots_and_roll_backs_allocate_nothing_but_the_engine() {
    for name in busy::names() {
        let mut world = world(name);
        let mut snapshot = Snapshot::new();
        world.snapshot_into(&mut snapshot);
        let first = allocations(|| world.snapshot_into(&mut Snapshot::new())).0;
        assert!(first > 0, "{name}: the control: {first} allocations the first time");
        common::steps(&mut world, 5);
        world.rollback(&snapshot).unwrap_or_else(|error| panic!("{name}: {error}"));
        // rapier3d's sets have no copy in place; scripts have one.
        let is_dynamic = world.bodies().iter().any(|body| body.kind == BodyKind::Dynamic);
        let engine = if is_dynamic { allocations(|| world.rigid_engine().boxed_clone()).0 } else { 0 };
        let taken = allocations(|| world.snapshot_into(&mut snapshot)).0;
        assert!(taken <= engine, "{name}: {taken} allocations of a snapshot, {engine} of its engine");
        common::steps(&mut world, 5);
        let (taken, _) = allocations(|| world.rollback(&snapshot).is_ok());
        assert!(taken <= engine, "{name}: {taken} allocations of a roll back, {engine} of its engine");
    }
}

#[test]
#[expect(clippy::print_stdout, reason = "the table of the documentation")]
fn steps_hold_no_more_memory_than_before() {
    for name in busy::names() {
        let mut world = world(name);
        let first = allocations(|| common::steps(&mut world, 40));
        let later = allocations(|| common::steps(&mut world, 40));
        println!("| {name} | {} | {} bytes |", later.0 / 40, later.1);
        assert!(later.1 < 1 << 20, "{name}: {} bytes more after 40 steps", later.1);
        assert!(later.0 < first.0 * 3 / 2 + 100, "{name}: {} allocations, and {} before", later.0, first.0);
    }
    // The control.
    let (count, bytes) = allocations(|| vec![0_u8; 1 << 21]);
    assert!(count == 1 && bytes == 1 << 21);
}
