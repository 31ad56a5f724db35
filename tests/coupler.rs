//! Worlds of hosts that own their rigid bodies: the same bits as with the engine of the library, or an error.

#[path = "common/mod.rs"]
mod common;

use sorb::{
    Command, Coupler, Options, Snapshot, SubStep, World,
    glam::Vec3,
    rigid::{HostBody, RapierEngine, RigidEngine, body_setups},
    scene::{Body, Fluid, FluidBlock, Motion, Scene, ShapeKind, Sponge},
};

const LOW: Vec3 = Vec3::new(-0.05, 0.0, -0.05);
const HIGH: Vec3 = Vec3::new(0.05, 0.12, 0.05);

fn scene() -> Scene {
    let fluid = Fluid { blocks: vec![FluidBlock::new(LOW, HIGH.with_y(0.03))], ..Fluid::default() };
    let sponge = Sponge { cells: [3, 3, 3].into(), ..Sponge::new("sponge", Vec3::new(-0.045, 0.0, -0.045)) };
    let ball = Body::dynamic("ball", ShapeKind::Sphere { radius: 0.012 }, Vec3::new(0.02, 0.05, 0.02), 600.0);
    Scene::new("pool").in_box(LOW, HIGH).with_fluid(fluid).with_sponge(sponge).with_body(ball)
}

fn options() -> Options {
    Options { threads: Some(2), ..Options::default() }
}

/// The rigid bodies of a host.
fn own(scene: &Scene) -> RapierEngine {
    let setups = body_setups(scene).unwrap_or_else(|error| panic!("{error}"));
    RapierEngine::new(scene.gravity, Some((LOW, HIGH)), &setups).unwrap_or_else(|error| panic!("{error}"))
}

fn step(engine: &mut RapierEngine, step: &mut SubStep<'_>) {
    engine.step(step.length, step.wrenches).unwrap_or_else(|error| panic!("{error}"));
    say(engine, step.bodies);
}

/// What a host says of its bodies.
fn say(engine: &RapierEngine, bodies: &mut [HostBody]) {
    for (index, body) in bodies.iter_mut().enumerate() {
        body.state = engine.state(index);
        (body.inverse_mass, body.inverse_inertia) =
            (engine.inverse_mass(index), engine.inverse_inertia(index));
    }
}

fn coupler(scene: &Scene) -> Coupler {
    Coupler::new(scene, &options()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_host_that_steps_rapier_gets_the_bits_of_the_library() {
    let scene = scene();
    let (mut coupler, mut engine) = (coupler(&scene), own(&scene));
    let mut library = common::world(&scene);
    coupler.tell(|bodies| say(&engine, bodies)).unwrap_or_else(|error| panic!("{error}"));
    let mut deaf = coupler.clone();
    for frame in 1..=20 {
        // Frames of the library end at these times.
        let left = f64::from(frame) / 60.0 - coupler.world().clock().time;
        let steps =
            coupler.advance(left, |sub| step(&mut engine, sub)).unwrap_or_else(|error| panic!("{error}"));
        let report = library.advance_frame().unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(steps, report.steps);
        assert!(coupler.world().particle_positions() == library.particle_positions());
        assert!(coupler.world().node_positions() == library.node_positions());
        assert_eq!(coupler.world().bodies()[0].state, library.bodies()[0].state);
        // The control: a host that ignores what it is told.
        deaf.advance(left, |_| {}).unwrap_or_else(|error| panic!("{error}"));
    }
    assert!(deaf.world().particle_positions() != library.particle_positions());
    let loads = coupler.world().body_loads();
    assert!(loads[0].fluid.force.y > 0.0, "{loads:?}");
}

#[test]
fn commands_saves_and_roll_backs_work_in_a_coupler() {
    let scene = scene();
    let (mut coupler, mut engine) = (coupler(&scene), own(&scene));
    let advance = |coupler: &mut Coupler, engine: &mut RapierEngine| {
        coupler.advance(0.01, |sub| step(engine, sub)).unwrap_or_else(|error| panic!("{error}"));
        coupler.world().digest()
    };
    advance(&mut coupler, &mut engine);
    let force = Command::Force { body: 0.into(), force: Vec3::X * 0.1, torque: Vec3::ZERO };
    coupler.world_mut().push(force).unwrap_or_else(|error| panic!("{error}"));
    advance(&mut coupler, &mut engine);
    assert!(coupler.world().bodies()[0].state.linear_velocity.x > 0.01, "the host was told");
    // What the host does itself is refused.
    let (linear_velocity, angular_velocity) = (Vec3::ZERO, Vec3::ZERO);
    let velocity = Command::Velocity { body: 0.into(), linear_velocity, angular_velocity };
    assert!(coupler.world_mut().push(velocity).is_err());
    let (save, kept) = (coupler.world().to_save(), engine.clone());
    let save = save.unwrap_or_else(|error| panic!("{error}"));
    let mut snapshot = Snapshot::new();
    coupler.world().snapshot_into(&mut snapshot);
    let expected = advance(&mut coupler, &mut engine);
    coupler.world_mut().rollback(&snapshot).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(advance(&mut coupler, &mut kept.clone()), expected, "rolled back");
    coupler.world_mut().resume(&save).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(advance(&mut coupler, &mut kept.clone()), expected, "resumed");
}

#[test]
fn what_a_coupler_cannot_do_is_an_error() {
    let mut sleepy = scene();
    sleepy.time.sleep_after = 1.0;
    let text = |scene: &Scene| {
        Coupler::new(scene, &options()).err().map(|error| error.to_string()).unwrap_or_default()
    };
    assert!(text(&sleepy).contains("`time.sleep_after` = 1: must be 0 in a coupler"), "{}", text(&sleepy));
    let slide = Motion::Linear { velocity: Vec3::X, start: 0.0, end: 1.0, ease: 0.0 };
    let plate = Body::kinematic("plate", ShapeKind::Sphere { radius: 0.01 }, Vec3::Y * 0.1, vec![slide]);
    let moved = scene().with_body(plate);
    assert!(
        text(&moved).contains("`bodies[1].motions` = (1 motions): must be empty in a coupler"),
        "{}",
        text(&moved)
    );
    let mut coupler = coupler(&scene());
    assert!(coupler.advance(f64::NAN, |_| {}).is_err() && coupler.advance(0.0, |_| {}).is_err());
    let lost = coupler.advance(0.01, |sub| sub.bodies[0].state.position = Vec3::NAN);
    assert!(lost.is_err_and(|error| error.to_string().contains("body number 0: position = [NaN, NaN, NaN]")));
    assert!(coupler.tell(|bodies| bodies[0].inverse_mass = -1.0).is_err());
    // It has failed, and stays so.
    assert!(coupler.advance(0.01, |_| {}).is_err());
    // The control.
    assert!(World::new(&scene()).is_ok() && text(&scene()).is_empty());
}
