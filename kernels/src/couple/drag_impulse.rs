//! Drag impulse that every particle loses to the sponge, at the velocities of the nodes in the present state of the elastic
//! solve.
//!
//! ```text
//! u_a = (y_a - x_a) / h                                       velocity of the node
//! u_i = sum_a w_ia u_a,   w_ia = V_a W_ia / chi_i             velocity of the sponge at the particle
//! b_i = beta_i + gamma_i s_i,   k_i = m h b_i / (1 + h b_i)       implicit in the particle
//! J_i = k_i (v_i - u_i)
//! s_i = 2 |v_i - u_i| / (1 + h beta_i + sqrt((1 + h beta_i)^2 + 4 h gamma_i |v_i - u_i|))
//! ```
//!
//! with the speed s that the drag leaves, `s (1 + h beta + h gamma s) = |v - u|`: with the speed before the drag, drag would
//! grow with the step.
//!
//! `couple::drag_target` computes the targets of the nodes from it, and `couple::drag_kick` applies it to the particles.

use crate::{
    column::padded,
    columns::{Columns, Fluid},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
    vector::{dot, minus, times},
};

use super::impulses::{weight_inside, weighted};

declare! {
    needs: [Fluid, Sponge, Incompressible, Porous],
    reads: [
        FluidVelocity, FluidControls, FluidControlWeights, FluidInterior, FluidDragRate, ControlNode, NodePosition,
        NodePredicted,
    ],
    writes: [ControlVelocity, FluidDrag],
    oracle: crate::oracle::porous::drag_impulse,
    bound: 4e-6,
    // Weights are computed where they are needed.
    twin_reads: [FluidPosition, ControlPosition],
    twin: [pass("couple::node_velocity", Nodes), pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    node_velocities(cpu, params, columns);
    let Fluid { velocity, controls: lists, control_weights, interior, drag_rate, drag, .. } =
        &mut columns.fluid;
    let control_velocity = &columns.controls.velocity;
    let (step, mass) = (params.step, params.fluid.particle_mass);
    drag.resize(interior.len(), [0.0; 4]);
    cpu.for_chunks(&mut drag[..], |first, drag| {
        let (lists, weights) = (lists.chunk(first), control_weights.chunk(first));
        with_lanes!(cpu, simd => {
            let one = lanes::splat(simd, 1.0);
            for row in (0..drag.len()).step_by(LANES) {
                let group = lists.group(row);
                if group.is_empty() {
                    drag[row..row + LANES].fill([0.0; 4]);
                    continue;
                }
                let [vx, vy, vz, _] = lanes::load_rows(simd, velocity, first + row);
                let [ux, uy, uz, _] = weighted(simd, control_velocity, group, &weights[lists.range(row)]);
                let inverse = weight_inside(simd, lanes::load(simd, interior, first + row));
                let relative = minus([vx, vy, vz], times([ux, uy, uz], inverse));
                let [linear, inertial, _, _] = lanes::load_rows(simd, drag_rate, first + row);
                let speed = dot(relative, relative).sqrt();
                let slowed = one + linear * step;
                let root = (slowed * slowed + inertial * speed * (4.0 * step)).sqrt();
                let left = (speed + speed) / (slowed + root);
                let rate = (linear + inertial * left) * step;
                // The column has impulses and masses over chi.
                let strength = rate / (one + rate) * mass * inverse;
                let [jx, jy, jz] = times(relative, strength);
                lanes::store_rows(drag, row, [jx, jy, jz, strength]);
            }
        });
    });
}

/// The velocities of the nodes, in the order of the controls.
fn node_velocities(cpu: &Cpu, params: &Params, columns: &mut Columns) {
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
