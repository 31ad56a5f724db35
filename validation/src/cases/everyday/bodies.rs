//! Bodies that are thrown, roll, float and sink.

use sorb::{
    glam::Vec3,
    scene::{Body, Scene, ShapeKind},
};

use super::{DENSITY, Expectation, GRAVITY, advance, after, all, gravity, mean_over, pool, spacing, tank};
use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    level::heights,
    norms::mean,
};

pub(in crate::cases) static CASE: Case = Case {
    name: "everyday_bodies",
    title: "what anybody would try first with bodies, in water and without it",
    source: "free fall, rolling, Archimedes",
    subject: Subject::Water,
    control: "gravity of 6 m/s^2",
    run,
};

const EXPECTATIONS: &[Expectation] = &[
    (true, ball_comes_back),
    (true, ball_rolls),
    (true, steel_sinks),
    (false, wood_floats),
    (true, ball_weighs_less),
    (false, load_sinks_a_raft),
    (false, cup_is_a_boat),
    (false, cork_comes_up),
];

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    all(setting, EXPECTATIONS)
}

fn dry(setting: &Setting) -> Scene {
    Scene { gravity: gravity(setting), ..Scene::new("everyday") }
}

/// A ball that is thrown up at 1.5 m/s is where it was after 2 v / g.
fn ball_comes_back(setting: &Setting) -> Result<Figure, Failure> {
    let ball = Body { linear_velocity: Vec3::Y * 1.5, ..Body::default() };
    let mut world = setting.world(&dry(setting).with_body(ball))?;
    let mut last = (0.0, 0.0);
    let mut time = f64::NAN;
    advance(setting, &mut world, 0.5, |world| {
        let now = (world.clock().time, f64::from(world.bodies()[0].state.position.y));
        if last.1 > 0.0 && now.1 <= 0.0 && time.is_nan() {
            time = last.0 + (now.0 - last.0) * last.1 / (last.1 - now.1);
        }
        last = now;
    })?;
    Ok(Figure::relative(
        "time in which a ball thrown up at 1.5 m/s comes back",
        "s",
        3.0 / GRAVITY,
        time,
        0.01,
    ))
}

/// A ball rolls down a slope of ten degrees: 5/7 of what slides.
fn ball_rolls(setting: &Setting) -> Result<Figure, Failure> {
    let angle = 10_f64.to_radians();
    let down = Vec3::new(libm::sin(angle) as f32, -libm::cos(angle) as f32, 0.0);
    let floor = Body::fixed("floor", ShapeKind::Plane, Vec3::ZERO);
    let ball = Body { position: Vec3::Y * 0.03, friction: 1.0, ..Body::default() };
    let mut scene = dry(setting).with_body(ball).with_body(floor);
    scene.gravity = down * scene.gravity.length();
    let world = after(setting, &scene, 0.5)?;
    let due = 0.5 * 5.0 / 7.0 * GRAVITY * libm::sin(angle) * world.clock().time.powi(2);
    let way = f64::from(world.bodies()[0].state.position.x);
    Ok(Figure::relative("way of a ball down a slope of 10 degrees in 0.5 s", "m", due, way, 0.03))
}

/// Radius of balls in water \[m\].
const BALL: f32 = 0.015;

fn ball(density: f32, height: f32) -> Body {
    Body::dynamic("ball", ShapeKind::Sphere { radius: BALL }, Vec3::Y * height, density)
}

/// A ball of steel lies on the floor.
fn steel_sinks(setting: &Setting) -> Result<Figure, Failure> {
    let scene = tank(setting, (0.06, 0.12), pool(0.06, 0.06)).with_body(ball(7800.0, 0.09));
    let world = after(setting, &scene, 0.6)?;
    let above = f64::from(world.bodies()[0].state.position.y - BALL);
    Ok(Figure::error("height of a ball of steel above the floor after 0.6 s", "m", above.abs(), 1e-3))
}

/// A ball of half the density of water floats with its centre in the surface.
fn wood_floats(setting: &Setting) -> Result<Figure, Failure> {
    let scene = tank(setting, (0.06, 0.12), pool(0.06, 0.05)).with_body(ball(500.0, 0.08));
    let mut world = setting.world(&scene)?;
    let above = mean_over(setting, &mut world, (1.5, 2.5), |world| {
        let corners = [(-0.045, -0.045), (0.045, -0.045), (-0.045, 0.045), (0.045, 0.045)];
        f64::from(world.bodies()[0].state.position.y) - mean(heights(world, &corners))
    })?;
    let name = "centre of a ball of half the density above the water, over spacings";
    Ok(Figure::over(name, "m", (0.0, above), spacing(setting), 0.5))
}

/// A ball that is held under water is pushed up by the weight of what it displaces.
fn ball_weighs_less(setting: &Setting) -> Result<Figure, Failure> {
    let held = Body::fixed("held", ShapeKind::Sphere { radius: 0.02 }, Vec3::Y * 0.035);
    let mut world = setting.world(&tank(setting, (0.06, 0.12), pool(0.06, 0.07)).with_body(held))?;
    let force = mean_over(setting, &mut world, (0.5, 0.8), |world| world.body_loads()[0].fluid.force.y)?;
    let volume = 4.0 / 3.0 * std::f64::consts::PI * 0.02_f64.powi(3);
    Ok(Figure::relative("force of water on a ball held in it", "N", DENSITY * GRAVITY * volume, force, 0.05))
}

/// A slab of 12 cm with a load on it floats deeper by the load over density and area.
fn load_sinks_a_raft(setting: &Setting) -> Result<Figure, Failure> {
    let slab = |name: &str, half: f32, thick: f32, y: f32, density: f32| {
        let half_extents = Vec3::new(half, 0.5 * thick, half);
        Body::dynamic(name, ShapeKind::Cuboid { half_extents }, Vec3::Y * y, density)
    };
    let height = |density: f32| -> Result<f64, Failure> {
        let scene = tank(setting, (0.09, 0.16), pool(0.09, 0.05))
            .with_body(slab("raft", 0.06, 0.03, 0.06, 300.0))
            .with_body(slab("load", 0.03, 0.02, 0.086, density));
        let mut world = setting.world(&scene)?;
        mean_over(setting, &mut world, (1.5, 2.5), |world| {
            let corners = [(-0.075, -0.075), (0.075, -0.075), (-0.075, 0.075), (0.075, 0.075)];
            mean(heights(world, &corners)) - f64::from(world.bodies()[0].state.position.y)
        })
    };
    // 0.36 and 7.2 * 1.5 hundredths of a kilogram on 0.0144 square metres.
    let deeper = height(1600.0)? - height(100.0)?;
    let due = 1500.0 * 0.06 * 0.06 * 0.02 / (DENSITY * 0.12 * 0.12);
    let name = "how much deeper a raft floats with a load, error over spacings";
    Ok(Figure::over(name, "m", (due, deeper), spacing(setting), 0.4))
}

/// A cup floats, and stays dry within.
fn cup_is_a_boat(setting: &Setting) -> Result<Figure, Failure> {
    let shape = ShapeKind::Cup { radius: 0.04, height: 0.06, thickness: 0.01 };
    let cup = Body::dynamic("cup", shape, Vec3::Y * 0.06, 500.0);
    let scene = tank(setting, (0.1, 0.2), pool(0.1, 0.05)).with_body(cup);
    let mut world = setting.world(&scene)?;
    let inside = mean_over(setting, &mut world, (1.5, 2.0), |world| {
        let state = world.bodies()[0].state;
        let is_in = |row: &&[f32; 4]| {
            let own = state.rotation.conjugate() * (super::place(row) - state.position);
            own.with_y(0.0).length() < 0.04 && own.y > -0.01
        };
        world.particle_positions().iter().filter(is_in).count() as f64
    })?;
    Ok(Figure::error("particles in a cup that floats", "1", inside, 0.0))
}

/// A cork of a quarter of the density of water comes up from the floor, and not out of the water.
fn cork_comes_up(setting: &Setting) -> Result<Figure, Failure> {
    let scene = tank(setting, (0.06, 0.16), pool(0.06, 0.08)).with_body(ball(250.0, 0.02));
    let mut world = setting.world(&scene)?;
    let height =
        mean_over(setting, &mut world, (1.0, 2.0), |world| f64::from(world.bodies()[0].state.position.y))?;
    let corners = [(-0.045, -0.045), (0.045, -0.045), (-0.045, 0.045), (0.045, 0.045)];
    let level = mean(heights(&world, &corners));
    // A cap of a quarter of the volume is 0.653 radii high.
    let due = level + f64::from(BALL) * (1.0 - 0.653);
    let name = "height at which a cork of a quarter of the density floats, error over spacings";
    Ok(Figure::over(name, "m", (due, height), spacing(setting), 0.5))
}
