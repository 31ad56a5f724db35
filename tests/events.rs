//! Events: contact, absorption and sleep, begun and ended.

#[path = "common/mod.rs"]
mod common;

use sorb::{
    Command, Event, Part, Touched, Watcher, World,
    glam::Vec3,
    rigid::BodyKind,
    scene::{Body, Fluid, FluidBlock, Scene, ShapeKind, Sponge},
};

const LOW: Vec3 = Vec3::new(-0.06, 0.0, -0.06);
const HIGH: Vec3 = Vec3::new(0.06, 0.16, 0.06);

fn ball(name: &str, position: Vec3, density: f32) -> Body {
    Body::dynamic(name, ShapeKind::Sphere { radius: 0.012 }, position, density)
}

/// Events of some frames, with their frame.
fn watch(world: &mut World, watcher: &mut Watcher, frames: u32) -> Vec<(u32, Event)> {
    let mut all = Vec::new();
    for frame in 0..frames {
        common::frame(world);
        all.extend(watcher.look(world).into_iter().map(|event| (frame, event)));
    }
    all
}

fn frame_of(events: &[(u32, Event)], event: Event) -> u32 {
    let found = events.iter().find(|(_, own)| *own == event);
    found.unwrap_or_else(|| panic!("{event:?} is not in {events:?}")).0
}

#[test]
fn a_ball_touches_a_sponge_another_ball_and_a_wall() {
    let sponge = Sponge { cells: [4, 3, 4].into(), ..Sponge::new("sponge", Vec3::new(-0.055, 0.0, -0.055)) };
    let scene = Scene::new("dry")
        .in_box(LOW, HIGH)
        .with_sponge(sponge)
        .with_body(ball("above", Vec3::new(-0.035, 0.06, -0.035), 800.0))
        .with_body(ball("lower", Vec3::new(0.03, 0.03, 0.03), 800.0))
        .with_body(ball("upper", Vec3::new(0.03, 0.08, 0.03), 800.0));
    let (mut world, mut watcher) = (common::world(&scene), Watcher::new());
    assert_eq!(watcher.look(&world), [], "nothing touches");
    let mut events = watch(&mut world, &mut watcher, 30);
    let began = |body: u32, with| Event::ContactBegan(body.into(), with);
    // Falls of 18 mm to the floor, 18 mm to the sponge and 26 mm to the other ball which lies by then.
    let floor = frame_of(&events, began(1, Touched::Wall));
    let other = frame_of(&events, began(1, Touched::Body(2.into())));
    assert!((2..=5).contains(&floor) && other > floor, "{floor} {other}");
    assert!((2..=5).contains(&frame_of(&events, began(0, Touched::Sponge(0.into())))));
    assert!(!events.iter().any(|(_, event)| *event == began(1, Touched::Sponge(0.into()))));
    assert!(!events.iter().any(|(_, event)| matches!(event, Event::ContactBegan(_, Touched::Water))));
    // One that is removed touches nothing any more, and one that is lifted lets go.
    world.push(Command::RemoveBody { body: 2.into() }).unwrap_or_else(|error| panic!("{error}"));
    let velocity =
        Command::Velocity { body: 0.into(), linear_velocity: Vec3::Y * 1.0, angular_velocity: Vec3::ZERO };
    world.push(velocity).unwrap_or_else(|error| panic!("{error}"));
    events = watch(&mut world, &mut watcher, 5);
    let ended = |body: u32, with| Event::ContactEnded(body.into(), with);
    frame_of(&events, ended(1, Touched::Body(2.into())));
    frame_of(&events, ended(0, Touched::Sponge(0.into())));
    // The control: what goes on has no event.
    assert!(!events.iter().any(|(_, event)| matches!(event, Event::ContactBegan(..))));
}

#[test]
fn a_sponge_drinks_and_is_full() {
    let fluid = Fluid { blocks: vec![FluidBlock::new(LOW, HIGH.with_y(0.02))], ..Fluid::default() };
    let sponge = |x: f32| Sponge { cells: [3, 3, 3].into(), ..Sponge::new("dry", Vec3::new(x, 0.0, -0.015)) };
    let high = Sponge { name: "high".to_owned(), position: Vec3::new(0.02, 0.12, -0.015), ..sponge(0.0) };
    let holder = Body {
        grip: true,
        ..Body::fixed("holder", ShapeKind::Sphere { radius: 0.05 }, Vec3::new(0.035, 0.135, 0.0))
    };
    let raft = ball("raft", Vec3::new(-0.045, 0.04, 0.04), 500.0);
    let scene =
        Scene::new("pool").in_box(LOW, HIGH).with_fluid(fluid).with_sponge(sponge(-0.05)).with_sponge(high);
    let (mut world, mut watcher) = (common::world(&scene.with_body(holder).with_body(raft)), Watcher::new());
    watcher.look(&world);
    let events = watch(&mut world, &mut watcher, 240);
    let (began, ended) = (Event::AbsorptionBegan(0.into()), Event::AbsorptionEnded(0.into()));
    assert!(
        frame_of(&events, began) < 10 && frame_of(&events, ended) > frame_of(&events, began) + 10,
        "{events:?}"
    );
    frame_of(&events, Event::ContactBegan(1.into(), Touched::Water));
    // The control: a sponge above the water drinks nothing, and a body that grips touches no sponge.
    assert!(!events.iter().any(|(_, event)| *event == Event::AbsorptionBegan(1.into())));
    assert!(!events.iter().any(|(_, event)| matches!(event, Event::ContactBegan(_, Touched::Sponge(_)))));
}

#[test]
fn parts_fall_asleep_and_wake() {
    let sponge =
        |name: &str, x: f32| Sponge { cells: [3, 3, 3].into(), ..Sponge::new(name, Vec3::new(x, 0.0, 0.0)) };
    let hammer = Body { kind: BodyKind::Kinematic, ..ball("hammer", Vec3::new(-0.04, 0.1, 0.015), 1000.0) };
    let scene = Scene::new("dry")
        .in_box(LOW, HIGH.with_x(0.4))
        .with_sponge(sponge("left", -0.055))
        .with_sponge(sponge("right", 0.3));
    let mut scene = scene.with_body(hammer);
    (scene.time.sleep_after, scene.time.sleep_speed) = (0.2, 0.01);
    let (mut world, mut watcher) = (common::world(&scene), Watcher::new());
    let events = watch(&mut world, &mut watcher, 90);
    let part = |index: u32| Part::Sponge(index.into());
    frame_of(&events, Event::FellAsleep(part(0)));
    frame_of(&events, Event::FellAsleep(part(1)));
    let position = Vec3::new(-0.04, 0.035, 0.015);
    let pose = Command::Pose { body: 0.into(), position, rotation: Default::default(), duration: 0.2 };
    world.push(pose).unwrap_or_else(|error| panic!("{error}"));
    let events = watch(&mut world, &mut watcher, 20);
    frame_of(&events, Event::Woke(part(0)));
    frame_of(&events, Event::ContactBegan(0.into(), Touched::Sponge(0.into())));
    assert!(!events.iter().any(|(_, event)| *event == Event::Woke(part(1))), "the control: {events:?}");
}
