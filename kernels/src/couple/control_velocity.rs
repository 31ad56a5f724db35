//! Brings the velocities of the nodes, after their constraints, into the order of the controls.

use crate::{
    columns::{Column::*, Columns, Controls, padded},
    cpu::Cpu,
    kernel::{Kernel, Need},
    params::Params,
};

/// `couple::control_velocity`.
pub static KERNEL: Kernel = Kernel {
    name: "couple::control_velocity",
    needs: &[Need::Fluid, Need::Sponge],
    reads: &[ControlNode, NodePosition, NodeVelocity],
    writes: &[ControlVelocity, ControlUnfiltered],
    cpu,
};

fn cpu(cpu: &Cpu, _params: &Params, columns: &mut Columns) {
    let nodes = &columns.nodes;
    let Controls { node, velocity, unfiltered, .. } = &mut columns.controls;
    velocity.clear();
    velocity.resize(padded(node.len()), [0.0; 4]);
    cpu.for_chunks(&mut velocity[..node.len()], |first, velocity| {
        for (velocity, node) in velocity.iter_mut().zip(&node[first..]) {
            let ([x, y, z, _], [_, _, _, w]) =
                (nodes.velocity[*node as usize], nodes.position[*node as usize]);
            *velocity = [x, y, z, w];
        }
    });
    unfiltered.clone_from(velocity);
}
