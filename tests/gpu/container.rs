//! A container that moves on a device: what it feels is what the CPU says, and a turn is refused.

use std::sync::Arc;

use sorb::{
    Command, Offload, Options, World,
    glam::Vec3,
    scene::{Body, Fluid, FluidBlock, GravityKey, Motion, Scene, ShapeKind},
};

use super::{common, difference, gpu, world};

fn shake() -> Motion {
    Motion::Shake { amplitude: Vec3::new(0.02, 0.005, 0.0), frequency: 5.0, start: 0.0, end: 0.3, ease: 0.1 }
}

fn turn() -> Motion {
    Motion::Turn { axis: Vec3::Z, pivot: Vec3::ZERO, rate: 1.0, start: 0.05, end: 0.3, ease: 0.1 }
}

fn tank(motions: Vec<Motion>) -> Scene {
    let (low, high) = (Vec3::new(-0.05, 0.0, -0.03), Vec3::new(0.05, 0.1, 0.03));
    let fluid = Fluid { blocks: vec![FluidBlock::new(low, high.with_y(0.03))], ..Fluid::default() };
    let ball = Body::dynamic("ball", ShapeKind::Sphere { radius: 0.012 }, Vec3::new(0.02, 0.06, 0.0), 700.0);
    let mut scene = Scene::new("tank").in_box(low, high).with_fluid(fluid).with_body(ball);
    scene.container.motions = motions;
    scene.gravity_path = vec![GravityKey { time: 0.1, gravity: Vec3::NEG_Y * 8.0 }];
    scene
}

#[test]
fn a_shaken_tank_is_as_on_the_cpu() {
    let scene = tank(vec![shake()]);
    let (mut on_cpu, mut on_gpu) = (world(&scene, Offload::Cpu), world(&scene, Offload::Gpu));
    let (mut twice, mut still) = (on_gpu.clone(), world(&tank(Vec::new()), Offload::Gpu));
    for _ in 0..8 {
        [&mut on_cpu, &mut on_gpu, &mut twice, &mut still].into_iter().for_each(common::frame);
    }
    assert_eq!(on_gpu.digest(), twice.digest());
    let apart = difference(&on_cpu.measures(), &on_gpu.measures());
    assert!(apart.0 < 0.05, "{apart:?}");
    let gravities = (on_cpu.gravity(), on_gpu.gravity());
    assert!(gravities.0.distance(gravities.1) < 0.5, "{gravities:?}");
    // The control: a tank that rests.
    let apart = difference(&on_gpu.measures(), &still.measures());
    assert!(apart.0 > 0.2, "{apart:?}");
    let mut bytes = Vec::new();
    on_gpu.save(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
    let options = Options { offload: Offload::Gpu, gpu: Some(gpu()), ..Options::default() };
    let mut restored = World::restore(&bytes[..], &options).unwrap_or_else(|error| panic!("{error}"));
    [&mut on_gpu, &mut restored].into_iter().for_each(common::frame);
    assert_eq!(on_gpu.digest(), restored.digest());
}

#[test]
fn a_device_refuses_to_turn_and_says_why() {
    let options =
        |offload| Options { offload, gpu: Some(Arc::clone(&gpu())), threads: Some(1), ..Options::default() };
    let refused = World::with_options(&tank(vec![turn()]), &options(Offload::Gpu));
    let text = refused.err().map(|error| error.to_string()).unwrap_or_default();
    assert!(text.contains("a container turns on the CPU only"), "{text}");
    // Left to itself the world stays on the CPU, and turns.
    let mut free = World::with_options(&tank(vec![turn()]), &options(Offload::Auto))
        .unwrap_or_else(|error| panic!("{error}"));
    common::frame(&mut free);
    let mut world = world(&tank(Vec::new()), Offload::Gpu);
    let error = world.push(Command::Container { motions: vec![turn()] });
    assert!(error.is_err_and(|error| error.to_string().contains("a container turns on the CPU only")));
    world.push(Command::Container { motions: vec![shake()] }).unwrap_or_else(|error| panic!("{error}"));
    common::frame(&mut world);
    // On the CPU it may, and then it cannot go back before that is over.
    world.move_to(None).unwrap_or_else(|error| panic!("{error}"));
    world.push(Command::Container { motions: vec![turn()] }).unwrap_or_else(|error| panic!("{error}"));
    common::frame(&mut world);
    assert!(world.move_to(Some(&gpu())).is_err());
    while world.clock().time < 0.32 {
        common::frame(&mut world);
    }
    world.move_to(Some(&gpu())).unwrap_or_else(|error| panic!("{error}"));
    common::frame(&mut world);
}
