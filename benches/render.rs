//! Time of a picture: by view, by size, by number of particles.
//!
//! `cargo bench --bench render --features render,serde`. The particles are those of `water` at time zero, two thirds of the way through a
//! splash for the smaller counts. A million is never stepped.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use sorb::{
    World,
    render::{Camera, View, draw_world},
    scene,
};

/// A scene at a resolution after a number of frames.
fn world(name: &str, resolution: f32, frames: u32) -> World {
    let scene = scene::preset(name).and_then(|scene| scene.scaled(resolution));
    let mut world = World::new(&scene.expect("a scene")).expect("a world");
    for _ in 0..frames {
        world.advance_frame().expect("a frame");
    }
    world
}

fn draw(world: &World, view: View, (width, height): (u32, u32)) -> usize {
    let camera: Camera = world.scene().viewpoint().into();
    draw_world(world, &camera, view, width, height).pixels.len()
}

const FULL: (u32, u32) = (1280, 720);

fn by_view(criterion: &mut Criterion) {
    let world = world("dam_break", 1.0, 30);
    let mut group = criterion.benchmark_group("view");
    group.sample_size(10);
    for view in View::ALL {
        group.bench_function(format!("{view:?}").to_lowercase(), |bencher| {
            bencher.iter(|| draw(black_box(&world), view, FULL));
        });
    }
    group.finish();
}

fn by_scene(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("scene");
    group.sample_size(10);
    for (name, frames) in
        [("empty", 0), ("dry", 18), ("ball_drop", 12), ("dam_break", 30), ("standing", 30), ("water", 30)]
    {
        let world = world(name, 1.0, frames);
        group.bench_function(name, |bencher| {
            bencher.iter(|| draw(black_box(&world), View::Realistic, FULL));
        });
    }
    group.finish();
}

fn by_particles(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("particles");
    group.sample_size(10);
    for (resolution, frames) in [(0.63, 30), (1.0, 30), (2.0, 0), (5.0, 0)] {
        let world = world("water", resolution, frames);
        let count = world.particle_positions().len();
        for view in [View::Realistic, View::Fast] {
            let id = BenchmarkId::new(format!("{view:?}").to_lowercase(), count);
            group.bench_function(id, |bencher| bencher.iter(|| draw(black_box(&world), view, FULL)));
        }
    }
    group.finish();
}

fn by_size(criterion: &mut Criterion) {
    let world = world("dam_break", 1.0, 30);
    let mut group = criterion.benchmark_group("size");
    group.sample_size(10);
    for size in [(320, 180), (640, 360), FULL, (1920, 1080)] {
        group.bench_function(format!("{}x{}", size.0, size.1), |bencher| {
            bencher.iter(|| draw(black_box(&world), View::Realistic, size));
        });
    }
    group.finish();
}

criterion_group!(benches, by_view, by_scene, by_particles, by_size);
criterion_main!(benches);
