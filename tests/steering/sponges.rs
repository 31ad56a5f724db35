//! Sponges that come and go.

use sorb::{
    Command, Nodes, Snapshot, SpongeHandle, World,
    glam::{Quat, Vec3},
    scene::{Body, Material, Scene, ShapeKind, Solver, Sponge},
};

use super::{audit, common, pool, push, refused, sponge};

fn add(world: &World, description: Sponge) -> Command {
    Command::AddSponge { sponge: world.next_sponge(), description: Box::new(description) }
}

fn run(world: &mut World, frames: u32) {
    for _ in 0..frames {
        common::frame(world);
        audit(world);
    }
}

/// Positions of the nodes of a sponge, in order.
fn nodes(world: &World, sponge: usize) -> Vec<[f32; 4]> {
    let rows = world.node_positions().iter().zip(&world.lattice().node_sponge);
    rows.filter(|(_, own)| **own as usize == sponge).map(|(row, _)| *row).collect()
}

/// The pool without its second sponge.
fn with_one() -> Scene {
    let mut scene = pool();
    scene.sponges.truncate(1);
    scene
}

#[test]
fn a_sponge_that_is_added_is_one_of_the_scene() {
    // Dry as well: then the first sponge begins everything that has to do with nodes.
    for is_dry in [false, true] {
        let (mut whole, mut part) = (pool(), pool());
        if is_dry {
            (whole.fluid, part.fluid) = (None, None);
            whole.sponges.iter_mut().chain(&mut part.sponges).for_each(|sponge| sponge.saturation = 0.0);
        }
        let added: Vec<Sponge> = part.sponges.drain(if is_dry { 0.. } else { 1.. }).collect();
        let (mut whole, mut part) = (common::world(&whole), common::world(&part));
        for description in added {
            let command = add(&part, description);
            push(&mut part, command);
        }
        for frame in 0..6 {
            run(&mut whole, 1);
            run(&mut part, 1);
            assert_eq!(whole.node_positions(), part.node_positions(), "{is_dry}, frame {frame}");
            assert_eq!(whole.particle_positions(), part.particle_positions(), "{is_dry}, frame {frame}");
        }
        // The control: one that falls moves.
        assert_ne!(whole.node_positions(), &whole.lattice().position[..]);
    }
}

#[test]
fn a_sponge_that_is_removed_was_never_there() {
    let (mut world, mut other) = (common::world(&pool()), common::world(&with_one()));
    push(&mut world, Command::RemoveSponge { sponge: 1.into() });
    for frame in 0..6 {
        run(&mut world, 1);
        run(&mut other, 1);
        assert_eq!(nodes(&world, 0), nodes(&other, 0), "frame {frame}");
        assert_eq!(world.node_positions().len(), other.node_positions().len());
        assert_eq!(world.particle_positions(), other.particle_positions(), "frame {frame}");
    }
    // The control: it was there.
    assert_eq!(nodes(&common::world(&pool()), 1).len(), nodes(&other, 0).len());
}

#[test]
fn others_stay_where_they_are_and_keep_what_they_have() {
    let mut world = common::world(&pool());
    run(&mut world, 20);
    // Where others were at first there is room by now.
    for (name, height) in [("second", 0.055), ("third", 0.075)] {
        let command = add(&world, sponge(name, Vec3::new(0.01, height, 0.01)));
        push(&mut world, command);
        run(&mut world, 12);
    }
    for index in [2, 3] {
        push(&mut world, Command::RemoveSponge { sponge: index.into() });
    }
    run(&mut world, 1);
    let (before, saturation) = (nodes(&world, 1), world.measures().saturation);
    // The wet one goes, its water stays.
    let present = world.ledger().present;
    push(&mut world, Command::RemoveSponge { sponge: 0.into() });
    common::steps(&mut world, 1);
    audit(&world);
    assert_eq!(world.ledger().present, present);
    let way = |a: &[f32; 4], b: &[f32; 4]| (0..3).map(|axis| (a[axis] - b[axis]).abs()).fold(0.0, f32::max);
    let farthest = nodes(&world, 1).iter().zip(&before).map(|(a, b)| way(a, b)).fold(0.0, f32::max);
    assert!(farthest < 2e-3, "{farthest} m in a step");
    assert!(world.measures().saturation != saturation && nodes(&world, 0).is_empty());
    run(&mut world, 20);
    // Another one takes its number, with water in its pores.
    let wet = Sponge { saturation: 0.8, ..sponge("next", Vec3::new(-0.055, 0.1, -0.055)) };
    let command = add(&world, wet);
    push(&mut world, command);
    run(&mut world, 1);
    let brought = world.ledger().present - present;
    assert!(brought > 100 && world.ledger().poured == brought, "{brought} particles in its pores");
    let handles: Vec<SpongeHandle> = world.sponge_handles().collect();
    assert_eq!((handles[0].index(), handles[0].generation(), handles.len()), (0, 1, 2));
    run(&mut world, 20);
    let lowest = nodes(&world, 0).iter().map(|row| row[1]).fold(f32::INFINITY, f32::min);
    assert!(lowest < 0.05, "it has fallen to {lowest} m");
}

#[test]
fn all_sponges_go_and_one_comes_back() {
    let mut scene = pool();
    (scene.time.sleep_after, scene.time.sleep_speed) = (0.03, 0.5);
    for sleeps in [false, true] {
        if !sleeps {
            scene.time.sleep_after = 0.0;
        }
        let mut world = common::world(&scene);
        run(&mut world, 3);
        for index in 0..2 {
            push(&mut world, Command::RemoveSponge { sponge: index.into() });
        }
        run(&mut world, 30);
        assert_eq!((world.node_positions().len(), world.sponge_handles().count()), (0, 0));
        assert_eq!(world.measures().absorbed_mass, 0.0);
        let command = add(&world, sponge("back", Vec3::new(0.0, 0.06, 0.0)));
        push(&mut world, command);
        run(&mut world, 30);
        assert!(world.measures().saturation > 0.05, "{}", world.measures().saturation);
        // A save of it is restored, and goes on with the same bits.
        let mut bytes = Vec::new();
        world.save(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
        let mut restored = World::restore(&bytes[..], &sorb::Options::default())
            .unwrap_or_else(|error| panic!("sleeps {sleeps}: {error}"));
        run(&mut world, 3);
        run(&mut restored, 3);
        assert_eq!(world.digest(), restored.digest());
        scene.time.sleep_after = 0.03;
    }
}

#[test]
fn the_last_sponge_that_depends_on_wetness_goes() {
    let mut world = common::world(&pool());
    run(&mut world, 6);
    let soft = Material { softening: 0.5, swelling: 0.1, ..Material::default() };
    push(&mut world, Command::Material { sponge: 1.into(), material: soft });
    push(&mut world, Command::RemoveSponge { sponge: 1.into() });
    run(&mut world, 6);
    let text = format!("{:?}", world.measures());
    assert!(!text.contains("NaN"), "{text}");
}

#[test]
fn a_rollback_goes_back_over_a_sponge() {
    let (mut world, mut snapshot) = (common::world(&pool()), Snapshot::new());
    run(&mut world, 2);
    world.snapshot_into(&mut snapshot);
    let mut straight = world.clone();
    let command = add(&world, sponge("new", Vec3::new(-0.02, 0.1, 0.02)));
    push(&mut world, command);
    push(&mut world, Command::RemoveSponge { sponge: 1.into() });
    run(&mut world, 2);
    world.rollback(&snapshot).unwrap_or_else(|error| panic!("{error}"));
    run(&mut world, 3);
    run(&mut straight, 3);
    assert_eq!(world.digest(), straight.digest());
}

#[test]
fn bodies_that_grip_hold_what_comes_into_them() {
    let shape = ShapeKind::Cuboid { half_extents: Vec3::new(0.02, 0.005, 0.02) };
    let hand = Body { grip: true, ..Body::fixed("hand", shape, Vec3::new(0.0, 0.12, 0.0)) };
    let mut world = common::world(&pool().with_body(hand));
    let command = add(&world, sponge("held", Vec3::new(-0.015, 0.09, -0.015)));
    push(&mut world, command);
    run(&mut world, 40);
    let highest = nodes(&world, 2).iter().map(|row| row[1]).fold(0.0, f32::max);
    assert!((highest - 0.12).abs() < 0.002, "{highest} m");
    // The control: without a hand it falls.
    let mut free = common::world(&pool());
    let command = add(&free, sponge("free", Vec3::new(-0.015, 0.09, -0.015)));
    push(&mut free, command);
    run(&mut free, 40);
    assert!(nodes(&free, 2).iter().map(|row| row[1]).fold(0.0, f32::max) < 0.09);
}

#[test]
fn what_cannot_be_is_refused_with_its_key() {
    let mut world = common::world(&pool());
    let mut text = |description: Sponge| {
        let command = add(&world, description);
        refused(&mut world, command)
    };
    let above = Vec3::new(-0.015, 0.1, -0.015);
    for (description, part) in [
        (sponge("dry", above), "`add_sponge.description.name`"),
        (sponge("removed-2", above), "begin with `removed-`"),
        (sponge("new", Vec3::NAN), "`add_sponge.description.position[0]` = NaN"),
        (sponge("new", Vec3::new(0.05, 0.1, 0.0)), "`add_sponge.description` = (from [0.05, 0.1, 0]"),
        (sponge("new", Vec3::new(0.02, 0.04, 0.02)), "sponge number 1 is there, `dry`"),
        (sponge("new", Vec3::new(0.015, 0.085, -0.045)), "body number 0 is there, `ball`"),
        (Sponge { porosity: 2.0, ..sponge("new", above) }, "`add_sponge.description.porosity`"),
        (Sponge { solver: Solver::Sbd, ..sponge("new", above) }, "solved or coupled in another way"),
        (
            Sponge { saturation: 1.0, ..sponge("new", Vec3::new(0.0, 0.0, -0.05)) },
            "of the particles in its pores would be in other water",
        ),
    ] {
        let found = text(description);
        assert!(found.contains(part), "{part}: {found}");
    }
    // The control: nothing is wrong with the place.
    assert_eq!(text(sponge("new", above)), "");
    assert!(text(sponge("other", above)).contains("a command that waits brings something there"));
    let wrong = Command::AddSponge { sponge: 0.into(), description: Box::new(sponge("third", above)) };
    assert!(refused(&mut world, wrong).contains("the next one is 3"));
    // Not there yet.
    let (new, material) = (SpongeHandle::from(2), Material::default());
    assert!(
        refused(&mut world, Command::Material { sponge: new, material })
            .contains("a command that waits adds it")
    );
    let nodes = Nodes::Rows(vec![0]);
    assert!(refused(&mut world, Command::Release { nodes }).contains("changes the rows of nodes"));
    run(&mut world, 1);
    push(&mut world, Command::RemoveSponge { sponge: new });
    let text = refused(&mut world, Command::RemoveSponge { sponge: new });
    assert!(text.contains("`remove_sponge.sponge` = 2: no such sponge"), "{text}");
    run(&mut world, 1);
    let (position, rotation, velocity) = (above, Quat::IDENTITY, Vec3::ZERO);
    let place = Command::PlaceSponge { sponge: new, position, rotation, velocity };
    assert!(refused(&mut world, place).contains("no such sponge"));
    assert!(world.material(new).is_none() && world.material(1.into()).is_some());
}
