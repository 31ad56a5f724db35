//! What nodes bring into the solve for the pressure. These are their velocities, the impulses that they are expected to receive from
//! everything but the pressure, and the volume of their material.
//!
//! ```text
//! u_a = u,   Q_a = m_a (h / h') (u - u'),   V_s = (1 - phi) V_a
//! ```
//!
//! `u'` is the velocity that the node would have by the pressure alone in the last step, of length h' (`couple::solid_kick`). What it lacks
//! of u came from elasticity, contact, gravity and the drag of moving water: these change slowly from step to step.

use crate::{
    column::padded,
    columns::{Columns, Nodes, lane},
    cpu::Cpu,
    kernel::declare,
    params::Params,
};

declare! {
    needs: [Fluid, Sponge, Divergence, Porous],
    reads: [ControlNode, NodePosition, NodeVelocity, NodeDriven, NodeSponge, NodeVolume],
    writes: [ControlMaterial, ControlExpected],
    oracle: crate::oracle::solid::expect,
    bound: 1e-6,
    twin: [pass(NAME, Nodes)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let (nodes, controls) = (&columns.nodes, &mut columns.controls);
    let (node, material, expected) = (&controls.node, &mut controls.material, &mut controls.expected);
    for column in [&mut *material, expected] {
        column.clear();
        column.resize(padded(node.len()), [0.0; 4]);
    }
    let rows = (&mut material[..node.len()], &mut expected[..node.len()]);
    cpu.for_chunks(rows, |first, (material, expected)| {
        for (row, node) in node[first..][..material.len()].iter().enumerate() {
            let node = *node as usize;
            // Of the dry node: swelling widens pores and adds no material.
            let solid = 1.0 - params.sponges[nodes.sponge[node] as usize].porosity;
            let [vx, vy, vz, _] = nodes.velocity[node];
            material[row] = [vx, vy, vz, solid * nodes.volume[node]];
            expected[row] = impulse(params, nodes, node);
        }
    });
}

/// Impulse that a node is expected to receive from everything but the pressure; none of held nodes and before the first step.
fn impulse(params: &Params, nodes: &Nodes, node: usize) -> [f32; 4] {
    let inverse_mass = nodes.position[node][lane::nodes::position::INVERSE_MASS];
    let driven = nodes.driven.get(node).copied().unwrap_or_default();
    let step = driven[lane::nodes::driven::STEP];
    if inverse_mass == 0.0 || step == 0.0 {
        return [0.0; 4];
    }
    let scale = params.step / (step * inverse_mass);
    let [x, y, z] = [0, 1, 2].map(|axis| scale * (nodes.velocity[node][axis] - driven[axis]));
    [x, y, z, 0.0]
}
