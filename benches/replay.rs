//! Saves, restores, snapshots and roll backs, and the largest scene for which a host can roll back eight frames in every frame.

#[path = "../tests/common/busy.rs"]
mod busy;

use criterion::{BatchSize, BenchmarkId, Criterion, criterion_group, criterion_main};
use sorb::{Command, Options, Save, Snapshot, World, glam::Vec3};

/// Frames before the first sample.
const FRAMES: u32 = 4;

/// A world in motion on two threads.
fn prepared(name: &str, resolution: f32) -> World {
    let options = Options { threads: Some(2), ..Options::default() };
    let mut world = World::with_options(&busy::scene(name, resolution), &options).expect("a preset is valid");
    for _ in 0..FRAMES {
        world.advance_frame().expect("a preset is stable");
    }
    world
}

fn states(criterion: &mut Criterion) {
    for name in ["ball_drop", "life"] {
        let world = prepared(name, 1.0);
        let mut group = criterion.benchmark_group(format!("state::{name}"));
        let save = world.to_save().expect("it can be saved");
        let (mut raw, mut packed) = (Vec::new(), Vec::new());
        save.write(&mut raw).expect("memory can be written");
        save.write_compressed(&mut packed).expect("memory can be written");
        group.bench_function("digest", |bencher| bencher.iter(|| world.digest()));
        group.bench_function("save", |bencher| {
            let mut out = Vec::with_capacity(raw.len());
            bencher.iter(|| {
                out.clear();
                world.save(&mut out).expect("memory can be written");
            });
        });
        group.bench_function("save, lz4", |bencher| {
            bencher.iter(|| {
                let mut out = Vec::with_capacity(raw.len());
                let save = world.to_save().expect("it can be saved");
                save.write_compressed(&mut out).expect("memory can be written");
            });
        });
        group.bench_function("restore in the same world", |bencher| {
            let mut other = world.clone();
            bencher.iter(|| {
                let save = Save::read(&raw[..]).expect("a save");
                other.resume(&save).expect("of this scene");
            });
        });
        group.bench_function("restore in the same world, lz4", |bencher| {
            let mut other = world.clone();
            bencher.iter(|| {
                let save = Save::read(&packed[..]).expect("a save");
                other.resume(&save).expect("of this scene");
            });
        });
        group.bench_function("restore as a new world", |bencher| {
            let options = Options { threads: Some(1), ..Options::default() };
            bencher.iter(|| World::restore(&raw[..], &options).expect("a save"));
        });
        group.bench_function("snapshot", |bencher| {
            let mut snapshot = Snapshot::new();
            world.snapshot_into(&mut snapshot);
            bencher.iter(|| world.snapshot_into(&mut snapshot));
        });
        group.bench_function("roll back", |bencher| {
            let (mut other, mut snapshot) = (world.clone(), Snapshot::new());
            world.snapshot_into(&mut snapshot);
            bencher.iter(|| other.rollback(&snapshot).expect("of this scene"));
        });
        group.bench_function("copy", |bencher| {
            bencher.iter_batched(|| (), |()| world.clone(), BatchSize::LargeInput)
        });
        group.finish();
    }
}

/// A roll back, eight frames, and a snapshot in each: what a frame costs a host with netcode in the worst case.
fn netcode(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("netcode");
    group.sample_size(10);
    for (name, resolution) in [
        ("dry", 0.3),
        ("dry", 0.4),
        ("dry", 0.5),
        ("water", 0.3),
        ("water", 0.4),
        ("water", 0.5),
        ("ball_drop", 0.3),
        ("ball_drop", 0.4),
        ("life", 0.3),
    ] {
        let mut world = prepared(name, resolution);
        let id = format!("{} particles, {} nodes", world.particle_ids().len(), world.node_positions().len());
        let mut first = Snapshot::new();
        world.snapshot_into(&mut first);
        let mut snapshots: Vec<Snapshot> = (0..8).map(|_| Snapshot::new()).collect();
        group.bench_function(BenchmarkId::new(name, id), |bencher| {
            bencher.iter(|| {
                world.rollback(&first).expect("of this scene");
                for snapshot in &mut snapshots {
                    world.push(Command::Gravity { gravity: Vec3::new(0.0, -9.81, 0.0) }).expect("in range");
                    world.advance_frame().expect("a preset is stable");
                    world.snapshot_into(snapshot);
                }
            });
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(30);
    targets = states, netcode
}
criterion_main!(benches);
