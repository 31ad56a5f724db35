//! The elastic bar under gravity: whole steps and single sweeps of every solver.
//!
//! The bar has 1 m x 0.5 m x 0.5 m and 11 008 tets. One face is pinned, and steps have 5 ms. Young's modulus is 1e6 Pa, Poisson's
//! ratio 0.3, the density 1000 kg/m^3. The digest of a sample is compared with that of the others.

use std::{
    cell::Cell,
    hint::black_box,
    time::{Duration, Instant},
};

use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use sorb::{
    World,
    glam::{UVec3, Vec3},
    internal::{self, kernel_named},
    scene::{Body, Scene, ShapeKind, Solver, Sponge, Time},
};

/// Steps before a sample.
const STEPS: u32 = 20;
/// Sweeps after which the columns are restored.
const CALLS: u64 = 16;

fn bar(solver: Solver, iterations: u32) -> World {
    let sponge = Sponge {
        edge: 0.0625,
        cells: UVec3::new(16, 8, 8),
        density: 1000.0,
        solver,
        young_modulus: 1e6,
        poisson_ratio: 0.3,
        stretch_modulus: 1e6,
        shear_modulus: 4e5,
        volume_modulus: 1e6,
        iterations,
        ..Sponge::new("bar", Vec3::ZERO)
    };
    let wall = ShapeKind::Cuboid { half_extents: Vec3::new(0.01, 1.0, 1.0) };
    let mut scene = Scene::new("bar")
        .with_sponge(sponge)
        .with_body(Body { grip: true, ..Body::fixed("wall", wall, Vec3::ZERO) });
    scene.time = Time { maximum_step: 0.005, frame_rate: 200.0, ..Time::default() };
    let mut world = World::new(&scene).expect("the scene is valid");
    for _ in 0..STEPS {
        world.step().expect("the bar is stable");
    }
    world
}

fn steps(criterion: &mut Criterion) {
    for sweeps in [1, 2, 4, 8] {
        let mut group = criterion.benchmark_group("step::bar");
        group.sampling_mode(SamplingMode::Flat);
        let prepared = bar(Solver::Vbd, sweeps);
        group.throughput(Throughput::Elements(internal::columns(&prepared).rows.tets as u64));
        let digest = Cell::new(None);
        group.bench_function(BenchmarkId::new("vbd", sweeps), |bencher| {
            bencher.iter_custom(|count| {
                let mut total = Duration::ZERO;
                for _ in 0..count {
                    let mut world = prepared.clone();
                    let start = Instant::now();
                    world.step().expect("the bar is stable");
                    total += start.elapsed();
                    let expected = digest.get().unwrap_or_else(|| world.digest());
                    digest.set(Some(expected));
                    assert_eq!(world.digest(), expected, "a step ended elsewhere");
                }
                total
            });
        });
        group.finish();
    }
}

fn sweeps(criterion: &mut Criterion) {
    let solvers = [
        (Solver::Sbd, "pbd::strain"),
        (Solver::XpbdNeoHookean, "pbd::xpbd_neo_hookean"),
        (Solver::Vbd, "pbd::vbd"),
    ];
    for (solver, name) in solvers {
        let world = bar(solver, 1);
        let kernel = kernel_named(name).expect("there is one");
        let mut group = criterion.benchmark_group(name);
        group.sampling_mode(SamplingMode::Flat);
        group.throughput(Throughput::Elements(internal::columns(&world).rows.tets as u64));
        group.bench_function(BenchmarkId::from_parameter("bar"), |bencher| {
            bencher.iter_custom(|count| {
                let mut total = Duration::ZERO;
                let mut left = count;
                while left > 0 {
                    let calls = left.min(CALLS);
                    left -= calls;
                    let mut columns = internal::columns(&world).clone();
                    total += world.cpu().enter(|| {
                        let start = Instant::now();
                        for _ in 0..calls {
                            (kernel.cpu)(world.cpu(), internal::params(&world), black_box(&mut columns));
                        }
                        start.elapsed()
                    });
                }
                total
            });
        });
        group.finish();
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(2));
    targets = steps, sweeps
}
criterion_main!(benches);
