//! One digest after saves, roll backs and recordings, on any threads and at any level.

use sorb::{
    BodyHandle, Command, Options, Player, Recorder, Recording, SimdLevel, Snapshot, World,
    glam::{Quat, Vec3},
    rigid::BodyKind,
    scene::{Body, Material, Scene},
};

use super::{audit, bodies, common, pool, push};

const FRAMES: u32 = 12;

fn world_on(scene: &Scene, threads: usize, simd: SimdLevel) -> World {
    let options = Options { threads: Some(threads), simd: Some(simd), ..Options::default() };
    World::with_options(scene, &options).unwrap_or_else(|error| panic!("{error}"))
}

/// A handle as a host keeps it.
fn handle(index: u32, generation: u32) -> BodyHandle {
    let text = format!("{{\"index\":{index},\"generation\":{generation}}}");
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}"))
}

/// What a host does before a frame.
fn commands(frame: u32) -> Vec<Command> {
    let place = |sponge: u32, position: Vec3| Command::PlaceSponge {
        sponge: sponge.into(),
        position,
        rotation: Quat::from_rotation_y(0.3),
        velocity: Vec3::new(0.2, -0.3, 0.0),
    };
    let soft = Material { young_modulus: 5000.0, permeability: 4e-9, ..Material::default() };
    let ball = |generation: u32| {
        let description =
            Body { name: format!("new{generation}"), ..bodies::ball("", Vec3::new(0.04, 0.13, -0.04)) };
        (handle(1, generation), Box::new(description))
    };
    match frame {
        0 => vec![Command::AddBody { body: ball(0).0, description: ball(0).1 }],
        2 => vec![Command::BodyKind { body: 0.into(), kind: BodyKind::Kinematic }],
        4 => vec![Command::RemoveBody { body: ball(0).0 }],
        6 => vec![
            Command::AddBody { body: ball(1).0, description: ball(1).1 },
            Command::BodyKind { body: 0.into(), kind: BodyKind::Dynamic },
        ],
        8 => vec![Command::RemoveBody { body: 0.into() }],
        1 => vec![place(0, Vec3::new(-0.02, 0.12, -0.02))],
        3 => vec![Command::Material { sponge: 1.into(), material: soft }],
        5 => vec![Command::Material { sponge: 0.into(), material: Material { softening: 0.5, ..soft } }],
        7 => vec![place(1, Vec3::new(0.03, 0.12, 0.03)), Command::Gravity { gravity: Vec3::NEG_Y * 6.0 }],
        9 => vec![Command::Material { sponge: 0.into(), material: Material::default() }],
        _ => Vec::new(),
    }
}

fn advance(world: &mut World, frame: u32) {
    commands(frame).into_iter().for_each(|command| push(world, command));
    common::frame(world);
    audit(world);
}

fn straight(scene: &Scene, threads: usize, simd: SimdLevel) -> Vec<u64> {
    let mut world = world_on(scene, threads, simd);
    let digests = (0..FRAMES).map(|frame| {
        advance(&mut world, frame);
        world.digest()
    });
    digests.collect()
}

fn saved(world: &World) -> Vec<u8> {
    let mut bytes = Vec::new();
    world.save(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
    bytes
}

#[test]
fn one_digest() {
    let scene = pool();
    let expected = straight(&scene, 1, SimdLevel::Fallback);
    for (threads, simd) in [(2, SimdLevel::best()), (3, SimdLevel::Fallback)] {
        assert_eq!(straight(&scene, threads, simd), expected, "{threads} threads, {simd}");
    }
    let mut restored = world_on(&scene, 2, SimdLevel::best());
    // One that returns to every state of the other in place.
    let mut resumed = restored.clone();
    for frame in 0..FRAMES {
        let bytes = saved(&restored);
        let options = Options { threads: Some(1 + frame as usize % 3), ..Options::default() };
        restored = World::restore(&bytes[..], &options).unwrap_or_else(|error| panic!("{error}"));
        resumed
            .resume(&restored.to_save().unwrap_or_else(|error| panic!("{error}")))
            .unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(saved(&restored), bytes, "frame {frame}");
        advance(&mut restored, frame);
        advance(&mut resumed, frame);
        assert_eq!(restored.digest(), expected[frame as usize], "frame {frame}: restored");
        assert_eq!(resumed.digest(), expected[frame as usize], "frame {frame}: resumed");
    }
    rolled_back(&scene, &expected);
}

/// Over changes of the scene, forwards and backwards.
fn rolled_back(scene: &Scene, expected: &[u64]) {
    let mut world = world_on(scene, 2, SimdLevel::best());
    let mut snapshots = Vec::new();
    for frame in 0..FRAMES {
        let mut snapshot = Snapshot::new();
        world.snapshot_into(&mut snapshot);
        snapshots.push(snapshot);
        advance(&mut world, frame);
    }
    for frame in (0..FRAMES).rev().step_by(2) {
        world.rollback(&snapshots[frame as usize]).unwrap_or_else(|error| panic!("{error}"));
        advance(&mut world, frame);
        assert_eq!(world.digest(), expected[frame as usize], "frame {frame}: rolled back");
    }
    // Of another scene.
    let mut other = common::world(&{
        let mut scene = pool();
        scene.sponges[0].young_modulus = 3e4;
        scene
    });
    common::frame(&mut other);
    push(&mut other, Command::Material { sponge: 1.into(), material: Material::default() });
    common::frame(&mut other);
    assert!(other.rollback(&snapshots[11]).is_err());
    assert!(other.resume(&world.to_save().unwrap_or_else(|error| panic!("{error}"))).is_err());
}

#[test]
fn recordings_play_and_seek_over_changes() {
    let scene = pool();
    let expected = straight(&scene, 1, SimdLevel::Fallback);
    let mut world = world_on(&scene, 2, SimdLevel::best());
    let mut recorder = Recorder::new(&world, Some(2)).unwrap_or_else(|error| panic!("{error}"));
    for frame in 0..FRAMES {
        for command in commands(frame) {
            recorder.push(&mut world, command).unwrap_or_else(|error| panic!("{error}"));
        }
        recorder.advance_frame(&mut world).unwrap_or_else(|error| panic!("{error}"));
    }
    assert!(recorder.lost_key_frame().is_none());
    let mut bytes = Vec::new();
    recorder.into_recording().write(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
    let recording = Recording::read(&bytes[..]).unwrap_or_else(|error| panic!("{error}"));
    let mut player = Player::new(&recording, &Options::default()).unwrap_or_else(|error| panic!("{error}"));
    while player.advance().unwrap_or_else(|error| panic!("{error}")) {}
    assert_eq!(player.world().digest(), expected[FRAMES as usize - 1]);
    for frame in [10_u32, 2, 7, 4] {
        player.seek(u64::from(frame)).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(player.world().digest(), expected[frame as usize - 1], "frame {frame}");
        assert!(player.advance().unwrap_or_else(|error| panic!("{error}")));
    }
    // The control: another command.
    let mut other = world_on(&scene, 2, SimdLevel::best());
    (0..FRAMES).for_each(|_| common::frame(&mut other));
    assert_ne!(other.digest(), expected[FRAMES as usize - 1]);
}
