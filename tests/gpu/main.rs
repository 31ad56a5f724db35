//! Whole scenes on the GPU against the CPU. A machine without an adapter fails here: lavapipe is one.

#[path = "../common/mod.rs"]
mod common;

mod alike;
mod asleep;
mod container;
mod pictures;
mod placement;
mod queries;
mod replay;
mod state;
mod steering;
mod water;

use std::sync::{Arc, OnceLock};

use common::{busy, resting::one_lies_one_flies};
use sorb::{Bound, Measures, Offload, Options, World, WorldError, glam::Vec3, gpu::Gpu, scene::Scene};

/// Pressure by a solve.
const DFSPH: &[&str] = &["fluid.solver=\"dfsph\""];

/// Pressure by a solve for the divergence of the velocities.
const DIVERGENCE: &[&str] = &["fluid.solver=\"divergence\""];

/// The same with a ball that falls into the water, and a box under it.
const DIVERGENCE_AND_BODIES: &[&str] = &[
    "fluid.solver=\"divergence\"",
    "bodies=[\
        {name=\"ball\",kind=\"dynamic\",shape={kind=\"sphere\",radius=0.02},position=[-0.15,0.13,0.0],density=500.0},\
        {name=\"box\",kind=\"dynamic\",shape={kind=\"cuboid\",half_extents=[0.02,0.015,0.02]},position=[-0.09,0.016,0.0]}]",
];

/// Water and sponges coupled by nodes within the suction radius.
const SMOOTHED: &[&str] = &["fluid.coupling_weights=\"smoothed\""];

/// Viscous fluid with no-slip everywhere, solved so precisely that one iteration more or less does not show.
const HONEY: &[&str] = &[
    "fluid.viscosity=5",
    "fluid.viscosity_integration=\"implicit\"",
    "fluid.viscosity_tolerance=1e-5",
    "fluid.no_slip=true",
];

fn new_gpu() -> Gpu {
    Gpu::new().unwrap_or_else(|error| {
        panic!("{error}; these tests need one, and do not pass without: install mesa-vulkan-drivers and libvulkan1")
    })
}

/// One device for all tests.
fn gpu() -> Arc<Gpu> {
    static GPU: OnceLock<Arc<Gpu>> = OnceLock::new();
    Arc::clone(GPU.get_or_init(|| Arc::new(new_gpu())))
}

/// One where threads share rows as on a hardware adapter, which takes longer in software.
fn gpu_that_shares_rows() -> Arc<Gpu> {
    static GPU: OnceLock<Arc<Gpu>> = OnceLock::new();
    Arc::clone(GPU.get_or_init(|| Arc::new(new_gpu().with_busy_threads(Gpu::BUSY_THREADS))))
}

fn world(scene: &Scene, offload: Offload) -> World {
    world_on(gpu(), scene, offload)
}

fn world_on(gpu: Arc<Gpu>, scene: &Scene, offload: Offload) -> World {
    let options = Options { offload, gpu: Some(gpu), ..Options::default() };
    World::with_options(scene, &options).unwrap_or_else(|error| panic!("{}: {error}", scene.name))
}

/// The scene with water that starts a micrometre per second faster, and sponges a tenth of a micrometre aside. Rounding grows as large as
/// its difference. Splashing water is chaotic. Water of a sponge starts on faces of its tets: gradients jump there, and rounding decides
/// which tet a particle is in.
fn shifted(scene: &Scene) -> Scene {
    let mut shifted = scene.clone();
    if let Some(fluid) = &mut shifted.fluid {
        fluid.blocks.iter_mut().for_each(|block| block.velocity += Vec3::new(1e-6, 1e-6, -1e-6));
    }
    for sponge in &mut shifted.sponges {
        sponge.position += Vec3::new(1e-7, -1e-7, 1e-7);
    }
    shifted
}

/// Largest difference from the CPU that is permitted: `tolerance`, or on a hardware adapter, which fuses products and sums, twice what a
/// shift does on the CPU itself. A shift is one sample of it.
fn bound(tolerance: f64, shift: f64) -> f64 {
    if gpu().report().is_software() { tolerance } else { tolerance.max(2.0 * shift) }
}

/// Largest difference of two states: of each measure, over its expected scale.
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

/// The largest, also if one is NaN.
fn worst(differences: &[(f64, &'static str)]) -> (f64, &'static str) {
    differences.iter().fold((0.0, "nothing"), |worst, new| if new.0 <= worst.0 { worst } else { *new })
}

#[test]
fn a_world_and_its_clone_end_with_the_same_bits() {
    let presets = ["water", "ball_drop", "water_paper", "ball_drop_paper", "water_divergence"];
    let mut scenes: Vec<_> = presets.iter().map(|name| busy::scene(name, 0.3)).collect();
    scenes.extend([common::preset("stack", 0.3), one_lies_one_flies()]);
    for scene in scenes {
        let name = &scene.name;
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
    // Steps that the default would limit before the pressure does.
    let long = &["fluid.solver=\"dfsph\"", "time.maximum_step=0.01"][..];
    for (name, keys, bound) in [("ball_drop", &[][..], None), ("water", long, Some(Bound::Pressure))] {
        let scene = common::with(&busy::scene(name, 0.5), keys);
        let (mut cpu, mut gpu) = (world(&scene, Offload::Cpu), world(&scene, Offload::Gpu));
        let mut bounds = Vec::new();
        for _ in 0..10 {
            let fail = |error| panic!("{error}");
            let (expected, found) = (cpu.step().unwrap_or_else(fail), gpu.step().unwrap_or_else(fail));
            assert_eq!(expected.bound, found.bound, "{name}");
            let apart = |a: f32, b: f32| (a / b - 1.0).abs();
            assert!(apart(expected.step, found.step) < 1e-3, "{name}: {expected:?}, {found:?}");
            let speeds = (expected.maximum_speed, found.maximum_speed);
            assert!(apart(speeds.0, speeds.1) < 1e-3, "{name}: {expected:?}, {found:?}");
            bounds.push(found.bound);
        }
        assert!((cpu.clock().time - gpu.clock().time).abs() < 1e-6, "{name}");
        assert!(bound.is_none_or(|bound| bounds.contains(&bound)), "{name}: {bounds:?}");
    }
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
