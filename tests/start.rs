//! Changes by a host before the first step.

mod common;

use sorb::{
    World, WorldError,
    glam::Vec3,
    scene::{Body, Fluid, FluidBlock, Scene, ShapeKind, Sponge},
};

/// A cube of water in the open, whose block moves.
fn cube(velocity: Vec3) -> World {
    let block = FluidBlock { velocity, ..FluidBlock::new(Vec3::splat(-0.02), Vec3::splat(0.02)) };
    let fluid = Fluid { sound_speed: Some(5.0), blocks: vec![block], ..Fluid::default() };
    common::world(&Scene::new("cube").with_fluid(fluid))
}

fn set(world: &mut World, field: impl Fn(Vec3) -> Vec3) {
    world.set_particle_velocities(field).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn a_uniform_field_is_the_velocity_of_the_block() {
    let velocity = Vec3::new(0.5, -0.25, 1.0);
    let mut expected = cube(velocity);
    let mut set_later = cube(Vec3::ZERO);
    set(&mut set_later, |_| velocity);
    assert_eq!(set_later.digest(), expected.digest());
    common::steps(&mut expected, 5);
    common::steps(&mut set_later, 5);
    assert_eq!(set_later.digest(), expected.digest());
    // Negative control: another field.
    let mut other = cube(Vec3::ZERO);
    set(&mut other, |_| 1.001 * velocity);
    common::steps(&mut other, 5);
    assert_ne!(other.digest(), expected.digest());
}

#[test]
fn a_field_is_taken_at_the_position_of_every_particle() {
    let spin = |position: Vec3| Vec3::new(0.0, 3.0, 0.0).cross(position);
    let mut world = cube(Vec3::X);
    set(&mut world, spin);
    for (position, velocity) in world.particle_positions().iter().zip(world.particle_velocities()) {
        let [position, velocity] = [position, velocity].map(|row| Vec3::new(row[0], row[1], row[2]));
        assert_eq!(velocity, spin(position));
    }
    // The new velocities bound the step.
    let mut still = cube(Vec3::ZERO);
    set(&mut world, |_| Vec3::new(50.0, 0.0, 0.0));
    let (fast, slow) = (world.step(), still.step());
    assert!(fast.is_ok_and(|fast| slow.is_ok_and(|slow| fast.step < 0.1 * slow.step)));
}

#[test]
fn what_is_out_of_range_or_too_late_is_refused_and_changes_nothing() {
    let mut world = cube(Vec3::X);
    let digest = world.digest();
    for bad in [f32::NAN, f32::INFINITY, -100.5] {
        let refused =
            world.set_particle_velocities(|at| Vec3::new(0.0, if at.x > 0.01 { bad } else { 1.0 }, 0.0));
        let text = refused.expect_err("a bad velocity").to_string();
        assert!(text.contains("particle ") && text.contains("100 m/s"), "{text}");
        assert_eq!(world.digest(), digest, "{bad}");
    }
    common::steps(&mut world, 1);
    let late = world.set_particle_velocities(|_| Vec3::ZERO).expect_err("too late");
    assert!(matches!(late, WorldError::Started { steps: 1 }), "{late}");
}

/// A sponge of 8 cm, and a ball that begins at a height above its bottom.
fn sponge_and_ball(height: f32) -> World {
    let sponge =
        Sponge { cells: [8, 8, 8].into(), edge: 0.01, ..Sponge::new("sponge", Vec3::new(-0.04, 0.0, -0.04)) };
    let ball = Body::dynamic("ball", ShapeKind::Sphere { radius: 0.02 }, Vec3::Y * height, 500.0);
    let mut scene = Scene::new("embedded").with_sponge(sponge).with_body(ball);
    scene.gravity = Vec3::ZERO;
    common::world(&scene)
}

#[test]
fn a_sponge_leaves_room_for_a_body_that_begins_inside_it() {
    let (mut embedded, apart, touching) =
        (sponge_and_ball(0.041), sponge_and_ball(0.15), sponge_and_ball(0.1));
    let within = |world: &World| {
        let centre = Vec3::Y * 0.041;
        let nodes = world.node_positions().iter();
        nodes.filter(|x| Vec3::new(x[0], x[1], x[2]).distance(centre) < 0.0199).count()
    };
    assert_eq!(within(&embedded), 0);
    // Negative control: without the ball there are some, and contact takes none away.
    assert!(within(&apart) > 20);
    assert_eq!(touching.node_positions().len(), apart.node_positions().len());
    common::steps(&mut embedded, 100);
    let fastest =
        embedded.node_velocities().iter().flat_map(|v| v[..3].iter().map(|v| v.abs())).fold(0.0, f32::max);
    assert!(fastest < 1.0e-3, "nothing is flung out, but {fastest} m/s");
}
