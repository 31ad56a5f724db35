//! Reaction of the suction of particles on the corners of their tets.
//!
//! ```text
//! a_k -= r sum_i b_ik m a_i / m_k                          a_i: acceleration of the particle by suction
//! ```
//!
//! Takes the place of `couple::zero_distance`: a node without water in its tets is not pulled, as nothing holds it by drag either.

use crate::{
    column::padded,
    columns::Columns,
    couple::impulses::accelerate,
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
    vector::{plus, times},
};

declare! {
    needs: [Fluid, Sponge, Divergence, Porous, Barycentric],
    reads: [
        FluidSuction, FluidShares, ControlNode, ControlCorners, NodePosition, NodeSponge, NodeAcceleration,
    ],
    writes: [NodeAcceleration],
    oracle: crate::oracle::tets::suction,
    bound: 6e-6,
    twin_bound: 1.5e-5,
    twin: [pass(NAME, Controls)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let (suction, shares, controls) = (&columns.fluid.suction, &columns.fluid.shares, &columns.controls);
    let mut force = vec![[0.0_f32; 4]; padded(controls.node.len())];
    cpu.for_chunks(&mut force[..], |first, force| {
        let lists = controls.corners.chunk(first);
        with_lanes!(cpu, simd => {
            let zero = lanes::splat(simd, 0.0);
            for row in (0..force.len()).step_by(LANES) {
                let mut sum = [zero; 3];
                for entry in lists.group(row) {
                    let [.., weight] = lanes::gather_rows(simd, shares.0.as_flattened(), entry);
                    let [x, y, z, _] = lanes::gather_rows(simd, suction, &entry.map(|place| place / 4));
                    sum = plus(sum, times([x, y, z], weight));
                }
                let [x, y, z] = times(sum, lanes::splat(simd, -params.fluid.particle_mass));
                lanes::store_rows(force, row, [x, y, z, zero]);
            }
        });
    });
    accelerate(params, &mut columns.nodes, &controls.node, &force);
}
