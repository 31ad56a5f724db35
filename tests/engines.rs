//! Rigid-body engines of hosts: the same bits as those of the library, or an error that says what is missing.

mod common;

use std::any::Any;

use sorb::{
    Command, Options, Player, Recorder, World,
    glam::{DVec3, Mat3, Quat, Vec3},
    rigid::{BodyKind, BodyState, RapierEngine, RigidEngine, RigidError, Target, Wrench, body_setups},
    scene::{Body, Fluid, FluidBlock, Scene, ShapeKind},
};

/// How an engine of a host is wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    /// It ignores what fluid and sponges do to its bodies.
    Deaf,
    /// It has only what every engine must have.
    Bare,
    /// Its bodies are nowhere after a few steps.
    Lost,
    Turned,
    Massless,
    OtherKind,
    OneMore,
}

/// rapier3d as a host would wrap it.
#[derive(Clone, Debug)]
struct Own {
    inner: RapierEngine,
    fault: Fault,
    steps: u32,
}

impl RigidEngine for Own {
    fn body_count(&self) -> usize {
        self.inner.body_count() + usize::from(self.fault == Fault::OneMore)
    }
    fn kind(&self, index: usize) -> BodyKind {
        if self.fault == Fault::OtherKind { BodyKind::Fixed } else { self.inner.kind(index) }
    }
    fn state(&self, index: usize) -> BodyState {
        let state = self.inner.state(index);
        match self.fault {
            Fault::Lost if self.steps > 3 => BodyState { position: Vec3::NAN, ..state },
            Fault::Turned => BodyState { rotation: Quat::from_xyzw(0.0, 0.0, 0.0, 2.0), ..state },
            _ => state,
        }
    }
    fn inverse_mass(&self, index: usize) -> f32 {
        if self.fault == Fault::Massless { f32::INFINITY } else { self.inner.inverse_mass(index) }
    }
    fn inverse_inertia(&self, index: usize) -> Mat3 {
        self.inner.inverse_inertia(index)
    }
    fn step(&mut self, dt: f32, wrenches: &[Wrench]) -> Result<(), RigidError> {
        self.steps += 1;
        let none = vec![Wrench { impulse: DVec3::ZERO, angular_impulse: DVec3::ZERO }; wrenches.len()];
        self.inner.step(dt, if self.fault == Fault::Deaf { &none } else { wrenches })
    }
    fn wait(&mut self, time: f64) {
        self.inner.wait(time);
    }
    fn hold(&mut self, index: usize, is_held: bool) {
        self.inner.hold(index, is_held);
    }
    fn boxed_clone(&self) -> Box<dyn RigidEngine> {
        Box::new(self.clone())
    }
    fn as_any(&self) -> Option<&dyn Any> {
        Some(self)
    }
    fn save(&self, out: &mut Vec<u8>) -> Result<(), RigidError> {
        if self.fault == Fault::Bare {
            return Err(RigidError::Unsupported { what: "saves" });
        }
        self.inner.save(out)
    }
    fn restore(&mut self, bytes: &[u8]) -> Result<(), RigidError> {
        self.inner.restore(bytes)
    }
    fn set_velocity(&mut self, index: usize, linear: Vec3, angular: Vec3) -> Result<(), RigidError> {
        if self.fault == Fault::Bare {
            return Err(RigidError::Unsupported { what: "velocities from outside" });
        }
        self.inner.set_velocity(index, linear, angular)
    }
    fn set_target(&mut self, index: usize, target: Target) -> Result<(), RigidError> {
        self.inner.set_target(index, target)
    }
    fn set_gravity(&mut self, gravity: Vec3) -> Result<(), RigidError> {
        if self.fault == Fault::Bare {
            return Err(RigidError::Unsupported { what: "another gravity" });
        }
        self.inner.set_gravity(gravity)
    }
}

const LOW: Vec3 = Vec3::new(-0.05, 0.0, -0.05);
const HIGH: Vec3 = Vec3::new(0.05, 0.12, 0.05);

/// A ball above water.
fn scene() -> Scene {
    let water = FluidBlock::new(LOW, Vec3::new(0.05, 0.03, 0.05));
    Scene::new("ball")
        .in_box(LOW, HIGH)
        .with_fluid(Fluid { blocks: vec![water], ..Fluid::default() })
        .with_body(Body::dynamic("ball", ShapeKind::Sphere { radius: 0.015 }, Vec3::Y * 0.05, 400.0))
}

fn engine(fault: Fault) -> Box<dyn RigidEngine> {
    let (scene, corners) = (scene(), Some((LOW, HIGH)));
    let setups = body_setups(&scene).unwrap_or_else(|error| panic!("{error}"));
    let inner = RapierEngine::new(scene.gravity, corners, &setups).unwrap_or_else(|error| panic!("{error}"));
    Box::new(Own { inner, fault, steps: 0 })
}

fn own(fault: Fault) -> World {
    World::with_engine(&scene(), engine(fault), &Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn frames(world: &mut World, count: u32) {
    (0..count).for_each(|_| common::frame(world));
}

#[test]
fn an_engine_of_a_host_gives_the_bits_of_the_same_engine_in_the_library() {
    let (mut by_host, mut by_library) = (own(Fault::None), common::world(&scene()));
    frames(&mut by_host, 20);
    frames(&mut by_library, 20);
    assert_eq!(by_host.digest(), by_library.digest());
    // Negative control.
    let mut deaf = own(Fault::Deaf);
    frames(&mut deaf, 20);
    assert_ne!(deaf.digest(), by_library.digest());
    assert!(deaf.bodies()[0].state.position.y < by_host.bodies()[0].state.position.y - 0.002);
}

#[test]
fn a_save_goes_on_in_a_world_of_the_same_engine_only() {
    let mut world = own(Fault::None);
    frames(&mut world, 5);
    let mut bytes = Vec::new();
    world.save(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
    let error = World::restore(&bytes[..], &Options::default()).map(|_| ()).expect_err("another engine");
    assert!(error.to_string().contains("moved by an engine of a host: `resume` it"), "{error}");
    let save = sorb::Save::read(&bytes[..]).unwrap_or_else(|error| panic!("{error}"));
    let mut other = own(Fault::None);
    other.resume(&save).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(other.digest(), world.digest());
    frames(&mut world, 5);
    frames(&mut other, 5);
    assert_eq!(other.digest(), world.digest());
    // A save of the library in a world of a host.
    let library = common::world(&scene()).to_save().unwrap_or_else(|error| panic!("{error}"));
    let before = world.digest();
    let error = world.resume(&library).expect_err("another engine");
    assert!(error.to_string().contains("moved by an engine of the library"), "{error}");
    assert_eq!(world.digest(), before, "nothing has changed");
}

#[test]
fn a_recording_plays_in_a_world_of_the_same_engine() {
    let mut world = own(Fault::None);
    let mut recorder = Recorder::new(&world, Some(4)).unwrap_or_else(|error| panic!("{error}"));
    for frame in 0..10 {
        if frame == 3 {
            let (linear_velocity, angular_velocity) = (Vec3::new(0.1, 0.2, 0.0), Vec3::X);
            let command = Command::Velocity { body: 0.into(), linear_velocity, angular_velocity };
            recorder.push(&mut world, command).unwrap_or_else(|error| panic!("{error}"));
        }
        recorder.advance_frame(&mut world).unwrap_or_else(|error| panic!("{error}"));
    }
    let recording = recorder.into_recording();
    let mut player = Player::in_world(&recording, own(Fault::None)).unwrap_or_else(|error| panic!("{error}"));
    while player.advance().unwrap_or_else(|error| panic!("{error}")) {}
    assert_eq!(player.world().digest(), world.digest());
    player.seek(2).unwrap_or_else(|error| panic!("{error}"));
    assert!(player.advance().unwrap_or_else(|error| panic!("{error}")));
    // Negative controls: another engine, and another scene.
    let mut deaf = Player::in_world(&recording, own(Fault::Deaf)).unwrap_or_else(|error| panic!("{error}"));
    let error = (0..10).find_map(|_| deaf.advance().err()).expect("another engine");
    assert!(error.to_string().contains("instead of"), "{error}");
    let other = common::world(&Scene::new("space"));
    let error = Player::in_world(&recording, other).map(|_| ()).expect_err("another scene");
    assert!(error.to_string().contains("scene `ball`"), "{error}");
}

#[test]
fn what_an_engine_lacks_is_refused_before_anything_changes() {
    let mut world = own(Fault::Bare);
    let error = world.save(Vec::new()).expect_err("no saves");
    assert!(error.to_string().contains("the rigid-body engine supports no saves"), "{error}");
    assert!(world.try_digest().is_err() && Recorder::new(&world, None).is_err());
    let (linear_velocity, angular_velocity) = (Vec3::X, Vec3::ZERO);
    let error = world.push(Command::Velocity { body: 0.into(), linear_velocity, angular_velocity });
    let error = error.expect_err("no velocities").to_string();
    assert!(error.contains("`velocity.body` = 0: the rigid-body engine supports no velocities"), "{error}");
    assert!(world.push(Command::Gravity { gravity: Vec3::ZERO }).is_err());
    frames(&mut world, 2);
    // Forces go through the wrenches, which every engine has.
    let error = world.push(Command::RemoveBody { body: 0.into() });
    let error = error.err().map(|error| error.to_string()).unwrap_or_default();
    assert!(
        error.contains("`remove_body.body` = 0: the rigid-body engine supports no bodies that come"),
        "{error}"
    );
    let force = Command::Force { body: 0.into(), force: Vec3::X, torque: Vec3::ZERO };
    world.push(force).unwrap_or_else(|error| panic!("{error}"));
    frames(&mut world, 1);
    assert!(world.bodies()[0].state.linear_velocity.x > 0.1);
}

#[test]
fn engines_of_other_bodies_are_refused() {
    let refused = |fault, expected: &str| {
        let built = World::with_engine(&scene(), engine(fault), &Options::default());
        let error = built.map(|_| ()).expect_err("wrong").to_string();
        assert!(error.contains(expected), "{error}");
    };
    refused(Fault::OneMore, "it has 2 bodies, and the scene has 1");
    refused(Fault::OtherKind, "body `ball` is Fixed in it, and Dynamic in the scene");
    refused(Fault::Turned, "is not of unit length");
    refused(Fault::Massless, "inverse mass = inf 1/kg is out of range: finite and above 0");
    let mut lost = own(Fault::Lost);
    let error = (0..20).find_map(|_| lost.step().err()).expect("a body is nowhere");
    assert!(error.to_string().contains("body number 0: position = [NaN, NaN, NaN] is not finite"), "{error}");
}
