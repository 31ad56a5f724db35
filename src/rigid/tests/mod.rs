#[cfg(feature = "rigid")]
mod bodies;
#[cfg(feature = "rigid")]
mod contacts;
mod errors;
#[cfg(feature = "rigid")]
mod hulls;
#[cfg(feature = "rigid")]
mod limits;
mod scripts;

use super::{BodyKind, BodySetup, BodyState, Motion, RigidEngine, Shape, Wrench};
use glam::{DVec3, Quat, Vec3};

#[cfg(feature = "rigid")]
const GRAVITY: Vec3 = Vec3::new(0.0, -9.81, 0.0);

fn at_rest(position: Vec3) -> BodyState {
    BodyState {
        position,
        rotation: Quat::IDENTITY,
        linear_velocity: Vec3::ZERO,
        angular_velocity: Vec3::ZERO,
    }
}

fn body(name: &str, kind: BodyKind, shape: Shape, position: Vec3) -> BodySetup {
    BodySetup {
        name: name.to_owned(),
        shape,
        kind,
        density: 800.0,
        state: at_rest(position),
        friction: 0.5,
        restitution: 0.0,
        motions: Vec::new(),
    }
}

fn ball(position: Vec3) -> BodySetup {
    body("ball", BodyKind::Dynamic, Shape::Sphere { radius: 0.02 }, position)
}

fn plate(motions: Vec<Motion>) -> BodySetup {
    let half_extents = Vec3::new(0.1, 0.01, 0.1);
    let plate = body("plate", BodyKind::Kinematic, Shape::Cuboid { half_extents }, Vec3::new(0.0, 0.1, 0.0));
    BodySetup { motions, ..plate }
}

fn step(engine: &mut dyn RigidEngine, dt: f32, count: usize) {
    let wrenches = vec![Wrench::default(); engine.body_count()];
    for _ in 0..count {
        engine.step(dt, &wrenches).expect("a step without wrenches succeeds");
    }
}

fn impulse(x: f64, y: f64, z: f64) -> Wrench {
    Wrench { impulse: DVec3::new(x, y, z), ..Wrench::default() }
}

fn bits(engine: &dyn RigidEngine) -> Vec<u32> {
    let mut bits = Vec::new();
    for index in 0..engine.body_count() {
        let state = engine.state(index);
        bits.extend(state.position.to_array().map(f32::to_bits));
        bits.extend(state.rotation.to_array().map(f32::to_bits));
        bits.extend(state.linear_velocity.to_array().map(f32::to_bits));
        bits.extend(state.angular_velocity.to_array().map(f32::to_bits));
    }
    bits
}

fn assert_close(found: Vec3, expected: Vec3, tolerance: f32) {
    assert!(found.distance(expected) <= tolerance, "found {found}, expected {expected} within {tolerance}");
}
