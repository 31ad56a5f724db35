//! The drag law, and the targets of nodes by its impulses.

use crate::{
    column::padded,
    columns::{Columns, Controls, Nodes, lane},
    cpu::Cpu,
    lanes::{self, Simd, f32x8, select},
    layout::constants,
    params::Params,
    vector::{Vec3x8, dot},
};

constants! {
    /// Mass below which nothing is pulled \[kg\]: far below that of any particle, and its inverse is a number.
    const MINIMUM_DRAG_MASS: f32 = 1.0e-20;
}

/// Part of its velocity relative to the sponge that a particle loses, at these linear and inertial rates.
#[inline(always)]
pub(crate) fn strength<S: Simd>(
    simd: S,
    step: f32,
    relative: Vec3x8<S>,
    [linear, inertial]: [f32x8<S>; 2],
) -> f32x8<S> {
    let one = lanes::splat(simd, 1.0);
    let speed = dot(relative, relative).sqrt();
    let slowed = one + linear * step;
    let root = (slowed * slowed + inertial * speed * (4.0 * step)).sqrt();
    let left = (speed + speed) / (slowed + root);
    let rate = (linear + inertial * left) * step;
    rate / (one + rate)
}

/// The velocities of the nodes, in the order of the controls.
pub(crate) fn node_velocities(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let (controls, nodes) = (&mut columns.controls, &columns.nodes);
    let (node, velocity) = (&controls.node, &mut controls.velocity);
    velocity.clear();
    velocity.resize(padded(node.len()), [0.0; 4]);
    let rate = 1.0 / params.step;
    cpu.for_chunks(&mut velocity[..node.len()], |first, velocity| {
        for (velocity, node) in velocity.iter_mut().zip(&node[first..]) {
            let (x, y) = (nodes.position[*node as usize], nodes.predicted[*node as usize]);
            (0..3).for_each(|axis| velocity[axis] = (y[axis] - x[axis]) * rate);
        }
    });
}

/// Displacement of eight nodes to their targets by the impulse and the mass of the drag, and that mass.
#[inline(always)]
pub(crate) fn displacement<S: Simd>(
    simd: S,
    step: f32,
    [ux, uy, uz, _]: [f32x8<S>; 4],
    [jx, jy, jz, mass]: [f32x8<S>; 4],
) -> [f32x8<S>; 4] {
    let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
    let is_pulled = mass.simd_gt(lanes::splat(simd, MINIMUM_DRAG_MASS));
    let inverse = select(is_pulled, one / select(is_pulled, mass, one), zero);
    let step = lanes::splat(simd, step);
    let [x, y, z] = [ux + jx * inverse, uy + jy * inverse, uz + jz * inverse];
    [x * step, y * step, z * step, select(is_pulled, mass, zero)]
}

/// Targets of the nodes by these displacements.
pub(crate) fn settle(moved: &[[f32; 4]], controls: &Controls, nodes: &mut Nodes) {
    nodes.target.clone_from(&nodes.free);
    for ((node, place), moved) in controls.node.iter().zip(&controls.position).zip(moved) {
        let (free, target) = (nodes.free[*node as usize], &mut nodes.target[*node as usize]);
        let mass = free[lane::nodes::free::MASS] + moved[lane::fluid::drag::MASS];
        if free[lane::nodes::free::MASS] > 0.0 {
            let share = moved[lane::fluid::drag::MASS] / mass;
            (0..3).for_each(|axis| target[axis] += (place[axis] + moved[axis] - free[axis]) * share);
            target[lane::nodes::target::MASS] = mass;
        }
    }
}
