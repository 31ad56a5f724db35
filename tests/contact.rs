//! Contact between sponges: they rest on each other, conserve their momentum, and pass neither through each other nor
//! through themselves.

mod common;

use common::Claims;
use sorb::{
    SimdLevel, World, WorldError,
    glam::{DVec3, UVec3, Vec3},
    scene::{Axis, BlockShape, Body, Domain, Motion, Scene, ShapeKind, Solver, Sponge},
};

const EDGE: f32 = 0.01;

fn sponge(name: &str, cells: [u32; 3], position: [f32; 3]) -> Sponge {
    Sponge { edge: EDGE, cells: UVec3::from(cells), ..Sponge::new(name, Vec3::from(position)) }
}

fn place(row: &[f32; 4]) -> DVec3 {
    Vec3::new(row[0], row[1], row[2]).as_dvec3()
}

/// Mean position of the nodes of every sponge, by volume \[m\].
fn centres(world: &World) -> Vec<DVec3> {
    let lattice = world.lattice();
    let mut sums = vec![(DVec3::ZERO, 0.0); lattice.sponges.len()];
    let nodes = world.node_positions().iter().zip(&lattice.node_sponge).zip(&lattice.node_volume);
    for ((row, sponge), volume) in nodes {
        let (sum, all) = &mut sums[*sponge as usize];
        *sum += place(row) * f64::from(*volume);
        *all += f64::from(*volume);
    }
    sums.into_iter().map(|(sum, all)| sum / all).collect()
}

/// Depth of the deepest node of a sponge inside another, or inside a part of its own, in edges. Its distance from the
/// nearest corner of the surface there, less half an edge, the distance of nodes on a surface.
fn deepest(world: &World) -> f64 {
    let (lattice, nodes) = (world.lattice(), world.node_positions());
    let at = |node: u32| place(&nodes[node as usize]);
    let volume = |[a, b, c, d]: [DVec3; 4]| (b - a).cross(c - a).dot(d - a);
    let mut deepest = 0.0_f64;
    for node in 0..lattice.node_count() as u32 {
        let x = at(node);
        for (tet, sponge) in lattice.tets.iter().zip(&lattice.tet_sponge) {
            let corners = tet.map(at);
            if tet.contains(&node) || (corners[0] - x).length() > 3.0 * f64::from(EDGE) {
                continue;
            }
            let share = |slot: usize| {
                let mut moved = corners;
                moved[slot] = x;
                volume(moved) / volume(corners)
            };
            if (0..4).all(|slot| share(slot) > 1e-3) {
                let own =
                    lattice.triangles.iter().zip(&lattice.triangle_sponge).filter(|(_, of)| *of == sponge);
                let corners = own.flat_map(|(triangle, _)| *triangle).filter(|corner| *corner != node);
                let nearest = corners.map(|corner| (at(corner) - x).length()).fold(f64::MAX, f64::min);
                deepest = deepest.max(nearest / f64::from(EDGE) - 0.5);
            }
        }
    }
    deepest
}

/// One cube over another, slightly shifted.
fn pair(gap: f32) -> Scene {
    Scene::new("pair")
        .in_box(Vec3::new(-0.1, 0.0, -0.1), Vec3::new(0.1, 0.25, 0.1))
        .with_sponge(sponge("lower", [6, 6, 6], [-0.03, 0.0, -0.03]))
        .with_sponge(sponge("upper", [6, 6, 6], [-0.026, 0.06 + gap, -0.033]))
}

#[test]
fn a_cube_that_falls_on_another_comes_to_rest_on_it() {
    let mut claims = Claims::default();
    // Sweeps, largest slide of the upper cube, and largest final speed.
    for (iterations, slide, slowest) in [(2, 0.008, 0.03), (4, 0.004, 5e-3)] {
        let mut scene = pair(0.03);
        scene.sponges.iter_mut().for_each(|sponge| sponge.iterations = iterations);
        let mut world = common::world(&scene);
        let mut worst = 0.0_f64;
        for frame in 0..120 {
            common::frame(&mut world);
            if frame % 4 == 0 {
                worst = worst.max(deepest(&world));
            }
        }
        let centres = centres(&world);
        let (apart, speed) = (centres[1] - centres[0], world.measures().maximum_speed);
        let text =
            format!("{iterations} sweeps: apart {apart:?}, deepest {worst:.3} edges, at last {speed} m/s");
        // A thirtieth of an edge less than the height of a cube.
        claims.claim((0.0580..0.0602).contains(&apart.y), &text);
        claims.claim((apart.x - 0.004).abs() < slide && (apart.z + 0.003).abs() < slide, &text);
        claims.claim(speed < slowest && worst < 0.1, &text);
    }
    claims.hold();
}

/// Two sponges that meet in free space, off their centres.
fn crash(speed: f32) -> Scene {
    let mut scene = Scene::new("crash");
    (scene.gravity, scene.domain) = (Vec3::ZERO, Domain::Open);
    let velocity = Vec3::new(speed, 0.0, 0.0);
    scene
        .with_sponge(Sponge { velocity, ..sponge("left", [6, 6, 6], [-0.065, 0.0, 0.0]) })
        .with_sponge(Sponge { velocity: -velocity, ..sponge("right", [5, 6, 7], [0.0, 0.012, 0.007]) })
}

#[test]
fn sponges_that_collide_keep_both_momenta_and_gain_no_energy() {
    let mut claims = Claims::default();
    for (speed, frames) in [(1.0, 6), (5.0, 4)] {
        let scene = crash(speed);
        let mut world = common::world(&scene);
        let start = world.measures();
        let (mut linear, mut angular, mut energy) = (0.0_f64, 0.0_f64, 0.0_f64);
        let mut worst = 0.0_f64;
        for _ in 0..frames {
            common::frame(&mut world);
            let now = world.measures();
            linear = linear.max((now.linear_momentum - start.linear_momentum).length());
            angular = angular.max((now.angular_momentum - start.angular_momentum).length());
            energy = energy.max((now.kinetic_energy + now.elastic_energy) / start.kinetic_energy);
            worst = worst.max(deepest(&world));
        }
        // The impulse that they exchange, and that at the distance of half a sponge.
        let mass: f64 = world
            .node_positions()
            .iter()
            .zip(&world.lattice().node_sponge)
            .filter(|(_, sponge)| **sponge == 0)
            .map(|(row, _)| 1.0 / f64::from(row[3]))
            .sum();
        let given = f64::from(speed) * mass;
        let centres = centres(&world);
        let text = format!(
            "{speed} m/s: momentum {:.1e}, angular {:.1e} of what is given, energy {energy:.3}, deepest {worst:.2} edges, {centres:?}",
            linear / given,
            angular / (given * 0.03)
        );
        claims.claim(linear < 1e-5 * given && angular < 1e-5 * given * 0.03, &text);
        // They bounced off: the left one is on its way back.
        claims.claim(centres[0].x < -0.035 && centres[1].x > 0.025, &text);
        claims.claim(energy < 1.001 && worst < 0.5, &text);
    }
    claims.hold();
}

#[test]
fn sponges_at_twenty_metres_a_second_do_not_pass_through_each_other() {
    let mut world = common::world(&crash(20.0));
    let start = world.measures();
    for _ in 0..3 {
        common::frame(&mut world);
        assert_eq!(common::unhealthy(&world, 0), None);
    }
    let (now, centres) = (world.measures(), centres(&world));
    // Without contact they would be two metres past each other.
    assert!(centres[0].x < centres[1].x, "they went through: {centres:?}");
    let energy = (now.kinetic_energy + now.elastic_energy) / start.kinetic_energy;
    assert!(energy < 1.01, "energy {energy}");
}

#[test]
fn what_has_no_contact_goes_through() {
    // Negative control of the tests above: the solver of the paper has none.
    let mut scene = crash(1.0);
    scene.sponges.iter_mut().for_each(|sponge| sponge.solver = Solver::Sbd);
    let mut world = common::world(&scene);
    (0..3).for_each(|_| common::frame(&mut world));
    assert!(centres(&world)[0].x > 0.0 && deepest(&world) > 0.5);
}

/// A bar whose ends are turned up into a U; then plates press its legs together from both sides.
fn folded(self_contact: bool) -> Scene {
    let mut scene = Scene::new("folded");
    (scene.gravity, scene.domain) = (Vec3::ZERO, Domain::Open);
    let pivot = Vec3::new(0.12, 0.055, 0.015);
    let quarter = std::f32::consts::FRAC_PI_2;
    let cuboid = |half_extents: [f32; 3]| ShapeKind::Cuboid { half_extents: Vec3::from(half_extents) };
    let grip = |name: &str, side: f32| {
        let fold =
            Motion::Turn { axis: Vec3::Z, pivot, rate: side * quarter, start: 0.0, end: 1.0, ease: 0.0 };
        let place = Vec3::new(0.12 + side * 0.105, 0.02, 0.015);
        Body { grip: true, ..Body::kinematic(name, cuboid([0.0155, 0.021, 0.016]), place, vec![fold]) }
    };
    let plate = |name: &str, side: f32| {
        let velocity = Vec3::new(-0.3 * side, 0.0, 0.0);
        let press = Motion::Linear { velocity, start: 1.1, end: 1.1 + 0.165 / 0.3, ease: 0.0 };
        let place = Vec3::new(0.12 + side * 0.2, 0.105, 0.015);
        Body { friction: 0.0, ..Body::kinematic(name, cuboid([0.01, 0.02, 0.03]), place, vec![press]) }
    };
    scene
        .with_sponge(Sponge { self_contact, damping: 0.005, ..sponge("bar", [24, 4, 3], [0.0, 0.0, 0.0]) })
        .with_body(grip("left", -1.0))
        .with_body(grip("right", 1.0))
        .with_body(plate("from_the_left", -1.0))
        .with_body(plate("from_the_right", 1.0))
}

#[test]
fn a_folded_bar_does_not_pass_through_itself() {
    let deepest_of = |self_contact: bool| {
        let mut world = common::world(&folded(self_contact));
        let mut worst = 0.0_f64;
        for frame in 0..120 {
            common::frame(&mut world);
            if frame % 4 == 0 {
                worst = worst.max(deepest(&world));
            }
        }
        worst
    };
    let (with, without) = (deepest_of(true), deepest_of(false));
    assert!(with < 0.1 && without > 0.4, "{with:.2} edges with contact, {without:.2} without");
}

#[test]
fn a_wrung_bar_keeps_its_twist() {
    let scene = common::with(&common::preset("wring", 0.5), &["sponges[0].self_contact=true"]);
    let mut world = common::world(&scene);
    let mut energy_at = |time: f64| {
        while world.measures().time < time {
            common::frame(&mut world);
        }
        world.measures().elastic_energy
    };
    // Twisted and at rest; then spun and held.
    let (twisted, spun, held) = (energy_at(1.9), energy_at(2.8), energy_at(3.5));
    assert!(twisted > 0.2 && spun > 0.98 * twisted && held > 0.98 * twisted, "{twisted} {spun} {held} J");
}

#[test]
fn sponges_inside_each_other_are_refused() {
    let mut scene = pair(-0.02);
    scene.sponges.iter_mut().for_each(|sponge| sponge.shape = BlockShape::Ellipsoid);
    let refused = World::new(&scene).expect_err("they overlap");
    assert!(matches!(refused, WorldError::Overlap { .. }), "{refused}");
    assert!(refused.to_string().contains("`lower`") && refused.to_string().contains("`upper`"), "{refused}");
    // Round ones fit where their boxes overlap.
    scene.sponges[1].position += Vec3::new(0.05, 0.0, 0.0);
    assert!(World::new(&scene).is_ok());
    let mut alone = pair(0.0);
    (alone.sponges[0].self_contact, alone.sponges[0].solver) = (true, Solver::Sbd);
    let refused = World::new(&alone).expect_err("no such contact").to_string();
    assert!(refused.contains("sponges[0].self_contact"), "{refused}");
}

#[test]
fn a_slight_overlap_is_pushed_apart_without_a_jump() {
    let mut scene = pair(-0.003);
    scene.sponges.iter_mut().for_each(|sponge| sponge.shape = BlockShape::Cylinder { axis: Axis::Y });
    let mut world = common::world(&scene);
    let mut fastest = 0.0_f32;
    for _ in 0..60 {
        common::frame(&mut world);
        fastest = fastest.max(world.measures().maximum_speed as f32);
    }
    let apart = centres(&world)[1].y - centres(&world)[0].y;
    assert!(fastest < 3.0 && apart > 0.055, "fastest {fastest} m/s, apart {apart} m");
}

#[test]
fn threads_and_levels_change_no_bit_of_contact() {
    let digest = |threads: usize, simd: SimdLevel| {
        let mut scene = crash(2.0);
        scene.sponges[0].self_contact = true;
        let options = sorb::Options { threads: Some(threads), simd: Some(simd), ..sorb::Options::default() };
        let mut world = World::with_options(&scene, &options).unwrap_or_else(|error| panic!("{error}"));
        common::steps(&mut world, 6);
        let touched = sorb::internal::columns(&world).nodes.touch_stiffness.iter().any(|row| row[0] > 0.0);
        (world.digest(), touched)
    };
    let first = digest(1, SimdLevel::Fallback);
    assert!(first.1, "nothing touches");
    for simd in SimdLevel::supported() {
        for threads in [1, 2, 3, 8] {
            assert_eq!(digest(threads, simd), first, "{threads} threads, {simd}");
        }
    }
}
