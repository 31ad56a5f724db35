//! Saves, roll backs, commands and recordings on a device: the same device, the same bits.

use std::sync::Arc;

use sorb::{
    Command, Nodes, Offload, Options, Player, Recorder, Snapshot, World,
    glam::{Quat, Vec3},
    rigid::BodyKind,
    scene::Scene,
};

use super::{busy, common, difference, gpu};

const FRAMES: u32 = 6;

fn options() -> Options {
    Options { offload: Offload::Gpu, gpu: Some(Arc::clone(&gpu())), ..Options::default() }
}

fn world(scene: &Scene) -> World {
    World::with_options(scene, &options()).unwrap_or_else(|error| panic!("{}: {error}", scene.name))
}

fn saved(world: &World) -> Vec<u8> {
    let mut bytes = Vec::new();
    world.save(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
    bytes
}

/// What the host does before a frame.
fn push(scene: &Scene, world: &mut World, frame: u32) {
    let mut commands = Vec::new();
    for (body, own) in (0_u32..).map(sorb::BodyHandle::from).zip(&scene.bodies) {
        if own.kind == BodyKind::Dynamic && frame == 1 {
            let (linear_velocity, angular_velocity) = (Vec3::new(0.1, -0.2, 0.0), Vec3::Z);
            commands.push(Command::Velocity { body, linear_velocity, angular_velocity });
        }
        if own.kind == BodyKind::Kinematic && frame == 1 {
            let position = own.position + Vec3::Y * 0.004;
            commands.push(Command::Pose { body, position, rotation: Quat::IDENTITY, duration: 0.05 });
        }
    }
    let nodes = Nodes::Sphere { centre: scene.sponges[0].position, radius: 0.03 };
    match frame {
        2 => commands.push(Command::Gravity { gravity: Vec3::new(0.3, -9.0, 0.0) }),
        3 => commands.push(Command::Grip { body: 0.into(), nodes }),
        5 => commands.push(Command::Release { nodes }),
        _ => {}
    }
    for command in commands {
        world.push(command).unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn the_same_bits_after_any_interruption() {
    for name in ["ball_drop", "life"] {
        let scene = busy::scene(name, 0.3);
        let mut straight = world(&scene);
        for frame in 0..FRAMES {
            push(&scene, &mut straight, frame);
            common::frame(&mut straight);
        }
        let expected = straight.digest();
        let (mut interrupted, mut rolled) = (world(&scene), world(&scene));
        let mut snapshot = Snapshot::new();
        for frame in 0..FRAMES {
            let bytes = saved(&interrupted);
            interrupted = World::restore(&bytes[..], &options()).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(saved(&interrupted), bytes, "{name}: frame {frame}");
            rolled.snapshot_into(&mut snapshot);
            common::frame(&mut rolled);
            rolled.rollback(&snapshot).unwrap_or_else(|error| panic!("{error}"));
            for world in [&mut interrupted, &mut rolled] {
                push(&scene, world, frame);
                common::frame(world);
            }
        }
        assert_eq!(interrupted.digest(), expected, "{name}: saved and restored");
        assert_eq!(rolled.digest(), expected, "{name}: rolled back");
        // The control: without the commands.
        let mut other = world(&scene);
        (0..FRAMES).for_each(|_| common::frame(&mut other));
        assert_ne!(other.digest(), expected, "{name}");
    }
}

#[test]
fn a_recording_of_a_device_plays_on_it() {
    let scene = busy::scene("ball_drop", 0.3);
    let mut recorded = world(&scene);
    let mut recorder = Recorder::new(&recorded, Some(2)).unwrap_or_else(|error| panic!("{error}"));
    for _ in 0..5 {
        recorder.advance_frame(&mut recorded).unwrap_or_else(|error| panic!("{error}"));
    }
    let recording = recorder.into_recording();
    assert!(recording.is_on_gpu());
    let mut player = Player::new(&recording, &options()).unwrap_or_else(|error| panic!("{error}"));
    while player.advance().unwrap_or_else(|error| panic!("{error}")) {}
    assert_eq!(player.world().digest(), recorded.digest());
}

#[test]
fn a_state_of_a_device_continues_on_the_cpu_within_parity_and_back() {
    let scene = busy::scene("ball_drop", 0.4);
    let mut first = world(&scene);
    (0..3).for_each(|_| common::frame(&mut first));
    let bytes = saved(&first);
    let mut on_cpu =
        World::restore(&bytes[..], &Options::default()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(on_cpu.digest(), first.digest());
    push(&scene, &mut first, 1);
    push(&scene, &mut on_cpu, 1);
    for _ in 0..2 {
        common::frame(&mut first);
        common::frame(&mut on_cpu);
    }
    let (found, what) = difference(&first.measures(), &on_cpu.measures());
    assert!(found < 1e-3, "{what} differs by {found:.1e}");
    let back = World::restore(&saved(&on_cpu)[..], &options()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(back.digest(), on_cpu.digest());
}
