//! Commands do what they say, or are refused with the texts of scene keys.

use sorb::{
    Command, Nodes, World,
    glam::{Quat, Vec3},
    scene::{Body, Scene, ShapeKind, Sponge},
};

use super::{common, restored, saved};

fn push(world: &mut World, command: Command) {
    world.push(command).unwrap_or_else(|error| panic!("{error}"));
}

/// A ball and a plate in space, without anything else.
fn space() -> World {
    let ball = Body::dynamic("ball", ShapeKind::Sphere { radius: 0.1 }, Vec3::ZERO, 1000.0);
    let cuboid = ShapeKind::Cuboid { half_extents: Vec3::splat(0.1) };
    let plate = Body::kinematic("plate", cuboid, Vec3::X, Vec::new());
    let mut scene = Scene::new("space").with_body(ball).with_body(plate);
    scene.gravity = Vec3::ZERO;
    common::world(&scene)
}

fn mass() -> f32 {
    1000.0 * 4.0 / 3.0 * std::f32::consts::PI * 1e-3
}

#[test]
fn a_body_is_pushed_as_mechanics_says() {
    let mut world = space();
    let (force, torque) = (Vec3::X * mass(), Vec3::ZERO);
    push(&mut world, Command::Force { body: 0.into(), force, torque });
    while world.clock().time < 1.0 - 1e-6 {
        common::frame(&mut world);
    }
    let speed = world.bodies()[0].state.linear_velocity.x;
    assert!((speed - 1.0).abs() < 1e-3, "1 m/s^2 for a second gives {speed} m/s");
    // Until zeros end it.
    push(&mut world, Command::Force { body: 0.into(), force: Vec3::ZERO, torque });
    push(
        &mut world,
        Command::Impulse { body: 0.into(), impulse: Vec3::Y * mass(), angular_impulse: Vec3::ZERO },
    );
    common::frame(&mut world);
    let velocity = world.bodies()[0].state.linear_velocity;
    assert!(velocity.distance(Vec3::new(speed, 1.0, 0.0)) < 1e-4, "{velocity}");
    let (linear_velocity, angular_velocity) = (Vec3::Z, Vec3::X);
    push(&mut world, Command::Velocity { body: 0.into(), linear_velocity, angular_velocity });
    common::frame(&mut world);
    let state = world.bodies()[0].state;
    assert_eq!(state.linear_velocity, Vec3::Z);
    assert!(state.angular_velocity.distance(Vec3::X) < 1e-5, "{}", state.angular_velocity);
    // An impulse about the centre of a ball of inertia 2/5 m r^2.
    let angular_impulse = Vec3::Y * 0.4 * mass() * 0.01;
    push(&mut world, Command::Impulse { body: 0.into(), impulse: Vec3::ZERO, angular_impulse });
    common::frame(&mut world);
    let spin = world.bodies()[0].state.angular_velocity;
    assert!(spin.distance(Vec3::new(1.0, 1.0, 0.0)) < 1e-3, "{spin}");
    push(&mut world, Command::Gravity { gravity: Vec3::NEG_Y });
    let before = world.bodies()[0].state.linear_velocity.y;
    common::frame(&mut world);
    let change = world.bodies()[0].state.linear_velocity.y - before;
    assert!((change + 1.0 / 60.0).abs() < 1e-4, "{change}");
}

#[test]
fn a_kinematic_body_goes_to_a_pose_and_stays() {
    let mut world = space();
    common::frame(&mut world);
    let (position, rotation) = (Vec3::new(1.0, 0.5, 0.0), Quat::from_rotation_y(0.5));
    push(&mut world, Command::Pose { body: 1.into(), position, rotation, duration: 0.5 });
    for _ in 0..15 {
        common::frame(&mut world);
    }
    let state = world.bodies()[1].state;
    assert!(state.position.distance(Vec3::new(1.0, 0.25, 0.0)) < 1e-5, "{}", state.position);
    assert!(state.linear_velocity.distance(Vec3::Y) < 1e-5, "{}", state.linear_velocity);
    // It goes on after a restore.
    let mut world = restored(&saved(&world), &sorb::Options::default());
    for _ in 0..16 {
        common::frame(&mut world);
    }
    let state = world.bodies()[1].state;
    assert_eq!((state.position, state.linear_velocity), (position, Vec3::ZERO));
    assert!(state.rotation.dot(rotation) > 1.0 - 1e-6);
}

/// A sponge in the air, and a small body far from it.
fn hanging() -> World {
    let sponge = Sponge { cells: [4, 4, 4].into(), edge: 0.01, ..Sponge::new("sponge", Vec3::ZERO) };
    let shape = ShapeKind::Sphere { radius: 0.01 };
    let hand = Body::kinematic("hand", shape, Vec3::new(0.3, 0.3, 0.3), Vec::new());
    common::world(&Scene::new("hanging").with_sponge(sponge).with_body(hand))
}

fn lowest(world: &World) -> f32 {
    world.node_positions().iter().map(|row| row[1]).fold(f32::INFINITY, f32::min)
}

#[test]
fn a_hand_takes_nodes_moves_them_and_lets_go() {
    let (mut world, mut falling) = (hanging(), hanging());
    let nodes = Nodes::Sphere { centre: Vec3::new(0.02, 0.04, 0.02), radius: 0.03 };
    push(&mut world, Command::Grip { body: 0.into(), nodes: nodes.clone() });
    for _ in 0..30 {
        common::frame(&mut world);
        common::frame(&mut falling);
    }
    let held = world.node_positions().iter().filter(|row| row[3] == 0.0).count();
    assert!(held > 5, "{held} nodes are held");
    assert!(lowest(&world) > -0.05 && lowest(&falling) < -1.0, "{} {}", lowest(&world), lowest(&falling));
    let position = Vec3::new(0.3, 0.5, 0.3);
    push(&mut world, Command::Pose { body: 0.into(), position, rotation: Quat::IDENTITY, duration: 0.25 });
    let mut world = restored(&saved(&world), &sorb::Options::default());
    for _ in 0..30 {
        common::frame(&mut world);
    }
    assert!(lowest(&world) > 0.12, "lifted by 20 cm: {}", lowest(&world));
    let all = (0..world.node_positions().len() as u32).collect();
    push(&mut world, Command::Release { nodes: Nodes::Rows(all) });
    for _ in 0..30 {
        common::frame(&mut world);
    }
    assert!(lowest(&world) < -0.8, "it falls: {}", lowest(&world));
    assert!(world.node_positions().iter().all(|row| row[3] > 0.0));
}

#[test]
fn what_cannot_be_is_refused_with_key_value_and_range() {
    let mut world = space();
    let before = world.digest();
    let zero = Vec3::ZERO;
    let rotation = Quat::IDENTITY;
    let bad = [
        (
            Command::Force { body: 2.into(), force: zero, torque: zero },
            "command: `force.body` = 2: no such body; there are 2, numbered from 0",
        ),
        (
            Command::Impulse { body: 1.into(), impulse: zero, angular_impulse: zero },
            "command: `impulse.body` = 1: the body is kinematic, and must be dynamic",
        ),
        (
            Command::Velocity { body: 0.into(), linear_velocity: Vec3::X * 101.0, angular_velocity: zero },
            "command: `velocity.linear_velocity` = 101 is out of range -100 to 100 m/s",
        ),
        (
            Command::Gravity { gravity: Vec3::new(0.0, f32::NAN, 0.0) },
            "command: `gravity.gravity` = NaN is out of range -100 to 100 m/s^2",
        ),
        (
            Command::Pose { body: 1.into(), position: zero, rotation: rotation * 2.0, duration: 1.0 },
            "must be a quaternion of unit length",
        ),
        (
            Command::Pose { body: 1.into(), position: zero, rotation, duration: 0.0 },
            "`pose.duration` = 0 is out of range",
        ),
        (Command::Grip { body: 0.into(), nodes: Nodes::Rows(vec![0]) }, "no such node; there are 0"),
    ];
    for (command, expected) in bad {
        let error = world.push(command.clone()).map_err(|error| error.to_string());
        assert!(error.as_ref().is_err_and(|error| error.contains(expected)), "{command:?}: {error:?}");
    }
    assert_eq!(world.digest(), before, "nothing has changed");
}
