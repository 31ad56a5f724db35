//! Roll backs in every frame, as netcode does them: GGRS goes back eight frames, plays them again and compares.

use ggrs::{Config, GgrsError, GgrsRequest, PredictRepeatLast, SessionBuilder, SyncTestSession};
use sorb::{
    Command, Snapshot, World,
    glam::Vec3,
    scene::{Body, Fluid, FluidBlock, Scene, ShapeKind, Sponge},
};

use super::{common, options};

const FRAMES: u32 = 600;
const BACK: usize = 8;

/// A game whose state is a world.
struct Game;

impl Config for Game {
    /// Pushes to the left and to the right.
    type Input = i8;
    type InputPredictor = PredictRepeatLast;
    /// The number of the snapshot.
    type State = usize;
    type Address = u8;
}

/// Two balls in shallow water, a sponge between them.
fn scene() -> Scene {
    let half = Vec3::new(0.05, 0.0, 0.03);
    let blocks = vec![FluidBlock::new(-half, half + Vec3::Y * 0.012)];
    let fluid = Fluid { spacing: 0.006, blocks, ..Fluid::default() };
    let sponge = Sponge {
        cells: [2, 2, 2].into(),
        edge: 0.012,
        ..Sponge::new("sponge", Vec3::new(-0.012, 0.0, -0.012))
    };
    let ball = |name: &str, x: f32| {
        Body::dynamic(name, ShapeKind::Sphere { radius: 0.01 }, Vec3::new(x, 0.012, 0.0), 3000.0)
    };
    Scene::new("game")
        .in_box(-half, half + Vec3::Y * 0.08)
        .with_fluid(fluid)
        .with_sponge(sponge)
        .with_body(ball("left", -0.035))
        .with_body(ball("right", 0.035))
}

fn session() -> SyncTestSession<Game> {
    let builder = SessionBuilder::<Game>::new().with_num_players(2);
    let builder = builder.unwrap_or_else(|error| panic!("{error}"));
    let session = builder.with_max_prediction_window(BACK + 1).with_check_distance(BACK).with_input_delay(0);
    session.start_synctest_session().unwrap_or_else(|error| panic!("{error}"))
}

/// What a player does in a frame.
fn input(player: usize, frame: u32) -> i8 {
    let turn = frame / 20 + 3 * player as u32;
    [1, 1, -1, 0, 1, -1][turn as usize % 6] * if player == 0 { 1 } else { -1 }
}

/// Plays; `fault` is what a frame that is played again does otherwise.
fn play(frames: u32, fault: f32) -> Result<World, GgrsError> {
    let mut world = World::with_options(&scene(), &options(1, sorb::SimdLevel::best()))
        .unwrap_or_else(|error| panic!("{error}"));
    let mut snapshots: Vec<Snapshot> = (0..2 * BACK).map(|_| Snapshot::new()).collect();
    let mut session = session();
    for frame in 0..frames {
        for player in 0..2 {
            session.add_local_input(player, input(player, frame))?;
        }
        let mut played = 0;
        for request in session.advance_frame()? {
            match request {
                GgrsRequest::SaveGameState { cell, frame } => {
                    let slot = frame as usize % snapshots.len();
                    world.snapshot_into(&mut snapshots[slot]);
                    cell.save(frame, Some(slot), Some(u128::from(world.digest())));
                }
                GgrsRequest::LoadGameState { cell, .. } => {
                    let slot = cell.load().unwrap_or_else(|| panic!("nothing was saved"));
                    world.rollback(&snapshots[slot]).unwrap_or_else(|error| panic!("{error}"));
                }
                GgrsRequest::AdvanceFrame { inputs } => {
                    let wrong = if played == 0 { 0.0 } else { fault };
                    for ((push, _), body) in inputs.into_iter().zip(0..) {
                        let force = Vec3::new(0.15 * f32::from(push) + wrong, 0.0, 0.0);
                        let command = Command::Force { body: body.into(), force, torque: Vec3::ZERO };
                        world.push(command).unwrap_or_else(|error| panic!("{error}"));
                    }
                    common::frame(&mut world);
                    played += 1;
                }
            }
        }
    }
    Ok(world)
}

#[test]
fn two_players_push_a_sponge_through_600_frames_of_roll_backs() {
    let world = play(FRAMES, 0.0).unwrap_or_else(|error| panic!("{error}"));
    assert!(world.clock().frames == u64::from(FRAMES) || world.clock().frames == u64::from(FRAMES) - 1);
    let centre = world.measures().sponge_centre;
    assert!(centre.x.abs() > 1e-3, "nobody has pushed the sponge: {centre}");
    // The same without any roll back, on two threads.
    let mut straight = World::with_options(&scene(), &options(2, sorb::SimdLevel::best()))
        .unwrap_or_else(|error| panic!("{error}"));
    for frame in 0..world.clock().frames as u32 {
        for (player, body) in (0..2).zip(0..) {
            let force = Vec3::new(0.15 * f32::from(input(player, frame)), 0.0, 0.0);
            let command = Command::Force { body: body.into(), force, torque: Vec3::ZERO };
            straight.push(command).unwrap_or_else(|error| panic!("{error}"));
        }
        common::frame(&mut straight);
    }
    assert_eq!(world.digest(), straight.digest());
}

#[test]
fn a_frame_that_is_played_otherwise_is_a_desync() {
    let error = play(20, 1e-6).map(|_| ());
    assert!(matches!(error, Err(GgrsError::MismatchedChecksum { .. })), "{error:?}");
}

#[test]
fn an_empty_snapshot_and_one_of_another_scene_are_refused() {
    let mut world = common::world(&scene());
    let mut snapshot = Snapshot::new();
    assert!(snapshot.clock().is_none());
    let error = world.rollback(&snapshot).map_err(|error| error.to_string());
    assert_eq!(error, Err("not usable: snapshot: it is empty".to_owned()));
    common::world(&super::busy::scene("dry", 0.3)).snapshot_into(&mut snapshot);
    let before = world.digest();
    let error = world.rollback(&snapshot).map_err(|error| error.to_string());
    assert_eq!(error, Err("not usable: snapshot: it is of another scene".to_owned()));
    assert_eq!(world.digest(), before);
}
