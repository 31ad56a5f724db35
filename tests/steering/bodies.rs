//! Bodies that come, go and change their kind.

use sorb::{
    BodyHandle, Command, Nodes, Region, World,
    glam::{Quat, Vec3},
    rigid::BodyKind,
    scene::{Body, Fluid, FluidBlock, Motion, Scene, ShapeKind},
};

use super::{HIGH, LOW, audit, common, pool, push, refused};

pub(super) fn ball(name: &str, position: Vec3) -> Body {
    Body::dynamic(name, ShapeKind::Sphere { radius: 0.012 }, position, 700.0)
}

pub(super) fn add(world: &World, description: Body) -> Command {
    Command::AddBody { body: world.next_body(), description: Box::new(description) }
}

fn run(world: &mut World, frames: u32) {
    for _ in 0..frames {
        common::frame(world);
        audit(world);
    }
}

#[test]
fn a_body_comes_falls_floats_and_goes() {
    let mut world = common::world(&pool());
    run(&mut world, 2);
    let new = world.next_body();
    assert_eq!((new.index(), new.generation()), (1, 0));
    let command = add(&world, ball("new", Vec3::new(-0.04, 0.12, 0.04)));
    push(&mut world, command);
    assert_eq!(world.next_body().index(), 2, "after those that wait");
    // It can be pushed before it is there.
    push(
        &mut world,
        Command::Velocity { body: new, linear_velocity: Vec3::NEG_Y, angular_velocity: Vec3::ZERO },
    );
    run(&mut world, 1);
    let speed = world.body(new).map_or(0.0, |body| body.state.linear_velocity.y);
    assert!((-1.3..-1.0).contains(&speed), "{speed} m/s");
    run(&mut world, 60);
    let height = world.body(new).map_or(0.0, |body| body.state.position.y);
    assert!((0.01..0.05).contains(&height), "it floats at {height} m");
    assert!(world.body_loads()[1].fluid.force.y > 0.01, "{:?}", world.body_loads()[1].fluid);
    push(&mut world, Command::RemoveBody { body: new });
    let text = refused(&mut world, Command::RemoveBody { body: new });
    assert!(text.contains("`remove_body.body` = 1: no such body"), "removal twice: {text}");
    run(&mut world, 2);
    assert!(world.body(new).is_none());
    assert_eq!(world.body_handles().map(BodyHandle::index).collect::<Vec<_>>(), [0]);
    let zero = Vec3::ZERO;
    let text = refused(&mut world, Command::Impulse { body: new, impulse: zero, angular_impulse: zero });
    assert!(text.contains("`impulse.body` = 1: no such body"), "stale: {text}");
    // Another one takes the number, and the old handle stays stale.
    let next = world.next_body();
    assert_eq!((next.index(), next.generation()), (1, 1));
    let command = add(&world, ball("next", Vec3::new(0.04, 0.12, -0.04)));
    push(&mut world, command);
    run(&mut world, 5);
    assert!(world.body(new).is_none() && world.body(next).is_some());
    assert!(!refused(&mut world, Command::RemoveBody { body: new }).is_empty());
}

#[test]
fn a_scene_without_dynamic_bodies_gets_one() {
    let fluid = Fluid { blocks: vec![FluidBlock::new(LOW, HIGH.with_y(0.03))], ..Fluid::default() };
    let lift = Motion::Linear { velocity: Vec3::Y * 0.1, start: 0.0, end: 1.0, ease: 0.1 };
    let shape = ShapeKind::Cuboid { half_extents: Vec3::splat(0.01) };
    let plate = Body::kinematic("plate", shape, Vec3::new(0.03, 0.05, 0.03), vec![lift]);
    let mut world = common::world(&Scene::new("plate").in_box(LOW, HIGH).with_fluid(fluid).with_body(plate));
    run(&mut world, 10);
    let (before, at) = (world.bodies()[0].state, world.clock().time);
    let command = add(&world, ball("ball", Vec3::new(-0.02, 0.1, 0.0)));
    push(&mut world, command);
    run(&mut world, 10);
    let way = world.bodies()[0].state.position.y - before.position.y;
    assert!((way - 0.1 * (world.clock().time - at) as f32).abs() < 1e-4, "the script goes on: {way}");
    assert!(world.bodies()[1].state.position.y < 0.09, "it falls");
}

#[test]
fn a_body_changes_its_kind_where_it_is() {
    let mut world = common::world(&pool());
    let ball = BodyHandle::from(0);
    run(&mut world, 3);
    let kind = |kind| Command::BodyKind { body: ball, kind };
    push(&mut world, kind(BodyKind::Fixed));
    run(&mut world, 1);
    let held = world.bodies()[0].state;
    assert_eq!((held.linear_velocity, world.bodies()[0].kind), (Vec3::ZERO, BodyKind::Fixed));
    run(&mut world, 5);
    assert_eq!(world.bodies()[0].state, held);
    let zero = Vec3::ZERO;
    let text = refused(&mut world, Command::Impulse { body: ball, impulse: zero, angular_impulse: zero });
    assert!(text.contains("the body is fixed, and must be dynamic"), "{text}");
    push(&mut world, kind(BodyKind::Kinematic));
    // In the same step, in this order.
    let position = held.position + Vec3::Y * 0.02;
    push(&mut world, Command::Pose { body: ball, position, rotation: Quat::IDENTITY, duration: 0.1 });
    run(&mut world, 3);
    assert!((world.bodies()[0].state.linear_velocity.y - 0.2).abs() < 1e-4);
    push(&mut world, kind(BodyKind::Dynamic));
    common::steps(&mut world, 1);
    let speed = world.bodies()[0].state.linear_velocity.y;
    assert!((0.1..0.2).contains(&speed), "it goes on at {speed} m/s");
    run(&mut world, 40);
    assert!(world.bodies()[0].state.position.y < position.y - 0.02, "and falls");
}

#[test]
fn bad_bodies_and_stale_handles_are_refused() {
    let mut world = common::world(&pool());
    run(&mut world, 1);
    let before = world.digest();
    let free = Vec3::new(0.04, 0.14, -0.04);
    let at = |position: Vec3| ball("new", position);
    let bad = [
        (
            Body { density: 0.0, ..at(free) },
            "`add_body.description.density` = 0 is out of range 1 to 100000 kg/m^3",
        ),
        (Body { name: "ball".to_owned(), ..at(free) }, "already the name of"),
        (Body { name: "removed-7".to_owned(), ..at(free) }, "begin with `removed-`"),
        (
            Body { position: Vec3::splat(f32::NAN), ..at(free) },
            "`add_body.description.position[0]` = NaN is out of range",
        ),
        (Body { shape: ShapeKind::Plane, ..at(free) }, "a plane has no mass"),
        (at(Vec3::new(0.5, 0.1, 0.0)), "must be inside the container"),
        (at(Vec3::new(0.03, 0.014, -0.03)), "particles are there; remove them first"),
        (at(Vec3::new(0.025, 0.045, 0.025)), "sponge number 1 is there, `dry`"),
    ];
    for (description, expected) in bad {
        let command = add(&world, description);
        let text = refused(&mut world, command.clone()).to_lowercase();
        assert!(text.contains(&expected.to_lowercase()), "{expected}: {text}");
    }
    let wrong = Command::AddBody { body: 7.into(), description: Box::new(at(free)) };
    assert!(refused(&mut world, wrong).contains("no handle is used twice; the next one is 1"));
    let text = refused(&mut world, Command::BodyKind { body: 3.into(), kind: BodyKind::Fixed });
    assert!(text.contains("`body_kind.body` = 3: no such body; there are 1"), "{text}");
    assert_eq!(world.digest(), before, "nothing has changed");
    let region = Region::Sphere { centre: free, radius: 0.01 };
    push(&mut world, Command::Pour { region, velocity: Vec3::ZERO });
    let command = add(&world, at(free));
    assert!(refused(&mut world, command).contains("a command that waits brings something there"));
    // The control.
    let command = add(&world, at(free.with_x(-0.04)));
    push(&mut world, command);
    run(&mut world, 3);
}

#[test]
fn the_first_body_of_a_scene_follows_poses_when_it_comes_late() {
    let scene = Scene::new("late").in_box(Vec3::splat(-0.1), Vec3::splat(0.1));
    let mut world = World::new(&scene).unwrap();
    for _ in 0..10 {
        world.advance_frame().unwrap();
    }
    let hand = Body::kinematic("hand", ShapeKind::Sphere { radius: 0.001 }, Vec3::ZERO, Vec::new());
    let body = world.next_body();
    world.push(Command::AddBody { body, description: Box::new(hand) }).unwrap();
    let position = Vec3::new(0.0, 0.05, 0.0);
    world.push(Command::Pose { body, position, rotation: Quat::IDENTITY, duration: 0.1 }).unwrap();
    for _ in 0..7 {
        world.advance_frame().unwrap();
    }
    assert!(
        world.bodies()[0].state.position.distance(position) < 1e-6,
        "{}",
        world.bodies()[0].state.position
    );
}

#[test]
fn a_small_ball_cannot_hold_nodes_many_radii_away() {
    let mut world = common::world(&pool());
    let nodes = Nodes::Sphere { centre: Vec3::new(-0.05, 0.03, -0.05), radius: 0.02 };
    let (body, rule) = (0.into(), "a dynamic body cannot hold more than it has");
    let text = refused(&mut world, Command::Grip { body, nodes: nodes.clone() });
    assert!(text.contains(rule), "{text}");
    // Negative control: a hand can, but cannot become free with them.
    push(&mut world, Command::BodyKind { body, kind: BodyKind::Kinematic });
    common::steps(&mut world, 1);
    push(&mut world, Command::Grip { body, nodes: nodes.clone() });
    common::steps(&mut world, 1);
    let free = Command::BodyKind { body, kind: BodyKind::Dynamic };
    let text = refused(&mut world, free.clone());
    assert!(text.contains(rule), "{text}");
    push(&mut world, Command::Release { nodes });
    common::steps(&mut world, 1);
    push(&mut world, free);
}
