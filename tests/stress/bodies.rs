//! Bodies that are heavy, fast, thin, shaken, or that jump.

use sorb::{
    World,
    glam::Vec3,
    scene::{Body, FluidBlock, Motion, Scene, ShapeKind},
};

use crate::{
    case::{Case, Check, Figure, table},
    pick,
    scenes::{BOX, WAVE, dry, pool, shaken, wet, with_ball},
};

#[test]
fn bodies_a_thousand_times_as_heavy_as_each_other() {
    let mut cases = Vec::new();
    for scene in [wet(), dry()] {
        let ball = |name: &str, height: f32, density: f32| {
            Body::dynamic(name, ShapeKind::Sphere { radius: 0.012 }, Vec3::new(0.001, height, 0.0), density)
        };
        for (name, low, high) in [
            ("100 under 100 000 kg/m^3", 100.0, 1e5),
            ("100 000 over 100 kg/m^3", 1e5, 100.0),
            ("1 kg/m^3", 1.0, 1.0),
        ] {
            let name = format!("{}: balls of {name}", scene.name);
            let scene = scene.clone().with_body(ball("low", 0.061, low)).with_body(ball("high", 0.087, high));
            // Nodes and water between a sponge and a ball that weighs a hundred times as much are pressed out fast.
            cases.push(Case { fastest: 2.0 * WAVE, ..Case::new(name, scene, pick(0.3, 2.0)) });
        }
    }
    table(cases);
}

/// Balls released at the floor of a pool. Single particles below them are pushed out. Without the inertia of what they displace, balls
/// below 50 kg/m^3 were thrown at 4 to 16 m/s, or steps became too short.
#[test]
fn balls_of_next_to_nothing_rise() {
    let mut scene = pool();
    if let Some(fluid) = &mut scene.fluid {
        fluid.blocks[0].maximum.y = BOX;
    }
    let case = |density: f32| {
        let name = format!("pool: a ball of {density} kg/m^3 let go at the floor");
        let place = Vec3::new(0.001, 0.021, 0.0);
        let ball = Body::dynamic("ball", ShapeKind::Sphere { radius: 0.02 }, place, density);
        Case { fastest: 6.0, ..Case::new(name, scene.clone().with_body(ball), pick(0.5, 2.0)) }
    };
    table([1.0, 10.0, 30.0, 100.0].map(case));
}

/// A plate of 1.2 spacings floats, and a centimetre of water falls onto it. Some lighter than 50 kg/m^3 are thrown
/// (docs/history.md, light plates).
#[test]
fn water_falls_onto_a_light_plate() {
    let mut cases = Vec::new();
    let mut pool = pool().in_box(Vec3::new(-BOX, 0.0, -BOX), Vec3::new(BOX, 0.15, BOX));
    if let Some(fluid) = &mut pool.fluid {
        let water = |half: f32, low: f32, high: f32| {
            FluidBlock::new(Vec3::new(-half, low, -half), Vec3::new(half, high, half))
        };
        fluid.blocks = vec![water(BOX, 0.0, 0.05), water(0.04, 0.0665, 0.0765)];
    }
    for density in [50.0, 100.0, 200.0] {
        let plate = ShapeKind::Cuboid { half_extents: Vec3::new(0.04, 0.003, 0.04) };
        let plate = Body::dynamic("plate", plate, Vec3::Y * 0.0535, density);
        let name = format!("pool: water falls onto a plate of {density} kg/m^3");
        let figure = Figure { name: "plate m/s", of: speed_of_a_plate, maximum: 0.5 };
        let case = Case::new(name, pool.clone().with_body(plate), pick(0.3, 1.0));
        cases.push(Case { figure: Some(figure), ..case });
    }
    table(cases);
}

fn speed_of_a_plate(world: &World) -> f64 {
    f64::from(world.bodies()[0].state.linear_velocity.length())
}

#[test]
fn a_hundred_metres_a_second() {
    let mut cases = Vec::new();
    for mut scene in [wet(), dry(), pool()] {
        scene.time.minimum_step = 1e-8;
        for density in [100.0, 2000.0, 1e5] {
            let name = format!("{}: a ball of {density} kg/m^3 at 100 m/s", scene.name);
            let case = Case::new(name, with_ball(scene.clone(), density, 100.0), pick(0.05, 1.0));
            cases.push(Case { fastest: 300.0, ..case });
        }
        if let Some(fluid) = &mut scene.fluid {
            fluid.blocks.push(FluidBlock {
                velocity: Vec3::NEG_Y * 100.0,
                ..FluidBlock::new(Vec3::new(-0.03, 0.08, -0.03), Vec3::new(0.03, 0.11, 0.03))
            });
            let name = format!("{}: a block of water at 100 m/s", scene.name);
            cases.push(Case { fastest: 300.0, ..Case::new(name, scene.clone(), pick(0.03, 0.5)) });
        }
        if let Some(sponge) = scene.sponges.first_mut() {
            (sponge.position.y, sponge.velocity) = (0.05, Vec3::NEG_Y * 100.0);
            let name = format!("{}: a sponge at 100 m/s", scene.name);
            cases.push(Case { fastest: 400.0, ..Case::new(name, scene, pick(0.03, 0.5)) });
        }
    }
    table(cases);
}

/// Thickness of a thin wall \[m\]: a third of a spacing.
const THIN: f32 = 0.002;

/// Where the wall starts, and where it stops \[m\].
const WAY: (f32, f32) = (-0.052, 0.03);

/// A wall across the box from its left side to 3 cm from the right one.
fn swept(mut scene: Scene, thickness: f32, speed: f32) -> Scene {
    let half_extents = Vec3::new(0.5 * thickness, 2.0 * BOX, 2.0 * BOX);
    let (from, to) = WAY;
    if let Some(fluid) = &mut scene.fluid {
        fluid.blocks[0].minimum.x = from + 0.5 * thickness + 0.003;
    }
    if let Some(sponge) = scene.sponges.first_mut() {
        sponge.position.x = -0.01;
    }
    let motion =
        Motion::Linear { velocity: Vec3::X * speed, start: 0.0, end: (to - from) / speed, ease: 0.0 };
    let shape = ShapeKind::Cuboid { half_extents };
    scene.with_body(Body::kinematic("wall", shape, Vec3::new(from, BOX, 0.0), vec![motion]))
}

/// Share of the particles and nodes that the wall has passed \[%\].
fn behind(world: &World) -> f64 {
    let wall = world.bodies()[0].state.position.x;
    let rows = || world.particle_positions().iter().chain(world.node_positions());
    100.0 * rows().filter(|row| row[0] < wall).count() as f64 / rows().count() as f64
}

#[test]
fn a_thin_wall_sweeps_through() {
    let mut cases = Vec::new();
    let steps = pick(vec![4.0], vec![4.0, 0.1]);
    for scene in [pool(), wet(), dry()] {
        for (thickness, speed) in [(2.0, 1.0), (2.0, 3.0), (2.0, 10.0), (12.0, 1.0), (12.0, 3.0)] {
            for step in &steps {
                let name =
                    format!("{}: a wall of {thickness} mm at {speed} m/s, steps up to {step} ms", scene.name);
                let mut scene = swept(scene.clone(), 1e-3 * thickness, speed);
                scene.time.maximum_step = 1e-3 * step;
                let figure = Figure { name: "behind the wall %", of: behind, maximum: 0.0 };
                // The work of the wall is not counted.
                let (fastest, excess) = (f64::from(5.0 * speed).max(1.5 * WAVE), None);
                let case = Case::new(name, scene, f64::from((WAY.1 - WAY.0) / speed) + 0.1);
                cases.push(Case { fastest, excess, figure: Some(figure), ..case });
            }
        }
    }
    table(cases);
}

/// Inner half width of the closed cup, and half of the thickness of its walls \[m\].
const CUP: (f32, f32) = (0.03, 0.002);

/// A closed cup, half full, shaken along a diagonal.
fn cup(speed: f32) -> Scene {
    let centre = Vec3::new(0.0, 0.1, 0.0);
    let (inner, thickness) = CUP;
    let corner = Vec3::new(-0.1, 0.0, -0.1);
    let mut scene = pool().in_box(corner, Vec3::new(0.1, 0.2, 0.1));
    scene.name = "cup".to_owned();
    let block = FluidBlock::new(centre - Vec3::splat(inner), centre + Vec3::new(inner, 0.0, inner));
    if let Some(fluid) = &mut scene.fluid {
        fluid.blocks = vec![block];
    }
    for axis in 0..3 {
        for (name, sign) in [("low", -1.0), ("high", 1.0)] {
            let mut half_extents = Vec3::splat(inner + 2.0 * thickness);
            half_extents[axis] = thickness;
            let mut place = centre;
            place[axis] += sign * (inner + thickness);
            let motions = shaken(Vec3::new(0.6, 0.6, 0.53) * speed, 0.05 / speed, 10);
            let shape = ShapeKind::Cuboid { half_extents };
            scene = scene.with_body(Body::kinematic(&format!("{name}{axis}"), shape, place, motions));
        }
    }
    scene
}

/// Share of the particles that are no longer in the cup \[%\].
fn spilled(world: &World) -> f64 {
    let (low, high) = (world.bodies()[0].state.position, world.bodies()[1].state.position);
    let centre = 0.5 * (low + high);
    let reach = CUP.0 + CUP.1;
    let outside = |row: &&[f32; 4]| (Vec3::new(row[0], row[1], row[2]) - centre).abs().max_element() > reach;
    let rows = world.particle_positions();
    100.0 * rows.iter().filter(outside).count() as f64 / rows.len() as f64
}

/// Why a shaken cup throws water faster than it moves.
const TURNS: &str =
    "walls that turn round at once shut water in between them and what follows: pressed out, it gains speed";

/// Checks that fail, and why.
type Faults = &'static [(Check, &'static str)];

/// Faults of the cup: speed \[m/s\], longest step \[ms\], and the checks that fail.
const CUPS: &[(f32, f32, Faults)] = &[
    (0.5, 4.0, &[(Check::Speed, TURNS)]),
    (0.5, 0.1, &[(Check::Speed, TURNS)]),
    (2.0, 4.0, &[(Check::Speed, TURNS)]),
    (2.0, 0.1, &[(Check::Speed, TURNS)]),
    (5.0, 4.0, &[(Check::Speed, TURNS)]),
    (5.0, 0.1, &[(Check::Speed, TURNS)]),
];

#[test]
fn a_cup_is_shaken() {
    let mut cases = Vec::new();
    for (speed, step, known) in CUPS.iter().filter(|(_, step, _)| *step >= pick(1.0, 0.0)) {
        let times = speed / 0.1;
        let name = format!("cup: shaken at {speed} m/s, {times:.0} times a second, steps up to {step} ms");
        let figure = Figure { name: "spilled %", of: spilled, maximum: 0.0 };
        let mut scene = cup(*speed);
        scene.time.maximum_step = 1e-3 * step;
        let fastest = f64::from(4.0 * speed).max(3.0);
        cases.push(Case { fastest, known, figure: Some(figure), ..Case::new(name, scene, 1.0) });
    }
    table(cases);
}

/// Largest allowed speed after an impact at 100 m/s \[m/s\]: neighbours push a node in a corner on.
const HIT: f64 = 500.0;

/// Why a fast wall throws water faster than a hit does.
const PRESSED: &[(Check, &str)] = &[(
    Check::Speed,
    "a wall a third of a spacing thin has images on both sides: what it presses against the container leaves at 1.2 to 2.8 km/s",
)];

#[test]
fn bodies_that_are_somewhere_else_at_once() {
    let mut cases = Vec::new();
    for scene in [wet(), dry(), pool()] {
        // 6 cm in 0.6 ms: from above into the middle of the scene.
        let jump = |start: f32, sign: f32| Motion::Linear {
            velocity: Vec3::Y * 100.0 * sign,
            start,
            end: start + 6e-4,
            ease: 0.0,
        };
        let ball = ShapeKind::Sphere { radius: 0.015 };
        let motions = vec![jump(0.05, -1.0), jump(0.1, 1.0), jump(0.15, -1.0)];
        let ball = Body::kinematic("ball", ball, Vec3::new(0.002, 0.085, 0.001), motions);
        let name = format!("{}: a ball appears inside, goes and comes", scene.name);
        let case = Case::new(name, scene.clone().with_body(ball), pick(0.2, 2.0));
        // It hits its surroundings at 100 m/s: that energy is in no budget.
        cases.push(Case { fastest: HIT, excess: None, ..case });
        let mut passed = swept(scene.clone(), THIN, 82.0);
        passed.time.minimum_step = 1e-8;
        let name = format!("{}: a wall of 2 mm passes at 82 m/s", scene.name);
        let known = if scene.fluid.is_some() { PRESSED } else { &[] };
        cases.push(Case { fastest: HIT, excess: None, known, ..Case::new(name, passed, pick(0.15, 1.0)) });
    }
    table(cases);
}
