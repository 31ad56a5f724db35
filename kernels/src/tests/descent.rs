//! Vertex block descent as mechanics.

use glam::{DVec3, Vec3};

use super::{
    lattice::Lattice,
    scene::{FULL, Options, Scene, best, blocks},
};
use crate::columns::lane;
use crate::{params::Solver, testing::Random};

const EDGES: [f64; 2] = [0.01, 0.008];

/// Two free sponges without fluid, bodies and walls, at rest around the origin, without gravity.
fn free() -> Scene {
    let mut scene = Scene::new(Options { fluid: 0, bodies: false, walls: false, ..FULL });
    for (node, [x, y, z]) in Lattice::new(&blocks(), 8).position.into_iter().enumerate() {
        let w = scene.columns.nodes.position[node][lane::nodes::position::INVERSE_MASS];
        scene.columns.nodes.position[node] = [x - 0.04, y - 0.02, z - 0.02, w];
        scene.columns.nodes.velocity[node] = [0.0; 4];
    }
    scene.params.gravity = Vec3::ZERO;
    for sponge in &mut scene.params.sponges {
        sponge.solver = Solver::Vbd;
        sponge.damping = 0.0;
    }
    scene
}

/// A step of the sponge alone.
fn step(scene: &mut Scene, sweeps: usize) {
    let mut names = vec!["pbd::gravity", "pbd::predict", "pbd::guess"];
    scene.params.sponges.iter_mut().for_each(|sponge| sponge.iterations = sweeps as u32);
    names.extend(vec!["pbd::vbd"; sweeps]);
    names.extend(["pbd::reaction", "pbd::momentum", "pbd::velocity"]);
    scene.run(&best(), &names);
}

fn vector(row: [f32; 4]) -> DVec3 {
    DVec3::new(f64::from(row[0]), f64::from(row[1]), f64::from(row[2]))
}

fn places(scene: &Scene) -> Vec<DVec3> {
    scene.columns.nodes.position[..scene.columns.rows.nodes].iter().map(|row| vector(*row)).collect()
}

/// Momentum and angular momentum about the origin, of all sponges.
fn momenta(scene: &Scene) -> [DVec3; 2] {
    let nodes = &scene.columns.nodes;
    let mut momenta = [DVec3::ZERO; 2];
    for node in 0..scene.columns.rows.nodes {
        let momentum = vector(nodes.velocity[node])
            / f64::from(nodes.position[node][lane::nodes::position::INVERSE_MASS]);
        momenta[0] += momentum;
        momenta[1] += vector(nodes.position[node]).cross(momentum);
    }
    momenta
}

fn map_velocities(scene: &mut Scene, map: impl Fn(usize, DVec3) -> DVec3) {
    for node in 0..scene.columns.rows.nodes {
        let v = map(node, vector(scene.columns.nodes.position[node])).as_vec3();
        scene.columns.nodes.velocity[node] = [v.x, v.y, v.z, 0.0];
    }
}

/// Smallest volume of a tet over that at rest.
fn smallest_ratio(scene: &Scene) -> f64 {
    let places = places(scene);
    let nodes = &scene.columns.nodes;
    let ratio = |tet: &[u32; 4]| {
        let [p0, p1, p2, p3] = tet.map(|node| places[node as usize]);
        let edge = EDGES[nodes.sponge[tet[0] as usize] as usize];
        (p1 - p0).dot((p2 - p3).cross(p2 + p3 - p0 - p1)) / edge.powi(3)
    };
    nodes.topology.tets.iter().map(ratio).fold(f64::INFINITY, f64::min)
}

#[test]
fn what_is_at_rest_stays_at_rest() {
    let mut scene = free();
    let before = places(&scene);
    step(&mut scene, 1);
    let moved = before.iter().zip(places(&scene)).map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
    assert!(moved < 1e-5 * EDGES[1], "{moved:.1e} m");
    // Negative control: a stretch by a thousandth is answered.
    for row in &mut scene.columns.nodes.position {
        (0..3).for_each(|axis| row[axis] *= 1.001);
    }
    let before = places(&scene);
    step(&mut scene, 1);
    let moved = before.iter().zip(places(&scene)).map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
    assert!(moved > 1e-5 * EDGES[1], "{moved:.1e} m");
}

#[test]
fn free_fall_is_exact_at_any_number_of_sweeps() {
    for (sweeps, length) in [(1, 0.001), (1, 0.01), (4, 0.004)] {
        let mut scene = free();
        scene.params.gravity = Vec3::new(0.0, -9.81, 0.0);
        scene.params.step = length;
        let before = places(&scene);
        for _ in 0..20 {
            step(&mut scene, sweeps);
        }
        let h = f64::from(length);
        let expected = 9.81 * h * h * 20.0 * 21.0 / 2.0;
        for (old, new) in before.iter().zip(places(&scene)) {
            let error = (new - *old + DVec3::Y * expected).length();
            assert!(error < 2e-6 * expected.max(0.1), "{sweeps} sweeps of {length}: {error:.1e} m");
        }
    }
}

#[test]
#[expect(clippy::disallowed_methods, reason = "compared with itself only")]
fn a_sweep_never_raises_the_energy() {
    let mut scene = free();
    let mut random = Random(9);
    let count = scene.columns.rows.nodes;
    scene.run(&best(), &["pbd::gravity", "pbd::predict", "pbd::guess"]);
    for row in &mut scene.columns.nodes.predicted[..count] {
        (0..3).for_each(|axis| row[axis] += (random.unit() - 0.5) * 0.02);
    }
    let energy = |scene: &Scene| -> f64 {
        let nodes = &scene.columns.nodes;
        let h = f64::from(scene.params.step);
        let y: Vec<DVec3> = nodes.predicted.iter().map(|row| vector(*row)).collect();
        let inertia = |node: usize| {
            (y[node] - vector(nodes.target[node])).length_squared()
                / (2.0 * h * h * f64::from(nodes.predicted[node][lane::nodes::predicted::INVERSE_MASS]))
        };
        let elastic = |(tet, weight): (&[u32; 4], &f32)| {
            let sponge = nodes.sponge[tet[0] as usize] as usize;
            let (edge, params) = (EDGES[sponge], &scene.params.sponges[sponge]);
            let (mu, lambda) = (f64::from(params.mu), f64::from(params.lambda));
            let [p0, p1, p2, p3] = tet.map(|node| y[node as usize]);
            let f = [p1 - p0, p2 - p3, p2 + p3 - p0 - p1].map(|column| column / edge);
            let square: f64 = f.iter().map(|f| f.length_squared()).sum();
            let ratio = f[0].dot(f[1].cross(f[2]));
            let minimum = ratio.max(0.2);
            let beyond = ratio / minimum - 1.0;
            let logarithm = minimum.ln() + beyond - 0.5 * beyond * beyond;
            f64::from(*weight) * edge.powi(3) / 24.0
                * (mu * (square - 3.0 - 2.0 * logarithm) + (lambda - mu) * (ratio - 1.0).powi(2))
        };
        let tets = nodes.topology.tets.iter().zip(&nodes.topology.weights);
        (0..count).map(inertia).sum::<f64>() + tets.map(elastic).sum::<f64>()
    };
    let mut last = energy(&scene);
    let first = last;
    for sweep in 0..30 {
        scene.run(&best(), &["pbd::vbd"]);
        let now = energy(&scene);
        assert!(now <= last * (1.0 + 1e-6), "sweep {sweep}: {last} J, then {now} J");
        last = now;
    }
    assert!(last < 0.1 * first, "{first} J, then {last} J");
    // Negative control: one node that is moved away raises it.
    scene.columns.nodes.predicted[3][0] += 0.001;
    assert!(energy(&scene) > last * (1.0 + 1e-6));
}

/// Changes of both momenta of a sponge that vibrates and spins, over what moves.
fn drift(damping: f32, steps: usize, correct: bool) -> [f64; 2] {
    let mut scene = free();
    scene.params.step = 0.004;
    scene.params.sponges.iter_mut().for_each(|sponge| sponge.damping = damping);
    let mut random = Random(11);
    let jitter: Vec<DVec3> = (0..scene.columns.rows.nodes)
        .map(|_| DVec3::from_array([0, 1, 2].map(|_| f64::from(random.unit() - 0.5))))
        .collect();
    let spin = DVec3::new(5.0, -8.0, 3.0);
    map_velocities(&mut scene, |node, x| DVec3::new(0.2, 0.1, -0.3) + spin.cross(x) + 0.2 * jitter[node]);
    let before = momenta(&scene);
    for _ in 0..steps {
        let mut names = vec!["pbd::gravity", "pbd::predict", "pbd::guess", "pbd::vbd", "pbd::reaction"];
        if correct {
            names.push("pbd::momentum");
        }
        names.push("pbd::velocity");
        scene.run(&best(), &names);
    }
    let after = momenta(&scene);
    [0, 1].map(|k| (after[k] - before[k]).length() / before[k].length())
}

#[test]
fn one_sweep_keeps_momentum_and_angular_momentum() {
    for damping in [0.0, 0.01] {
        let found = drift(damping, 50, true);
        // Fifty roundings of places of centimetres to f32, over steps of 4 ms.
        assert!(found[0] < 2e-5 && found[1] < 2e-4, "damping {damping}: {found:?}");
        // Negative control: what is corrected is worth it.
        let without = drift(damping, 50, false);
        assert!(without[0] > 1e-2 && without[1] > 1e-2, "damping {damping}: {without:?}");
    }
}

/// A spoilt sponge after two seconds.
fn recovered(spoil: impl Fn(usize, DVec3) -> DVec3) -> f64 {
    let mut scene = free();
    scene.params.step = 0.004;
    scene.params.sponges.iter_mut().for_each(|sponge| sponge.damping = 0.004);
    for node in 0..scene.columns.rows.nodes {
        let place = spoil(node, vector(scene.columns.nodes.position[node])).as_vec3();
        let w = scene.columns.nodes.position[node][lane::nodes::position::INVERSE_MASS];
        scene.columns.nodes.position[node] = [place.x, place.y, place.z, w];
    }
    assert!(smallest_ratio(&scene) <= 0.0, "nothing is spoilt");
    for _ in 0..500 {
        step(&mut scene, 4);
    }
    smallest_ratio(&scene)
}

#[test]
fn inverted_sponges_recover() {
    // Every coordinate is off by up to an edge, which inverts tets of every kind.
    let tangled = |seed| {
        let mut random = Random(seed);
        let mut unit = || f64::from(random.unit() - 0.5) * 2.0;
        let noise: Vec<DVec3> = (0..1000).map(|_| EDGES[0] * DVec3::new(unit(), unit(), unit())).collect();
        recovered(|node, x| x + noise[node])
    };
    let tangled = (3..7).map(tangled).fold(f64::INFINITY, f64::min);
    let flat = recovered(|_, x| DVec3::new(x.x, 0.0, x.z));
    let mirrored = recovered(|_, x| DVec3::new(x.x, x.y, -0.01 * x.z));
    assert!(tangled > 0.8 && flat > 0.8 && mirrored > 0.8, "{tangled} {flat} {mirrored}");
}
