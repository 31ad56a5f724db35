//! Exchange of momentum between fluid and sponge by drag.

use glam::DVec3;

use super::scene::{FULL, Options, Scene, best};
use crate::columns::lane;

/// Momentum, its magnitude, and kinetic energy of particles and nodes.
#[derive(Clone, Copy, Debug)]
struct Motion {
    momentum: DVec3,
    magnitude: f64,
    energy: f64,
}

fn motion(scene: &Scene) -> Motion {
    let columns = &scene.columns;
    let particle = f64::from(scene.params.fluid.particle_mass);
    let fluid = columns.fluid.velocity[..columns.rows.fluid].iter().map(|v| (particle, *v));
    let masses =
        columns.nodes.position.iter().map(|x| 1.0 / f64::from(x[lane::nodes::position::INVERSE_MASS]));
    let nodes = masses.zip(columns.nodes.velocity.iter().copied()).take(columns.rows.nodes);
    let mut total = Motion { momentum: DVec3::ZERO, magnitude: 0.0, energy: 0.0 };
    for (mass, v) in fluid.chain(nodes) {
        let v = DVec3::new(f64::from(v[0]), f64::from(v[1]), f64::from(v[2]));
        total.momentum += mass * v;
        total.magnitude += mass * v.length();
        total.energy += 0.5 * mass * v.length_squared();
    }
    total
}

/// A free scene in which the fluid weighs twenty times as much as the sponge that it fills.
fn wet(strength: f32) -> Scene {
    let free = Options { bodies: false, walls: false, ..FULL };
    let mut scene = Scene::new(free);
    for (x, volume) in scene.columns.nodes.position.iter_mut().zip(&scene.columns.nodes.volume) {
        if x[lane::nodes::position::INVERSE_MASS] > 0.0 {
            x[lane::nodes::position::INVERSE_MASS] = 1.0 / (50.0 * volume);
        }
    }
    scene.params.sponges.iter_mut().for_each(|sponge| sponge.drag_rate *= strength);
    scene.before("couple::control_velocity", &best())
}

fn exchange(scene: &mut Scene, sweeps: usize) {
    let cpu = best();
    scene.run(&cpu, &["couple::control_velocity", "couple::drag"]);
    for _ in 0..sweeps {
        scene.run(&cpu, &["couple::velocity_filter", "couple::drag"]);
    }
    scene.run(&cpu, &["couple::exchange", "couple::drag_kick"]);
}

#[test]
fn drag_keeps_momentum_and_loses_energy() {
    for strength in [1.0, 100.0] {
        let mut last = 1.0;
        for sweeps in 0..=3 {
            let mut scene = wet(strength);
            let before = motion(&scene);
            exchange(&mut scene, sweeps);
            let after = motion(&scene);
            let error = (after.momentum - before.momentum).length() / before.magnitude;
            assert!(error < 1e-7, "{error:.1e}");
            let energy = after.energy / before.energy;
            assert!(energy < last, "x{strength}, {sweeps} sweeps: {energy} after {last}");
            last = energy;
        }
    }
    // Negative control: a node that is not told of its impulse shows.
    let mut scene = wet(1.0);
    let before = motion(&scene);
    let node = scene.columns.rows.nodes / 2;
    let velocity = scene.columns.nodes.velocity[node];
    exchange(&mut scene, 1);
    scene.columns.nodes.velocity[node] = velocity;
    assert!((motion(&scene).momentum - before.momentum).length() > 1e-6 * before.magnitude);
}

#[test]
fn strong_drag_is_stable() {
    for strength in [1.0, 100.0] {
        for sweeps in [0, 1, 3] {
            let mut scene = wet(strength);
            let mut last = motion(&scene).energy;
            for _ in 0..200 {
                exchange(&mut scene, sweeps);
                let energy = motion(&scene).energy;
                assert!(energy <= last * (1.0 + 1e-6), "x{strength}, {sweeps} sweeps: {energy} after {last}");
                last = energy;
            }
        }
    }
}

#[test]
fn drag_that_forgets_who_shares_a_node_is_not_stable() {
    let mut scene = wet(1.0);
    let first = motion(&scene).energy;
    for _ in 0..5 {
        scene.run(&best(), &["couple::control_velocity"]);
        scene
            .columns
            .controls
            .velocity
            .iter_mut()
            .for_each(|velocity| velocity[lane::controls::velocity::DRAG_SHARE] = 0.0);
        scene.run(&best(), &["couple::drag", "couple::exchange", "couple::drag_kick"]);
    }
    assert!(motion(&scene).energy > 10.0 * first);
}

/// Impulses on the nodes by a given flow, after so many sweeps.
fn impulses(sweeps: usize, flow: impl Fn([f32; 4]) -> [f32; 3]) -> Vec<f64> {
    let mut scene = wet(1.0);
    let fluid = &mut scene.columns.fluid;
    for (x, v) in fluid.position.iter().zip(&mut fluid.velocity).take(scene.columns.rows.fluid) {
        v[..3].copy_from_slice(&flow(*x));
    }
    scene.columns.nodes.velocity.fill([0.0; 4]);
    exchange(&mut scene, sweeps);
    let nodes = scene.columns.nodes.velocity.iter().zip(&scene.columns.nodes.position);
    nodes
        .take(scene.columns.rows.nodes)
        .flat_map(|(v, x)| {
            [0, 1, 2].map(|k| f64::from(v[k]) / f64::from(x[lane::nodes::position::INVERSE_MASS]))
        })
        .collect()
}

#[test]
fn sweeps_converge() {
    let length = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>().sqrt();
    let uniform = |_: [f32; 4]| [0.3, -0.2, 0.1];
    let shear = |x: [f32; 4]| [30.0 * (x[1] - 0.02), 0.0, 20.0 * x[0]];
    for name in ["uniform", "shear"] {
        let flow = |x| if name == "uniform" { uniform(x) } else { shear(x) };
        let converged = impulses(400, flow);
        let mut last = f64::INFINITY;
        for sweeps in [0, 1, 2, 3, 6, 12] {
            let found = impulses(sweeps, flow);
            let difference: Vec<f64> = found.iter().zip(&converged).map(|(a, b)| a - b).collect();
            let error = length(&difference) / length(&converged);
            assert!(error < last, "{name} {sweeps}: {error} after {last}");
            last = error;
        }
        assert!(last < 0.05, "{name}: {last}");
    }
}
