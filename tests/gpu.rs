//! Whole scenes on the GPU against the CPU. A machine without an adapter fails here: lavapipe is one.

mod common;

use std::sync::{Arc, OnceLock};

use common::busy;
use sorb::{
    Measures, Offload, Options, StepError, World, WorldError,
    columns::{Column, Columns},
    glam::{DVec3, Vec3},
    gpu::{Gpu, GpuError},
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
    worst(&[
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
    ])
}

/// The largest, also if one is not a number.
fn worst(differences: &[(f64, &'static str)]) -> (f64, &'static str) {
    differences.iter().fold((0.0, "nothing"), |worst, new| if new.0 <= worst.0 { worst } else { *new })
}

/// Largest difference of what is left when single particles have gone ways of their own: where water and sponges are,
/// how much the sponges hold, and the energies, over those that the scene had to lose.
fn bulk_difference(a: &World, b: &World, energy: f64) -> (f64, &'static str) {
    let centre = |world: &World| {
        let count = world.particle_positions().len().max(1) as f64;
        world
            .particle_positions()
            .iter()
            .map(|row| DVec3::new(row[0].into(), row[1].into(), row[2].into()))
            .sum::<DVec3>()
            / count
    };
    let water = (centre(a) - centre(b)).abs();
    let (a, b) = (a.measures(), b.measures());
    worst(&[
        ((a.time - b.time).abs() * 1e3, "time"),
        ((a.water_mass - b.water_mass).abs() / (a.water_mass + 1e-3), "water mass"),
        (water.x.max(water.z) / 0.1, "centre of the water"),
        // Twice the height of the centre, of water at rest.
        (2.0 * water.y / 0.1, "level"),
        ((a.absorbed_mass - b.absorbed_mass).abs() / (a.water_mass + 1e-3), "absorbed mass"),
        ((a.saturation - b.saturation).abs(), "saturation"),
        ((a.sponge_volume - b.sponge_volume).abs() / (a.sponge_volume + 1e-9), "sponge volume"),
        ((a.sponge_centre - b.sponge_centre).length() / 0.1, "sponge centre"),
        ((a.kinetic_energy - b.kinetic_energy).abs() / energy, "kinetic energy"),
        ((a.potential_energy - b.potential_energy).abs() / energy, "potential energy"),
        ((a.elastic_energy - b.elastic_energy).abs() / energy, "elastic energy"),
    ])
}

/// A scene, how long it runs, and how far apart CPU and GPU may be then.
#[derive(Clone, Copy)]
struct Case {
    scene: &'static str,
    resolution: f32,
    /// Changes of the scene: softer and slower, where steps of the preset are too many for a software adapter.
    keys: &'static [&'static str],
    frames: u32,
    /// For [`difference`], after 1 frame, or [`bulk_difference`], after more. Beside it what was found, and how far apart
    /// two runs on the CPU end of which one starts a micrometre a second faster.
    tolerance: f64,
}

impl Case {
    fn scene(&self) -> Scene {
        common::with(&busy::scene(self.scene, self.resolution), self.keys)
    }

    /// How far apart two worlds of the case are.
    fn difference(&self, a: &World, b: &World) -> (f64, &'static str) {
        if self.frames == 1 {
            return difference(&a.measures(), &b.measures());
        }
        let start = world(&self.scene(), Offload::Cpu).measures();
        // What is there to lose: motion, and height of a tenth of a metre.
        let energy = start.kinetic_energy + start.water_mass * 9.81 * 0.1 + 1e-4;
        bulk_difference(a, b, energy)
    }

    #[track_caller]
    fn run(&self, scene: &Scene, offload: Offload) -> World {
        let mut world = world(scene, offload);
        (0..self.frames).for_each(|_| common::frame(&mut world));
        world
    }
}

#[track_caller]
#[expect(clippy::print_stdout, reason = "how far apart they are is worth reading in a test that passes")]
fn assert_alike(case: &Case) {
    let scene = case.scene();
    let name = case.scene;
    let (cpu, gpu) = (case.run(&scene, Offload::Cpu), case.run(&scene, Offload::Gpu));
    assert!(cpu.clock().steps.abs_diff(gpu.clock().steps) <= 2 + cpu.clock().steps / 20, "{name}");
    assert_eq!(common::unhealthy(&gpu, cpu.particle_ids().len()), None, "{name}");
    let (found, what) = case.difference(&cpu, &gpu);
    // The control: gravity that leans by three degrees is noticed.
    let mut other = scene.clone();
    other.gravity.x += 0.5;
    let (control, _) = case.difference(&cpu, &case.run(&other, Offload::Cpu));
    // Splashing water is chaotic: rounding becomes as large as what it does to the same program.
    let mut shifted = scene.clone();
    if let Some(fluid) = &mut shifted.fluid {
        fluid.blocks.iter_mut().for_each(|block| block.velocity += Vec3::new(1e-6, 1e-6, -1e-6));
    }
    let (chaos, _) = case.difference(&cpu, &case.run(&shifted, Offload::Cpu));
    let Case { frames, tolerance, .. } = case;
    println!(
        "{name}, {frames} frames: {found:.1e} of {tolerance:.0e}, {what}; chaos {chaos:.1e}, control {control:.1e}"
    );
    assert!(found <= *tolerance, "{name} after {frames} frames: {what} differs by {found:.1e}");
    assert!(
        control > *tolerance || scene.bodies.is_empty() && scene.fluid.is_none(),
        "{name}: {control:.1e}"
    );
}

macro_rules! cases {
    ($($name:ident: $scene:literal, $resolution:literal, $keys:expr, $frames:literal, $tolerance:literal;)*) => {
        $(#[test]
        fn $name() {
            assert_alike(&Case {
                scene: $scene,
                resolution: $resolution,
                keys: $keys,
                frames: $frames,
                tolerance: $tolerance,
            });
        })*
    };
}

/// Ten steps a frame instead of forty, and water that comes to rest.
const SOFT: &[&str] = &[
    "fluid.sound_speed=4",
    "fluid.viscosity=0.5",
    "sponges.0.stretch_modulus=1000",
    "sponges.0.shear_modulus=500",
    "sponges.0.volume_modulus=1000",
    "sponges.0.entry_pressure=100",
];

/// A tank that the water fills: a puddle of a few particles in a wide one drifts to and fro for ever.
const NARROW: &[&str] = &["fluid.sound_speed=4", "fluid.viscosity=0.5", "domain.maximum=[-0.1, 0.2, 0.06]"];

cases! {
    standing: "standing", 0.5, &[], 1, 1e-4;
    ball_drop: "ball_drop", 0.5, &[], 1, 1e-4;
    squish: "squish", 0.5, &[], 1, 1e-4;
    dam_break: "dam_break", 0.5, &[], 1, 1e-4;
    wring: "wring", 0.5, &[], 1, 1e-4;
    water: "water", 0.5, &[], 1, 1e-4;
    dry: "dry", 0.5, &[], 1, 1e-4;
    empty: "empty", 0.5, &[], 1, 1e-4;
    a_second_of_water: "water", 0.3, &[], 60, 1e-1;
    a_second_of_standing: "standing", 0.3, SOFT, 60, 1e-3;
    a_second_of_ball_drop: "ball_drop", 0.3, &[], 60, 1e-3;
    a_second_of_squish: "squish", 0.3, SOFT, 60, 3e-3;
    a_second_of_dam_break: "dam_break", 0.3, SOFT, 60, 3e-2;
    ten_seconds_of_water: "water", 0.3, NARROW, 600, 5e-2;
    ten_seconds_of_standing: "standing", 0.3, SOFT, 600, 1e-2;
    ten_seconds_of_ball_drop: "ball_drop", 0.2, SOFT, 600, 1e-3;
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
    for part in [
        "gpu   1 x pbd::strain",
        "cpu   1 x pbd::contact",
        "send  nodes.position, nodes.predicted: ",
        "fetch nodes.predicted: ",
    ] {
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

/// A device of its own, that can be lost without the others.
fn another_gpu() -> Arc<Gpu> {
    Arc::new(Gpu::new().unwrap_or_else(|error| panic!("{error}")))
}

fn world_on(scene: &Scene, gpu: &Arc<Gpu>) -> World {
    let options = Options { offload: Offload::Gpu, gpu: Some(Arc::clone(gpu)), ..Options::default() };
    World::with_options(scene, &options).unwrap_or_else(|error| panic!("{}: {error}", scene.name))
}

/// Steps until the loss of the device shows.
fn lose(world: &mut World, gpu: &Gpu) {
    gpu.device().destroy();
    let error = world.advance_frame().map(|_| ());
    assert!(matches!(error, Err(StepError::Gpu(GpuError::Lost { .. }))), "{error:?}");
    assert_eq!(world.advance_frame().map(|_| ()), error, "a world without a device stays where it is");
}

#[test]
fn a_lost_device_costs_what_was_not_looked_at() {
    for name in ["water", "ball_drop"] {
        let scene = busy::scene(name, 0.5);
        let lost = another_gpu();
        let (mut world, mut never_lost) = (world_on(&scene, &lost), world_on(&scene, &gpu()));
        for _ in 0..2 {
            common::frame(&mut world);
            common::frame(&mut never_lost);
        }
        assert_eq!(world.digest(), never_lost.digest(), "{name}");
        let (digest, clock) = (world.digest(), *world.clock());
        common::frame(&mut world);
        lose(&mut world, &lost);
        let on_cpu = {
            let mut world = world.clone();
            world.move_to(None).unwrap_or_else(|error| panic!("{name}: {error}"));
            world
        };
        world.move_to(Some(&gpu())).unwrap_or_else(|error| panic!("{name}: {error}"));
        for (mut world, bound) in [(world, 0.0), (on_cpu, 1e-3)] {
            assert_eq!((world.digest(), *world.clock()), (digest, clock), "{name}");
            let mut never_lost = never_lost.clone();
            for _ in 0..2 {
                common::frame(&mut world);
                common::frame(&mut never_lost);
            }
            let (found, what) = difference(&never_lost.measures(), &world.measures());
            assert!(found <= bound, "{name}: {what} differs by {found:.1e}");
            assert_eq!(world.digest() == never_lost.digest(), bound == 0.0, "{name}");
        }
    }
}

#[test]
fn a_device_that_is_lost_before_anyone_looked_costs_everything() {
    let scene = busy::scene("ball_drop", 0.5);
    let lost = another_gpu();
    let mut world = world_on(&scene, &lost);
    let first = world.digest();
    common::frame(&mut world);
    lose(&mut world, &lost);
    world.move_to(Some(&gpu())).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((world.digest(), world.clock().time), (first, 0.0));
    let mut again = world_on(&scene, &gpu());
    common::frame(&mut world);
    common::frame(&mut again);
    assert_eq!(world.digest(), again.digest());
}

#[test]
fn a_world_can_leave_a_device_that_works() {
    let scene = busy::scene("ball_drop", 0.5);
    let mut world = world_on(&scene, &gpu());
    common::frame(&mut world);
    let mut copy = world.clone();
    let digest = copy.digest();
    world.move_to(None).unwrap_or_else(|error| panic!("{error}"));
    assert!(world.gpu().is_none() && world.plan().placement().is_none());
    assert_eq!(world.digest(), digest);
    common::frame(&mut world);
    world.move_to(Some(&gpu())).unwrap_or_else(|error| panic!("{error}"));
    assert!(world.gpu().is_some());
    common::frame(&mut world);
    common::frame(&mut copy);
    common::frame(&mut copy);
    let (found, what) = difference(&copy.measures(), &world.measures());
    assert!(found < 1e-3, "{what} differs by {found:.1e}");
}

#[test]
fn measures_are_the_same_without_reading_the_state_back() {
    for name in ["water", "ball_drop", "dry", "dam_break"] {
        let scene = busy::scene(name, 0.5);
        let mut world = world_on(&scene, &gpu());
        common::frame(&mut world);
        let on_device = world.measures();
        assert_eq!(world.measures(), on_device, "{name}: sums are taken in a fixed order");
        // Reads the state back, and measures that from now on.
        let _ = world.columns();
        let on_host = world.measures();
        assert_ne!(on_device, on_host, "{name}: the device was not asked");
        let (found, what) = difference(&on_host, &on_device);
        assert!(found < 1e-6, "{name}: {what} differs by {found:.1e}");
        let apart = |a: f64, b: f64| (a - b).abs() / (a.abs() + 1e-9);
        for (what, a, b) in [
            ("wicking height", on_host.wicking_height, on_device.wicking_height),
            ("maximum speed", on_host.maximum_speed, on_device.maximum_speed),
            ("maximum density error", on_host.maximum_density_error, on_device.maximum_density_error),
            ("angular momentum", on_host.angular_momentum.length(), on_device.angular_momentum.length()),
        ] {
            assert!(apart(a, b) < 1e-4, "{name}: {what} is {a:e} and {b:e}");
        }
        // The control: a step more is another state.
        let mut later = world.clone();
        common::steps(&mut later, 1);
        assert!(difference(&on_host, &later.measures()).0 > 1e-6, "{name}");
    }
}

#[test]
fn a_state_that_was_asked_for_is_the_one_at_that_time() {
    let scene = busy::scene("ball_drop", 0.5);
    for offload in [Offload::Gpu, Offload::Cpu] {
        let mut world = world(&scene, offload.clone());
        common::frame(&mut world);
        let mut then = world.clone();
        let mut request = world.request_state().unwrap_or_else(|error| panic!("{error}"));
        common::frame(&mut world);
        // The device has answered: it worked on the frame after that.
        assert!(request.is_ready(), "{offload}");
        assert_eq!(request.clock(), then.clock());
        let found = request.take().unwrap_or_else(|error| panic!("{error}"));
        for column in [Column::FluidPosition, Column::FluidId, Column::NodeVelocity, Column::NodeSaturation] {
            let words = |columns: &Columns| {
                let mut words = Vec::new();
                let rows = columns.rows.of(column.store());
                columns.data(column).visit_words(rows, &mut |word| words.push(word));
                words
            };
            assert!(words(&found) == words(then.columns()), "{offload}: {}", column.name());
            let is_state = column != Column::FluidId;
            assert!(!is_state || words(&found) != words(world.columns()), "{offload}: {}", column.name());
        }
        common::frame(&mut then);
        // One that is taken at once waits, one that is dropped harms nobody.
        drop(world.request_state());
        let waited = world.request_state().and_then(|request| request.take());
        assert!(waited.is_ok_and(|columns| columns.fluid.position == world.columns().fluid.position));
    }
}
