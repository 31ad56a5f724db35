//! Pressure of the particles against the material of the sponge, at the beginning of the step.
//!
//! ```text
//! lambda_i = sum_a V_s W_ia,   V_s = (1 - phi) V_a         share of the material around a particle
//! a_i -= P_i grad lambda_i
//! ```
//!
//! The material displaces volume, as walls and bodies do: fluid and solid volume fraction add up to one. Pores hold the
//! volume that the porosity leaves, and release it under compression. The volume of the material is constant.
//!
//! In the solve that follows, the motion of nodes is prescribed. They move to their expected positions at the end of the
//! step. These have the share s of the external acceleration that the nodes followed in the last step (`pbd::guess`),
//!
//! ```text
//! x*_a = x_a + h (u_a + h s a_a)
//! ```

use crate::{
    column::padded,
    columns::{Columns, Fluid, lane},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
};

declare! {
    needs: [Fluid, Sponge, Density, Porous],
    reads: [
        FluidPosition, FluidControls, FluidAcceleration, ControlNode, ControlPosition, NodePosition,
        NodeVelocity, NodeAcceleration, NodeSponge, NodeVolume,
    ],
    writes: [FluidAcceleration, ControlSolid],
    oracle: crate::oracle::porous::solid_pressure,
    bound: 2e-5,
    twin: [pass("couple::expect_solid", Nodes), pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(smoothing) = &params.solid else { return };
    expect(params, columns);
    let Fluid { position, controls: lists, acceleration, .. } = &mut columns.fluid;
    let (controls, solid) = (&columns.controls.position, &columns.controls.solid);
    let rest_density = params.fluid.rest_density;
    cpu.for_chunks(&mut acceleration[..], |first, acceleration| {
        let lists = lists.chunk(first);
        with_lanes!(cpu, simd => {
            let kernel = smoothing.lanes(simd);
            let scale = kernel.gradient_scale() * rest_density;
            for row in (0..acceleration.len()).step_by(LANES) {
                let [x, y, z, pressure] = lanes::load_rows(simd, position, first + row);
                let mut sum = [lanes::splat(simd, 0.0); 3];
                for entry in lists.group(row) {
                    let [xa, ya, za, _] = lanes::gather_rows(simd, controls, entry);
                    let [_, _, _, volume] = lanes::gather_rows(simd, solid, entry);
                    let (dx, dy, dz) = (x - xa, y - ya, z - za);
                    let u = kernel.closeness(dx * dx + dy * dy + dz * dz);
                    let push = volume * (u * u * u);
                    sum = [sum[0] + push * dx, sum[1] + push * dy, sum[2] + push * dz];
                }
                let [ax, ay, az, aw] = lanes::load_rows(simd, acceleration, row);
                let scale = scale * pressure;
                let total = [ax + sum[0] * scale, ay + sum[1] * scale, az + sum[2] * scale, aw];
                lanes::store_rows(acceleration, row, total);
            }
        });
    });
}

/// Expected positions of the nodes at the end of the step, and the volume of their material.
fn expect(params: &Params, columns: &mut Columns) {
    let (nodes, controls) = (&columns.nodes, &mut columns.controls);
    let step = params.step;
    controls.solid.clear();
    controls.solid.resize(padded(controls.node.len()), [0.0; 4]);
    for (solid, node) in controls.solid.iter_mut().zip(&controls.node) {
        let node = *node as usize;
        let (x, v, a) = (nodes.position[node], nodes.velocity[node], nodes.acceleration[node]);
        let share = if x[lane::nodes::position::INVERSE_MASS] > 0.0 {
            v[lane::nodes::velocity::FOLLOWED_SHARE]
        } else {
            0.0
        };
        for axis in 0..3 {
            solid[axis] = x[axis] + step * (v[axis] + step * share * a[axis]);
        }
        // Of the dry node: swelling widens pores and adds no material.
        solid[lane::controls::solid::VOLUME] =
            (1.0 - params.sponges[nodes.sponge[node] as usize].porosity) * nodes.volume[node];
    }
}
