//! Every kernel of the table, on the columns of the first scene of a list that runs it.
//!
//! The scenes are `ball_drop` with the ball on the sponge and with surface tension, in the models that scenes can name. They have the
//! paper's size and 100 000 particles. With the feature `gpu` also the twins, on the best adapter of the machine. There a kernel is
//! timed by time stamps of the device, within whole steps.

#[path = "../tests/common/busy.rs"]
mod busy;
#[cfg(feature = "gpu")]
mod on_gpu;

use std::{
    hint::black_box,
    time::{Duration, Instant},
};

use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use sorb::{
    Cpu, World,
    internal::{self, KERNELS, Verdict, columns::Columns, kernel::Kernel, params::Params},
    scene::Scene,
};

/// (name, resolution): 7650 and about 100 000 particles.
const SIZES: [(&str, f32); 2] = [("paper", 1.0), ("100k", 2.35)];
/// Steps before the columns are copied: lists are filled and the ball is in contact.
const STEPS: u32 = 5;
/// Calls after which the columns are restored: most kernels change what they read, such as positions.
const CALLS: u64 = 16;

/// Names of busy scenes with the keys that are changed in them. A kernel is timed in the first one that runs it.
const MODELS: [(&str, &[&str]); 8] = [
    ("ball_drop", &[]),
    ("ball_drop_smoothed", &[]),
    ("ball_drop_paper", &[]),
    ("ball_drop", &["fluid.solver=\"dfsph\""]),
    ("ball_drop_pbf", &[]),
    ("ball_drop", &["sponges[0].solver=\"xpbd_neo_hookean\""]),
    ("ball_drop", &["fluid.no_slip=true", "sponges[0].self_contact=true", "sponges[0].softening=0.5"]),
    ("ball_drop", &["fluid.viscosity=5", "fluid.viscosity_integration=\"implicit\"", "fluid.no_slip=true"]),
];

fn scene((name, keys): (&str, &[&str]), resolution: f32) -> Scene {
    let mut scene = busy::scene(name, resolution);
    if let Some(fluid) = &mut scene.fluid {
        fluid.surface_tension = 0.072;
    }
    scene.with_overrides(keys.iter().copied()).expect("the keys suit the scene")
}

fn prepared(scene: &Scene) -> World {
    let run = || {
        let mut world = World::new(scene).expect("a preset is valid");
        for _ in 0..STEPS {
            world.step().expect("a preset is stable");
        }
        world
    };
    let world = run();
    // The timed work must be the same every time, to the bit.
    assert_eq!(world.digest(), run().digest(), "two runs differ");
    world
}

/// The first world that runs a kernel.
fn world_of(kernel: &Kernel, worlds: &[World]) -> Option<usize> {
    let runs = |world: &World| {
        world.plan().lines().iter().any(|line| line.name == kernel.name && line.verdict == Verdict::Runs)
    };
    let found = worlds.iter().position(runs);
    if found.is_none() {
        eprintln!("{}: runs in none of the scenes", kernel.name);
    }
    found
}

/// Time of some calls, in blocks with fresh columns each.
fn time(kernel: &Kernel, cpu: &Cpu, params: &Params, prepared: &Columns, iterations: u64) -> Duration {
    let mut total = Duration::ZERO;
    let mut left = iterations;
    while left > 0 {
        let calls = left.min(CALLS);
        left -= calls;
        let mut columns = prepared.clone();
        // Inside the pool, as in a step.
        total += cpu.enter(|| {
            let start = Instant::now();
            for _ in 0..calls {
                (kernel.cpu)(cpu, params, black_box(&mut columns));
            }
            start.elapsed()
        });
    }
    total
}

fn kernels(criterion: &mut Criterion) {
    for (size, resolution) in SIZES {
        let worlds = MODELS.map(|model| prepared(&scene(model, resolution)));
        for kernel in KERNELS {
            let Some(world) = world_of(kernel, &worlds).map(|index| &worlds[index]) else { continue };
            let mut group = criterion.benchmark_group(kernel.name);
            group.sampling_mode(SamplingMode::Flat);
            let rows = internal::columns(world).rows.of(kernel.writes[0].store());
            group.throughput(Throughput::Elements(rows as u64));
            group.bench_function(BenchmarkId::from_parameter(size), |bencher| {
                bencher.iter_custom(|iterations| {
                    time(kernel, world.cpu(), internal::params(world), internal::columns(world), iterations)
                });
            });
            group.finish();
        }
    }
}

/// Twins, on an adapter that can time kernels.
#[cfg(feature = "gpu")]
fn twins(criterion: &mut Criterion) {
    let Some(gpu) = on_gpu::adapter().filter(|gpu| gpu.has_timestamps()) else {
        return;
    };
    for (size, resolution) in SIZES {
        let mut worlds = MODELS.map(|model| on_gpu::world(&scene(model, resolution), &gpu, true));
        for kernel in KERNELS {
            let Some(world) = world_of(kernel, &worlds).map(|index| &mut worlds[index]) else { continue };
            let mut group = criterion.benchmark_group(kernel.name);
            group.sampling_mode(SamplingMode::Flat);
            let rows = internal::columns(world).rows.of(kernel.writes[0].store());
            group.throughput(Throughput::Elements(rows as u64));
            group.bench_function(BenchmarkId::from_parameter(format!("{size}-gpu")), |bencher| {
                bencher.iter_custom(|iterations| time_on_gpu(kernel.name, world, iterations));
            });
            group.finish();
        }
    }
}

#[cfg(not(feature = "gpu"))]
fn twins(_criterion: &mut Criterion) {}

/// Time of the calls of a kernel within whole steps.
#[cfg(feature = "gpu")]
fn time_on_gpu(name: &str, world: &mut World, iterations: u64) -> Duration {
    let so_far = |world: &World| {
        let time = world.phase_times().iter().find(|time| time.name == name);
        time.map_or((0, 0.0), |time| (time.calls, time.total_s))
    };
    let before = so_far(world);
    for _ in 0..iterations {
        world.step().expect("a preset is stable");
    }
    let after = so_far(world);
    // The search on a device also sums the density, which has no calls of its own.
    let calls = (after.0 - before.0).max(1) as f64;
    Duration::from_secs_f64(((after.1 - before.1) / calls * iterations as f64).max(1e-9))
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(2));
    targets = kernels, twins
}
criterion_main!(benches);
