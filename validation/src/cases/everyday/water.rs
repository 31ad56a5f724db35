//! Water that falls, is poured, held, tilted and let out.

use sorb::{
    World,
    glam::Vec3,
    scene::{
        Axis, BlockShape, Body, Container, Drain, Emitter, Fluid, FluidBlock, Motion, Scene, ShapeKind,
        ViscosityIntegration,
    },
};

use super::{
    DENSITY, Expectation, GRAVITY, advance, after, all, mean_height, mean_over, pool, share, spacing, tank,
};
use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    level::heights,
    norms::mean,
};

pub(in crate::cases) static CASE: Case = Case {
    name: "everyday_water",
    title: "what anybody would try first with water",
    source: "free fall, weight, hydrostatics, conservation of mass and momentum",
    subject: Subject::Water,
    control: "gravity of 6 m/s^2",
    run,
};

const EXPECTATIONS: &[Expectation] = &[
    (true, drop_falls),
    (true, cup_weighs_its_water),
    (true, cup_loses_nothing),
    (false, cup_empties),
    (true, tap_fills),
    (true, drain_takes),
    (false, tilted_level),
    (false, level_behind_a_wall),
    (true, wall_holds),
    (false, jet_pushes),
    (false, paste_spreads),
    (false, cubes_apart),
    (true, drop_stays),
    (true, drop_slides),
];

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    all(setting, EXPECTATIONS)
}

/// A ball of water of 2 cm falls for a tenth of a second.
fn drop_falls(setting: &Setting) -> Result<Figure, Failure> {
    let (low, high) = (Vec3::new(-0.01, 0.1, -0.01), Vec3::new(0.01, 0.12, 0.01));
    let block = FluidBlock { shape: BlockShape::Ellipsoid, ..FluidBlock::new(low, high) };
    let mut world = setting.world(&tank(setting, (0.05, 0.15), vec![block]))?;
    let start = mean_height(world.particle_positions());
    advance(setting, &mut world, 0.1, |_| ())?;
    let fallen = start - mean_height(world.particle_positions());
    let due = 0.5 * GRAVITY * world.clock().time.powi(2);
    // Semi-implicit steps are ahead by half a step, of 4 ms at most.
    Ok(Figure::relative("a drop falls for 0.1 s", "m", due, fallen, 0.04))
}

/// Hollow of the cup: radius, height and thickness \[m\].
const CUP: (f32, f32, f32) = (0.03, 0.07, 0.008);

/// A cup with water to two thirds, two centimetres above the floor.
fn cup(setting: &Setting, motions: Vec<Motion>) -> Scene {
    let (radius, height, thickness) = CUP;
    let low = Vec3::new(-radius, 0.02 + thickness, -radius);
    let high = Vec3::new(radius, 0.02 + thickness + 0.04, radius);
    let shape = BlockShape::Cylinder { axis: Axis::Y };
    let block = FluidBlock { shape, ..FluidBlock::new(low, high) };
    let shape = ShapeKind::Cup { radius, height, thickness };
    let cup = if motions.is_empty() {
        Body::fixed("cup", shape, Vec3::Y * 0.02)
    } else {
        Body::kinematic("cup", shape, Vec3::Y * 0.02, motions)
    };
    tank(setting, (0.1, 0.2), vec![block]).with_body(cup)
}

/// What a full cup is pushed down by.
fn cup_weighs_its_water(setting: &Setting) -> Result<Figure, Failure> {
    let mut world = setting.world(&cup(setting, Vec::new()))?;
    let force = mean_over(setting, &mut world, (0.5, 0.8), |world| -world.body_loads()[0].fluid.force.y)?;
    let weight = GRAVITY * world.measures().water_mass;
    Ok(Figure::relative("weight of the water in a cup, on the cup", "N", weight, force, 0.03))
}

fn cup_loses_nothing(setting: &Setting) -> Result<Figure, Failure> {
    let world = after(setting, &cup(setting, Vec::new()), 1.0)?;
    let outside = share(&world, |point| point.with_y(0.0).length() > CUP.0 + 0.002 || point.y < 0.02);
    Ok(Figure::error("share of the water that a cup has lost in 1 s", "1", outside, 0.0))
}

/// Turned over in half a second.
fn cup_empties(setting: &Setting) -> Result<Figure, Failure> {
    let rate = std::f32::consts::PI / 0.4;
    let pivot = Vec3::new(0.0, 0.1, 0.0);
    let turn = Motion::Turn { axis: Vec3::Z, pivot, rate, start: 0.1, end: 0.6, ease: 0.1 };
    let world = after(setting, &cup(setting, vec![turn]), 1.5)?;
    let state = world.bodies()[0].state;
    let inside = share(&world, |point| {
        let own = state.rotation.conjugate() * (point - state.position);
        own.with_y(0.0).length() < CUP.0 && own.y.abs() < 0.5 * CUP.1
    });
    Ok(Figure::error("share of the water left in a cup that was turned over", "1", inside, 0.02))
}

/// Mass that a tap brings in a second.
fn tap_fills(setting: &Setting) -> Result<Figure, Failure> {
    let (radius, speed) = (0.02, 0.5);
    let mut scene = tank(setting, (0.06, 0.3), Vec::new());
    let (position, velocity) = (Vec3::Y * 0.28, Vec3::NEG_Y * speed as f32);
    scene.emitters = vec![Emitter { position, velocity, radius: radius as f32, ..Emitter::default() }];
    let world = after(setting, &scene, 1.0)?;
    let due = DENSITY * std::f64::consts::PI * radius * radius * speed;
    Ok(Figure::relative("mass out of a tap in 1 s", "kg", due, world.measures().water_mass, 0.05))
}

/// Mass that a drain takes in a second at a fifth of a kilogram a second.
fn drain_takes(setting: &Setting) -> Result<Figure, Failure> {
    let mut scene = tank(setting, (0.06, 0.1), pool(0.06, 0.04));
    let (minimum, maximum) = (Vec3::new(-0.06, 0.0, -0.06), Vec3::new(0.06, 0.01, 0.06));
    scene.drains = vec![Drain { minimum, maximum, rate: 0.2, ..Drain::default() }];
    let mut world = setting.world(&scene)?;
    let before = world.measures().water_mass;
    advance(setting, &mut world, 1.0, |_| ())?;
    let taken = before - world.measures().water_mass;
    Ok(Figure::relative("mass down a drain of 0.2 kg/s in 1 s", "kg", 0.2, taken, 0.02))
}

/// Slope of the water in a tank that was tilted by 15 degrees.
fn tilted_level(setting: &Setting) -> Result<Figure, Failure> {
    let angle = 15_f64.to_radians();
    let rate = angle as f32 / 0.4;
    let turn = Motion::Turn { axis: Vec3::Z, pivot: Vec3::ZERO, rate, start: 0.1, end: 0.7, ease: 0.2 };
    let scene = Scene {
        container: Container { motions: vec![turn] },
        ..tank(setting, (0.06, 0.12), pool(0.06, 0.04))
    };
    let mut world = setting.world(&scene)?;
    let slope = mean_over(setting, &mut world, (2.0, 3.0), |world| {
        let level = |x: f64| mean(heights(world, &[(x, -0.03), (x, 0.0), (x, 0.03)]));
        (level(-0.04) - level(0.04)) / 0.08
    })?;
    Ok(Figure::relative(
        "slope of the water in a tank tilted by 15 degrees",
        "1",
        libm::tan(angle),
        slope.abs(),
        0.05,
    ))
}

/// Water on one side of a wall that leaves a gap above the floor.
fn level_behind_a_wall(setting: &Setting) -> Result<Figure, Failure> {
    let block = FluidBlock::new(Vec3::new(-0.08, 0.0, -0.08), Vec3::new(-0.01, 0.08, 0.08));
    let half_extents = Vec3::new(0.01, 0.1, 0.1);
    let wall = Body::fixed("wall", ShapeKind::Cuboid { half_extents }, Vec3::new(0.0, 0.12, 0.0));
    let scene = tank(setting, (0.08, 0.2), vec![block]).with_body(wall);
    let mut world = setting.world(&scene)?;
    let difference = mean_over(setting, &mut world, (3.0, 4.0), |world| {
        let level = |x: f64| mean(heights(world, &[(x, -0.04), (x, 0.0), (x, 0.04)]));
        level(-0.045) - level(0.045)
    })?;
    let name = "levels on both sides of a wall with a gap, difference over spacings";
    Ok(Figure::over(name, "m", (0.0, difference), spacing(setting), 0.5))
}

/// A wall of 2 mm with water on one side.
fn wall_holds(setting: &Setting) -> Result<Figure, Failure> {
    let block = FluidBlock::new(Vec3::new(-0.06, 0.0, -0.06), Vec3::new(-0.001, 0.06, 0.06));
    let half_extents = Vec3::new(0.001, 0.1, 0.1);
    let wall = Body::fixed("wall", ShapeKind::Cuboid { half_extents }, Vec3::new(0.0, 0.095, 0.0));
    let world = after(setting, &tank(setting, (0.06, 0.12), vec![block]).with_body(wall), 1.0)?;
    let beyond = share(&world, |point| point.x > 0.0);
    Ok(Figure::error("share of the water that goes through a wall of 2 mm in 1 s", "1", beyond, 0.0))
}

/// A jet of 1 m/s hits a large plate without gravity: the force is the momentum that arrives.
fn jet_pushes(setting: &Setting) -> Result<Figure, Failure> {
    let half_extents = Vec3::new(0.01, 0.2, 0.2);
    let plate = Body::fixed("plate", ShapeKind::Cuboid { half_extents }, Vec3::X * 0.06);
    let fluid = Fluid { spacing: spacing(setting) as f32, ..Fluid::default() };
    let mut scene =
        Scene { gravity: Vec3::ZERO, ..Scene::new("everyday") }.with_fluid(fluid).with_body(plate);
    scene.emitters = vec![Emitter { velocity: Vec3::X, radius: 0.015, ..Emitter::default() }];
    let mut world = setting.world(&scene)?;
    advance(setting, &mut world, 0.1, |_| ())?;
    let before = (world.measures().water_mass, world.clock().time);
    let force = mean_over(setting, &mut world, (0.1, 0.2), |world| world.body_loads()[0].fluid.force.x)?;
    // On a device water comes once a frame: its mass lags, its rate does not. The speed is 1 m/s.
    let arrives = (world.measures().water_mass - before.0) / (world.clock().time - before.1);
    Ok(Figure::relative("force of a jet of 1 m/s on a plate", "N", arrives, force, 0.05))
}

/// A column of 100 Pa s on a floor without friction. A slice with the weight of a height h above it is stretched by
/// `1 / (1 + k h t)`, `k = density gravity / (3 viscosity)` (Trouton).
fn paste_spreads(setting: &Setting) -> Result<Figure, Failure> {
    let (height, viscosity, time) = (0.06, 100.0, 0.1);
    let block = FluidBlock::new(Vec3::new(-0.02, 0.0, -0.02), Vec3::new(0.02, height as f32, 0.02));
    let mut scene = tank(setting, (0.1, 0.1), vec![block]);
    if let Some(fluid) = &mut scene.fluid {
        fluid.viscosity = viscosity as f32;
        fluid.viscosity_integration = ViscosityIntegration::Implicit;
    }
    let mut world = setting.world(&scene)?;
    let start = mean_height(world.particle_positions());
    advance(setting, &mut world, time, |_| ())?;
    let fallen = start - mean_height(world.particle_positions());
    let k = DENSITY * GRAVITY / (3.0 * viscosity) * world.clock().time;
    // Mean over the slices of the lengths below them.
    let slices = 1000;
    let (mut below, mut sum) = (0.0, 0.0);
    for index in 0..slices {
        let length = height
            / f64::from(slices)
            / (1.0 + k * height * (1.0 - (f64::from(index) + 0.5) / f64::from(slices)));
        sum += below + 0.5 * length;
        below += length;
    }
    let due = 0.5 * height - sum / f64::from(slices);
    Ok(Figure::relative("fall of the middle of a column of 100 Pa s in 0.1 s", "m", due, fallen, 0.2))
}

/// Two cubes of water fall beside each other: the one that is higher arrives later.
fn cubes_apart(setting: &Setting) -> Result<Figure, Failure> {
    let cube = |x: f32, y: f32| FluidBlock::new(Vec3::new(x, y, -0.01), Vec3::new(x + 0.02, y + 0.02, 0.01));
    let mut world = setting.world(&tank(setting, (0.06, 0.25), vec![cube(-0.04, 0.05), cube(0.02, 0.2)]))?;
    let mut arrived = [f64::NAN; 2];
    advance(setting, &mut world, 0.3, |world| {
        for (is_second, time) in [false, true].into_iter().zip(&mut arrived) {
            let rows = world.particle_positions().iter().zip(world.particle_ids());
            // Numbers are those of the order of the blocks.
            let own = rows.filter(|(_, id)| (2 * **id as usize >= world.particle_count()) == is_second);
            let lowest = own.map(|(row, _)| row[1]).fold(f32::INFINITY, f32::min);
            if time.is_nan() && f64::from(lowest) < 0.6 * spacing(setting) {
                *time = world.clock().time;
            }
        }
    })?;
    let due = |height: f64| (2.0 * height / GRAVITY).sqrt();
    let name = "time between the landings of two cubes, error over frames";
    Ok(Figure::over(name, "s", (due(0.2) - due(0.05), arrived[1] - arrived[0]), 1.0 / 60.0, 1.0))
}

/// Force on a drop of water on plastic over its width \[N/m\].
const RETENTION: f64 = 0.02;
/// Time for which drops are watched \[s\].
const SLIDES: f64 = 0.5;

/// A drop of one particle on a floor whose angle has that sine, for half a second: the way down, and the acceleration without retention
/// and with that of a round drop of its width.
fn way_on_plastic(setting: &Setting, sine: f64) -> Result<(f64, [f64; 2]), Failure> {
    let d = spacing(setting);
    let half = (0.5 * d) as f32;
    let block = FluidBlock::new(Vec3::new(-half, 0.0, -half), Vec3::new(half, 2.0 * half, half));
    let mut scene = tank(setting, (0.2, 0.1), vec![block]);
    let cosine = (1.0 - sine * sine).sqrt();
    let weight = f64::from(scene.gravity.length());
    scene.gravity = Vec3::new((weight * sine) as f32, (-weight * cosine) as f32, 0.0);
    // Other solvers have none.
    let holds = setting.solvers.water.as_deref().is_none_or(|solver| solver == "divergence");
    let retention = if holds { RETENTION as f32 } else { 0.0 };
    scene.fluid.iter_mut().for_each(|fluid| fluid.retention = retention);
    let along = |world: &World| mean(world.particle_positions().iter().map(|row| f64::from(row[0])));
    let mut world = setting.world(&scene)?;
    let start = along(&world);
    advance(setting, &mut world, SLIDES, |_| ())?;
    let held = RETENTION / (DENSITY * d * d);
    Ok((along(&world) - start, [GRAVITY * sine, GRAVITY * sine - held]))
}

fn drop_stays(setting: &Setting) -> Result<Figure, Failure> {
    let (way, [free, _]) = way_on_plastic(setting, 0.06)?;
    let free = 0.5 * free * SLIDES.powi(2);
    Ok(Figure::over(
        "a drop on plastic that leans by 6 %, way over that of a free slide",
        "m",
        (0.0, way),
        free,
        0.05,
    ))
}

fn drop_slides(setting: &Setting) -> Result<Figure, Failure> {
    let (way, [_, slowed]) = way_on_plastic(setting, 0.2)?;
    Ok(Figure::relative(
        "a drop on plastic that leans by 20 % slides",
        "m",
        0.5 * slowed * SLIDES.powi(2),
        way,
        0.15,
    ))
}
