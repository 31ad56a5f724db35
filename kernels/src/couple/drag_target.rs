//! Targets of the nodes by the drag of the fluid, for a sweep of vertex block descent.
//!
//! Elasticity, inertia and drag are one minimisation, in which the drag is the energy
//!
//! ```text
//! E_d(x) = sum_i k_i / 2 |v_i - sum_a w_ia (x_a - x_a(before)) / h|^2
//! ```
//!
//! Its matrix couples all nodes around a particle. The weights add up to one, so that the diagonal matrix of its row sums is
//! an upper bound of it. A sweep with that instead,
//!
//! ```text
//! k_a = sum_i w_ia k_i,   t_a = x_a(before) + h (u_a + sum_i w_ia J_i / k_a),   E_a(x) = k_a / (2 h^2) |x - t_a|^2
//! ```
//!
//! never raises the energy, converges to the same minimum, and is exact at once for uniform motion. Together with the
//! inertia it is one mass, that of the node and of the fluid, with the weighted mean of both targets.

use crate::{
    columns::{Columns, Controls},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, Simd, f32x8, with_lanes},
    params::Params,
};

use super::drag_model::{displacement, settle};

declare! {
    needs: [Fluid, Solver(Vbd), Incompressible, Porous, Smoothed],
    reads: [
        FluidDrag, ControlNode, ControlPosition, ControlVelocity, ControlFluid, ControlFluidWeights, NodeFree,
    ],
    writes: [NodeTarget],
    oracle: crate::oracle::porous::drag_target,
    // Few particles hardly move the target of a node.
    bound: 1.5e-4,
    // Weights are computed where they are needed.
    twin_reads: [FluidPosition],
    twin: [pass(NAME, Controls)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let drag = &columns.fluid.drag;
    let controls = &columns.controls;
    let Controls { velocity, fluid: lists, fluid_weights, .. } = controls;
    // Displacement of each node, and its mass.
    let mut moved = vec![[0.0_f32; 4]; velocity.len()];
    cpu.for_chunks(&mut moved[..], |first, moved| {
        let (lists, weights) = (lists.chunk(first), fluid_weights.chunk(first));
        with_lanes!(cpu, simd => {
            for row in (0..moved.len()).step_by(LANES) {
                let received = received(simd, drag, lists.group(row), &weights[lists.range(row)]);
                let velocity = lanes::load_rows(simd, velocity, first + row);
                lanes::store_rows(moved, row, displacement(simd, params.step, velocity, received));
            }
        });
    });
    settle(&moved, controls, &mut columns.nodes);
}

/// Sum over the particles of eight controls of `V_a W_ia` times the rows of the drag.
#[inline(always)]
pub(super) fn received<S: Simd>(
    simd: S,
    drag: &[[f32; 4]],
    lists: &[[u32; LANES]],
    weights: &[[f32; LANES]],
) -> [f32x8<S>; 4] {
    let mut sum = [lanes::splat(simd, 0.0); 4];
    for (entry, weight) in lists.iter().zip(weights) {
        let [jx, jy, jz, mass] = lanes::gather_rows(simd, drag, entry);
        let weight = lanes::load(simd, weight, 0);
        sum = [sum[0] + weight * jx, sum[1] + weight * jy, sum[2] + weight * jz, sum[3] + weight * mass];
    }
    sum
}
