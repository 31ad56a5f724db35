//! Cost of a sleeping part of a scene, over its cost awake, while another part moves.
//!
//! Three worlds are stepped by turns: one in which the part sleeps, one in which it may not, and one without it. The cost of
//! the part is the time of a step less that of the third. `cargo bench --bench sleep`, on a GPU
//! `cargo bench --features gpu --bench sleep -- --gpu`.

#![expect(clippy::print_stdout, reason = "the figures are what it is for")]

use std::time::Instant;

use sorb::{
    Offload, Options, World,
    glam::{UVec3, Vec3},
    scene::{Body, Fluid, FluidBlock, Motion, Scene, ShapeKind, Sponge, Time},
};

/// Steps that are timed.
const STEPS: usize = 400;

/// Everything stands on the floor, in two halves with a dam between them. The right half moves.
fn room(name: &str) -> Scene {
    let dam = ShapeKind::Cuboid { half_extents: Vec3::new(0.05, 0.3, 0.1) };
    let mut scene = Scene::new(name)
        .in_box(Vec3::new(-0.3, 0.0, -0.1), Vec3::new(0.5, 0.4, 0.1))
        .with_body(Body::fixed("dam", dam, Vec3::new(0.0, 0.1, 0.0)));
    scene.time = Time { maximum_step: 0.002, ..Time::default() };
    scene
}

fn block(name: &str, x: f32, cells: UVec3) -> Sponge {
    let size = cells.as_vec3() * 0.01;
    Sponge { cells, edge: 0.01, ..Sponge::new(name, Vec3::new(x, 0.0, -0.5 * size.z)) }
}

fn pool(low: f32, high: f32) -> Fluid {
    let corners = (Vec3::new(low, 0.0, -0.1), Vec3::new(high, 0.04, 0.1));
    Fluid { spacing: 0.005, blocks: vec![FluidBlock::new(corners.0, corners.1)], ..Fluid::default() }
}

/// A sponge that is held at its foot and rotated for the whole scene.
fn turned(scene: Scene) -> Scene {
    let foot = ShapeKind::Cuboid { half_extents: Vec3::new(0.1, 0.011, 0.1) };
    let turn =
        Motion::Turn { axis: Vec3::Y, pivot: Vec3::X * 0.3, rate: 2.0, start: 0.0, end: 1e5, ease: 0.0 };
    let foot = Body::kinematic("foot", foot, Vec3::new(0.3, 0.0, 0.0), vec![turn]);
    scene.with_sponge(block("turned", 0.26, UVec3::new(8, 8, 8))).with_body(Body { grip: true, ..foot })
}

/// A body that pushes the water back and forth.
fn stirred(scene: Scene) -> Scene {
    let paddle = ShapeKind::Cuboid { half_extents: Vec3::new(0.005, 0.06, 0.06) };
    let turn = Motion::Turn {
        axis: Vec3::Y,
        pivot: Vec3::new(0.3, 0.0, 0.0),
        rate: 2.0,
        start: 0.0,
        end: 1e5,
        ease: 0.0,
    };
    let paddle = Body::kinematic("paddle", paddle, Vec3::new(0.3, 0.06, 0.0), vec![turn]);
    scene.with_fluid(pool(0.1, 0.4)).with_body(paddle)
}

fn is_asked(flag: &str) -> bool {
    std::env::args().any(|argument| argument == flag)
}

/// A world that has been stepped for three seconds.
fn settled(mut scene: Scene, sleep_after: f32) -> World {
    scene.time.sleep_after = sleep_after;
    let offload = if is_asked("--gpu") { Offload::Gpu } else { Offload::Cpu };
    let options = Options { offload, ..Options::default() };
    let mut world =
        World::with_options(&scene, &options).expect("the scene is valid, and there is a GPU if asked for");
    while world.clock().time < 3.0 {
        world.advance_frame().expect("the scene is stable");
    }
    world
}

fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn compare(name: &str, with: &Scene, without: &Scene, is_asleep: impl Fn(&World) -> bool) {
    let mut worlds = [settled(with.clone(), 0.25), settled(with.clone(), 0.0), settled(without.clone(), 0.0)];
    assert!(is_asleep(&worlds[0]) && !worlds[0].is_asleep(), "{name}: only the part must sleep");
    assert!(!is_asleep(&worlds[1]), "{name}: the other must be awake");
    let mut times = [Vec::new(), Vec::new(), Vec::new()];
    for _ in 0..STEPS {
        for (world, times) in worlds.iter_mut().zip(&mut times) {
            let start = Instant::now();
            world.step().expect("the scene is stable");
            times.push(start.elapsed().as_secs_f64() * 1e3);
        }
    }
    assert!(is_asleep(&worlds[0]), "{name}: the part must sleep on");
    let [asleep, awake, rest] = times.each_mut().map(|times| median(times));
    println!(
        "{name}: {awake:.4} ms a step, {asleep:.4} ms with it asleep, {rest:.4} ms without it: {:.1} % of its cost awake",
        100.0 * (asleep - rest) / (awake - rest)
    );
    if is_asked("--phases") {
        for time in worlds[0].phase_times() {
            let of = |world: &World| {
                let found = world.phase_times().iter().find(|other| other.name == time.name);
                found.map_or(0.0, |time| time.median_ms() * (time.calls / world.clock().steps.max(1)) as f32)
            };
            println!("  {:26} {:.4} {:.4} {:.4}", time.name, of(&worlds[0]), of(&worlds[1]), of(&worlds[2]));
        }
    }
}

fn main() {
    let at_rest = |scene: Scene| scene.with_sponge(block("rest", -0.2, UVec3::new(12, 8, 12)));
    let first_sleeps = |world: &World| (0..2).any(|index| world.is_sponge_asleep(index));
    compare("a sponge beside a moving sponge", &at_rest(turned(room("a"))), &turned(room("a")), first_sleeps);
    compare("a sponge beside moving water", &at_rest(stirred(room("b"))), &stirred(room("b")), first_sleeps);
    let with_pool = turned(room("c")).with_fluid(pool(-0.3, -0.05));
    compare("a pool beside a moving sponge", &with_pool, &turned(room("c")), World::is_fluid_asleep);
    let ball = |index: usize| {
        let x = 0.042 * index as f32 - 0.275;
        let shape = ShapeKind::Sphere { radius: 0.02 };
        Body::dynamic(&format!("ball{index}"), shape, Vec3::new(x, 0.0201, 0.0), 500.0)
    };
    let balls = |scene: Scene| (0..5).fold(scene, |scene, index| scene.with_body(ball(index)));
    let bodies = |world: &World| (0..world.bodies().len()).any(|index| world.is_body_asleep(index));
    compare("balls beside a moving sponge", &balls(turned(room("d"))), &turned(room("d")), bodies);
}
