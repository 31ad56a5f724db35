//! Answers about the state against closed forms.

mod common;

use sorb::{
    BodyLoads, Command, Options, Ray, Region, Surface, Targets, World,
    glam::{DVec3, UVec3, Vec3},
    scene::{Body, Fluid, FluidBlock, FluidSolver, Rotation, Scene, ShapeKind, Sponge},
};

fn ray(origin: [f32; 3], direction: [f32; 3]) -> Ray {
    Ray { origin: origin.into(), direction: direction.into(), length: 100.0 }
}

fn first(world: &World, ray: Ray) -> Option<(f32, Vec3, Surface)> {
    let hits = world.cast_rays(&[ray], Targets::ALL).unwrap_or_else(|error| panic!("{error}"));
    hits[0].map(|hit| {
        assert!(hit.point.distance(ray.origin + ray.direction.normalize() * hit.distance) < 1e-5);
        assert!((hit.normal.length() - 1.0).abs() < 1e-4);
        (hit.distance, hit.normal, hit.surface)
    })
}

#[track_caller]
fn assert_hit(world: &World, ray: Ray, distance: f32, normal: Vec3, surface: Surface) {
    let Some(found) = first(world, ray) else { panic!("nothing at {distance} m") };
    assert!((found.0 - distance).abs() < 2e-5, "{} m instead of {distance}", found.0);
    assert!(found.1.distance(normal) < 2e-3, "{} instead of {normal}", found.1);
    assert_eq!(found.2, surface);
}

#[test]
fn rays_meet_bodies_where_geometry_says() {
    let cuboid = ShapeKind::Cuboid { half_extents: Vec3::new(0.5, 0.2, 0.3) };
    let turned = Body {
        rotation: Rotation { axis: Vec3::Z, degrees: 90.0 },
        ..Body::fixed("box", cuboid, Vec3::new(3.0, 0.0, 0.0))
    };
    let scene = Scene::new("bodies")
        .with_body(Body::fixed("ball", ShapeKind::Sphere { radius: 0.5 }, Vec3::ZERO))
        .with_body(turned)
        .with_body(Body::fixed("pill", ShapeKind::Capsule { half_height: 0.5, radius: 0.25 }, Vec3::X * 6.0))
        .with_body(Body::fixed("floor", ShapeKind::Plane, Vec3::NEG_Y * 2.0));
    let world = common::world(&scene);
    assert_hit(&world, ray([0.0, 3.0, 0.0], [0.0, -2.0, 0.0]), 2.5, Vec3::Y, Surface::Body(0));
    // Beside the axis of a ball.
    let height = 0.4_f32;
    assert_hit(
        &world,
        ray([0.3, 3.0, 0.0], [0.0, -1.0, 0.0]),
        3.0 - height,
        Vec3::new(0.6, 0.8, 0.0),
        Surface::Body(0),
    );
    assert_hit(&world, ray([3.1, 3.0, 0.1], [0.0, -1.0, 0.0]), 2.5, Vec3::Y, Surface::Body(1));
    assert_hit(&world, ray([3.1, 0.0, 5.0], [0.0, 0.0, -1.0]), 4.7, Vec3::Z, Surface::Body(1));
    assert_hit(&world, ray([9.0, 0.3, 0.0], [-1.0, 0.0, 0.0]), 2.75, Vec3::X, Surface::Body(2));
    assert_hit(&world, ray([6.0, 3.0, 0.0], [0.0, -1.0, 0.0]), 2.25, Vec3::Y, Surface::Body(2));
    let slanted = Ray { direction: Vec3::new(1.0, -1.0, 0.0), ..ray([10.0, 0.0, 0.0], [0.0; 3]) };
    assert_hit(&world, slanted, 2.0 * 2.0_f32.sqrt(), Vec3::Y, Surface::Body(3));
    // From inside at once, up from the floor never, and not beyond the end.
    assert_eq!(first(&world, ray([0.1, 0.0, 0.0], [1.0, 0.0, 0.0])).map(|hit| hit.0), Some(0.0));
    assert_eq!(first(&world, ray([20.0, 1.0, 0.0], [0.0, 1.0, 0.0])), None);
    assert_eq!(first(&world, Ray { length: 2.4, ..ray([0.0, 3.0, 0.0], [0.0, -1.0, 0.0]) }), None);
    let only = Targets { bodies: false, ..Targets::ALL };
    let hits = world.cast_rays(&[ray([0.0, 3.0, 0.0], [0.0, -1.0, 0.0])], only);
    assert_eq!(hits.as_deref(), Ok(&[None][..]));
}

/// A pool 40 mm deep on one side of a box, and a saturated sponge on the other.
fn pool() -> Scene {
    let (low, high) = (Vec3::new(-0.1, 0.0, -0.05), Vec3::new(0.1, 0.1, 0.05));
    let block = FluidBlock::new(low, Vec3::new(0.0, 0.04, 0.05));
    let fluid = Fluid { blocks: vec![block], solver: Some(FluidSolver::Divergence), ..Fluid::default() };
    let sponge = Sponge {
        cells: UVec3::new(4, 4, 4),
        edge: 0.01,
        saturation: 1.0,
        ..Sponge::new("sponge", Vec3::new(0.04, 0.0, -0.02))
    };
    Scene::new("pool").in_box(low, high).with_fluid(fluid).with_sponge(sponge)
}

#[test]
fn rays_meet_sponges_and_water_where_they_are() {
    let world = common::world(&pool());
    // The faces of a block have pits, half a cell deep.
    for (origin, direction, distance) in
        [([0.06, 1.0, 0.0], [0.0, -1.0, 0.0], 0.96), ([1.0, 0.02, 0.0], [-1.0, 0.0, 0.0], 0.92)]
    {
        for beside in [0.0, 0.002, 0.004] {
            let ray = ray([origin[0], origin[1], origin[2] + beside], direction);
            let hit = first(&world, ray).unwrap_or_else(|| panic!("a sponge"));
            assert!(hit.0 > distance - 1e-5 && hit.0 < distance + 0.0051, "{hit:?}");
            assert!(hit.1.dot(-ray.direction) > 0.7 && hit.2 == Surface::Sponge(0), "{hit:?}");
        }
    }
    let spacing = pool().fluid.map_or(0.0, |fluid| fluid.spacing);
    let hit = first(&world, ray([-0.05, 1.0, 0.0], [0.0, -1.0, 0.0])).unwrap_or_else(|| panic!("water"));
    assert!((hit.0 - 0.96).abs() < 0.25 * spacing && hit.2 == Surface::Water, "{hit:?}");
    assert!(hit.1.distance(Vec3::Y) < 0.05, "{}", hit.1);
    let side = first(&world, ray([0.03, 0.02, 0.0], [-1.0, 0.0, 0.0])).unwrap_or_else(|| panic!("water"));
    assert!((side.0 - 0.03).abs() < 0.25 * spacing && side.1.distance(Vec3::X) < 0.1, "{side:?}");
    assert_eq!(first(&world, ray([0.02, 1.0, 0.0], [0.0, -1.0, 0.0])), None, "between them");
    let solid = world.cast_rays(&[ray([-0.05, 1.0, 0.0], [0.0, -1.0, 0.0])], Targets::SOLID);
    assert_eq!(solid.as_deref(), Ok(&[None][..]));
}

#[test]
fn water_stands_as_high_as_it_was_filled_everywhere() {
    let mut world = common::world(&pool());
    let spacing = pool().fluid.map_or(0.0, |fluid| fluid.spacing);
    let places = [[-0.05, 0.0], [-0.1, -0.05], [-0.0999, 0.0], [-0.05, 0.05], [-0.03, 0.02]];
    let levels = |world: &World| world.water_levels(&places).unwrap_or_else(|error| panic!("{error}"));
    for level in levels(&world) {
        assert!((level.unwrap_or(0.0) - 0.04).abs() < 0.25 * spacing, "{level:?}");
    }
    assert_eq!(world.water_levels(&[[0.02, 0.0], [5.0, 5.0]]), Ok(vec![None, None]));
    // Negative control: half of it is taken away.
    let region = Region::Box { minimum: Vec3::new(-1.0, 0.02, -1.0), maximum: Vec3::new(0.03, 1.0, 1.0) };
    world.push(Command::Remove { region }).unwrap_or_else(|error| panic!("{error}"));
    common::steps(&mut world, 1);
    for level in levels(&world) {
        assert!((level.unwrap_or(0.0) - 0.02).abs() < 0.3 * spacing, "{level:?}");
    }
}

#[test]
fn points_have_the_pressure_of_water_at_rest_and_the_saturation_of_the_sponge() {
    let world = common::world(&pool());
    let points =
        [Vec3::new(-0.05, 0.01, 0.0), Vec3::new(-0.05, 0.03, 0.0), Vec3::new(0.06, 0.02, 0.0), Vec3::ONE];
    let found = world.probe(&points).unwrap_or_else(|error| panic!("{error}"));
    for (probe, depth) in found.iter().zip([0.03, 0.01]) {
        let expected = 1000.0 * 9.81 * depth;
        assert!((probe.pressure - expected).abs() < 60.0, "{} Pa instead of {expected}", probe.pressure);
        assert!((probe.density - 1000.0).abs() < 40.0 && (probe.filled - 1.0).abs() < 0.04, "{probe:?}");
        assert_eq!((probe.velocity, probe.sponge), (Vec3::ZERO, None));
    }
    let sponge = found[2].sponge.unwrap_or_else(|| panic!("it is in the sponge"));
    assert!((sponge.saturation - 1.0).abs() < 0.15, "{sponge:?}");
    assert!((sponge.volume_ratio - 1.0).abs() < 1e-4 && sponge.sponge == 0, "{sponge:?}");
    let porosity = pool().sponges[0].porosity;
    assert!((found[2].filled - porosity).abs() < 0.15, "{} of {porosity}", found[2].filled);
    // Negative control: far from everything.
    assert_eq!(found[3], sorb::Probe::default());
    assert_eq!(world.probe(&[]), Ok(Vec::new()));
}

#[test]
fn water_in_pores_has_the_pressure_of_water_beside_them() {
    // A solve for the density keeps pores less exactly.
    for (solver, tolerance) in [(FluidSolver::Divergence, 0.1), (FluidSolver::Dfsph, 0.4)] {
        let mut scene = pool();
        scene.sponges[0].porosity = 0.6;
        // Its material is as dense as water, so that it rests wherever it is.
        scene.sponges[0].density = 400.0;
        scene.sponges[0].entry_pressure = 0.0;
        if let Some(fluid) = &mut scene.fluid {
            fluid.solver = Some(solver);
            let (low, high) = (Vec3::new(-0.1, 0.0, -0.05), Vec3::new(0.1, 0.06, 0.05));
            fluid.blocks = vec![FluidBlock::new(low, high)];
        }
        let mut world = common::world(&scene);
        let points = [0.012, 0.02, 0.028].map(|y| Vec3::new(0.06, y, 0.0));
        let (mut in_pores, mut of_particles, mut expected) = (0.0, 0.0, 0.0);
        for frame in 0..30 {
            common::frame(&mut world);
            if frame < 15 {
                continue;
            }
            let level = world.water_levels(&[[-0.05, 0.0]]).unwrap_or_else(|error| panic!("{error}"))[0];
            for probe in world.probe(&points).unwrap_or_else(|error| panic!("{error}")) {
                in_pores += probe.sponge.map_or(f32::NAN, |sponge| sponge.pore_pressure);
                of_particles += probe.pressure;
            }
            expected +=
                points.iter().map(|point| 9810.0 * (level.unwrap_or(f32::NAN) - point.y)).sum::<f32>();
        }
        let error = |found: f32| (found / expected - 1.0).abs();
        assert!(error(in_pores) < tolerance, "{solver:?}: {in_pores} of {expected}");
        // Negative control: without the porosity.
        assert!(error(of_particles) > 0.6, "{solver:?}: {of_particles} of {expected}");
    }
}

#[test]
fn points_move_with_the_water_and_the_sponge() {
    let mut scene = pool();
    let velocity = Vec3::new(0.3, 0.2, -0.1);
    if let Some(fluid) = &mut scene.fluid {
        fluid.blocks[0].velocity = velocity;
    }
    scene.sponges[0].velocity = -velocity;
    let world = common::world(&scene);
    let points = [Vec3::new(-0.05, 0.02, 0.0), Vec3::new(0.06, 0.02, 0.0)];
    let found = world.probe(&points).unwrap_or_else(|error| panic!("{error}"));
    assert!(found[0].velocity.distance(velocity) < 1e-5, "{}", found[0].velocity);
    let sponge = found[1].sponge.map(|sponge| sponge.velocity);
    assert!(sponge.is_some_and(|own| own.distance(-velocity) < 1e-5), "{sponge:?}");
}

#[test]
fn bad_questions_are_refused() {
    let world = common::world(&pool());
    let good = ray([0.0; 3], [0.0, 1.0, 0.0]);
    let refused = |ray: Ray, expected: &str| {
        let error = world.cast_rays(&[good, ray], Targets::ALL).expect_err(expected).to_string();
        assert!(error.contains(expected), "{error}");
    };
    refused(
        ray([f32::NAN, 0.0, 0.0], [1.0; 3]),
        "query 1: origin = [NaN, 0, 0] is out of range -1000 to 1000 m",
    );
    refused(ray([0.0; 3], [0.0; 3]), "query 1: direction = [0, 0, 0] is out of range finite");
    refused(ray([0.0; 3], [f32::INFINITY; 3]), "direction");
    refused(Ray { length: -1.0, ..good }, "query 1: length = -1 is out of range 0 to 2000 m");
    refused(Ray { length: f32::NAN, ..good }, "length = NaN");
    let error = world.probe(&[Vec3::ZERO, Vec3::splat(1e9)]).expect_err("far").to_string();
    assert!(error.contains("query 1: point"), "{error}");
    assert!(world.water_levels(&[[f32::NAN, 0.0]]).is_err());
    let nothing = common::world(&Scene::new("nothing"));
    assert_eq!(nothing.cast_rays(&[good], Targets::ALL), Ok(vec![None]));
    assert_eq!(nothing.water_levels(&[[0.0, 0.0]]), Ok(vec![None]));
    assert_eq!(nothing.probe(&[Vec3::ZERO]), Ok(vec![sorb::Probe::default()]));
}

/// A ball of 1000 kg/m^3 above a floor, and what is pushed.
fn ball(height: f32) -> Scene {
    let (low, high) = (Vec3::new(-0.1, 0.0, -0.1), Vec3::new(0.1, 0.3, 0.1));
    let ball = Body::dynamic("ball", ShapeKind::Sphere { radius: 0.02 }, Vec3::Y * height, 1000.0);
    Scene::new("ball").in_box(low, high).with_body(ball)
}

fn loads(world: &World) -> BodyLoads {
    world.body_loads()[0]
}

const WEIGHT: f64 = 1000.0 * 4.0 / 3.0 * std::f64::consts::PI * 8e-6 * 9.81;

#[test]
fn a_ball_is_held_by_the_floor_and_by_nothing_while_it_falls() {
    let mut falling = common::world(&ball(0.25));
    assert!(falling.body_loads().is_empty());
    common::frame(&mut falling);
    let found = loads(&falling);
    assert!(found.contact.force.length() < 1e-4 * WEIGHT, "{found:?}");
    let mut lying = common::world(&ball(0.02));
    (0..60).for_each(|_| common::frame(&mut lying));
    let found = loads(&lying);
    assert!((found.contact.force - DVec3::Y * WEIGHT).length() < 0.02 * WEIGHT, "{found:?}");
    assert_eq!((found.fluid.force, found.sponges.force), (DVec3::ZERO, DVec3::ZERO));
    // A host lifts half of it.
    let force = Vec3::Y * (0.5 * WEIGHT as f32);
    lying
        .push(Command::Force { body: 0.into(), force, torque: Vec3::ZERO })
        .unwrap_or_else(|error| panic!("{error}"));
    (0..30).for_each(|_| common::frame(&mut lying));
    let found = loads(&lying);
    assert!((found.host.force.y / WEIGHT - 0.5).abs() < 1e-5, "{found:?}");
    assert!((found.contact.force.y / WEIGHT - 0.5).abs() < 0.02, "{found:?}");
}

#[test]
fn all_loads_together_are_the_change_of_momentum() {
    let block = FluidBlock::new(Vec3::new(-0.1, 0.0, -0.1), Vec3::new(0.1, 0.06, 0.1));
    let sponge = Sponge { cells: UVec3::splat(4), ..Sponge::new("sponge", Vec3::new(-0.02, 0.0, -0.02)) };
    let fluid = Fluid { blocks: vec![block], ..Fluid::default() };
    let mut world = common::world(&ball(0.065).with_fluid(fluid).with_sponge(sponge));
    let (mut by_sponges, mut by_fluid) = (0.0, 0.0);
    for frame in 0..20 {
        let before = world.bodies()[0].state.linear_velocity.as_dvec3();
        let time = world.clock().time;
        common::frame(&mut world);
        let after = world.bodies()[0].state.linear_velocity.as_dvec3();
        let BodyLoads { fluid, sponges, host, contact, .. } = loads(&world);
        let sum = fluid.force + sponges.force + host.force + contact.force - DVec3::Y * WEIGHT;
        let change = (after - before) * (WEIGHT / 9.81) / (world.clock().time - time);
        assert!((sum - change).length() < 2e-3 * WEIGHT, "frame {frame}: {sum} {change}");
        assert!((fluid.force - world.body_fluid_forces()[0]).length() == 0.0);
        by_sponges += sponges.force.length();
        by_fluid += fluid.force.length();
    }
    // Negative control: without one of them they are not.
    assert!(by_sponges > WEIGHT && by_fluid > 0.1 * WEIGHT, "{by_sponges} {by_fluid}");
    let mut bytes = Vec::new();
    world.save(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
    let restored = World::restore(&bytes[..], &Options::default()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((restored.body_loads(), restored.digest()), (world.body_loads(), world.digest()));
}
