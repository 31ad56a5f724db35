//! Iteration of the pressure solve with sponges: what the nodes receive, and how they respond.
//!
//! ```text
//! F_a = sum_i m P_i g_ia
//! I_a = h F_a + sum_i b_ia (1 - b_i) m h a_i               by the pressure, and by the water that drag holds
//! w_a = u_a + (Q_a + I_a) / D_a
//! ```
//!
//! as in `couple::solid_response`, over the particles in the tets of the node.

use crate::{
    columns::{Columns, Controls, Fluid, lane},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
    vector::{plus, times},
};

declare! {
    needs: [Fluid, Sponge, Divergence, Porous, Barycentric],
    reads: [
        FluidPredicted, FluidVelocity, FluidCorrection, FluidShares, FluidPushed, ControlCorners, ControlMaterial,
        ControlCompliance, ControlExpected,
    ],
    writes: [FluidCarried, FluidUndragged, ControlForce, ControlImpulse, ControlSolved],
    oracle: crate::oracle::tets::response,
    bound: 1e-5,
    twin: [pass("tets::carry", Fluid), pass("tets::push", Controls), pass(NAME, Nodes)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    carry(cpu, params, &mut columns.fluid);
    let Fluid { shares, carried, .. } = &columns.fluid;
    let Controls { corners: lists, material, compliance, expected, force, impulse, solved, .. } =
        &mut columns.controls;
    for column in [&mut *force, &mut *impulse, &mut *solved] {
        column.resize(material.len(), [0.0; 4]);
    }
    let rows = (&mut force[..], &mut impulse[..], &mut solved[..]);
    cpu.for_chunks(rows, |first, (force, impulse, solved)| {
        let lists = lists.chunk(first);
        with_lanes!(cpu, simd => {
            let (zero, step) = (lanes::splat(simd, 0.0), lanes::splat(simd, params.step));
            for row in (0..force.len()).step_by(LANES) {
                let (mut own, mut held) = ([zero; 3], [zero; 3]);
                for entry in lists.group(row) {
                    let [gx, gy, gz, weight] = lanes::gather_rows(simd, shares.0.as_flattened(), entry);
                    let [x, y, z, pressure] = lanes::gather_rows(simd, carried, &entry.map(|place| place / 4));
                    own = plus(own, times([gx, gy, gz], pressure));
                    held = plus(held, times([x, y, z], weight));
                }
                let [compliance, _, _, volume] = lanes::load_rows(simd, compliance, first + row);
                let received = plus(times(own, step), held);
                let [qx, qy, qz, _] = lanes::load_rows(simd, expected, first + row);
                let [ux, uy, uz, _] = lanes::load_rows(simd, material, first + row);
                let [wx, wy, wz] = plus([ux, uy, uz], times(plus(received, [qx, qy, qz]), compliance));
                lanes::store_rows(force, row, [own[0], own[1], own[2], zero]);
                lanes::store_rows(impulse, row, [received[0], received[1], received[2], zero]);
                lanes::store_rows(solved, row, [wx, wy, wz, volume]);
            }
        });
    });
}

/// The impulses that drag hands on to the nodes, and the velocities without drag.
fn carry(cpu: &Cpu, params: &Params, fluid: &mut Fluid) {
    let Fluid { velocity, correction, predicted, pushed, carried, undragged, .. } = fluid;
    carried.resize(correction.len(), [0.0; 4]);
    undragged.resize(correction.len(), [0.0; 4]);
    let mass = params.fluid.particle_mass;
    cpu.for_chunks((&mut carried[..], &mut undragged[..]), |first, (carried, undragged)| {
        undragged.copy_from_slice(&correction[first..][..undragged.len()]);
        for (row, (carried, w)) in carried.iter_mut().zip(undragged).enumerate() {
            let (v, row) = (velocity[first + row], first + row);
            let held = mass * (1.0 - pushed[row][lane::fluid::pushed::MOBILITY]);
            (0..3).for_each(|axis| carried[axis] = held * (w[axis] - v[axis]));
            carried[lane::fluid::carried::ENERGY] = mass * predicted[row][lane::fluid::predicted::PRESSURE];
        }
    });
}
