//! Recordings give the same bits, and say what differs.

use sorb::{
    BodyHandle, Command, Nodes, Options, Player, Recorder, Recording, ReplayError, SimdLevel, World,
    glam::{Quat, Vec3},
    internal::{columns::Column, poison},
    rigid::BodyKind,
    scene::Scene,
};

use super::{busy, common, options};

/// Commands of every kind that the scene has something for, at some frames.
pub(crate) fn commands(scene: &Scene, frame: u32) -> Vec<Command> {
    let mut all = Vec::new();
    let bodies = || scene.bodies.iter().zip((0_u32..).map(BodyHandle::from));
    if let Some((_, body)) = bodies().find(|(body, _)| body.kind == BodyKind::Dynamic) {
        let (up, turn) = (Vec3::Y * 2.0, Vec3::Z * 1e-3);
        match frame {
            1 => all.push(Command::Force { body, force: Vec3::X * 0.5, torque: Vec3::ZERO }),
            2 => all.push(Command::Impulse { body, impulse: up * 0.05, angular_impulse: turn }),
            3 => all.push(Command::Velocity { body, linear_velocity: -up, angular_velocity: turn }),
            5 => all.push(Command::Force { body, force: Vec3::ZERO, torque: Vec3::ZERO }),
            _ => {}
        }
    }
    if let Some((own, body)) = bodies().find(|(body, _)| body.kind == BodyKind::Kinematic && frame == 2) {
        let rotation = Quat::from_rotation_z(0.1);
        let position = own.position + Vec3::new(0.0, 0.004, 0.0);
        all.push(Command::Pose { body, position, rotation, duration: 0.05 });
    }
    if frame == 4 {
        all.push(Command::Gravity { gravity: Vec3::new(0.5, -8.0, 0.0) });
    }
    if let (Some(sponge), false) = (scene.sponges.first(), scene.bodies.is_empty()) {
        let nodes = Nodes::Sphere { centre: sponge.position, radius: 0.03 };
        match frame {
            3 => all.push(Command::Grip { body: 0.into(), nodes }),
            5 => all.push(Command::Release { nodes: Nodes::Rows(vec![0, 1, 2]) }),
            6 => all.push(Command::Release { nodes }),
            _ => {}
        }
    }
    all
}

/// Records some frames with commands.
pub(crate) fn recorded(scene: &Scene, frames: u32, every: Option<u32>) -> (Recording, World) {
    let mut world = common::world(scene);
    let mut recorder = Recorder::new(&world, every).unwrap_or_else(|error| panic!("{error}"));
    for frame in 0..frames {
        for command in commands(scene, frame) {
            recorder.push(&mut world, command).unwrap_or_else(|error| panic!("{}: {error}", scene.name));
        }
        recorder.advance_frame(&mut world).unwrap_or_else(|error| panic!("{}: {error}", scene.name));
    }
    let mut bytes = Vec::new();
    recorder.recording().write(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
    (Recording::read(&bytes[..]).unwrap_or_else(|error| panic!("{error}")), world)
}

fn played(recording: &Recording, options: &Options) -> u64 {
    let mut player = Player::new(recording, options).unwrap_or_else(|error| panic!("{error}"));
    while player.advance().unwrap_or_else(|error| panic!("{error}")) {}
    assert_eq!(player.frame(), recording.ticks());
    player.world().digest()
}

macro_rules! names {
    ($($scene:ident)+) => { [$(stringify!($scene)),+] };
}

#[test]
fn every_scene_replays_with_commands_on_other_threads_and_levels() {
    for name in for_every_scene!(names) {
        let scene = busy::scene(name, 0.4);
        let (recording, world) = recorded(&scene, 8, Some(3));
        let pushed = recording.commands().count();
        assert!(pushed > 0, "{name}");
        for (threads, simd) in [(1, SimdLevel::Fallback), (3, SimdLevel::best())] {
            assert_eq!(played(&recording, &options(threads, simd)), world.digest(), "{name}");
        }
        // The control: without its commands it ends elsewhere.
        let mut without = common::world(&scene);
        (0..8).for_each(|_| common::frame(&mut without));
        assert_ne!(without.digest(), world.digest(), "{name}");
    }
}

#[test]
fn seeking_is_playing() {
    let scene = busy::scene("ball_drop", 0.4);
    let (recording, _) = recorded(&scene, 9, Some(4));
    assert_eq!(recording.key_frames().collect::<Vec<_>>(), [4, 8]);
    let mut digests = Vec::new();
    let mut player = Player::new(&recording, &Options::default()).unwrap_or_else(|error| panic!("{error}"));
    loop {
        digests.push(player.world().digest());
        if !player.advance().unwrap_or_else(|error| panic!("{error}")) {
            break;
        }
    }
    for frame in [9, 2, 5, 5, 4, 0, 8, 3] {
        player.seek(frame).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(player.world().digest(), digests[frame as usize], "frame {frame}");
    }
    assert!(matches!(player.seek(10), Err(ReplayError::NoFrame { frame: 10, last: 9 })));
}

#[test]
fn the_first_frame_column_row_and_both_values_of_a_mismatch_are_named() {
    let scene = busy::scene("ball_drop", 0.4);
    let (recording, _) = recorded(&scene, 9, Some(4));
    let mut player =
        Player::new(&recording, &options(2, SimdLevel::best())).unwrap_or_else(|error| panic!("{error}"));
    for _ in 0..5 {
        assert!(player.advance().unwrap_or_else(|error| panic!("{error}")));
    }
    // Something that nobody recorded, by the smallest number.
    let gravity = Vec3::new(0.5, (-8.0_f32).next_up(), 0.0);
    player.world_mut().push(Command::Gravity { gravity }).unwrap_or_else(|error| panic!("{error}"));
    let error = player.advance().map(|_| ());
    let Err(ReplayError::Mismatch(mismatch)) = error else { panic!("{error:?}") };
    assert_eq!(mismatch.frame, 6);
    let (frame, difference) = mismatch.difference.as_ref().unwrap_or_else(|| panic!("{mismatch}"));
    assert_eq!(*frame, 6, "{mismatch}");
    assert!(difference.row.is_some() && difference.first != difference.second, "{mismatch}");
    assert!(mismatch.to_string().contains("frame 6 has digest"), "{mismatch}");
    let column = Column::ALL.iter().find(|column| column.name() == difference.column);
    assert!(column.is_some(), "{mismatch}");
    // A whole column that is not finite is an error of the step.
    poison(player.world_mut(), Column::NodeVelocity);
    assert!(matches!(player.advance(), Err(ReplayError::Step { frame: 6, .. })));
}

#[test]
fn single_steps_and_later_starts_are_recorded() {
    let scene = busy::scene("life", 0.4);
    let mut world = common::world(&scene);
    common::steps(&mut world, 3);
    let mut recorder = Recorder::new(&world, None).unwrap_or_else(|error| panic!("{error}"));
    for tick in 0..9 {
        let result = if tick % 3 == 2 {
            recorder.advance_frame(&mut world).map(|_| ())
        } else {
            recorder.step(&mut world).map(|_| ())
        };
        result.unwrap_or_else(|error| panic!("{error}"));
    }
    let recording = recorder.into_recording();
    assert_eq!(recording.key_frames().collect::<Vec<_>>(), [0], "the scene alone does not say how it began");
    assert_eq!(played(&recording, &options(1, SimdLevel::best())), world.digest());
}

#[test]
fn damaged_recordings_are_refused() {
    let (recording, _) = recorded(&busy::scene("dry", 0.3), 4, Some(2));
    let mut bytes = Vec::new();
    recording.write(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
    assert!(Recording::read(&bytes[..]).is_ok(), "the control");
    for at in (0..bytes.len()).step_by(97) {
        let mut other = bytes.clone();
        other[at] ^= 0x10;
        assert!(Recording::read(&other[..]).is_err(), "byte {at}");
        assert!(Recording::read(&bytes[..at]).is_err(), "cut at {at}");
    }
    let mut save = Vec::new();
    common::world(&busy::scene("dry", 0.3)).save(&mut save).unwrap_or_else(|error| panic!("{error}"));
    let error = Recording::read(&save[..]).map(|_| ()).map_err(|error| error.to_string());
    assert_eq!(error, Err("this is no recording of sorb: it begins with \"sorbsave\"".to_owned()));
}
