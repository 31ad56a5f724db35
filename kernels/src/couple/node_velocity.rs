//! Velocities of the nodes at the present state of the elastic solve, in the order of the controls.
//!
//! ```text
//! u_a = (y_a - x_a) / h
//! ```

use crate::{column::padded, columns::Columns, cpu::Cpu, kernel::declare, params::Params};

declare! {
    needs: [Fluid, Sponge, Incompressible, Porous],
    reads: [ControlNode, NodePosition, NodePredicted],
    writes: [ControlVelocity],
    oracle: crate::oracle::porous::node_velocity,
    bound: 4e-6,
    twin: [pass(NAME, Nodes)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
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
