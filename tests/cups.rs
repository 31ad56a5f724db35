//! Cups hold water: filled, turned over, shaken. And meshes as bodies.

mod common;

use std::collections::BTreeMap;

use sorb::{
    Command, Region, World,
    glam::Vec3,
    scene::{Body, Fluid, FluidBlock, FluidSolver, Mesh, Motion, Scene, ShapeKind},
};

const RADIUS: f32 = 0.03;
const HEIGHT: f32 = 0.08;
const WALL: f32 = 0.008;
const FLOOR: Vec3 = Vec3::new(0.0, 0.2, 0.0);

fn cup() -> ShapeKind {
    ShapeKind::Cup { radius: RADIUS, height: HEIGHT, thickness: WALL }
}

fn scene(solver: FluidSolver, shape: ShapeKind, motions: &[Motion], has_lid: bool) -> Scene {
    let fluid = Fluid { solver: Some(solver), sound_speed: Some(20.0), ..Fluid::default() };
    let mut scene = Scene::new("cup")
        .in_box(Vec3::new(-0.3, 0.0, -0.3), Vec3::new(0.3, 0.5, 0.3))
        .with_fluid(fluid)
        .with_body(Body::kinematic("cup", shape, FLOOR, motions.to_vec()));
    if has_lid {
        // The rim reaches into it.
        let half_extents = Vec3::new(RADIUS + 1.5 * WALL, 0.5 * WALL, RADIUS + 1.5 * WALL);
        let place = FLOOR + Vec3::Y * HEIGHT;
        let lid = Body::kinematic("lid", ShapeKind::Cuboid { half_extents }, place, motions.to_vec());
        scene = scene.with_body(lid);
    }
    scene
}

/// The cup with water to two thirds.
fn filled(scene: &Scene) -> World {
    let mut world = common::world(scene);
    let start = FLOOR + Vec3::Y * WALL;
    let region = Region::Cylinder { start, end: start + Vec3::Y * 0.05, radius: 0.98 * RADIUS };
    world.push(Command::Pour { region, velocity: Vec3::ZERO }).unwrap_or_else(|error| panic!("{error}"));
    world
}

/// Places of the particles in the frame of the cup, by their identities; `centre` is the place of the centre of mass in it.
fn places(world: &World, centre: Vec3) -> BTreeMap<u32, Vec3> {
    let state = world.bodies()[0].state;
    let place = |row: &[f32; 4]| {
        let arm = Vec3::new(row[0], row[1], row[2]) - state.position;
        state.rotation.conjugate() * arm + centre
    };
    let ids = world.particle_ids().iter().copied();
    ids.zip(world.particle_positions().iter().map(place)).collect()
}

/// Whether a place is not in the hollow.
fn is_outside(place: Vec3) -> bool {
    let radius = place.with_y(0.0).length();
    radius > RADIUS + 0.4 * WALL || place.y < 0.6 * WALL || place.y > HEIGHT + 0.4 * WALL
}

/// Runs a cup with water for some time \[s\]. Returns the world, how many particles have gone through wall and bottom, and how many are
/// outside.
fn run(scene: &Scene, duration: f64) -> (World, usize, usize) {
    let mut world = filled(scene);
    let centre = world.bodies()[0].state.position - FLOOR;
    let (mut before, mut through) = (BTreeMap::new(), 0);
    while world.clock().time < duration {
        common::steps(&mut world, 1);
        let now = places(&world, centre);
        // What leaves near the rim may have gone over it.
        let is_deep = |place: &Vec3| !is_outside(*place) && place.y < HEIGHT - 0.015;
        let were_deep = now.iter().filter(|(id, _)| before.get(*id).is_some_and(is_deep));
        through += were_deep.filter(|(_, place)| is_outside(**place)).count();
        before = now;
    }
    let outside = before.values().filter(|place| is_outside(**place)).count();
    (world, through, outside)
}

/// To and fro at a speed \[m/s\], and around at a rate \[rad/s\].
fn shaken(speed: f32, rate: f32) -> Vec<Motion> {
    let period = 0.1 / speed.max(1.0);
    let mut motions = Vec::new();
    for turn in 0..6 {
        let start = 0.1 + turn as f32 * period;
        let sign = if turn % 2 == 0 { 1.0 } else { -1.0 };
        let velocity = Vec3::new(sign * speed, 0.5 * sign * speed, 0.3 * sign * speed);
        motions.push(Motion::Linear { velocity, start, end: start + period, ease: 0.0 });
    }
    let pivot = FLOOR + Vec3::Y * 0.04;
    motions.push(Motion::Turn {
        axis: Vec3::new(1.0, 0.3, 0.5),
        pivot,
        rate,
        start: 0.1,
        end: 0.9,
        ease: 0.0,
    });
    motions
}

#[test]
fn a_cup_at_rest_holds_its_water() {
    for solver in [FluidSolver::Divergence, FluidSolver::Dfsph, FluidSolver::Pbf, FluidSolver::Wcsph] {
        let (world, through, outside) = run(&scene(solver, cup(), &[], false), 1.0);
        let ledger = world.ledger();
        assert!(ledger.present > 900 && ledger.lost == 0, "{ledger:?}");
        assert_eq!((through, outside), (0, 0), "{solver:?}");
        let level = world.water_levels(&[[0.0, 0.0]]).unwrap_or_else(|error| panic!("{error}"));
        let volume = ledger.present as f32 * ledger.particle_mass / 1000.0;
        let ideal = FLOOR.y + WALL + volume / (std::f32::consts::PI * RADIUS * RADIUS);
        let found = level[0].unwrap_or(0.0);
        assert!((found - ideal).abs() < 0.006, "{solver:?}: {found} m instead of {ideal} m");
    }
}

#[test]
fn a_closed_cup_is_shaken_and_leaks_nothing() {
    for solver in [FluidSolver::Divergence, FluidSolver::Dfsph] {
        for (speed, rate) in [(0.5, 8.0), (3.0, 30.0)] {
            let motions = shaken(speed, rate);
            let (world, through, _) = run(&scene(solver, cup(), &motions, true), 1.0);
            assert_eq!(through, 0, "{solver:?}, {speed} m/s, {rate} rad/s");
            assert!(world.ledger().lost == 0 && world.particle_count() > 900);
        }
    }
    // Negative control: what is counted goes through the wall of a cup whose wall ends half way.
    let low = ShapeKind::Cup { radius: RADIUS, height: 0.4 * HEIGHT, thickness: WALL };
    let (_, through, _) = run(&scene(FluidSolver::Divergence, low, &shaken(0.5, 8.0), true), 1.0);
    assert!(through > 100, "{through}");
}

#[test]
fn a_cup_that_is_tilted_pours_over_its_rim_alone() {
    let pivot = FLOOR + Vec3::Y * 0.04;
    let turn = Motion::Turn { axis: Vec3::Z, pivot, rate: 1.0, start: 0.2, end: 2.2, ease: 0.2 };
    let scene = scene(FluidSolver::Divergence, cup(), &[turn], false);
    let (world, through, outside) = run(&scene, 3.0);
    assert_eq!(through, 0);
    let (left, all) = (world.particle_count() - outside, world.particle_count());
    assert!(4 * left < all, "{left} of {all} are still in it");
}

#[test]
fn a_cup_that_floats_carries_a_ball_and_stays_dry() {
    let after = |density: f32| {
        let (low, high) = (Vec3::new(-0.08, 0.0, -0.08), Vec3::new(0.08, 0.25, 0.08));
        let water = FluidBlock::new(low, Vec3::new(high.x, 0.08, high.z));
        let shape = ShapeKind::Cup { radius: 0.035, height: 0.06, thickness: 0.01 };
        let ball = ShapeKind::Sphere { radius: 0.015 };
        let scene = Scene::new("boat")
            .in_box(low, high)
            .with_fluid(Fluid { spacing: 0.006, blocks: vec![water], ..Fluid::default() })
            .with_body(Body::dynamic("cup", shape, Vec3::Y * 0.082, density))
            .with_body(Body::dynamic("ball", ball, Vec3::Y * 0.12, 400.0));
        let mut world = common::world(&scene);
        let centre = world.bodies()[0].state.position - Vec3::Y * 0.082;
        for _ in 0..60 {
            common::frame(&mut world);
        }
        let state = world.bodies()[0].state;
        let place = |point: Vec3| state.rotation.conjugate() * (point - state.position) + centre;
        let is_aboard = |point: Vec3| {
            let place = place(point);
            place.with_y(0.0).length() < 0.035 && place.y > 0.01 && place.y < 0.06
        };
        let wet = world.particle_positions().iter();
        let wet = wet.filter(|row| is_aboard(Vec3::new(row[0], row[1], row[2]))).count();
        (state.rotation * Vec3::Y, is_aboard(world.bodies()[1].state.position), wet)
    };
    let (up, carries, wet) = after(700.0);
    assert!(up.y > 0.8 && carries && wet == 0, "{up}, ball aboard: {carries}, {wet} particles");
    // Negative control: a cup of stone fills and sinks.
    let (_, _, wet) = after(2500.0);
    assert!(wet > 100, "{wet} particles");
}

/// A closed surface of a box with an open hollow, by its corners.
fn trough() -> Mesh {
    // Profile in x and y, extruded along z; the ends are closed by walls.
    let mut vertices = Vec::new();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    let (outer, inner) = (Vec3::new(0.04, 0.0, 0.04), Vec3::new(0.03, 0.01, 0.03));
    for (half, y) in [(outer, 0.0), (outer, 0.06), (inner, 0.06), (inner, inner.y)] {
        for (x, z) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            vertices.push(Vec3::new(x * half.x, y, z * half.z));
        }
    }
    triangles.extend([[0, 1, 2], [0, 2, 3], [12, 14, 13], [12, 15, 14]]);
    for ring in 0..3 {
        for side in 0..4 {
            let (a, b) = (4 * ring + side, 4 * ring + (side + 1) % 4);
            triangles.extend([[a, a + 4, b + 4], [a, b + 4, b]]);
        }
    }
    Mesh { vertices, triangles, ..Mesh::default() }
}

#[test]
fn a_hollow_mesh_holds_water_as_parts_and_none_as_its_hull() {
    let in_hollow = |parts: u32| {
        let shape = ShapeKind::Mesh { mesh: trough(), parts };
        let fluid = Fluid { solver: Some(FluidSolver::Divergence), ..Fluid::default() };
        let scene = Scene::new("trough")
            .in_box(Vec3::new(-0.1, 0.0, -0.1), Vec3::new(0.1, 0.2, 0.1))
            .with_fluid(fluid)
            .with_body(Body::fixed("trough", shape, Vec3::Y * 0.05));
        let mut world = common::world(&scene);
        let region =
            Region::Box { minimum: Vec3::new(-0.03, 0.06, -0.03), maximum: Vec3::new(0.03, 0.1, 0.03) };
        let poured = world.push(Command::Pour { region, velocity: Vec3::ZERO });
        if poured.is_err() {
            return (0, 0);
        }
        for _ in 0..30 {
            common::frame(&mut world);
        }
        let is_in = |row: &&[f32; 4]| row[0].abs() < 0.031 && row[2].abs() < 0.031 && row[1] > 0.058;
        (world.particle_positions().iter().filter(is_in).count(), world.particle_count())
    };
    let (held, all) = in_hollow(32);
    assert!(all > 800 && held == all, "{held} of {all}");
    // Negative control: in the hull there is no room.
    assert_eq!(in_hollow(1).1, 0);
}
