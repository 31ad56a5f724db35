//! Water at rest: no pressures that alternate from particle to particle, and no motion.

use glam::Vec3;

use super::World;
use crate::scene::{Fluid, FluidBlock, FluidSolver, Scene};

/// Particles over the depth of the pool, and along its sides.
const LAYERS: usize = 20;

/// Scatter of the pressure within layers over the pressure at the floor, and the largest mean speed of a layer \[m/s\],
/// after four seconds.
fn pool(solver: FluidSolver, roughness: f32) -> (f64, f64) {
    let spacing = 0.02;
    let side = 0.5 * LAYERS as f32 * spacing;
    let (low, high) = (Vec3::new(-side, 0.0, -side), Vec3::new(side, 2.0 * side, side));
    let blocks = vec![FluidBlock::new(low, high)];
    let fluid = Fluid { spacing, blocks, solver: Some(solver), ..Fluid::default() };
    let scene = Scene::new("pool").in_box(low, high + Vec3::new(0.0, 0.1, 0.0)).with_fluid(fluid);
    let mut world = World::new(&scene).unwrap_or_else(|error| panic!("{error}"));
    world.params.fluid.roughness *= roughness;
    for _ in 0..240 {
        world.advance_frame().unwrap_or_else(|error| panic!("{error}"));
    }
    let mut layers = vec![[0.0; 4]; LAYERS + 2];
    let rows =
        world.particle_positions().iter().zip(world.particle_velocities()).zip(world.particle_pressures());
    for ((x, v), pressure) in rows {
        // Walls bear a part of the pressure.
        if x[0].abs() < side - 1.5 * spacing && x[2].abs() < side - 1.5 * spacing {
            let layer = &mut layers[((x[1] / spacing) as usize).min(LAYERS + 1)];
            let (pressure, speed) = (f64::from(pressure), f64::from(Vec3::new(v[0], v[1], v[2]).length()));
            *layer = [layer[0] + 1.0, layer[1] + pressure, layer[2] + pressure * pressure, layer[3] + speed];
        }
    }
    let weight = 9810.0 * f64::from(2.0 * side);
    let full = layers.iter().filter(|layer| layer[0] > 20.0);
    full.fold((0.0, 0.0), |(scatter, speed), [count, sum, squares, speeds]| {
        let variance = (squares / count - (sum / count).powi(2)).max(0.0);
        (f64::max(scatter, variance.sqrt() / weight), f64::max(speed, speeds / count))
    })
}

#[test]
#[expect(clippy::print_stdout, reason = "the figures of the documentation")]
fn a_pool_at_rest_has_smooth_pressures_and_does_not_move() {
    let (scatter, speed) = pool(FluidSolver::Divergence, 1.0);
    println!("divergence: scatter {scatter:.4}, fastest layer {speed:.5} m/s");
    assert!(scatter < 0.005 && speed < 4e-3, "scatter {scatter:.1e}, {speed:.1e} m/s");
    let (scatter, speed) = pool(FluidSolver::Dfsph, 1.0);
    println!("dfsph: scatter {scatter:.4}, fastest layer {speed:.5} m/s");
    assert!(scatter < 0.03 && speed < 4e-3, "scatter {scatter:.1e}, {speed:.1e} m/s");
    // The control: without the compact Laplacian in the solve.
    let (scatter, speed) = pool(FluidSolver::Dfsph, 0.0);
    println!("without: scatter {scatter:.4}, fastest layer {speed:.5} m/s");
    assert!(scatter > 0.06, "scatter {scatter:.1e}");
}
