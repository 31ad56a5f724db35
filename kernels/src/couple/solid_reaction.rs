//! Reaction of the nodes to the pressure of the particles: the exact opposite of the force on the particles.
//!
//! ```text
//! a_a += sum_i m_i (P_i grad lambda_ia at the beginning + dP_i grad lambda_ia where both are expected) / m_a
//! ```
//!
//! It is Archimedes' force on the material and the pressure of pores under compression. It is part of the load of the
//! elastic solve that follows.
//!
//! A density error is corrected at a limited speed (`sph::factors`), of the material as well: h |a| is at most that speed. Nodes that lie
//! scrambled between particles that weigh a hundred times as much would otherwise be shot.

use crate::{
    columns::{Columns, lane},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
    vector::times,
};

declare! {
    needs: [Fluid, Sponge, Incompressible, Porous],
    reads: [
        FluidPosition, FluidPredicted, ControlNode, ControlPosition, ControlSolid, ControlFluid, NodePosition,
        NodeAcceleration,
    ],
    writes: [NodeAcceleration],
    oracle: crate::oracle::porous::solid_reaction,
    bound: 4e-6,
    twin: [pass(NAME, Controls)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(smoothing) = &params.solid else { return };
    let (particles, predicted) = (&columns.fluid.position, &columns.fluid.predicted);
    let (controls, nodes) = (&columns.controls, &mut columns.nodes);
    let (mass, rest_density) = (params.fluid.particle_mass, params.fluid.rest_density);
    let Some(solve) = &params.fluid.incompressible else { return };
    let fastest = solve.correction_speed / params.step;
    let mut force = vec![[0.0_f32; 4]; controls.position.len()];
    cpu.for_chunks(&mut force[..], |first, force| {
        let lists = controls.fluid.chunk(first);
        with_lanes!(cpu, simd => {
            let kernel = smoothing.lanes(simd);
            let zero = lanes::splat(simd, 0.0);
            for row in (0..force.len()).step_by(LANES) {
                let [x, y, z, _] = lanes::load_rows(simd, &controls.position, first + row);
                let [ex, ey, ez, volume] = lanes::load_rows(simd, &controls.solid, first + row);
                let mut sum = [zero; 3];
                for entry in lists.group(row) {
                    let [xi, yi, zi, pressure] = lanes::gather_rows(simd, particles, entry);
                    let (dx, dy, dz) = (x - xi, y - yi, z - zi);
                    let u = kernel.closeness(dx * dx + dy * dy + dz * dz);
                    let push = pressure * rest_density * (u * u * u);
                    sum = [sum[0] + push * dx, sum[1] + push * dy, sum[2] + push * dz];
                    let [xi, yi, zi, change] = lanes::gather_rows(simd, predicted, entry);
                    let (dx, dy, dz) = (ex - xi, ey - yi, ez - zi);
                    let u = kernel.closeness(dx * dx + dy * dy + dz * dz);
                    let push = change * (u * u * u);
                    sum = [sum[0] + push * dx, sum[1] + push * dy, sum[2] + push * dz];
                }
                let sum = times(sum, volume * kernel.gradient_scale() * mass);
                lanes::store_rows(force, row, [sum[0], sum[1], sum[2], zero]);
            }
        });
    });
    for (node, force) in controls.node.iter().zip(&force) {
        let node = *node as usize;
        let inverse_mass = nodes.position[node][lane::nodes::position::INVERSE_MASS];
        let [x, y, z] = [0, 1, 2].map(|axis| force[axis] * inverse_mass);
        let length = (x * x + y * y + z * z).sqrt();
        let share = if length > fastest { fastest / length } else { 1.0 };
        for (sum, own) in nodes.acceleration[node].iter_mut().zip([x, y, z]) {
            *sum += own * share;
        }
    }
}
