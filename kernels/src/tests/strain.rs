//! The strain constraints as mechanics.

use glam::{DVec3, Quat, Vec3};

use super::{
    lattice::Lattice,
    scene::{FULL, Options, Scene, best, blocks},
};
use crate::columns::lane;

/// Two free sponges without fluid, bodies and walls, at rest around the origin.
fn free() -> Scene {
    let mut scene = Scene::new(Options { fluid: 0, bodies: false, walls: false, ..FULL });
    for (node, rest) in Lattice::new(&blocks(), 8).position.into_iter().enumerate() {
        let [x, y, z] = rest;
        let w = scene.columns.nodes.position[node][lane::nodes::position::INVERSE_MASS];
        scene.columns.nodes.position[node] = [x - 0.04, y - 0.02, z - 0.02, w];
    }
    scene.columns.nodes.predicted = scene.columns.nodes.position.clone();
    scene
}

/// Maps the predicted positions.
fn map(scene: &mut Scene, map: impl Fn(Vec3) -> Vec3) {
    let count = scene.columns.rows.nodes;
    for row in &mut scene.columns.nodes.predicted[..count] {
        let [x, y, z] = map(Vec3::new(row[0], row[1], row[2])).to_array();
        *row = [x, y, z, row[lane::nodes::predicted::INVERSE_MASS]];
    }
}

fn predicted(scene: &Scene) -> Vec<DVec3> {
    let rows = &scene.columns.nodes.predicted[..scene.columns.rows.nodes];
    rows.iter().map(|row| Vec3::new(row[0], row[1], row[2]).as_dvec3()).collect()
}

/// Largest displacement by one sweep [m].
fn moved(scene: &mut Scene) -> f64 {
    let before = predicted(scene);
    scene.run(&best(), &["pbd::strain"]);
    let after = predicted(scene);
    before.iter().zip(&after).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

const EDGE: f64 = 0.008;

#[test]
fn a_lattice_at_rest_stays_put() {
    let mut scene = free();
    let distance = moved(&mut scene);
    assert!(distance < 1e-5 * EDGE, "{:.1e} edges", distance / EDGE);
    // Negative control: a stretch by a thousandth is answered.
    map(&mut scene, |x| x * 1.001);
    assert!(moved(&mut scene) > 1e-5 * EDGE);
}

#[test]
fn a_rotated_lattice_stays_put() {
    for angle in [0.1, 1.0, 3.0] {
        let mut scene = free();
        let turn = Quat::from_axis_angle(Vec3::new(1.0, 2.0, -3.0).normalize(), angle);
        map(&mut scene, |x| turn * x);
        // Begin and end of the step alike: no rate of strain, so damping has no part in it.
        scene.columns.nodes.position = scene.columns.nodes.predicted.clone();
        let distance = moved(&mut scene);
        assert!(distance < 1e-5 * EDGE, "{angle}: {:.1e} edges", distance / EDGE);
    }
}

/// Extent in x over its value at rest, as the spread of the nodes of one sponge.
fn spread(scene: &Scene, rest: &[DVec3], sponge: u32) -> f64 {
    let own = |points: &[DVec3]| -> f64 {
        let owners = &scene.columns.nodes.sponge;
        let own: Vec<f64> =
            (0..points.len()).filter(|node| owners[*node] == sponge).map(|node| points[node].x).collect();
        let mean = own.iter().sum::<f64>() / own.len() as f64;
        own.iter().map(|x| (x - mean).powi(2)).sum::<f64>().sqrt()
    };
    own(&predicted(scene)) / own(rest)
}

#[test]
fn a_stretched_lattice_contracts() {
    let mut scene = free();
    let rest = predicted(&scene);
    map(&mut scene, |x| x * Vec3::new(1.3, 1.0, 1.0));
    scene.columns.nodes.position = scene.columns.nodes.predicted.clone();
    let mut last = [1.3; 2];
    for _ in 0..10 {
        scene.run(&best(), &["pbd::strain"]);
        let now = [0, 1].map(|sponge| spread(&scene, &rest, sponge));
        assert!(now[0] < last[0] && now[1] < last[1], "{now:?} after {last:?}");
        last = now;
    }
    assert!(last.iter().all(|spread| (0.9..1.25).contains(spread)), "{last:?}");
}

/// Leaves one tet of the second sponge, which has no damping; gives its nodes.
fn single_tet(scene: &mut Scene) -> [usize; 4] {
    let topology = &mut scene.columns.nodes.topology;
    let mut kept = None;
    for chunk in topology.chunks.iter_mut().flat_map(|chunks| {
        let all = std::mem::take(chunks);
        let first = all.into_iter().find(|chunk| kept.is_none() && chunk.sponge == 1);
        if let Some(mut chunk) = first {
            chunk.tets.end = chunk.tets.start + 1;
            kept = Some(chunk.tets.start);
            chunks.push(chunk);
        }
        chunks.iter()
    }) {
        assert_eq!(chunk.tets.len(), 1);
    }
    topology.tets[kept.expect("the second sponge has tets") as usize].map(|node| node as usize)
}

fn volume(scene: &Scene, tet: [usize; 4]) -> f64 {
    let p = predicted(scene);
    let [a, b, c] = [1, 2, 3].map(|vertex| p[tet[vertex]] - p[tet[0]]);
    a.dot(b.cross(c)) / 6.0 / (EDGE.powi(3) / 12.0)
}

#[test]
fn an_inverted_tet_recovers() {
    let mut scene = free();
    let tet = single_tet(&mut scene);
    let p = predicted(&scene);
    let normal = (p[tet[2]] - p[tet[1]]).cross(p[tet[3]] - p[tet[1]]).normalize();
    let inside_out = p[tet[0]] - 2.0 * normal * normal.dot(p[tet[0]] - p[tet[1]]);
    let [x, y, z] = inside_out.as_vec3().to_array();
    let row = &mut scene.columns.nodes.predicted[tet[0]];
    *row = [x, y, z, row[lane::nodes::predicted::INVERSE_MASS]];
    scene.columns.nodes.position = scene.columns.nodes.predicted.clone();
    assert!((volume(&scene, tet) + 1.0).abs() < 1e-3);
    for _ in 0..50 {
        scene.run(&best(), &["pbd::strain"]);
    }
    assert!((volume(&scene, tet) - 1.0).abs() < 1e-2, "{}", volume(&scene, tet));
}

/// Sums of `m dp` and of `m p x dp` over a sweep, over the sums of their magnitudes.
fn imbalance(scene: &Scene, before: &[DVec3], after: &[DVec3]) -> (f64, f64) {
    let (mut linear, mut angular) = (DVec3::ZERO, DVec3::ZERO);
    let (mut linear_scale, mut angular_scale) = (0.0, 0.0);
    for (node, (old, new)) in before.iter().zip(after).enumerate() {
        let momentum = (*new - *old)
            / f64::from(scene.columns.nodes.predicted[node][lane::nodes::predicted::INVERSE_MASS]);
        linear += momentum;
        linear_scale += momentum.length();
        // In the middle of its way the error of a node's place is of second order.
        let moment = (0.5 * (*old + *new)).cross(momentum);
        angular += moment;
        angular_scale += moment.length();
    }
    assert!(linear_scale > 0.0);
    (linear.length() / linear_scale, angular.length() / angular_scale)
}

fn deform(scene: &mut Scene, amount: f32) {
    let mut random = crate::testing::Random(5);
    let count = scene.columns.rows.nodes;
    for row in &mut scene.columns.nodes.predicted[..count] {
        (0..3).for_each(|axis| row[axis] += (random.unit() - 0.5) * amount * EDGE as f32);
    }
}

#[test]
fn corrections_keep_momentum() {
    for damping_time in [0.0, 0.005] {
        let mut angular = Vec::new();
        for amount in [0.2, 0.1] {
            let mut scene = free();
            scene.params.sponges.iter_mut().for_each(|sponge| sponge.damping_time = damping_time);
            deform(&mut scene, amount);
            let before = predicted(&scene);
            scene.run(&best(), &["pbd::strain"]);
            let found = imbalance(&scene, &before, &predicted(&scene));
            assert!(found.0 < 5e-6, "{:.1e}", found.0);
            angular.push(found.1);
        }
        // Each correction keeps it exactly, at the places that the nodes have by then; what is left of the sum
        // shrinks with the displacement.
        assert!(angular[0] < 3e-3 && angular[1] < 0.6 * angular[0], "{angular:?}");
    }
}

#[test]
fn one_correction_keeps_angular_momentum_to_rounding() {
    for damping_time in [0.0, 0.005] {
        let mut scene = free();
        let tet = single_tet(&mut scene);
        let sponge = &mut scene.params.sponges[1];
        sponge.damping_time = damping_time;
        // A modulus of zero is an infinite compliance: only the one correction for volume is left.
        (sponge.stretch_modulus, sponge.shear_modulus) = (0.0, 0.0);
        sponge.volume_modulus = 1.0e7;
        // Near the origin, where positions are rounded least.
        let centre = predicted(&scene)[tet[0]].as_vec3();
        map(&mut scene, |x| x - centre);
        scene.columns.nodes.position = scene.columns.nodes.predicted.clone();
        deform(&mut scene, 0.3);
        let before = predicted(&scene);
        scene.run(&best(), &["pbd::strain"]);
        let after = predicted(&scene);
        let moment = |points: &[DVec3]| -> (DVec3, f64) {
            let terms = tet.map(|node| {
                let mass = 1.0
                    / f64::from(scene.columns.nodes.predicted[node][lane::nodes::predicted::INVERSE_MASS]);
                points[node].cross((after[node] - before[node]) * mass)
            });
            (terms.into_iter().sum(), terms.iter().map(|term| term.length()).sum())
        };
        let (sum, scale) = moment(&before);
        assert!(scale > 0.0 && sum.length() < 5e-5 * scale, "{:.1e}", sum.length() / scale);
    }
}
