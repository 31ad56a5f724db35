//! Zero-distance constraints between nodes and the particles around them, which return the suction (the paper, section 3.3).
//!
//! ```text
//! F_a = sum_i k_ia (x_i - x_a),   k_ia = -r V_0 V_a p_a (210 / (pi H^5)) (1 - q_ia)^3
//! ```
//!
//! Differs from the paper, which tunes one stiffness by hand. With this stiffness and r = 1 the force on the node is exactly
//! opposite to the suction of `couple::suction`. A sponge then does not propel itself off the water.

use crate::{
    columns::{Columns, lane},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
    vector::times,
};

declare! {
    needs: [Fluid, Sponge],
    reads: [
        FluidPosition, ControlNode, ControlPosition, ControlFluid, ControlSuction, NodePosition, NodeSponge,
        NodeAcceleration,
    ],
    writes: [NodeAcceleration],
    oracle: crate::oracle::couple::zero_distance,
    bound: 6e-6,
    twin_bound: 1.5e-5,
    twin: [pass(NAME, Controls)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let particles = &columns.fluid.position;
    let (controls, nodes) = (&columns.controls, &mut columns.nodes);
    let volume = params.fluid.particle_mass / params.fluid.rest_density;
    let mut force = vec![[0.0_f32; 4]; controls.position.len()];
    cpu.for_chunks(&mut force[..], |first, force| {
        let lists = controls.fluid.chunk(first);
        with_lanes!(cpu, simd => {
            let kernel = params.coupling.lanes(simd);
            let zero = lanes::splat(simd, 0.0);
            for row in (0..force.len()).step_by(LANES) {
                let [x, y, z, _] = lanes::load_rows(simd, &controls.position, first + row);
                let mut sum = [zero; 3];
                for entry in lists.group(row) {
                    let [xi, yi, zi, _] = lanes::gather_rows(simd, particles, entry);
                    let (dx, dy, dz) = (x - xi, y - yi, z - zi);
                    let u = kernel.closeness(dx * dx + dy * dy + dz * dz);
                    let spring = u * u * u;
                    sum = [sum[0] + spring * dx, sum[1] + spring * dy, sum[2] + spring * dz];
                }
                let scale = lanes::load(simd, &controls.suction, first + row) * kernel.gradient_scale() * volume;
                let sum = times(sum, scale);
                lanes::store_rows(force, row, [sum[0], sum[1], sum[2], zero]);
            }
        });
    });
    for (node, force) in controls.node.iter().zip(&force) {
        let node = *node as usize;
        let scale = params.sponges[nodes.sponge[node] as usize].reaction
            * nodes.position[node][lane::nodes::position::INVERSE_MASS];
        (0..3).for_each(|axis| nodes.acceleration[node][axis] += force[axis] * scale);
    }
}
