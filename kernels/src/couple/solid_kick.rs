//! After the pressure solve: nodes receive the force of the pressure, the exact opposite of that on the particles, and particles have
//! velocities without the drag again.
//!
//! ```text
//! a_a += F_a / m_a
//! ```
//!
//! It is Archimedes' force on the material and the pressure of pores under compression: a part of the load of the elastic solve that
//! follows. Drag acts within that, on both.

use crate::{
    columns::{Columns, Controls, lane},
    cpu::Cpu,
    kernel::declare,
    params::Params,
};

declare! {
    needs: [Fluid, Sponge, Divergence, Porous],
    reads: [FluidUndragged, ControlNode, ControlForce, NodePosition, NodeAcceleration],
    writes: [FluidCorrection, NodeAcceleration],
    oracle: crate::oracle::solid::kick,
    bound: 4e-6,
    twin: [pass("couple::solid_undrag", Fluid), pass(NAME, Nodes)],
}

fn cpu(_: &Cpu, _: &Params, columns: &mut Columns) {
    let (fluid, nodes) = (&mut columns.fluid, &mut columns.nodes);
    fluid.correction.copy_from_slice(&fluid.undragged);
    let Controls { node, force, .. } = &columns.controls;
    for (node, force) in node.iter().zip(force) {
        let node = *node as usize;
        let inverse_mass = nodes.position[node][lane::nodes::position::INVERSE_MASS];
        (0..3).for_each(|axis| nodes.acceleration[node][axis] += force[axis] * inverse_mass);
    }
}
