//! Drag impulse that every particle loses to the sponge, at the velocities of the nodes in the present state of the elastic solve.
//!
//! ```text
//! u_i = sum_k b_ik u_k                                     velocity of the sponge at the particle
//! J_i = k_i (v_i - u_i)
//! ```
//!
//! with the strength `k_i` and the speed that the drag leaves of `couple::drag_impulse`.

use super::rows::mean;
use crate::{
    columns::{Columns, Fluid},
    couple::drag_model::{node_velocities, strength},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
    vector::{minus, times},
};

declare! {
    needs: [Fluid, Sponge, Divergence, Porous, Barycentric],
    reads: [
        FluidVelocity, FluidDragRate, FluidCorners, FluidShares, ControlNode, NodePosition, NodePredicted,
    ],
    writes: [ControlVelocity, FluidDrag],
    oracle: crate::oracle::tets::drag_impulse,
    bound: 4e-6,
    twin: [pass("couple::node_velocity", Nodes), pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    node_velocities(cpu, params, columns);
    let Fluid { velocity, drag_rate, corners, shares, drag, .. } = &mut columns.fluid;
    let control_velocity = &columns.controls.velocity;
    let mass = params.fluid.particle_mass;
    drag.resize(velocity.len(), [0.0; 4]);
    cpu.for_chunks(&mut drag[..], |first, drag| {
        with_lanes!(cpu, simd => {
            for row in (0..drag.len()).step_by(LANES) {
                if corners.are_outside(first + row) {
                    drag[row..row + LANES].fill([0.0; 4]);
                    continue;
                }
                let [vx, vy, vz, _] = lanes::load_rows(simd, velocity, first + row);
                let u = mean(simd, control_velocity, (corners, shares), first + row);
                let relative = minus([vx, vy, vz], u);
                let [linear, inertial, _, _] = lanes::load_rows(simd, drag_rate, first + row);
                let strength = strength(simd, params.step, relative, [linear, inertial]) * mass;
                let [jx, jy, jz] = times(relative, strength);
                lanes::store_rows(drag, row, [jx, jy, jz, strength]);
            }
        });
    });
}
