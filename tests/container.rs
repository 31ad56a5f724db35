//! Containers that move, and gravity over time: what is felt in the container, tight walls, and the same bits after interruptions.

#[path = "common/mod.rs"]
mod common;

use sorb::{
    Command, Options, Player, Recorder, Snapshot, World,
    glam::{Quat, Vec3},
    scene::{Body, Domain, Fluid, FluidBlock, GravityKey, Motion, Scene, ShapeKind, Sponge},
};

fn push(world: &mut World, command: Command) {
    world.push(command).unwrap_or_else(|error| panic!("{error}"));
}

fn run_to(world: &mut World, time: f64) {
    while world.clock().time < time - 1e-6 {
        common::frame(world);
    }
}

/// A way of 30 cm within half a second.
fn slide() -> Motion {
    Motion::Linear { velocity: Vec3::new(0.75, 0.0, 0.0), start: 0.1, end: 0.6, ease: 0.1 }
}

/// A turn by one radian about an axis that goes through nothing.
fn turn() -> Motion {
    let (axis, pivot) = (Vec3::new(0.2, 0.3, 1.0), Vec3::new(0.1, -0.2, 0.0));
    Motion::Turn { axis, pivot, rate: 2.5, start: 0.1, end: 0.6, ease: 0.1 }
}

fn free(motions: Vec<Motion>) -> Scene {
    let ball = Body::dynamic("ball", ShapeKind::Sphere { radius: 0.01 }, Vec3::new(0.3, 0.1, 0.0), 1000.0);
    let water = FluidBlock::new(Vec3::new(-0.1, 0.0, 0.0), Vec3::new(-0.095, 0.005, 0.005));
    let fluid = Fluid { blocks: vec![water], ..Fluid::default() };
    let sponge =
        Sponge { cells: [3, 3, 3].into(), edge: 0.01, ..Sponge::new("sponge", Vec3::new(0.0, 0.3, 0.0)) };
    let mut scene = Scene::new("free").with_body(ball).with_fluid(fluid).with_sponge(sponge);
    scene.gravity = Vec3::ZERO;
    scene.time.maximum_step = 0.001;
    scene.container.motions = motions;
    scene
}

/// Where the ball, the particle and the middle of the sponge are.
fn places(world: &World) -> [Vec3; 3] {
    let place = |row: &[f32; 4]| Vec3::new(row[0], row[1], row[2]);
    let nodes = world.node_positions();
    let middle = nodes.iter().map(place).sum::<Vec3>() / nodes.len() as f32;
    [world.bodies()[0].state.position, place(&world.particle_positions()[0]), middle]
}

#[test]
fn what_is_free_stays_where_it_is_outside() {
    for (name, motions) in [
        ("slides", vec![slide()]),
        ("turns", vec![turn()]),
        ("both", vec![slide(), turn()]),
        (
            "shakes",
            vec![Motion::Shake {
                amplitude: Vec3::Y * 0.05,
                frequency: 3.0,
                start: 0.1,
                end: 0.6,
                ease: 0.2,
            }],
        ),
    ] {
        let mut world = common::world(&free(motions));
        let before = places(&world);
        assert_eq!(world.particle_ids().len(), 1);
        // In the middle and at the end of the motion.
        let mut farthest = 0.0_f32;
        for time in [0.35, 0.7] {
            run_to(&mut world, time);
            let (position, rotation) = world.container_pose();
            for (before, now) in before.iter().zip(places(&world)) {
                let outside = position + rotation * now;
                assert!(outside.distance(*before) < 4e-3, "{name}, {time} s: {before} is at {outside}");
                // The control: in the container it is elsewhere.
                farthest = farthest.max(now.distance(*before));
            }
        }
        assert!(farthest > 0.04, "{name}: nothing was felt, {farthest}");
        let (_, rotation) = world.container_pose();
        let turned = rotation * world.bodies()[0].state.rotation;
        assert!(turned.angle_between(Quat::IDENTITY) < 5e-3, "{name}: the ball has turned by {turned}");
        let speeds = world.particle_velocities().iter().chain(world.node_velocities());
        let fastest = speeds.map(|row| Vec3::new(row[0], row[1], row[2]).length()).fold(0.0, f32::max);
        assert!(fastest < 0.02, "{name}: {fastest} m/s after a motion that is over");
    }
}

/// A tank that is half full.
fn tank(motions: Vec<Motion>) -> Scene {
    let (low, high) = (Vec3::new(-0.06, 0.0, -0.02), Vec3::new(0.06, 0.12, 0.02));
    let fluid = Fluid { blocks: vec![FluidBlock::new(low, high.with_y(0.04))], ..Fluid::default() };
    let mut scene = Scene::new("tank").in_box(low, high).with_fluid(fluid);
    scene.container.motions = motions;
    scene
}

fn assert_tight(world: &World) {
    let Domain::Box { minimum, maximum, .. } = world.scene().domain else { panic!("a box") };
    for row in world.particle_positions() {
        let point = Vec3::new(row[0], row[1], row[2]);
        assert!(point.is_finite() && point.cmpge(minimum).all() && point.cmple(maximum).all(), "{point}");
    }
    let ledger = world.ledger();
    assert_eq!((ledger.present, ledger.lost), (ledger.seeded, 0));
}

#[test]
fn water_in_a_tilted_tank_has_a_level_surface_outside() {
    let angle = 0.25_f32;
    let tilt =
        Motion::Turn { axis: Vec3::Z, pivot: Vec3::ZERO, rate: angle / 0.5, start: 0.1, end: 0.8, ease: 0.2 };
    let mut world = common::world(&tank(vec![tilt]));
    run_to(&mut world, 2.5);
    assert_tight(&world);
    let gravity = world.gravity();
    assert!(
        gravity.distance(Vec3::new(-libm::sinf(angle), -libm::cosf(angle), 0.0) * 9.81) < 1e-3,
        "{gravity}"
    );
    let levels = world.water_levels(&[[-0.04, 0.0], [0.04, 0.0]]).unwrap_or_else(|error| panic!("{error}"));
    let [left, right] = [levels[0], levels[1]].map(|level| level.unwrap_or(0.0));
    let slope = (left - right) / 0.08;
    assert!((slope - libm::tanf(angle)).abs() < 0.05, "{left} {right}");
    // The control: a tank that rests.
    let mut still = common::world(&tank(Vec::new()));
    run_to(&mut still, 0.5);
    let levels = still.water_levels(&[[-0.04, 0.0], [0.04, 0.0]]).unwrap_or_else(|error| panic!("{error}"));
    assert!((levels[0].unwrap_or(0.0) - levels[1].unwrap_or(0.0)).abs() < 4e-3);
}

#[test]
fn walls_are_tight_however_the_tank_is_shaken() {
    let shake = |amplitude: Vec3, frequency: f32| Motion::Shake {
        amplitude,
        frequency,
        start: 0.0,
        end: 0.6,
        ease: 0.1,
    };
    let spin =
        Motion::Turn { axis: Vec3::Z, pivot: Vec3::Y * 0.06, rate: 20.0, start: 0.0, end: 0.6, ease: 0.1 };
    for motions in [
        vec![shake(Vec3::new(0.05, 0.02, 0.0), 5.0)],
        vec![shake(Vec3::Y * 0.03, 12.0)],
        vec![spin],
        vec![spin, shake(Vec3::X * 0.05, 5.0)],
    ] {
        let mut world = common::world(&tank(motions.clone()));
        let mut fastest = 0.0_f32;
        while world.clock().time < 0.7 {
            let report = world.advance_frame().unwrap_or_else(|error| panic!("{motions:?}: {error}"));
            fastest = fastest.max(report.maximum_speed);
            assert_tight(&world);
        }
        assert!(fastest > 0.3 && fastest < 20.0, "{motions:?}: {fastest} m/s");
    }
}

#[test]
fn gravity_follows_its_path() {
    let ball = Body::dynamic("ball", ShapeKind::Sphere { radius: 0.01 }, Vec3::ZERO, 1000.0);
    let mut scene = Scene::new("path").with_body(ball);
    scene.gravity = Vec3::ZERO;
    let key = |time: f32, x: f32| GravityKey { time, gravity: Vec3::X * x };
    scene.gravity_path = vec![key(1.0, 4.0), key(2.0, 4.0), key(2.5, -2.0)];
    let mut world = common::world(&scene);
    let speed = |world: &World| world.bodies()[0].state.linear_velocity.x;
    for (time, expected) in [(0.5, 0.5), (1.0, 2.0), (2.0, 6.0), (2.5, 6.5), (3.0, 5.5)] {
        run_to(&mut world, time);
        assert!((speed(&world) - expected).abs() < 2e-3, "{time} s: {} m/s", speed(&world));
    }
    // A command goes on from the present gravity; another one ends the path.
    push(&mut world, Command::GravityPath { path: vec![key(4.0, 0.0), key(4.5, 0.0)] });
    run_to(&mut world, 4.25);
    assert!((speed(&world) - 4.5).abs() < 3e-3, "{}", speed(&world));
    push(&mut world, Command::Gravity { gravity: Vec3::Y });
    run_to(&mut world, 5.25);
    let velocity = world.bodies()[0].state.linear_velocity;
    assert!(velocity.distance(Vec3::new(4.5, 1.0, 0.0)) < 5e-3, "{velocity}");
}

/// What a host does in some frame.
fn commands(frame: u32) -> Option<Command> {
    let shake = Motion::Shake { amplitude: Vec3::X * 0.02, frequency: 6.0, start: 0.1, end: 0.4, ease: 0.1 };
    match frame {
        2 => Some(Command::Container { motions: vec![shake, turn()] }),
        4 => Some(Command::GravityPath { path: vec![GravityKey { time: 0.2, gravity: Vec3::NEG_Y * 5.0 }] }),
        8 => Some(Command::Gravity { gravity: Vec3::new(1.0, -8.0, 0.0) }),
        _ => None,
    }
}

const FRAMES: u32 = 14;

fn busy() -> Scene {
    let ball = Body::dynamic("ball", ShapeKind::Sphere { radius: 0.012 }, Vec3::new(0.02, 0.06, 0.0), 700.0);
    let sponge = Sponge {
        cells: [3, 3, 3].into(),
        edge: 0.01,
        ..Sponge::new("sponge", Vec3::new(-0.055, 0.0, -0.015))
    };
    tank(vec![slide()]).with_body(ball).with_sponge(sponge)
}

fn advance(world: &mut World, frame: u32) {
    if let Some(command) = commands(frame) {
        push(world, command);
    }
    common::frame(world);
}

#[test]
fn one_digest_after_saves_roll_backs_and_recordings() {
    let scene = busy();
    let mut straight = common::world(&scene);
    let (mut restored, mut rolled, mut snapshot) = (straight.clone(), straight.clone(), Snapshot::new());
    let mut recorded = straight.clone();
    let mut recorder = Recorder::new(&recorded, Some(5)).unwrap_or_else(|error| panic!("{error}"));
    for frame in 0..FRAMES {
        advance(&mut straight, frame);
        let mut bytes = Vec::new();
        restored.save(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
        let options = Options { threads: Some(1 + frame as usize % 3), ..Options::default() };
        restored = World::restore(&bytes[..], &options).unwrap_or_else(|error| panic!("{error}"));
        advance(&mut restored, frame);
        rolled.snapshot_into(&mut snapshot);
        push(&mut rolled, Command::Gravity { gravity: Vec3::ZERO });
        common::frame(&mut rolled);
        rolled.rollback(&snapshot).unwrap_or_else(|error| panic!("{error}"));
        advance(&mut rolled, frame);
        if let Some(command) = commands(frame) {
            recorder.push(&mut recorded, command).unwrap_or_else(|error| panic!("{error}"));
        }
        recorder.advance_frame(&mut recorded).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(restored.digest(), straight.digest(), "frame {frame}: restored");
        assert_eq!(rolled.digest(), straight.digest(), "frame {frame}: rolled back");
        assert_eq!(recorded.digest(), straight.digest(), "frame {frame}: recorded");
    }
    assert_tight(&straight);
    let recording = recorder.into_recording();
    let options = Options { threads: Some(1), ..Options::default() };
    let mut player = Player::new(&recording, &options).unwrap_or_else(|error| panic!("{error}"));
    while player.advance().unwrap_or_else(|error| panic!("{error}")) {}
    player.seek(3).unwrap_or_else(|error| panic!("{error}"));
    while player.advance().unwrap_or_else(|error| panic!("{error}")) {}
    // The control: without the commands.
    let mut without = common::world(&scene);
    (0..FRAMES).for_each(|_| common::frame(&mut without));
    assert_ne!(without.digest(), straight.digest());
}

#[test]
fn a_motion_wakes_everything_and_nothing_sleeps_in_it() {
    let mut scene = tank(vec![Motion::Linear { velocity: Vec3::X * 0.5, start: 4.0, end: 5.0, ease: 0.4 }]);
    (scene.time.sleep_after, scene.time.sleep_speed) = (0.25, 0.05);
    let mut world = common::world(&scene);
    run_to(&mut world, 3.9);
    assert!(world.is_asleep(), "water at rest sleeps");
    run_to(&mut world, 4.3);
    assert!(!world.is_asleep() && !world.is_fluid_asleep());
    let levels = world.water_levels(&[[-0.05, 0.0], [0.05, 0.0]]).unwrap_or_else(|error| panic!("{error}"));
    assert!(levels[0] > levels[1], "water stays behind: {levels:?}");
    run_to(&mut world, 4.99);
    assert!(!world.is_fluid_asleep());
}

#[test]
fn bad_motions_and_paths_are_refused_with_key_value_and_range() {
    let broken = |change: &dyn Fn(&mut Scene)| {
        let mut scene = tank(vec![slide()]);
        change(&mut scene);
        World::new(&scene).err().map(|error| error.to_string()).unwrap_or_default()
    };
    let abrupt = Motion::Linear { velocity: Vec3::X, start: 0.0, end: 1.0, ease: 0.0 };
    let wild = Motion::Shake { amplitude: Vec3::X, frequency: f32::NAN, start: 0.0, end: 1.0, ease: 0.1 };
    let late = GravityKey { time: 1.0, gravity: Vec3::ZERO };
    type Case<'a> = (&'a dyn Fn(&mut Scene), &'a str);
    let cases: [Case<'_>; 5] = [
        (&|scene| scene.container.motions.push(abrupt), "`container.motions[1].ease` = 0: must be above 0"),
        (
            &|scene| scene.container.motions.push(wild),
            "`container.motions[1].frequency` = NaN is out of range 0.001 to 1000 1/s",
        ),
        (
            &|scene| scene.gravity_path = vec![late, late],
            "`gravity_path[1].time` = 1: must be after `gravity_path[0].time` = 1",
        ),
        (
            &|scene| scene.gravity_path = vec![GravityKey { gravity: Vec3::X * 101.0, ..late }],
            "`gravity_path[0].gravity[0]` = 101 is out of range -100 to 100 m/s^2",
        ),
        (
            &|scene| {
                *scene = scene.clone().repeating([true, false, false]);
                scene.container.motions = vec![turn()];
            },
            "a container with periodic axes cannot turn",
        ),
    ];
    for (change, expected) in cases {
        let text = broken(change);
        assert!(text.to_lowercase().contains(&expected.to_lowercase()), "{expected}: {text}");
    }
    assert_eq!(broken(&|_| {}), "", "the control");
    let mut world = common::world(&tank(Vec::new()));
    run_to(&mut world, 0.2);
    let before = world.digest();
    for (command, expected) in [
        (Command::Container { motions: Vec::new() }, "`container.motions` = []: must not be empty"),
        (Command::Container { motions: vec![abrupt] }, "must be above 0"),
        (
            Command::Container { motions: vec![slide()] },
            "`container.motions[0].start` = 0.1: must not be before the present time",
        ),
        (
            Command::GravityPath { path: vec![GravityKey { time: 0.1, ..late }] },
            "`gravity_path.path[0].time` = 0.1: must not be before",
        ),
    ] {
        let text = world.push(command).err().map(|error| error.to_string()).unwrap_or_default();
        assert!(text.contains(expected), "{expected}: {text}");
    }
    assert_eq!(world.digest(), before, "nothing has changed");
}

#[test]
fn water_in_a_full_vessel_stays_where_it_is() {
    let shaken =
        Motion::Shake { amplitude: Vec3::X * 0.02, frequency: 4.0, start: 0.1, end: 1.1, ease: 0.25 };
    let moved = |scene: &Scene, motions: &[Motion]| {
        let mut scene = scene.clone();
        scene.container.motions = motions.to_vec();
        let mut world = common::world(&scene);
        let (mut fastest, mut steps) = (0.0_f32, 0);
        for _ in 0..36 {
            let report = world.advance_frame().unwrap_or_else(|error| panic!("{error}"));
            (fastest, steps) = (fastest.max(report.maximum_speed), steps + report.steps);
        }
        (fastest, steps as f32 / 36.0)
    };
    for gravity in [Vec3::ZERO, Vec3::Y * -9.81] {
        for motions in [&[][..], &[shaken]] {
            let (fastest, steps) = moved(&common::vessel(1.0, gravity), motions);
            assert!(fastest < 0.02 && steps < 12.0, "{gravity}: {fastest} m/s, {steps} steps a frame");
        }
    }
    // Negative control: with a free surface it sloshes.
    let (fastest, _) = moved(&common::vessel(0.9, Vec3::Y * -9.81), &[shaken]);
    assert!(fastest > 0.2, "{fastest} m/s");
}
