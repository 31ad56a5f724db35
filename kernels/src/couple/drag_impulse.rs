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
//! with the speed s that the drag leaves, `s (1 + h beta + h gamma s) = |v - u|`. With the speed before the drag, drag would
//! grow with the step.
//!
//! `couple::drag_target` computes the targets of the nodes from it, and `couple::drag_kick` applies it to the particles.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
    vector::{minus, times},
};

use super::{
    drag_model::{node_velocities, strength},
    impulses::{weight_inside, weighted},
};

declare! {
    needs: [Fluid, Sponge, Incompressible, Porous, Smoothed],
    reads: [
        FluidVelocity, FluidControls, FluidControlWeights, FluidDragRate, ControlNode, NodePosition,
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
    let Fluid { velocity, controls: lists, control_weights, drag_rate, drag, .. } = &mut columns.fluid;
    let control_velocity = &columns.controls.velocity;
    let (step, mass) = (params.step, params.fluid.particle_mass);
    drag.resize(drag_rate.len(), [0.0; 4]);
    cpu.for_chunks(&mut drag[..], |first, drag| {
        let (lists, weights) = (lists.chunk(first), control_weights.chunk(first));
        with_lanes!(cpu, simd => {
            for row in (0..drag.len()).step_by(LANES) {
                let group = lists.group(row);
                if group.is_empty() {
                    drag[row..row + LANES].fill([0.0; 4]);
                    continue;
                }
                let [vx, vy, vz, _] = lanes::load_rows(simd, velocity, first + row);
                let [ux, uy, uz, _] = weighted(simd, control_velocity, group, &weights[lists.range(row)]);
                let [linear, inertial, _, chi] = lanes::load_rows(simd, drag_rate, first + row);
                let inverse = weight_inside(simd, chi);
                let relative = minus([vx, vy, vz], times([ux, uy, uz], inverse));
                // The column has impulses and masses over chi.
                let strength = strength(simd, step, relative, [linear, inertial]) * mass * inverse;
                let [jx, jy, jz] = times(relative, strength);
                lanes::store_rows(drag, row, [jx, jy, jz, strength]);
            }
        });
    });
}
