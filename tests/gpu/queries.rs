//! Questions that a device answers, against the answers of the host about the same state.

use std::sync::Arc;

use sorb::{
    Hit, Offload, Options, Probe, Ray, Surface, Targets, World,
    glam::{UVec3, Vec3},
    gpu::Gpu,
    scene::{Body, Fluid, FluidBlock, FluidSolver, Scene, ShapeKind, Sponge},
};

use super::{common, new_gpu};

const LOW: Vec3 = Vec3::new(-0.06, 0.0, -0.04);
const HIGH: Vec3 = Vec3::new(0.06, 0.12, 0.04);

/// A pool with a wave in it, and a sponge that takes up water.
fn pool(solver: FluidSolver) -> Scene {
    let block =
        |low: f32, high: f32, height: f32| FluidBlock::new(LOW.with_x(low), HIGH.with_x(high).with_y(height));
    let blocks = vec![block(-0.06, 0.0, 0.05), block(0.0, 0.06, 0.012)];
    let fluid = Fluid { blocks, solver: Some(solver), ..Fluid::default() };
    Scene::new("pool").in_box(LOW, HIGH).with_fluid(fluid)
}

fn with_sponge(scene: Scene) -> Scene {
    let sponge = Sponge {
        cells: UVec3::new(3, 4, 3),
        edge: 0.01,
        saturation: 0.5,
        ..Sponge::new("sponge", Vec3::new(0.02, 0.013, -0.015))
    };
    scene.with_sponge(sponge)
}

/// After some frames on a device of its own, so that nobody else reads from it.
fn stepped(scene: &Scene, frames: u32) -> (World, Arc<Gpu>) {
    let gpu = Arc::new(new_gpu());
    let options = Options { offload: Offload::Gpu, gpu: Some(Arc::clone(&gpu)), ..Options::default() };
    let mut world = World::with_options(scene, &options).unwrap_or_else(|error| panic!("{error}"));
    (0..frames).for_each(|_| common::frame(&mut world));
    (world, gpu)
}

/// Answers of the device and of the host, and the bytes that each read back.
#[expect(clippy::print_stdout, reason = "figures of the documentation")]
fn both<T>(world: &World, gpu: &Gpu, ask: impl Fn(&World) -> T) -> ([T; 2], [u64; 2]) {
    let mut bytes = [gpu.bytes_read(), 0];
    let of_device = ask(world);
    bytes[1] = gpu.bytes_read();
    let by_device = bytes[1] - bytes[0];
    // Now the host has the state.
    let rows = world.particle_positions().len();
    assert_eq!(rows, world.particle_count());
    let read = gpu.bytes_read() - bytes[1];
    println!("{by_device} bytes for the answers, {read} for all columns");
    let of_host = ask(world);
    assert_eq!(gpu.bytes_read() - bytes[1], read, "the host answers from what it has");
    ([of_device, of_host], [by_device, read])
}

/// Places all over the container and a little outside.
fn points() -> Vec<Vec3> {
    let part = |index: u32, count: u32| (index % count) as f32 / (count - 1) as f32;
    let unit = |index: u32| Vec3::new(part(index, 11), part(index / 11, 9), part(index / 99, 5));
    (0..11 * 9 * 5).map(|index| LOW - 0.004 + unit(index) * (HIGH - LOW + 0.008)).collect()
}

fn values(probe: &Probe) -> [f32; 12] {
    let [vx, vy, vz] = probe.velocity.to_array();
    let sponge = probe.sponge.map_or([0.0; 6], |own| {
        let [x, y, z] = own.velocity.to_array();
        [own.saturation, own.pore_pressure / 1e3, own.volume_ratio, x, y, z]
    });
    let [a, b, c, d, e, f] = sponge;
    [probe.filled, probe.density / 1e3, probe.pressure / 1e3, vx, vy, vz, a, b, c, d, e, f]
}

/// Largest difference of two lists of probes.
fn apart(a: &[Probe], b: &[Probe]) -> f32 {
    let pairs = a.iter().zip(b).flat_map(|(a, b)| values(a).into_iter().zip(values(b)));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn values_at_points_are_those_of_the_host() {
    for periodic in [false, true] {
        let scene = pool(FluidSolver::Divergence);
        let scene = if periodic { scene.repeating([true, false, false]) } else { with_sponge(scene) };
        let (mut world, gpu) = stepped(&scene, 4);
        let points = points();
        let ask = |world: &World| world.probe(&points).unwrap_or_else(|error| panic!("{error}"));
        let ([device, host], [by_device, read]) = both(&world, &gpu, ask);
        let error = apart(&device, &host);
        assert!(error < 2e-4, "periodic {periodic}: {error:.1e}");
        let count = |of: fn(&Probe) -> bool| host.iter().filter(|probe| of(probe)).count();
        assert!(count(|probe| probe.filled > 0.5) > 50, "points in water");
        assert_eq!(count(|probe| probe.sponge.is_some()) > 0, !periodic, "points in the sponge");
        let of_sponge = |probe: &Probe| probe.sponge.map(|own| own.sponge);
        assert!(device.iter().map(of_sponge).eq(host.iter().map(of_sponge)));
        assert_eq!(by_device, 32 * points.len() as u64 * if periodic { 1 } else { 2 });
        assert!(read > 2 * by_device, "{read} bytes of all columns");
        // The control: a step later.
        common::frame(&mut world);
        assert!(apart(&device, &ask(&world)) > 1e-2);
    }
}

#[test]
fn levels_and_rays_are_those_of_the_host() {
    for periodic in [false, true] {
        let scene = pool(FluidSolver::Divergence);
        let scene = if periodic { scene.repeating([true, false, true]) } else { scene };
        let ball = Body::fixed("ball", ShapeKind::Sphere { radius: 0.01 }, Vec3::new(-0.03, 0.09, 0.0));
        let (mut world, gpu) = stepped(&scene.with_body(ball), 6);
        let places: Vec<[f32; 2]> = points().iter().step_by(3).map(|point| [point.x, point.z]).collect();
        let ask = |world: &World| world.water_levels(&places).unwrap_or_else(|error| panic!("{error}"));
        let ([device, host], [by_device, read]) = both(&world, &gpu, ask);
        let level = |level: &Option<f32>| level.unwrap_or(-1.0);
        let error = |a: &[Option<f32>], b: &[Option<f32>]| {
            let pairs = a.iter().zip(b).map(|(a, b)| (level(a) - level(b)).abs());
            pairs.fold(0.0, f32::max)
        };
        let spacing = world.scene().fluid.as_ref().map_or(0.0, |fluid| fluid.spacing);
        assert!(error(&device, &host) < 0.1 * spacing, "{:.1e}", error(&device, &host));
        assert!(host.iter().filter(|level| level.is_some()).count() > 100);
        assert_eq!(by_device, 32 * places.len() as u64);
        assert!(read > 5 * by_device, "{read} bytes of all columns");
        common::frame(&mut world);
        assert!(error(&device, &ask(&world)) > 0.1 * spacing, "the control: a frame later");
        let origin = Vec3::new(-0.05, 0.11, 0.01);
        let ray = |point: Vec3| {
            let way = point.clamp(LOW, HIGH) - origin;
            Ray { origin, direction: way, length: way.length() }
        };
        let rays: Vec<Ray> = points().into_iter().step_by(2).map(ray).collect();
        let ask =
            |world: &World| world.cast_rays(&rays, Targets::ALL).unwrap_or_else(|error| panic!("{error}"));
        common::frame(&mut world);
        let ([device, host], [by_device, _]) = both(&world, &gpu, ask);
        assert_eq!(by_device, 32 * rays.len() as u64);
        let mut met = [0; 2];
        for (device, host) in device.iter().zip(&host) {
            let way = |hit: &Option<Hit>| hit.map_or(-1.0, |hit| hit.distance);
            assert!((way(device) - way(host)).abs() < 0.25 * spacing, "{device:?} {host:?}");
            let (Some(device), Some(host)) = (device, host) else { continue };
            assert_eq!(device.surface, host.surface);
            assert!(device.normal.dot(host.normal) > 0.95, "{device:?} {host:?}");
            met[usize::from(host.surface == Surface::Water)] += 1;
        }
        assert!(met[0] > 0 && met[1] > 20, "bodies and water were met: {met:?}");
    }
}

/// What the device does not answer the host does, with the same results as ever.
#[test]
fn other_questions_are_answered_by_the_host() {
    let (world, gpu) = stepped(&with_sponge(pool(FluidSolver::Dfsph)), 1);
    let before = gpu.bytes_read();
    let points = points();
    let probes = world.probe(&points).unwrap_or_else(|error| panic!("{error}"));
    assert!(gpu.bytes_read() - before > 64 * points.len() as u64, "all columns were read back");
    assert!(probes.iter().any(|probe| probe.filled > 0.5));
    let error = world.probe(&[Vec3::NAN]).err().map(|error| error.to_string()).unwrap_or_default();
    assert!(error.contains("point") && error.contains("-1000 to 1000 m"), "{error}");
    assert!(world.probe(&[]).is_ok_and(|probes| probes.is_empty()));
}
