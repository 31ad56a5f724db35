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
    columns::{Columns, Controls, lane},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, Simd, f32x8, select, with_lanes},
    params::Params,
};

declare! {
    needs: [Fluid, Solver(Vbd), Incompressible, Porous],
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
    constants: {
        /// Mass below which nothing is pulled \[kg\]: far below that of any particle, and its inverse is a number.
        const MINIMUM_DRAG_MASS: f32 = 1.0e-20;
    },
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let drag = &columns.fluid.drag;
    let Controls { node, position, velocity, fluid: lists, fluid_weights, .. } = &columns.controls;
    let (step, nodes) = (params.step, &mut columns.nodes);
    // Displacement of each node, and its mass.
    let mut moved = vec![[0.0_f32; 4]; velocity.len()];
    cpu.for_chunks(&mut moved[..], |first, moved| {
        let (lists, weights) = (lists.chunk(first), fluid_weights.chunk(first));
        with_lanes!(cpu, simd => {
            let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
            for row in (0..moved.len()).step_by(LANES) {
                let [jx, jy, jz, mass] = received(simd, drag, lists.group(row), &weights[lists.range(row)]);
                let is_pulled = mass.simd_gt(lanes::splat(simd, MINIMUM_DRAG_MASS));
                let inverse = select(is_pulled, one / select(is_pulled, mass, one), zero);
                let [ux, uy, uz, _] = lanes::load_rows(simd, velocity, first + row);
                let step = lanes::splat(simd, step);
                let [x, y, z] = [ux + jx * inverse, uy + jy * inverse, uz + jz * inverse];
                lanes::store_rows(moved, row, [x * step, y * step, z * step, select(is_pulled, mass, zero)]);
            }
        });
    });
    nodes.target.clone_from(&nodes.free);
    for ((node, place), moved) in node.iter().zip(position).zip(&moved) {
        let (free, target) = (nodes.free[*node as usize], &mut nodes.target[*node as usize]);
        let mass = free[lane::nodes::free::MASS] + moved[lane::fluid::drag::MASS];
        if free[lane::nodes::free::MASS] > 0.0 {
            let share = moved[lane::fluid::drag::MASS] / mass;
            (0..3).for_each(|axis| target[axis] += (place[axis] + moved[axis] - free[axis]) * share);
            target[lane::nodes::target::MASS] = mass;
        }
    }
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
