//! Pictures and maps of the device against those of the CPU.

use std::sync::{Arc, OnceLock};

use glam::Vec3;
use sorb_kernels::gpu::{Gpu, shaders};

use super::passes::{Passes, Work};
use super::{Renderer, read};
use crate::render::{
    Camera, Image, Picture, View, legend, rays,
    stage::Stage,
    world::{Seen, with_picture},
};
use crate::{Offload, Options, World, scene};

const SIZE: (u32, u32) = (320, 180);
/// Levels of 255 that a pixel may differ by.
const LEVELS: u8 = 12;
/// Mean difference in levels: measured are 0.011 to 0.022, and 0.083 for superimposed surfaces.
const MEAN: f64 = 0.05;
/// Density, less the level of the surface, from which on a node is deep in the water.
const DEEP: f32 = 0.2;

/// Share of the pixels that may differ more: measured is none, and 0.0026 for superimposed surfaces. Those have the water inside of
/// sponges, where kernels of both sides differ: cells of the search for neighbours lie elsewhere.
fn bounds(view: View) -> (f64, f64) {
    if view == View::Superimposed { (0.005, 0.15) } else { (0.0005, MEAN) }
}

fn gpu() -> Arc<Gpu> {
    static GPU: OnceLock<Arc<Gpu>> = OnceLock::new();
    Arc::clone(GPU.get_or_init(|| Arc::new(Gpu::new().unwrap_or_else(|error| panic!("{error}")))))
}

fn world_of(name: &str, scale: f32, keys: &[&str], frames: u32, offload: Offload) -> World {
    let scene = scene::preset(name).and_then(|scene| scene.scaled(scale));
    let scene = scene.and_then(|scene| scene.with_overrides(keys.iter().copied()));
    let options = Options { offload, gpu: Some(gpu()), ..Options::default() };
    let scene = scene.unwrap_or_else(|error| panic!("{error}"));
    let mut world = World::with_options(&scene, &options).unwrap_or_else(|error| panic!("{error}"));
    for _ in 0..frames {
        world.advance_frame().unwrap_or_else(|error| panic!("{error}"));
    }
    world
}

/// A ball presses a sponge under water, and a splash in a tank with an open lid.
fn worlds() -> Vec<World> {
    let pressed = ["bodies.ball.position=[0, 0.12, 0]", "sponges.sponge.position=[-0.04, 0.04, -0.04]"];
    vec![world_of("life", 0.5, &pressed, 12, Offload::Cpu), world_of("dam_break", 0.4, &[], 20, Offload::Cpu)]
}

fn camera(world: &World) -> Camera {
    world.scene().viewpoint().into()
}

/// The picture of a world and what draws it.
fn picture<R>(world: &World, view: View, draw: impl FnOnce(&Picture<'_>, &Camera) -> R) -> R {
    let pressures = world.particle_pressures();
    let camera = camera(world);
    with_picture(world, (&Seen::of(world), &pressures), &camera, view, |picture| draw(picture, &camera))
}

/// The picture of the CPU with a ray for every pixel.
fn expected(world: &World, view: View) -> Image {
    picture(world, view, |picture, camera| {
        let mut image = rays::draw_every_pixel(picture, camera, SIZE.0, SIZE.1);
        if let Some(title) = view.map() {
            legend::draw(&mut image, title, picture.range);
        }
        image
    })
}

fn drawn(renderer: &mut Renderer, world: &World, view: View) -> Image {
    let image = renderer.draw_world(world, &camera(world), view, SIZE.0, SIZE.1);
    image.unwrap_or_else(|error| panic!("{view:?}: {error}"))
}

/// Share of the pixels that differ by more than [`LEVELS`], and the mean difference of a channel.
fn difference(a: &Image, b: &Image) -> (f64, f64) {
    assert_eq!((a.width, a.height, a.pixels.len()), (b.width, b.height, b.pixels.len()));
    let differs = |(a, b): &(&[u8], &[u8])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > LEVELS);
    let pixels = a.pixels.chunks(3).zip(b.pixels.chunks(3));
    let sum: f64 = a.pixels.iter().zip(&b.pixels).map(|(a, b)| f64::from(a.abs_diff(*b))).sum();
    (pixels.clone().filter(differs).count() as f64 / pixels.count() as f64, sum / a.pixels.len() as f64)
}

#[test]
fn every_view_is_that_of_the_cpu() {
    let mut renderer = Renderer::new(&gpu());
    for (index, world) in worlds().into_iter().enumerate() {
        for view in View::ALL {
            let (found, cpu) = (drawn(&mut renderer, &world, view), expected(&world, view));
            let (share, mean) = difference(&found, &cpu);
            let name = &world.scene().name;
            eprintln!("{name} {view:?}: {share:.5} of the pixels differ, {mean:.3} levels in the mean");
            let limits = bounds(view);
            assert!(share < limits.0 && mean < limits.1, "{name} {view:?}: {share:.5}, {mean:.3}");
            if index > 0 {
                continue;
            }
            assert!(drawn(&mut renderer, &world, view) == found, "{name} {view:?}: other bits");
            // Negative controls: the light comes from the other side, or absorption is forgotten.
            let faults: [fn(&mut super::Scene); 2] = [
                |scene| scene.light.x = -scene.light.x,
                |scene| scene.centre += Vec3::splat(2.0 * scene.size),
            ];
            for fault in faults {
                renderer.fault = Some(fault);
                let (share, mean) = difference(&drawn(&mut renderer, &world, view), &cpu);
                assert!(
                    share > limits.0 || mean > limits.1,
                    "{name} {view:?}: {share:.5}, {mean:.3} with a fault"
                );
            }
            renderer.fault = None;
        }
    }
}

/// Floats of a buffer of the newest picture.
fn floats(renderer: &Renderer, name: &'static str, count: usize) -> Vec<f32> {
    let mut passes = Passes::default();
    let work = Work::new(&renderer.gpu, &mut passes, &renderer.buffers);
    let staging = work.submit(&[(name, 4 * count as u64)], None).unwrap_or_else(|error| panic!("{error}"));
    let words = read::words(&renderer.gpu, staging).unwrap_or_else(|error| panic!("{error}"));
    words.into_iter().map(f32::from_bits).collect()
}

/// Largest difference, and share of the values that differ by more than a limit.
fn apart(a: &[f32], b: &[f32], limit: f32) -> (f32, f64) {
    assert_eq!(a.len(), b.len());
    // Ways to nothing are infinite.
    let differences: Vec<f32> = a.iter().zip(b).map(|(a, b)| (a.max(-1e9) - b.max(-1e9)).abs()).collect();
    let many = differences.iter().filter(|difference| **difference > limit).count();
    (differences.iter().copied().fold(0.0, f32::max), many as f64 / differences.len().max(1) as f64)
}

#[test]
fn passes_have_the_columns_of_the_cpu() {
    let mut renderer = Renderer::new(&gpu());
    for world in worlds() {
        drawn(&mut renderer, &world, View::Realistic);
        picture(&world, View::Realistic, |picture, camera| {
            let stage = Stage::new(picture, camera, SIZE.0 as usize, SIZE.1 as usize);
            let name = &world.scene().name;
            let free = floats(&renderer, "free", stage.free.len());
            let (worst, _) = apart(&free, &stage.free, 1e-3);
            assert!(worst < 1e-3, "{name}: free {worst}");
            let (values, arriving, solid, water) = rays::maps(&stage);
            let densities = if stage.sponge.triangles.is_empty() { "densities" } else { "sunk" };
            // Deep in the water the sign alone matters, and cells of the search for neighbours lie elsewhere.
            let near = |values: &[f32]| values.iter().map(|value| value.min(DEEP)).collect::<Vec<_>>();
            let (found, values) = (near(&floats(&renderer, densities, values.len())), near(&values));
            let (worst, many) = apart(&found, &values, 2e-3);
            eprintln!("{name}: densities {worst} {many}");
            assert!(many < 0.02, "{name}: densities {worst}, {many}");
            let texels = arriving.len();
            let ground = floats(&renderer, "ground", 8 * texels);
            let light: Vec<f32> = arriving.iter().flat_map(|light| light.to_array()).collect();
            let (worst, many) = apart(&ground[..4 * texels], &light, 0.02);
            eprintln!("{name}: light {worst} {many}");
            assert!(many < 0.01, "{name}: light {worst}, {many}");
            let ways =
                |lane: usize| -> Vec<f32> { (0..texels).map(|k| ground[4 * (texels + k) + lane]).collect() };
            for (map, lane) in [(&solid, 0), (&water, 1)] {
                let (worst, many) = apart(&ways(lane), map, 1e-3);
                eprintln!("{name}: ways {worst} {many}");
                assert!(many < 0.01, "{name}: ways {worst}, {many}");
            }
            // Negative control: the density of another state.
            let shifted: Vec<f32> = values.iter().skip(1).chain(&values[..1]).copied().collect();
            assert!(apart(&shifted, &values, 2e-3).1 > 0.01, "{name}");
        });
    }
}

#[test]
fn particles_of_a_world_on_the_same_device_are_read_where_they_are() {
    let world = world_of("life", 0.4, &[], 4, Offload::Gpu);
    let mut renderer = Renderer::new(&gpu());
    for view in [View::Realistic, View::Fast, View::Particles, View::Pressure, View::Speed] {
        let resident = drawn(&mut renderer, &world, view);
        if view != View::Pressure {
            let positions = renderer.buffers.get("positions").unwrap_or_else(|error| panic!("{error}"));
            assert!(world.particle_buffers().is_some_and(|(own, _)| own == positions), "{view:?}");
        }
        let uploaded =
            picture(&world, view, |picture, camera| renderer.draw(picture, camera, SIZE.0, SIZE.1));
        let uploaded = uploaded.unwrap_or_else(|error| panic!("{error}"));
        assert!(resident == uploaded, "{view:?}");
    }
}

#[test]
fn scenes_without_water_or_sponge_and_odd_sizes_are_drawn() {
    let mut renderer = Renderer::new(&gpu());
    for name in ["empty", "dry", "water"] {
        let world = world_of(name, 0.4, &[], 0, Offload::Cpu);
        for view in View::ALL {
            // Odd sizes where a picture costs least.
            let sizes: &[_] = if name == "empty" { &[(0, 9), (1, 1), (33, 17)] } else { &[(33, 17)] };
            for &(width, height) in sizes {
                let image = renderer.draw_world(&world, &camera(&world), view, width, height);
                let image = image.unwrap_or_else(|error| panic!("{name} {view:?}: {error}"));
                assert_eq!(image.pixels.len(), (width * height * 3) as usize, "{name} {view:?}");
            }
        }
    }
}

#[test]
fn an_open_scene_is_drawn_and_a_lost_particle_does_not_matter() {
    let mut particles: Vec<[f32; 4]> = Vec::new();
    for index in 0..1000_u32 {
        let place = Vec3::new((index % 10) as f32, (index / 10 % 10) as f32, (index / 100) as f32);
        particles.push((place * 0.01).extend(0.0).to_array());
    }
    particles.push([f32::NAN, 0.0, 0.0, 0.0]);
    let camera = Camera::framing(Vec3::ZERO, Vec3::splat(0.1));
    let mut renderer = Renderer::new(&gpu());
    let mut compare = |particles: &[[f32; 4]]| {
        let picture = Picture { particles, particle_radius: 0.005, ..Picture::default() };
        let found =
            renderer.draw(&picture, &camera, SIZE.0, SIZE.1).unwrap_or_else(|error| panic!("{error}"));
        difference(&found, &rays::draw_every_pixel(&picture, &camera, SIZE.0, SIZE.1))
    };
    let (share, mean) = compare(&particles);
    assert!(share < 0.0005 && mean < MEAN, "{share:.5} {mean:.3}");
    particles.push([1e4, 0.0, 0.0, 0.0]);
    let (share, mean) = compare(&particles);
    assert!(share < 0.0005 && mean < MEAN, "{share:.5} {mean:.3}");
    // Negative control: a particle that is near is not lost.
    particles.push([0.1, 0.1, 0.1, 0.0]);
    let (share, mean) = compare(&particles);
    assert!(share < 0.0005 && mean < MEAN, "{share:.5} {mean:.3}");
}

#[test]
fn every_pass_binds_at_most_eight_storage_buffers_and_three_uniforms() {
    for shader in shaders::RENDER_SHADERS {
        let lines = |space: &str| shader.source.lines().filter(|line| line.contains(space)).count();
        let (storage, uniforms) = (lines("var<storage"), lines("var<uniform>"));
        assert!(storage <= 8 && uniforms <= 3, "{}: {storage} and {uniforms}", shader.name);
        let declares = shader.source.lines().any(|line| line.trim_start().starts_with("const "));
        assert!(!declares, "{}: declare constants in Rust", shader.name);
    }
}
