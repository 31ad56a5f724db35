//! Iteration of the pressure solve with sponges: what the nodes receive, and how they respond.
//!
//! ```text
//! F_a = sum_i m P_i c_ia L_i (x_a - x_i)                   images of the node in walls included
//! I_a = h F_a + sum_i w_ia (1 - b_i) m h a_i               by the pressure, and by the water that drag holds
//! w_a = u_a + (Q_a + I_a) / D_a
//! ```
//!
//! u is the velocity of the node before the step. Q is the impulse that it is expected to receive from everything but the pressure
//! (`couple::solid_expect`). Both count with the same response: at rest they cancel, whatever `D` is. Without the response the scheme is
//! the drained split of poroelasticity, which is unstable for an incompressible fluid (docs/porous.md).

use crate::{
    columns::{Columns, Controls, Fluid, lane},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
    symmetric::Symmetric,
    vector::{dot, minus, plus, times},
};

use super::{impulses::weighted, solid_mirrors::Mirrors};

declare! {
    needs: [Fluid, Sponge, Divergence, Porous, Smoothed],
    reads: [
        FluidPredicted, FluidVelocity, FluidCorrection, FluidRenormalisation, FluidRenormalisationBetween, FluidHeld,
        ControlPosition, ControlFluid, ControlFluidWeights, ControlMaterial, ControlCompliance, ControlExpected,
    ],
    writes: [FluidHeld, FluidUndragged, ControlForce, ControlImpulse, ControlSolved],
    oracle: crate::oracle::solid::response,
    bound: 1e-5,
    twin: [pass("couple::solid_hold", Fluid), pass("couple::solid_push", Controls), pass(NAME, Nodes)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(smoothing) = &params.solid else { return };
    hold(cpu, &mut columns.fluid);
    let Fluid { predicted, renormalisation, renormalisation_between, held, .. } = &columns.fluid;
    let Controls {
        position,
        fluid: lists,
        fluid_weights,
        material,
        compliance,
        expected,
        force,
        impulse,
        solved,
        ..
    } = &mut columns.controls;
    for column in [&mut *force, &mut *impulse, &mut *solved] {
        column.resize(position.len(), [0.0; 4]);
    }
    let mass = params.fluid.particle_mass;
    let rows = (&mut force[..], &mut impulse[..], &mut solved[..]);
    cpu.for_chunks(rows, |first, (force, impulse, solved)| {
        let (lists, weights) = (lists.chunk(first), fluid_weights.chunk(first));
        with_lanes!(cpu, simd => {
            let kernel = smoothing.lanes(simd);
            let (zero, step) = (lanes::splat(simd, 0.0), lanes::splat(simd, params.step));
            for row in (0..force.len()).step_by(LANES) {
                let group = lists.group(row);
                let [x, y, z, _] = lanes::load_rows(simd, position, first + row);
                let mirrors = Mirrors::near(params, &position[first + row..][..LANES]);
                let mut sum = [zero; 3];
                for entry in group {
                    let [xi, yi, zi, pressure] = lanes::gather_rows(simd, predicted, entry);
                    let [xx, yy, zz, _] = lanes::gather_rows(simd, renormalisation, entry);
                    let [yz, zx, xy, _] = lanes::gather_rows(simd, renormalisation_between, entry);
                    let stress = Symmetric { along: [xx, yy, zz], between: [yz, zx, xy] };
                    for mirror in mirrors.iter() {
                        let offset = minus(mirror.image(simd, [x, y, z]), [xi, yi, zi]);
                        let u = kernel.closeness(dot(offset, offset));
                        let push = times(stress.times(offset), pressure * (u * u * u));
                        sum = plus(sum, mirror.turned(push));
                    }
                }
                let [cx, cy, cz, _] = weighted(simd, held, group, &weights[lists.range(row)]);
                let [compliance, _, _, volume] = lanes::load_rows(simd, compliance, first + row);
                let own = times(sum, volume * kernel.gradient_scale() * mass);
                let received = plus(times(own, step), [cx, cy, cz]);
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

/// The impulses that drag hands on to the nodes, over the interior values, and the velocities without drag.
fn hold(cpu: &Cpu, fluid: &mut Fluid) {
    let (velocity, correction) = (&fluid.velocity, &fluid.correction);
    fluid.undragged.resize(correction.len(), [0.0; 4]);
    cpu.for_chunks((&mut fluid.held[..], &mut fluid.undragged[..]), |first, (held, undragged)| {
        undragged.copy_from_slice(&correction[first..][..undragged.len()]);
        for ((held, v), w) in held.iter_mut().zip(&velocity[first..]).zip(undragged) {
            let mass = held[lane::fluid::held::MASS];
            (0..3).for_each(|axis| held[axis] = mass * (w[axis] - v[axis]));
        }
    });
}
