//! A container that moves on a device: what is felt in it is as on the CPU.

use sorb::{
    Command, Offload, Options, World,
    glam::{Quat, Vec3},
    scene::{Body, Fluid, FluidBlock, FluidSolver, GravityKey, Motion, Scene, ShapeKind, Sponge},
};

use super::{common, difference, gpu, world};

fn shake() -> Motion {
    Motion::Shake { amplitude: Vec3::new(0.02, 0.005, 0.0), frequency: 5.0, start: 0.0, end: 0.3, ease: 0.1 }
}

fn turn() -> Motion {
    let pivot = Vec3::new(0.0, -0.2, 0.0);
    Motion::Turn { axis: Vec3::Z, pivot, rate: 8.0, start: 0.0, end: 0.15, ease: 0.05 }
}

fn tank(motions: Vec<Motion>) -> Scene {
    let (low, high) = (Vec3::new(-0.05, 0.0, -0.03), Vec3::new(0.05, 0.1, 0.03));
    let blocks = vec![FluidBlock::new(low, high.with_y(0.03))];
    let fluid = Fluid { spacing: 0.007, blocks, ..Fluid::default() };
    let ball = Body::dynamic("ball", ShapeKind::Sphere { radius: 0.012 }, Vec3::new(0.02, 0.06, 0.0), 700.0);
    let mut scene = Scene::new("tank").in_box(low, high).with_fluid(fluid).with_body(ball);
    scene.container.motions = motions;
    scene.gravity_path = vec![GravityKey { time: 0.1, gravity: Vec3::NEG_Y * 8.0 }];
    scene
}

/// Worlds on the CPU and on the device have the same measures within 5 % after some frames. Another with other motions has not.
fn assert_as_on_the_cpu(motions: Vec<Motion>, others: Vec<Motion>) {
    let scene = tank(motions);
    let (mut on_cpu, mut on_gpu) = (world(&scene, Offload::Cpu), world(&scene, Offload::Gpu));
    let (mut twice, mut other) = (on_gpu.clone(), world(&tank(others), Offload::Gpu));
    for _ in 0..8 {
        [&mut on_cpu, &mut on_gpu, &mut twice, &mut other].into_iter().for_each(common::frame);
    }
    assert_eq!(on_gpu.digest(), twice.digest());
    let apart = difference(&on_cpu.measures(), &on_gpu.measures());
    assert!(apart.0 < 0.05, "{apart:?}");
    let gravities = (on_cpu.gravity(), on_gpu.gravity());
    assert!(gravities.0.distance(gravities.1) < 0.5, "{gravities:?}");
    // The control.
    let apart = difference(&on_gpu.measures(), &other.measures());
    assert!(apart.0 > 0.2, "{apart:?}");
    let mut bytes = Vec::new();
    on_gpu.save(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
    let options = Options { offload: Offload::Gpu, gpu: Some(gpu()), ..Options::default() };
    let mut restored = World::restore(&bytes[..], &options).unwrap_or_else(|error| panic!("{error}"));
    [&mut on_gpu, &mut restored].into_iter().for_each(common::frame);
    assert_eq!(on_gpu.digest(), restored.digest());
}

#[test]
fn a_shaken_tank_is_as_on_the_cpu() {
    assert_as_on_the_cpu(vec![shake()], Vec::new());
}

#[test]
fn a_tank_that_turns_is_as_on_the_cpu() {
    assert_as_on_the_cpu(vec![turn(), shake()], vec![shake()]);
}

/// A ball, a particle and a sponge far from each other, without gravity.
fn free() -> Scene {
    let ball = Body::dynamic("ball", ShapeKind::Sphere { radius: 0.01 }, Vec3::new(0.3, 0.1, 0.0), 1000.0);
    let water = FluidBlock::new(Vec3::new(-0.1, 0.0, 0.0), Vec3::new(-0.095, 0.005, 0.005));
    let fluid = Fluid { blocks: vec![water], solver: Some(FluidSolver::Pbf), ..Fluid::default() };
    let sponge =
        Sponge { cells: [3, 3, 3].into(), edge: 0.01, ..Sponge::new("sponge", Vec3::new(0.0, 0.3, 0.0)) };
    let mut scene = Scene::new("free").with_body(ball).with_fluid(fluid).with_sponge(sponge);
    scene.gravity = Vec3::ZERO;
    scene.time.maximum_step = 0.002;
    let (axis, pivot) = (Vec3::new(0.2, 0.3, 1.0), Vec3::new(0.1, -0.2, 0.0));
    scene.container.motions =
        vec![Motion::Turn { axis, pivot, rate: 7.0, start: 0.01, end: 0.13, ease: 0.04 }];
    scene
}

/// Where the ball, the particle and the middle of the sponge are.
fn places(world: &World) -> [Vec3; 3] {
    let place = |row: &[f32; 4]| Vec3::new(row[0], row[1], row[2]);
    let nodes = world.node_positions();
    let middle = nodes.iter().map(place).sum::<Vec3>() / nodes.len() as f32;
    [world.bodies()[0].state.position, place(&world.particle_positions()[0]), middle]
}

/// The same as on the CPU (`tests/container.rs`): where the device takes all of the step, where it shares it, and by single steps.
#[test]
fn what_is_free_stays_where_it_is_outside() {
    let shared = "each:all=gpu,sph::kick=cpu,pbd::velocity=cpu".parse().expect("two places");
    for (offload, by_steps) in [(Offload::Gpu, false), (Offload::Gpu, true), (shared, false)] {
        let mut world = world(&free(), offload.clone());
        let before = places(&world);
        while world.clock().time < 0.15 {
            if by_steps {
                common::steps(&mut world, 1)
            } else {
                common::frame(&mut world)
            };
        }
        let (position, rotation) = world.container_pose();
        for (before, now) in before.iter().zip(places(&world)) {
            let outside = position + rotation * now;
            assert!(outside.distance(*before) < 4e-3, "{offload}, {by_steps}: {before} is at {outside}");
            // The control: in the container it is elsewhere.
            assert!(now.distance(*before) > 0.05, "{offload}, {by_steps}: {now}");
        }
        let turned = rotation * world.bodies()[0].state.rotation;
        assert!(turned.angle_between(Quat::IDENTITY) < 5e-3, "{offload}: the ball has turned by {turned}");
        let speeds = world.particle_velocities().iter().chain(world.node_velocities());
        let fastest = speeds.map(|row| Vec3::new(row[0], row[1], row[2]).length()).fold(0.0, f32::max);
        assert!(fastest < 0.02, "{offload}: {fastest} m/s after a motion that is over");
    }
}

#[test]
fn a_container_turns_by_command_and_while_the_world_moves_between_places() {
    let mut world = world(&tank(Vec::new()), Offload::Gpu);
    world.push(Command::Container { motions: vec![turn()] }).unwrap_or_else(|error| panic!("{error}"));
    common::frame(&mut world);
    world.move_to(None).unwrap_or_else(|error| panic!("{error}"));
    common::frame(&mut world);
    world.move_to(Some(&gpu())).unwrap_or_else(|error| panic!("{error}"));
    while world.clock().time < 0.17 {
        common::frame(&mut world);
    }
    let (_, rotation) = world.container_pose();
    let felt = rotation * world.gravity();
    assert!(felt.distance(Vec3::NEG_Y * 8.0) < 1e-3, "{felt} outside");
    // The control: in the container that is elsewhere.
    assert!(world.gravity().distance(felt) > 1.0);
}

/// Water without a surface in a vessel that is shaken: no pressure can meet an error of its density, and none is asked for.
#[test]
fn water_in_a_full_vessel_stays_where_it_is() {
    let moved = |fill: f32, offload: Offload| {
        let mut scene = common::vessel(fill, Vec3::Y * -9.81);
        scene.container.motions = vec![Motion::Shake {
            amplitude: Vec3::X * 0.02,
            frequency: 4.0,
            start: 0.0,
            end: 1.0,
            ease: 0.1,
        }];
        let (mut world, mut fastest, mut steps) = (world(&scene, offload), 0.0_f32, 0);
        for _ in 0..8 {
            let report = world.advance_frame().unwrap_or_else(|error| panic!("{error}"));
            (fastest, steps) = (fastest.max(report.maximum_speed), steps + report.steps);
        }
        (fastest, steps)
    };
    for offload in [Offload::Cpu, Offload::Gpu] {
        let (speed, steps) = moved(1.0, offload.clone());
        assert!(speed < 0.02 && steps < 8 * 12, "{offload}: {speed} m/s, {steps} steps");
    }
    // Negative control: with a free surface it sloshes.
    let (speed, _) = moved(0.9, Offload::Gpu);
    assert!(speed > 0.2, "{speed} m/s");
}
