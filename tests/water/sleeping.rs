//! Water at rest sleeps, wakes when it gets company, and sleeps again.

use sorb::{Command, scene::FluidSolver};

use super::{audit, common, cuboid, cup, pour, push};

#[test]
fn sleeping_water_wakes_with_what_is_poured_and_removed() {
    let mut scene = cup(0.03, FluidSolver::Divergence);
    (scene.time.sleep_after, scene.time.sleep_speed) = (0.1, 0.05);
    let mut world = common::world(&scene);
    let sleeps = |world: &mut sorb::World| {
        (0..240).any(|_| {
            common::frame(world);
            world.is_asleep()
        })
    };
    assert!(sleeps(&mut world), "it comes to rest");
    push(&mut world, pour(cuboid([-0.02, 0.05, -0.02], [0.02, 0.07, 0.02])));
    common::frame(&mut world);
    assert!(!world.is_asleep() && !world.is_fluid_asleep());
    audit(&world);
    assert!(sleeps(&mut world), "and again");
    push(&mut world, Command::Remove { region: cuboid([0.0, -1.0, -1.0], [1.0, 1.0, 1.0]) });
    common::frame(&mut world);
    assert!(!world.is_asleep());
    audit(&world);
    let mut bytes = Vec::new();
    world.save(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
    let mut restored =
        sorb::World::restore(&bytes[..], &sorb::Options::default()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(world.digest(), restored.digest());
    assert!(sleeps(&mut world) && sleeps(&mut restored));
    assert_eq!(world.digest(), restored.digest());
    // All gone: nothing is left that could sleep or wake.
    push(&mut world, Command::Remove { region: cuboid([-1.0; 3], [1.0; 3]) });
    common::frame(&mut world);
    assert!(world.particle_ids().is_empty() && !world.is_fluid_asleep());
    push(&mut world, pour(cuboid([-0.05, 0.0, -0.05], [0.05, 0.02, 0.05])));
    assert!(sleeps(&mut world));
    audit(&world);
}
