//! Velocities that are expected of the nodes at the end of the step, but for what the pressure changes, and the volume of their material.
//!
//! ```text
//! u_a = u + h s a,   V_s = (1 - phi) V_a
//! ```
//!
//! with the share s of the external acceleration a that the node followed in the last step (`pbd::guess`).

use crate::{
    column::padded,
    columns::{Columns, lane},
    cpu::Cpu,
    kernel::declare,
    params::Params,
};

declare! {
    needs: [Fluid, Sponge, Divergence, Porous],
    reads: [ControlNode, NodeVelocity, NodeAcceleration, NodeSponge, NodeVolume],
    writes: [ControlExpected, ControlImpulse],
    oracle: crate::oracle::solid::expect,
    bound: 1e-6,
    twin: [pass(NAME, Nodes)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let (nodes, controls) = (&columns.nodes, &mut columns.controls);
    let (node, expected) = (&controls.node, &mut controls.expected);
    expected.clear();
    expected.resize(padded(node.len()), [0.0; 4]);
    // Nothing is known before the first round.
    controls.impulse.clear();
    controls.impulse.resize(padded(node.len()), [0.0; 4]);
    let step = params.step;
    cpu.for_chunks(&mut expected[..node.len()], |first, expected| {
        for (row, node) in expected.iter_mut().zip(&node[first..]) {
            let node = *node as usize;
            let (v, a) = (nodes.velocity[node], nodes.acceleration[node]);
            let share = v[lane::nodes::velocity::FOLLOWED_SHARE];
            (0..3).for_each(|axis| row[axis] = v[axis] + step * share * a[axis]);
            // Of the dry node: swelling widens pores and adds no material.
            let solid = 1.0 - params.sponges[nodes.sponge[node] as usize].porosity;
            row[lane::controls::expected::VOLUME] = solid * nodes.volume[node];
        }
    });
}
