//! Bad input is an error that says what is wrong, and nothing has changed.

use sorb::{
    Command, Region,
    glam::Vec3,
    scene::{FluidSolver, Scene},
};

use super::{audit, busy_cup, common, cuboid, pour, push};

#[test]
fn bad_pours_and_removals_are_refused() {
    let mut world = common::world(&busy_cup(0.03, FluidSolver::Divergence));
    common::frame(&mut world);
    let (before, balance) = (world.digest(), world.ledger());
    let sphere = |centre, radius| Region::Sphere { centre, radius };
    let (nan, far) = (f32::NAN, Vec3::splat(0.5));
    let velocity = Command::Pour { region: sphere(Vec3::Y * 0.1, 0.01), velocity: Vec3::splat(nan) };
    let line = Region::Cylinder { start: Vec3::Y, end: Vec3::Y, radius: 0.1 };
    let thin = cuboid([0.0, 0.1, 0.0], [0.01, 0.1005, 0.01]);
    let cases = [
        (
            pour(sphere(Vec3::splat(nan), 0.01)),
            "`pour.region.sphere.centre` = nan is out of range -1000 to 1000 m",
        ),
        (pour(sphere(Vec3::Y * 0.1, nan)), "`pour.region.sphere.radius` = nan is out of range 1e-4 to 100 m"),
        (pour(sphere(Vec3::Y * 0.1, -1.0)), "`pour.region.sphere.radius` = -1 is out of range"),
        (velocity, "`pour.velocity` = nan is out of range -100 to 100 m/s"),
        (pour(cuboid([0.0; 3], [0.1, -0.1, 0.1])), "must be above `pour.region.box.minimum`"),
        (pour(line), "must be at least 0.0001 m from `pour.region.cylinder.start`"),
        (pour(sphere(Vec3::ZERO, 100.0)), "the range is 0 to 50000000 in all"),
        (pour(thin), "room for 0 particles"),
        (pour(sphere(far, 0.01)), "0 particles; 32 places are outside"),
        (pour(sphere(Vec3::new(0.03, 0.05, 0.03), 0.008)), "room for 0 particles; 0 places are outside"),
        (pour(cuboid([-0.04, 0.01, -0.04], [-0.02, 0.02, -0.02])), "in sponges"),
        (Command::Remove { region: sphere(far, 0.01) }, "`remove.region` = Sphere"),
        (Command::Remove { region: sphere(far, 0.01) }, "holds none of"),
        (Command::Remove { region: sphere(far, nan) }, "`remove.region.sphere.radius` = nan"),
    ];
    for (command, expected) in cases {
        let error = world.push(command.clone()).expect_err(expected).to_string().to_lowercase();
        assert!(error.contains(&expected.to_lowercase()), "{command:?}: {error}");
    }
    assert_eq!((world.digest(), world.ledger()), (before, balance), "nothing has changed");
    // Negative control: a good one.
    push(&mut world, pour(sphere(Vec3::Y * 0.1, 0.01)));
    common::frame(&mut world);
    assert!(world.ledger().poured > 0);
    audit(&world);
}

#[test]
fn a_second_removal_is_refused_unless_it_waits_behind_the_first() {
    let mut world = common::world(&busy_cup(0.03, FluidSolver::Divergence));
    let region = cuboid([0.0, -1.0, -1.0], [1.0, 1.0, 1.0]);
    // Nobody knows yet what the second one will find.
    push(&mut world, Command::Remove { region: region.clone() });
    push(&mut world, Command::Remove { region });
    common::steps(&mut world, 1);
    let error = world.push(Command::Remove { region: cuboid([0.03, -1.0, -1.0], [1.0, 1.0, 1.0]) });
    assert!(error.is_err_and(|error| error.to_string().contains("holds none of")));
    audit(&world);
}

#[test]
fn a_scene_without_fluid_has_no_water() {
    let mut world = common::world(&Scene::new("space"));
    let region = Region::Sphere { centre: Vec3::ZERO, radius: 0.1 };
    let error = world.push(pour(region.clone())).expect_err("no fluid").to_string();
    assert!(error.contains("the scene has no `fluid`"), "{error}");
    assert!(world.push(Command::Remove { region }).is_err());
    let ledger = world.ledger();
    assert_eq!((ledger.present, ledger.lost, ledger.particle_mass), (0, 0, 0.0));
}
