//! What the hand takes follows it, by commands alone.

use sorb::{
    Options, Ray, Targets, World,
    glam::Vec3,
    scene::{Scene, preset},
};
use sorb_view::{Source, hand::Hand, session::Session};

fn source(name: &str, resolution: f32) -> Source {
    let scene = preset(name).and_then(|scene| scene.scaled(resolution));
    let scene: Scene = scene.unwrap_or_else(|error| panic!("{error}"));
    Source::Scene(Box::new(scene))
}

fn session(source: &Source) -> Session<'_> {
    Session::new(source, &Options::default(), None).unwrap_or_else(|error| panic!("{error}"))
}

/// Takes what a ray meets, moves it by a way in some frames, and lets go. The name of what was taken.
fn drag(session: &mut Session<'_>, ray: Ray, way: Vec3, frames: u32) -> Option<String> {
    let mut hand = Hand::default();
    let hit = session.world().cast_rays(&[ray], Targets::ALL).unwrap()[0].expect("something is there");
    let name = hand.take(session, &hit).unwrap();
    hand.reach(session.world(), hit.point + way);
    for _ in 0..frames {
        hand.act(session, 1.0 / session.world().scene().time.frame_rate).unwrap();
        session.advance().unwrap();
    }
    hand.let_go(session).unwrap();
    session.advance().unwrap();
    name
}

fn wait(session: &mut Session<'_>, frames: u32) {
    for _ in 0..frames {
        session.advance().unwrap();
    }
}

fn to(target: Vec3, from: Vec3) -> Ray {
    Ray { origin: target + from, direction: -from, length: 10.0 }
}

fn mean_node(world: &World) -> Vec3 {
    let nodes = world.node_positions();
    nodes.iter().map(|[x, y, z, _]| Vec3::new(*x, *y, *z)).sum::<Vec3>() / nodes.len() as f32
}

#[test]
fn a_sponge_follows_the_hand() {
    let source = source("standing", 0.5);
    let (mut moved, mut left) = (session(&source), session(&source));
    // The hand is the first body of this scene, and comes when time has passed.
    wait(&mut moved, 5);
    let middle = mean_node(moved.world());
    let name = drag(&mut moved, to(middle, Vec3::Z), Vec3::new(0.0, 0.04, 0.0), 24);
    assert_eq!(name.as_deref(), Some("sponge"));
    // Negative control: without the hand it stays.
    wait(&mut left, 30);
    let rise = mean_node(moved.world()).y - mean_node(left.world()).y;
    assert!(rise > 0.01, "{rise}");
    assert_eq!(moved.commands().get("grip"), Some(&1));
    assert!(left.commands().is_empty());
    // All nodes are free again.
    assert!(moved.world().node_positions().iter().all(|row| row[3] > 0.0));
}

#[test]
fn a_dynamic_body_follows_a_spring_and_falls_when_it_is_let_go() {
    let source = source("ball_drop", 0.4);
    let mut session = session(&source);
    let ball = |session: &Session<'_>| session.world().bodies()[0].state.position;
    let first = ball(&session);
    assert_eq!(
        drag(&mut session, to(first, Vec3::Z), Vec3::new(0.0, 0.03, 0.0), 30).as_deref(),
        Some("ball")
    );
    let held = ball(&session);
    assert!((held.y - first.y - 0.03).abs() < 0.01, "{first} {held}");
    wait(&mut session, 8);
    assert!(ball(&session).y < held.y - 0.01);
}

#[test]
fn a_finger_stirs_the_water_and_goes() {
    let source = source("water", 0.5);
    let (mut stirred, mut left) = (session(&source), session(&source));
    let (low, high) = stirred.world().scene().bounds();
    let block = stirred.world().scene().fluid.as_ref().unwrap().blocks[0].clone();
    let top = (0.5 * (block.minimum + block.maximum)).with_y(block.maximum.y);
    let name = drag(&mut stirred, to(top, Vec3::new(0.0, 1.0, 0.1)), 0.1 * (low - high), 10);
    assert_eq!(name.as_deref(), Some("water"));
    wait(&mut left, 11);
    assert_ne!(stirred.world().state_digest(), left.world().state_digest());
    let world = stirred.world();
    assert_eq!(world.body_handles().count(), left.world().body_handles().count());
    assert_eq!(world.ledger().present, left.world().ledger().present);
}

#[test]
fn water_is_poured_above_what_the_ray_meets() {
    let source = source("standing", 0.5);
    let mut session = session(&source);
    let before = session.world().ledger().present;
    let ray = to(mean_node(session.world()), Vec3::new(0.0, 0.5, 0.5));
    let spout = sorb_view::hand::spout(session.world(), ray).unwrap().expect("it meets the sponge");
    let mut hand = Hand::default();
    hand.pour(Some(spout));
    for _ in 0..10 {
        hand.act(&mut session, 1.0 / 60.0).unwrap();
        session.advance().unwrap();
    }
    assert!(session.world().ledger().present > before + 20);
}

#[test]
fn scenes_whose_grips_hold_nodes_keep_them() {
    let source = source("wring", 0.6);
    let mut session = session(&source);
    let held =
        |session: &Session<'_>| session.world().node_positions().iter().filter(|row| row[3] == 0.0).count();
    session.advance().unwrap();
    let before = held(&session);
    assert!(before > 0);
    let middle = mean_node(session.world());
    drag(&mut session, to(middle, Vec3::Z), Vec3::new(0.0, 0.01, 0.0), 3);
    assert_eq!(held(&session), before);
}
