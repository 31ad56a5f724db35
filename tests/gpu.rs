//! Whole scenes on the GPU against the CPU. A machine without an adapter fails here: lavapipe is one.

mod common;

use std::sync::{Arc, OnceLock};

use common::busy;
use sorb::{
    Measures, Offload, Options, World, WorldError,
    glam::Vec3,
    gpu::Gpu,
    kernel::KERNELS,
    scene::Scene,
    schedule::{Place, Verdict},
};

/// One device for all tests.
fn gpu() -> Arc<Gpu> {
    static GPU: OnceLock<Arc<Gpu>> = OnceLock::new();
    Arc::clone(GPU.get_or_init(|| {
        Arc::new(Gpu::new().unwrap_or_else(|error| {
            panic!("{error}; these tests need one, and do not pass without: install mesa-vulkan-drivers and libvulkan1")
        }))
    }))
}

fn world(scene: &Scene, offload: Offload) -> World {
    let options = Options { offload, gpu: Some(gpu()), ..Options::default() };
    World::with_options(scene, &options).unwrap_or_else(|error| panic!("{}: {error}", scene.name))
}

/// Largest difference of two states: of each measure, over what it can be expected to be.
fn difference(a: &Measures, b: &Measures) -> (f64, &'static str) {
    let mass = a.water_mass + 1e-3;
    let energy = a.kinetic_energy + a.elastic_energy + 1e-4;
    let momentum = (2.0 * mass * (a.kinetic_energy + 1e-6)).sqrt();
    let differences = [
        ((a.time - b.time).abs() * 1e3, "time"),
        ((a.water_mass - b.water_mass).abs() / mass, "water mass"),
        ((a.absorbed_mass - b.absorbed_mass).abs() / mass, "absorbed mass"),
        ((a.saturation - b.saturation).abs(), "saturation"),
        ((a.sponge_volume - b.sponge_volume).abs() / (a.sponge_volume + 1e-9), "sponge volume"),
        ((a.sponge_centre - b.sponge_centre).length() / 0.1, "sponge centre"),
        ((a.linear_momentum - b.linear_momentum).length() / momentum, "momentum"),
        ((a.kinetic_energy - b.kinetic_energy).abs() / energy, "kinetic energy"),
        ((a.potential_energy - b.potential_energy).abs() / (mass * 9.81 * 0.1), "potential energy"),
        ((a.elastic_energy - b.elastic_energy).abs() / energy, "elastic energy"),
        ((a.mean_density_error - b.mean_density_error).abs(), "density error"),
    ];
    // Also the largest if one is not a number.
    differences.into_iter().fold((0.0, "nothing"), |worst, new| if new.0 <= worst.0 { worst } else { new })
}

#[track_caller]
#[expect(clippy::print_stdout, reason = "how far apart they are is worth reading in a test that passes")]
fn assert_alike(name: &str, frames: u32, resolution: f32, bound: f64) {
    let scene = busy::scene(name, resolution);
    let (mut cpu, mut gpu) = (world(&scene, Offload::Cpu), world(&scene, Offload::Gpu));
    for _ in 0..frames {
        let fail = |error| panic!("{name}: {error}");
        let expected = cpu.advance_frame().unwrap_or_else(fail);
        let found = gpu.advance_frame().unwrap_or_else(fail);
        let steps = expected.steps.abs_diff(found.steps);
        assert!(steps <= 2 + expected.steps / 20, "{name}: {expected:?}, {found:?}");
        assert!((expected.time - found.time).abs() < 1e-6, "{name}: {expected:?}, {found:?}");
    }
    assert_eq!(common::unhealthy(&gpu, cpu.particle_ids().len()), None, "{name}");
    let (found, what) = difference(&cpu.measures(), &gpu.measures());
    println!("{name}, {frames} frames: {found:.1e} of {bound:.0e}, {what}");
    assert!(found <= bound, "{name}: {what} differs by {found:.1e}");
}

macro_rules! scenes {
    ($($scene:ident)+) => {
        $(#[test]
        fn $scene() {
            assert_alike(stringify!($scene), 1, 0.5, 1e-3);
        })+
    };
}
scenes! { standing ball_drop squish dam_break wring water dry empty }

/// How far apart two runs on the CPU end, of which one starts a micrometre a second faster.
fn chaos(name: &str, frames: u32, resolution: f32) -> f64 {
    let scene = busy::scene(name, resolution);
    let mut other = scene.clone();
    let shift = Vec3::new(1e-6, 1e-6, -1e-6);
    if let Some(fluid) = &mut other.fluid {
        fluid.blocks.iter_mut().for_each(|block| block.velocity += shift);
    }
    let (mut a, mut b) = (world(&scene, Offload::Cpu), world(&other, Offload::Cpu));
    for _ in 0..frames {
        common::frame(&mut a);
        common::frame(&mut b);
    }
    difference(&a.measures(), &b.measures()).0
}

/// Splashing water is chaotic: after a second, rounding has become as large as what it does to the same program.
#[test]
fn a_second_of_water_ends_alike() {
    let bound = 3.0 * chaos("water", 60, 0.4);
    assert!(bound < 1.0, "{bound}");
    assert_alike("water", 60, 0.4, bound);
}

#[test]
fn a_second_of_a_ball_on_a_sponge_ends_alike() {
    assert_alike("ball_drop", 60, 0.4, 2e-3);
}

#[test]
fn the_comparison_notices_another_gravity() {
    let scene = busy::scene("water", 0.5);
    let mut other = scene.clone();
    other.gravity.y *= 1.02;
    let (mut a, mut b) = (world(&scene, Offload::Gpu), world(&other, Offload::Gpu));
    common::frame(&mut a);
    common::frame(&mut b);
    assert!(difference(&a.measures(), &b.measures()).0 > 1e-3);
}

#[test]
fn a_world_and_its_clone_end_with_the_same_bits() {
    for name in ["water", "ball_drop"] {
        let scene = busy::scene(name, 0.5);
        let mut first = world(&scene, Offload::Gpu);
        common::frame(&mut first);
        let mut copy = first.clone();
        assert_eq!(copy.digest(), first.digest(), "{name}");
        common::frame(&mut first);
        common::frame(&mut copy);
        assert_eq!(copy.digest(), first.digest(), "{name}");
        let mut again = world(&scene, Offload::Gpu);
        common::frame(&mut again);
        common::frame(&mut again);
        assert_eq!(again.digest(), first.digest(), "{name}");
    }
}

#[test]
fn single_steps_are_as_long_as_on_the_cpu() {
    let scene = busy::scene("ball_drop", 0.5);
    let (mut cpu, mut gpu) = (world(&scene, Offload::Cpu), world(&scene, Offload::Gpu));
    for _ in 0..10 {
        let fail = |error| panic!("{error}");
        let (expected, found) = (cpu.step().unwrap_or_else(fail), gpu.step().unwrap_or_else(fail));
        assert_eq!(expected.bound, found.bound);
        assert!((expected.step / found.step - 1.0).abs() < 1e-3, "{expected:?}, {found:?}");
        assert!((expected.maximum_speed / found.maximum_speed - 1.0).abs() < 1e-3, "{expected:?}, {found:?}");
    }
    assert!((cpu.clock().time - gpu.clock().time).abs() < 1e-6);
}

#[test]
fn every_kernel_can_be_the_first_on_the_gpu() {
    let scene = busy::scene("ball_drop", 0.5);
    let mut cpu = world(&scene, Offload::Cpu);
    common::steps(&mut cpu, 3);
    let kernels = cpu.plan().lines().iter().filter(|line| line.verdict == Verdict::Runs);
    for kernel in kernels.map(|line| line.name).filter(|name| *name != "rigid::step") {
        let mut mixed = world(&scene, Offload::From(kernel));
        assert!(
            mixed.plan().lines().iter().any(|line| mixed.plan().place(line.name) == Place::Gpu),
            "{kernel}"
        );
        common::steps(&mut mixed, 3);
        let (found, what) = difference(&cpu.measures(), &mixed.measures());
        assert!(found < 1e-4, "from {kernel}: {what} differs by {found:.1e}");
    }
}

/// The scene with the ball on the sponge and surface tension, so that every kernel has work.
fn everything() -> Scene {
    let mut scene = busy::scene("ball_drop", 0.5);
    if let Some(fluid) = &mut scene.fluid {
        fluid.surface_tension = 0.072;
    }
    scene
}

/// Kernels of a scene that can be placed on their own: those that go through the cells go with the sort.
fn placed_alone(world: &World) -> Vec<Vec<&'static str>> {
    let beside = ["grid::sort_fluid", "grid::fluid_neighbors", "couple::controls"];
    let runs = world.plan().lines().iter().filter(|line| line.verdict == Verdict::Runs);
    let names = runs.map(|line| line.name).filter(|name| *name != "rigid::step" && !beside.contains(name));
    let mut all: Vec<Vec<_>> = names.map(|name| vec![name]).collect();
    all.push(beside.to_vec());
    all
}

#[test]
fn every_kernel_can_be_alone_on_either_side() {
    let scene = everything();
    let mut cpu = world(&scene, Offload::Cpu);
    common::steps(&mut cpu, 3);
    for names in placed_alone(&cpu) {
        for (alone, others) in [(Place::Gpu, Place::Cpu), (Place::Cpu, Place::Gpu)] {
            let mut list: Vec<_> = KERNELS.iter().map(|kernel| (kernel.name, others)).collect();
            list.extend(names.iter().map(|name| (*name, alone)));
            let mut mixed = world(&scene, Offload::Each(list));
            assert!(names.iter().all(|name| mixed.plan().place(name) == alone), "{names:?}");
            common::steps(&mut mixed, 3);
            let (found, what) = difference(&cpu.measures(), &mixed.measures());
            assert!(found < 1e-4, "{names:?} on {alone}: {what} differs by {found:.1e}");
        }
    }
}

#[test]
fn kernels_can_take_turns() {
    let scene = everything();
    let mut cpu = world(&scene, Offload::Cpu);
    let list = KERNELS.iter().enumerate().map(|(index, kernel)| {
        let sort = ["grid::sort_fluid", "grid::fluid_neighbors", "couple::controls"].contains(&kernel.name);
        (kernel.name, if sort || index % 2 == 0 { Place::Gpu } else { Place::Cpu })
    });
    let mut mixed = world(&scene, Offload::Each(list.collect()));
    for _ in 0..2 {
        common::frame(&mut cpu);
        common::frame(&mut mixed);
    }
    let (found, what) = difference(&cpu.measures(), &mixed.measures());
    assert!(found < 1e-3, "{what} differs by {found:.1e}");
    // The control: a frame more is another state.
    common::frame(&mut mixed);
    assert!(difference(&cpu.measures(), &mixed.measures()).0 > 1e-3);
}

#[test]
fn kernels_at_places_where_they_cannot_be_are_refused() {
    let scene = busy::scene("water", 0.5);
    let error = |list: Vec<(&'static str, Place)>| {
        let options = Options { offload: Offload::Each(list), gpu: Some(gpu()), ..Options::default() };
        World::with_options(&scene, &options).map(|_| ()).map_err(|error| error.to_string())
    };
    let sort = ("grid::sort_fluid", Place::Gpu);
    let refused = error(vec![sort]);
    assert!(refused.as_ref().is_err_and(|text| text.contains("grid::fluid_neighbors=cpu")), "{refused:?}");
    assert_eq!(error(vec![sort, ("grid::fluid_neighbors", Place::Gpu)]), Ok(()));
    let unknown = error(vec![("sph::nothing", Place::Gpu)]);
    assert!(unknown.as_ref().is_err_and(|text| text.contains("sph::nothing")), "{unknown:?}");
}

#[test]
fn plans_say_where_and_why_and_what_travels() {
    let scene = busy::scene("ball_drop", 0.5);
    let all = world(&scene, Offload::Gpu).plan().to_string();
    for part in ["backend gpu", "gpu   sph::density", "host  rigid::step", "send  bodies.states: 144 bytes"] {
        assert!(all.contains(part), "{part} is not in {all}");
    }
    let mixed = world(&scene, Offload::From("sph::forces")).plan().to_string();
    for part in ["cpu   sph::density", "gpu   sph::forces", "send ", "fetch "] {
        assert!(mixed.contains(part), "{part} is not in {mixed}");
    }
    let list = vec![("pbd::strain", Place::Gpu), ("pbd::contact", Place::Cpu)];
    let each = world(&scene, Offload::Each(list)).plan().to_string();
    for part in ["gpu   1 x pbd::strain", "cpu   1 x pbd::contact", "send  nodes.predicted: ", "fetch nodes.predicted: "]
    {
        assert!(each.contains(part), "{part} is not in {each}");
    }
    let few = world(&scene, Offload::Auto).plan().to_string();
    assert!(few.contains("backend cpu, of auto") && few.contains("worth a GPU"), "{few}");
    assert!(!world(&scene, Offload::Cpu).plan().to_string().contains("backend"));
}

#[test]
fn a_scene_that_is_too_large_for_the_adapter_is_an_error_with_its_size() {
    let scene = busy::scene("water", 0.5);
    let adapter = sorb::gpu::adapters().into_iter().next().expect("there is an adapter");
    let limits = sorb::gpu::wgpu::Limits {
        max_storage_buffer_binding_size: 1 << 16,
        ..sorb::gpu::required_limits(&adapter)
    };
    let small = Gpu::with_limits(&adapter, limits).unwrap_or_else(|error| panic!("{error}"));
    let options = Options { offload: Offload::Gpu, gpu: Some(Arc::new(small)), ..Options::default() };
    let mut world =
        World::with_options(&scene, &options).unwrap_or_else(|error: WorldError| panic!("{error}"));
    let error = world.step().map_err(|error| error.to_string());
    assert!(error.as_ref().is_err_and(|text| text.contains("bytes on the GPU")), "{error:?}");
    assert_eq!(world.step().map_err(|error| error.to_string()), error);
}
