//! After the pressure solve nodes receive the force of the pressure, the exact opposite of that on the particles. Particles have velocities
//! without the drag again.
//!
//! ```text
//! a_a += F_a / m_a,   u'_a = u_a + I_a / m_a
//! ```
//!
//! The force is Archimedes' force on the material and the pressure of pores under compression. It is a part of the load of the elastic
//! solve that follows. Drag acts within that, on both. The velocity `u'` by the whole impulse of the pressure, with the water that drag
//! holds, is for the next step (`couple::solid_expect`).

use crate::{
    columns::{Columns, Controls, lane},
    cpu::Cpu,
    kernel::declare,
    params::Params,
};

declare! {
    needs: [Fluid, Sponge, Divergence, Porous],
    reads: [
        FluidUndragged, ControlNode, ControlForce, ControlImpulse, NodePosition, NodeVelocity, NodeAcceleration,
    ],
    writes: [FluidCorrection, NodeAcceleration, NodeDriven],
    oracle: crate::oracle::solid::kick,
    bound: 4e-6,
    twin: [pass("couple::solid_undrag", Fluid), pass(NAME, Nodes)],
}

fn cpu(_: &Cpu, params: &Params, columns: &mut Columns) {
    let (fluid, nodes) = (&mut columns.fluid, &mut columns.nodes);
    fluid.correction.copy_from_slice(&fluid.undragged);
    nodes.driven.clear();
    nodes.driven.resize(nodes.position.len(), [0.0; 4]);
    let Controls { node, force, impulse, .. } = &columns.controls;
    for ((node, force), impulse) in node.iter().zip(force).zip(impulse) {
        let node = *node as usize;
        let inverse_mass = nodes.position[node][lane::nodes::position::INVERSE_MASS];
        let (velocity, driven) = (nodes.velocity[node], &mut nodes.driven[node]);
        for axis in 0..3 {
            nodes.acceleration[node][axis] += force[axis] * inverse_mass;
            driven[axis] = velocity[axis] + impulse[axis] * inverse_mass;
        }
        driven[lane::nodes::driven::STEP] = params.step;
    }
}
