//! Sponges that are put elsewhere.

use sorb::{
    Command, Nodes, Region, World,
    glam::{Quat, Vec3},
    scene::{Body, Scene, ShapeKind, Sponge},
};

use super::{audit, common, pool, push, refused};

fn place(sponge: u32, position: Vec3) -> Command {
    Command::PlaceSponge { sponge: sponge.into(), position, rotation: Quat::IDENTITY, velocity: Vec3::ZERO }
}

/// Where the nodes of a sponge are.
fn nodes(world: &World, sponge: u32) -> Vec<Vec3> {
    let rows = world.node_positions().iter().zip(&world.lattice().node_sponge);
    rows.filter(|(_, of)| **of == sponge).map(|(row, _)| Vec3::new(row[0], row[1], row[2])).collect()
}

fn middle(world: &World, sponge: u32) -> Vec3 {
    let nodes = nodes(world, sponge);
    nodes.iter().sum::<Vec3>() / nodes.len() as f32
}

#[test]
fn a_sponge_goes_to_a_pose_in_its_shape_at_rest() {
    let mut scene = Scene::new("space").with_sponge(Sponge::new("sponge", Vec3::ZERO));
    scene.gravity = Vec3::ZERO;
    let hand = Body::kinematic("hand", ShapeKind::Sphere { radius: 0.01 }, Vec3::splat(0.5), Vec::new());
    let mut world = common::world(&scene.with_body(hand));
    let rest = nodes(&world, 0);
    let grip = Nodes::Sphere { centre: Vec3::splat(0.04), radius: 0.02 };
    push(&mut world, Command::Grip { body: 0.into(), nodes: grip });
    common::frame(&mut world);
    let (position, rotation, velocity) = (Vec3::new(0.3, -0.2, 0.1), Quat::from_rotation_z(0.7), Vec3::X);
    push(&mut world, Command::PlaceSponge { sponge: 0.into(), position, rotation, velocity });
    let begin = world.clock().time;
    common::frame(&mut world);
    let way = velocity * (world.clock().time - begin) as f32;
    for (before, now) in rest.iter().zip(nodes(&world, 0)) {
        let expected = position + rotation * (*before - Vec3::splat(0.04)) + way;
        assert!(expected.distance(now) < 1e-5, "{expected} {now}");
    }
    assert!(world.node_positions().iter().all(|row| row[3] > 0.0), "nothing is held any more");
}

#[test]
fn water_in_the_pores_comes_along() {
    let mut world = common::world(&pool());
    common::frame(&mut world);
    let (before, held) = (middle(&world, 0), world.ledger().absorbed);
    assert!(held > 100, "{held}");
    push(&mut world, place(0, Vec3::new(-0.03, 0.12, -0.03)));
    common::steps(&mut world, 1);
    assert!(middle(&world, 0).y > before.y + 0.05);
    let ledger = world.ledger();
    // What hangs from its faces, outside of the tets, counts as absorbed and stays behind.
    assert!(ledger.absorbed as f64 > 0.75 * held as f64, "{} of {held}", ledger.absorbed);
    audit(&world);
    // The control: water around it stays.
    let high = world.particle_positions().iter().filter(|row| row[1] > 0.09).count() as u64;
    assert!(high == ledger.absorbed && high < ledger.present / 2, "{high} {ledger:?}");
    for _ in 0..20 {
        common::frame(&mut world);
        audit(&world);
    }
    // A dry one may go into the pool, and drinks.
    let mut world = common::world(&pool());
    push(&mut world, place(1, Vec3::new(0.03, 0.02, 0.03)));
    for _ in 0..20 {
        common::frame(&mut world);
        audit(&world);
    }
}

#[test]
fn places_that_are_taken_are_refused() {
    let mut world = common::world(&pool());
    common::frame(&mut world);
    let before = world.digest();
    let turned = Command::PlaceSponge {
        sponge: 1.into(),
        position: Vec3::ZERO,
        rotation: Quat::from_xyzw(0.0, 0.0, 0.0, 2.0),
        velocity: Vec3::ZERO,
    };
    for (command, expected) in [
        (place(2, Vec3::ZERO), "`place_sponge.sponge` = 2: no such sponge; there are 2"),
        (place(1, Vec3::splat(f32::NAN)), "`place_sponge.position` = NaN is out of range -1000 to 1000 m"),
        (turned, "must be a quaternion of unit length"),
        (place(1, Vec3::new(0.2, 0.1, 0.0)), "outside of the container"),
        (place(1, Vec3::new(0.03, 0.1, -0.03)), "it would be in body number 0, `ball`"),
        (place(1, Vec3::new(-0.03, 0.045, -0.03)), "it would be in sponge number 0, `wet`"),
        (place(0, Vec3::new(0.03, 0.016, -0.03)), "would be in other water"),
    ] {
        let text = refused(&mut world, command.clone());
        assert!(text.contains(expected), "{command:?}: {text}");
    }
    assert_eq!(world.digest(), before, "nothing has changed");
    push(&mut world, place(1, Vec3::new(0.0, 0.12, 0.0)));
    let text = refused(&mut world, place(0, Vec3::new(0.01, 0.12, 0.0)));
    assert!(text.contains("a command that waits brings something there"), "{text}");
    // The control: elsewhere, or where water comes later.
    push(&mut world, place(0, Vec3::new(-0.04, 0.12, -0.04)));
    let region = Region::Sphere { centre: Vec3::new(0.0, 0.12, 0.0), radius: 0.012 };
    push(&mut world, Command::Pour { region, velocity: Vec3::ZERO });
    for _ in 0..10 {
        common::frame(&mut world);
        audit(&world);
    }
}
