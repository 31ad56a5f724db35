//! Velocities of the bodies at the end of the step, but for the pressure: by their weight, and by what they have received so far.
//!
//! ```text
//! u* = u + h g + J / m,   w* = w + I^-1 L
//! ```
//!
//! Bodies that forces do not move keep their velocities.

use glam::Vec3;

use crate::{columns::Columns, cpu::Cpu, kernel::declare, params::Params};

declare! {
    needs: [Fluid, Divergence],
    reads: [BodyStates, BodyFluidWrenches],
    writes: [BodyExpected, BodyExpectedSpin],
    oracle: crate::oracle::divergence::expect,
    bound: 1e-5,
    twin: [
        pass(NAME, Bodies).on(&[("wrenches", "body_fluid_wrenches")]),
    ],
}

fn cpu(_: &Cpu, params: &Params, columns: &mut Columns) {
    let store = &mut columns.bodies;
    let count = store.states.0.len();
    store.expected.resize(count, [0.0; 4]);
    store.expected_spin.resize(count, [0.0; 4]);
    for (index, body) in store.states.0.iter().enumerate() {
        let received = store.fluid_wrenches.total(index, count);
        let weight = if body.inverse_mass > 0.0 { params.step * params.gravity } else { Vec3::ZERO };
        let linear = body.state.linear_velocity + weight + body.inverse_mass * received.impulse.as_vec3();
        let angular = body.state.angular_velocity + body.inverse_inertia * received.angular_impulse.as_vec3();
        store.expected[index] = [linear.x, linear.y, linear.z, 0.0];
        store.expected_spin[index] = [angular.x, angular.y, angular.z, 0.0];
    }
}
