//! What is poured is there, and what is removed is gone.

use sorb::{
    Command, Options, Region, World,
    glam::Vec3,
    scene::{FluidBlock, FluidSolver},
};

use super::{HIGH, LOW, audit, busy_cup, common, cuboid, cup, pour, push};

const SOLVERS: [FluidSolver; 4] =
    [FluidSolver::Divergence, FluidSolver::Dfsph, FluidSolver::Wcsph, FluidSolver::Pbf];

#[test]
fn a_pour_into_an_empty_scene_is_the_block_of_a_scene() {
    // The solve for the divergence begins with the pressure of water at rest, which a pour is not.
    for solver in [FluidSolver::Dfsph, FluidSolver::Wcsph, FluidSolver::Pbf] {
        let (low, high) = (Vec3::new(-0.03, 0.01, -0.02), Vec3::new(0.03, 0.05, 0.04));
        let velocity = Vec3::new(0.2, -0.5, 0.0);
        let mut with_block = cup(0.0, solver);
        if let Some(fluid) = &mut with_block.fluid {
            fluid.blocks.push(FluidBlock { velocity, ..FluidBlock::new(low, high) });
        }
        let (mut seeded, mut poured) = (common::world(&with_block), common::world(&cup(0.0, solver)));
        push(&mut poured, Command::Pour { region: Region::Box { minimum: low, maximum: high }, velocity });
        for _ in 0..5 {
            common::frame(&mut seeded);
            common::frame(&mut poured);
        }
        assert_eq!(seeded.state_digest(), poured.state_digest(), "{solver:?}");
        assert_ne!(seeded.digest(), poured.digest(), "the books differ");
        // Negative control: a particle less.
        let one = Vec3::from_slice(&poured.particle_positions()[0][..3]);
        push(&mut poured, Command::Remove { region: Region::Sphere { centre: one, radius: 1e-3 } });
        common::frame(&mut seeded);
        common::frame(&mut poured);
        assert_ne!(seeded.state_digest(), poured.state_digest(), "{solver:?}");
        assert_eq!(poured.ledger().removed, 1);
    }
}

#[test]
fn water_comes_and_goes_and_the_books_balance() {
    for solver in SOLVERS {
        let mut world = common::world(&busy_cup(0.03, solver));
        let seeded = world.ledger().present;
        let sphere = Region::Sphere { centre: Vec3::new(0.0, 0.11, 0.0), radius: 0.02 };
        let (start, end) = (Vec3::new(-0.02, 0.08, -0.03), Vec3::new(-0.01, 0.11, -0.03));
        let cylinder = Region::Cylinder { start, end, radius: 0.012 };
        for region in [sphere, cylinder, cuboid([-0.04, 0.1, 0.02], [0.0, 0.14, 0.045])] {
            push(&mut world, pour(region));
            common::frame(&mut world);
            audit(&world);
        }
        let ledger = world.ledger();
        let volume = 4.0 / 3.0 * std::f64::consts::PI * 8e-6 + 1.43e-5 + 4e-5;
        let poured =
            ledger.poured as f64 * f64::from(world.scene().fluid.as_ref().map_or(0.0, |f| f.spacing)).powi(3);
        assert!((poured / volume - 1.0).abs() < 0.15, "{solver:?}: {poured} m^3 of {volume}");
        let mass = world.measures().water_mass;
        let expected = ledger.present as f64 * f64::from(ledger.particle_mass);
        assert!((mass / expected - 1.0).abs() < 1e-9, "{mass} {expected}");
        (0..20).for_each(|_| common::frame(&mut world));
        audit(&world);
        push(&mut world, Command::Remove { region: cuboid([0.0, -0.01, -0.06], [0.06, 0.2, 0.06]) });
        common::steps(&mut world, 1);
        audit(&world);
        let after = world.ledger();
        assert!(after.removed > seeded / 4 && after.poured == ledger.poured, "{after:?}");
        (0..5).for_each(|_| common::frame(&mut world));
        audit(&world);
    }
}

#[test]
fn a_world_is_emptied_and_filled_again() {
    for solver in SOLVERS {
        let mut world = common::world(&busy_cup(0.02, solver));
        let everything = cuboid([-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]);
        let mut last = 0;
        for round in 0..3 {
            common::frame(&mut world);
            push(&mut world, Command::Remove { region: everything.clone() });
            common::frame(&mut world);
            audit(&world);
            assert!(world.particle_ids().is_empty() && world.node_saturations().is_empty(), "{round}");
            let measures = world.measures();
            assert_eq!((measures.water_mass, measures.absorbed_mass), (0.0, 0.0));
            assert!(world.particle_densities().is_empty() && world.particle_pressures().is_empty());
            push(&mut world, pour(cuboid([-0.04, 0.06, -0.04], [0.04, 0.1, 0.0])));
            common::frame(&mut world);
            audit(&world);
            let first = world.particle_ids().iter().min().copied().unwrap_or(0);
            assert!(first > last || round == 0, "numbers are never used again");
            last = first;
        }
        assert!(world.particle_densities().iter().all(|density| *density > 0.0));
        (0..20).for_each(|_| common::frame(&mut world));
        audit(&world);
    }
}

#[test]
fn places_in_bodies_sponges_water_and_walls_are_left_out_and_counted() {
    let mut world = common::world(&busy_cup(0.03, FluidSolver::Divergence));
    // All of the cup and more.
    let region = cuboid([-0.07, -0.02, -0.07], [0.07, 0.17, 0.07]);
    push(&mut world, pour(region));
    common::steps(&mut world, 1);
    audit(&world);
    let ledger = world.ledger();
    let spacing = world.scene().fluid.as_ref().map_or(0.0, |fluid| fluid.spacing);
    let wanted = (0.14 * 0.19 * 0.14 / spacing.powi(3)) as u64;
    let counted = ledger.poured + ledger.left_out;
    assert!(counted.abs_diff(wanted) < wanted / 10, "{counted} {wanted}");
    let room = (0.1 * 0.12 * 0.1 / spacing.powi(3)) as u64;
    assert!(ledger.poured.abs_diff(room) < room / 7, "{} {room}", ledger.poured);
    let bodies = world.bodies();
    assert!(bodies[0].distance(Vec3::new(0.03, 0.05, 0.03)) < -0.01);
    (0..5).for_each(|_| common::frame(&mut world));
    audit(&world);
}

#[test]
fn a_poured_drop_falls_freely() {
    let mut scene = cup(0.0, FluidSolver::Divergence);
    // Semi-implicit steps are ahead by half of one.
    scene.time.maximum_step = 2e-4;
    let mut world = common::world(&scene);
    push(
        &mut world,
        Command::Pour {
            region: Region::Sphere { centre: Vec3::Y * 0.12, radius: 0.015 },
            velocity: Vec3::ZERO,
        },
    );
    let height = |world: &World| {
        let rows = world.particle_positions();
        rows.iter().map(|row| f64::from(row[1])).sum::<f64>() / rows.len() as f64
    };
    for _ in 0..6 {
        common::frame(&mut world);
    }
    let fallen = 0.12 - height(&world);
    assert!((fallen / (0.5 * 9.81 * 0.01) - 1.0).abs() < 0.005, "{fallen} m in 0.1 s");
}

#[test]
fn a_save_of_a_scene_that_was_emptied_is_restored() {
    let mut scene = cup(0.04, FluidSolver::Dfsph);
    if let Some(fluid) = &mut scene.fluid {
        fluid.spacing = 0.0025;
    }
    let mut world = common::world(&scene);
    assert!(world.particle_ids().len() > 20_000);
    let saved = |world: &World| {
        let mut bytes = Vec::new();
        world.save(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
        bytes
    };
    push(&mut world, Command::Remove { region: cuboid([-1.0, 0.003, -1.0], [1.0; 3]) });
    common::steps(&mut world, 1);
    let bytes = saved(&world);
    let mut restored =
        World::restore(&bytes[..], &Options::default()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(saved(&restored), bytes);
    common::steps(&mut world, 3);
    common::steps(&mut restored, 3);
    assert_eq!(restored.digest(), world.digest());
    audit(&restored);
}

#[test]
fn reserved_room_and_growing_room_give_the_same_bits() {
    let mut plain = common::world(&cup(0.02, FluidSolver::Divergence));
    let mut reserved = plain.clone();
    reserved.reserve_particles(100_000);
    for turn in 0..4 {
        let x = -0.04 + 0.02 * turn as f32;
        for world in [&mut plain, &mut reserved] {
            push(world, pour(cuboid([x, 0.08, LOW.z], [x + 0.02, 0.12, HIGH.z])));
            common::frame(world);
        }
    }
    assert_eq!(plain.digest(), reserved.digest());
}
