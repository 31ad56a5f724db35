//! Whole steps of every scene at the paper's size, and of two at 100 000 particles.
//!
//! With the feature `gpu` also on the best adapter of the machine: wall time, the host's part included.
//!
//! A sample always starts from the same state and takes the same number of steps. Its digest is compared with that of the
//! other samples, so that the timed work is the same every time.

#[path = "../tests/common/busy.rs"]
mod busy;
#[cfg(feature = "gpu")]
mod on_gpu;

use std::{
    cell::RefCell,
    collections::BTreeMap,
    time::{Duration, Instant},
};

use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use sorb::{World, scene::Scene};

/// Resolutions at which the scenes have about 100 000 particles.
const LARGE: [(&str, f32); 2] = [("water", 2.31), ("ball_drop", 2.35)];
/// Steps before the first sample.
const STEPS: u32 = 10;

/// A world in motion, and its digest after a few steps.
fn prepared(scene: &Scene) -> (World, u64) {
    let mut world = World::new(scene).expect("a preset is valid");
    for _ in 0..STEPS {
        world.step().expect("a preset is stable");
    }
    let digest = world.digest();
    (world, digest)
}

/// Time of some steps from the prepared state, and the digest after them.
fn steps(prepared: &World, count: u64) -> (Duration, u64) {
    let mut world = prepared.clone();
    let start = Instant::now();
    for _ in 0..count {
        world.step().expect("a preset is stable");
    }
    (start.elapsed(), world.digest())
}

fn bench(criterion: &mut Criterion, name: &str, size: &str, resolution: f32) {
    let scene = busy::scene(name, resolution);
    let mut group = criterion.benchmark_group(format!("step::{name}"));
    group.sampling_mode(SamplingMode::Flat);
    let particles = scene.estimate().particles;
    if particles > 0 {
        group.throughput(Throughput::Elements(particles));
    }
    let mut world: Option<World> = None;
    let digests: RefCell<BTreeMap<u64, u64>> = RefCell::default();
    // The closure runs only if the bench is selected.
    group.bench_function(BenchmarkId::from_parameter(size), |bencher| {
        let world = world.get_or_insert_with(|| {
            let (world, digest) = prepared(&scene);
            assert_eq!(prepared(&scene).1, digest, "{name}: two runs differ");
            world
        });
        bencher.iter_custom(|count| {
            let (time, digest) = steps(world, count);
            let expected = *digests.borrow_mut().entry(count).or_insert(digest);
            assert_eq!(digest, expected, "{name}: {count} steps ended elsewhere");
            time
        });
    });
    group.finish();
}

fn scenes(criterion: &mut Criterion) {
    for name in busy::names() {
        bench(criterion, name, "paper", 1.0);
    }
    for (name, resolution) in LARGE {
        bench(criterion, name, "100k", resolution);
    }
}

/// The same steps on a device: a sample takes its steps at once, as a frame does.
#[cfg(feature = "gpu")]
fn scenes_on_gpu(criterion: &mut Criterion) {
    let Some(gpu) = on_gpu::adapter() else { return };
    let paper = busy::names().map(|name| (name, "paper", 1.0));
    for (name, size, resolution) in paper.chain(LARGE.map(|(name, resolution)| (name, "100k", resolution))) {
        let scene = busy::scene(name, resolution);
        let mut group = criterion.benchmark_group(format!("step::{name}"));
        group.sampling_mode(SamplingMode::Flat);
        group.throughput(Throughput::Elements(scene.estimate().particles.max(1)));
        let mut prepared: Option<World> = None;
        group.bench_function(BenchmarkId::from_parameter(format!("{size}-gpu")), |bencher| {
            let prepared = prepared.get_or_insert_with(|| on_gpu::world(&scene, &gpu, false));
            bencher.iter_custom(|frames| {
                let mut world = prepared.clone();
                // The first frame uploads the state.
                world.advance_frame().expect("a preset is stable");
                let (before, start) = (world.clock().steps, Instant::now());
                for _ in 0..frames {
                    world.advance_frame().expect("a preset is stable");
                }
                let steps = (world.clock().steps - before).max(1);
                start.elapsed().mul_f64(frames as f64 / steps as f64)
            });
        });
        group.finish();
    }
}

#[cfg(not(feature = "gpu"))]
fn scenes_on_gpu(_criterion: &mut Criterion) {}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(3));
    targets = scenes, scenes_on_gpu
}
criterion_main!(benches);
