//! Scenes after 1, 60 and 180 frames.

use std::sync::Arc;

use sorb::{
    Offload, Options, World,
    glam::DVec3,
    gpu::{Gpu, wgpu::Limits},
    scene::Scene,
};

use super::{
    DFSPH, DIVERGENCE, DIVERGENCE_AND_BODIES, HONEY, SMOOTHED, bound, busy, common, difference, gpu,
    gpu_that_shares_rows, shifted, world, world_on, worst,
};

/// Largest difference of quantities that do not depend on single particles. Place of water and sponges, absorbed water, and
/// energies, over the energy that the scene had to lose.
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

/// A scene, its duration, and the allowed difference between CPU and GPU.
#[derive(Clone, Copy)]
struct Case {
    scene: &'static str,
    resolution: f32,
    /// Changes of the scene: softer and slower, where the preset takes too many steps for a software adapter.
    keys: &'static [&'static str],
    frames: u32,
    /// For [`difference`], after 1 frame, or [`bulk_difference`], after more, as [`bound`] has it.
    tolerance: f64,
}

impl Case {
    fn scene(&self) -> Scene {
        common::with(&busy::scene(self.scene, self.resolution), self.keys)
    }

    /// Difference between two worlds of the case.
    fn difference(&self, a: &World, b: &World) -> (f64, &'static str) {
        if self.frames == 1 {
            return difference(&a.measures(), &b.measures());
        }
        let start = world(&self.scene(), Offload::Cpu).measures();
        // Energy that can be lost: motion, and a tenth of a metre of height.
        let energy = start.kinetic_energy + start.water_mass * 9.81 * 0.1 + 1e-4;
        bulk_difference(a, b, energy)
    }

    #[track_caller]
    fn run(&self, scene: &Scene, offload: Offload) -> World {
        let device = if self.frames == 1 { gpu_that_shares_rows() } else { gpu() };
        let mut world = world_on(device, scene, offload);
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
    // Negative control: gravity that leans by three degrees is noticed.
    let mut other = scene.clone();
    other.gravity.x += 0.5;
    let (control, _) = case.difference(&cpu, &case.run(&other, Offload::Cpu));
    let (chaos, _) = case.difference(&cpu, &case.run(&shifted(&scene), Offload::Cpu));
    let (frames, bound) = (case.frames, bound(case.tolerance, chaos));
    println!(
        "{name}, {frames} frames: {found:.1e} of {bound:.0e}, {what}; chaos {chaos:.1e}, control {control:.1e}"
    );
    assert!(found <= bound, "{name} after {frames} frames: {what} differs by {found:.1e}");
    assert!(control > bound || scene.bodies.is_empty() && scene.fluid.is_none(), "{name}: {control:.1e}");
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

/// A tank that the water fills: a puddle of a few particles in a wide one drifts for ever.
const NARROW: &[&str] = &["fluid.sound_speed=4", "fluid.viscosity=2.0", "domain.maximum=[-0.1, 0.2, 0.06]"];

/// Water that flows out of one end of its tank and into the other.
const STREAM: &[&str] = &["domain.periodic=[true, false, true]", "gravity=[5.0, -9.81, 1.0]"];

/// The ball touches the sponge and stays there: fixed bodies do not interrupt a batch of steps.
const FIXED: &[&str] = &[
    "bodies.0.kind=\"fixed\"",
    "bodies.0.linear_velocity=[0.0, 0.0, 0.0]",
    "bodies.0.position=[0.005, 0.105, 0.003]",
];

cases! {
    standing: "standing", 0.5, &[], 1, 1e-4;
    ball_drop: "ball_drop", 0.5, &[], 1, 1e-4;
    squish: "squish", 0.5, &[], 1, 3e-5;
    dam_break: "dam_break", 0.5, &[], 1, 1e-4;
    wring: "wring", 0.5, &[], 1, 1e-4;
    life: "life", 0.5, &[], 1, 1e-4;
    stack: "stack", 0.5, &[], 1, 1e-4;
    water: "water", 0.5, &[], 1, 1e-4;
    dry: "dry", 0.5, &[], 1, 1e-4;
    empty: "empty", 0.5, &[], 1, 1e-4;
    fixed_ball: "ball_drop", 0.5, FIXED, 1, 1e-4;
    standing_of_the_paper: "standing_paper", 0.5, &[], 1, 1e-4;
    ball_drop_of_the_paper: "ball_drop_paper", 0.5, &[], 1, 1e-4;
    squish_of_the_paper: "squish_paper", 0.5, &[], 1, 1e-4;
    dam_break_of_the_paper: "dam_break_paper", 0.5, &[], 1, 1e-4;
    wring_of_the_paper: "wring_paper", 0.5, &[], 1, 1e-4;
    water_of_the_paper: "water_paper", 0.5, &[], 1, 1e-4;
    dry_of_the_paper: "dry_paper", 0.5, &[], 1, 1e-4;
    honey: "water", 0.5, HONEY, 1, 1e-4;
    stream: "water", 0.5, STREAM, 1, 1e-4;
    stream_of_the_paper: "water_paper", 0.5, STREAM, 1, 1e-4;
    honey_in_a_sponge: "ball_drop", 0.5, HONEY, 1, 1e-4;
    solved_dam_break: "dam_break_paper", 0.5, DFSPH, 1, 1e-4;
    divergence: "water", 0.5, DIVERGENCE, 1, 1e-4;
    divergence_and_bodies: "water", 0.5, DIVERGENCE_AND_BODIES, 1, 1e-4;
    divergence_and_a_sponge: "standing", 0.5, DIVERGENCE, 1, 1e-4;
    divergence_and_a_ball_on_a_sponge: "ball_drop", 0.5, DIVERGENCE, 1, 1e-4;
    smoothed_and_a_ball_on_a_sponge: "ball_drop", 0.5, SMOOTHED, 1, 1e-4;
    smoothed_and_grips: "wring", 0.5, SMOOTHED, 1, 1e-4;
    a_second_of_a_smoothed_sponge: "standing", 0.3, SMOOTHED, 60, 1e-2;
    a_second_of_divergence_and_a_sponge: "standing", 0.3, DIVERGENCE, 60, 1e-2;
    a_second_of_solved_water: "water", 0.4, &[], 60, 1e-1;
    a_second_of_honey: "water", 0.4, HONEY, 60, 1e-2;
    a_second_of_standing: "standing", 0.3, &[], 60, 1e-2;
    a_second_of_ball_drop: "ball_drop", 0.3, &[], 60, 1e-2;
    a_second_of_water: "water_paper", 0.3, &[], 60, 1e-1;
    a_second_of_standing_of_the_paper: "standing_paper", 0.3, SOFT, 60, 1e-3;
    a_second_of_squish: "squish_paper", 0.3, SOFT, 60, 3e-3;
    a_second_of_dam_break: "dam_break_paper", 0.3, SOFT, 60, 3e-2;
    three_seconds_of_water: "water_paper", 0.3, NARROW, 180, 1e-2;
    three_seconds_of_standing: "standing_paper", 0.3, SOFT, 180, 1e-2;
    three_seconds_of_ball_drop: "ball_drop_paper", 0.2, SOFT, 180, 1e-3;
}

/// Passes that are one dispatch do what they do one after the other. Where kernels are timed every pass is alone, and with the
/// limits that every adapter has fewer are one.
#[test]
fn dispatches_of_several_passes_change_nothing() {
    for scene in
        [busy::scene("ball_drop", 0.5), common::with(&busy::scene("water", 0.5), DIVERGENCE_AND_BODIES)]
    {
        let run = |limits: Option<Limits>, gpu_times: bool| {
            let adapter = sorb::gpu::adapters().into_iter().next().expect("there is an adapter");
            let small = limits.map(|limits| Gpu::with_limits(&adapter, limits).expect("a device"));
            let small = small.map(|small| Arc::new(small.with_busy_threads(Gpu::BUSY_THREADS)));
            let device = small.unwrap_or_else(gpu_that_shares_rows);
            let options =
                Options { offload: Offload::Gpu, gpu: Some(device), gpu_times, ..Options::default() };
            let mut world = World::with_options(&scene, &options).expect("a scene of the tests");
            common::steps(&mut world, 8);
            world.measures()
        };
        let expected = run(None, true);
        for limits in [None, Some(Limits::default())] {
            let (found, what) = difference(&expected, &run(limits, false));
            assert!(found < 1e-6, "{}: {what} differs by {found:.1e}", scene.name);
        }
    }
}
