//! Initial position change: semi-implicit Euler without the elastic forces (the paper, Figure 2).
//!
//! ```text
//! y = x + h (v + h a)
//! ```
//!
//! with the external acceleration a, by gravity and fluid. Held nodes follow their body.

use glam::{Mat3, Vec3};

use crate::{
    body::Body,
    columns::{Columns, Nodes, lane},
    cpu::Cpu,
    kernel::declare,
    params::Params,
    wrench,
};

declare! {
    needs: [Sponge],
    reads: [NodePosition, NodeVelocity, NodeAcceleration, NodeGrip, NodeGripOffset, BodyStates],
    writes: [NodePredicted, BodyNodeWrenches],
    oracle: crate::oracle::pbd::predict,
    bound: 2e-5,
    twin: [pass(NAME, Nodes)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let bodies = &columns.bodies.states.0;
    let wrenches = &mut columns.bodies.node_wrenches.0;
    let Nodes { position, velocity, acceleration, grip, grip_offset, predicted, .. } = &mut columns.nodes;
    wrench::begin(wrenches, position.len(), bodies.len());
    predicted.resize(position.len(), [0.0; 4]);
    let h = params.step;
    cpu.for_chunks(&mut predicted[..], |first, predicted| {
        if params.asleep.has_all(first..first + predicted.len()) {
            predicted.copy_from_slice(&position[first..first + predicted.len()]);
            predicted.iter_mut().for_each(|row| row[lane::nodes::predicted::INVERSE_MASS] = 0.0);
            return;
        }
        for (row, predicted) in predicted.iter_mut().enumerate() {
            let node = first + row;
            let (x, v, a) = (position[node], velocity[node], acceleration[node]);
            if params.asleep.has(node) {
                *predicted = [x[0], x[1], x[2], 0.0];
                continue;
            }
            let y = match bodies.get(grip[node] as usize) {
                Some(body) => held(body, grip_offset[node], h).to_array(),
                None => [0, 1, 2].map(|axis| x[axis] + h * (v[axis] + h * a[axis])),
            };
            *predicted = [y[0], y[1], y[2], x[lane::nodes::position::INVERSE_MASS]];
        }
    });
}

/// Position of a held node at the end of the step.
fn held(body: &Body, offset: [f32; 4], step: f32) -> Vec3 {
    let arm = Mat3::from_quat(body.state.rotation) * Vec3::new(offset[0], offset[1], offset[2]);
    let velocity = body.state.linear_velocity + body.state.angular_velocity.cross(arm);
    body.state.position + arm + velocity * step
}
