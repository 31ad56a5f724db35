//! Drag of the sponge on the particles: one sweep for the impulse of each on the sponge (the paper, section 3.3).
//!
//! ```text
//! u_i = sum_a w_ia u_a,   w_ia = V_a W_ia / chi_i             velocity of the sponge at the particle
//! k_i = m h beta_i / (1 + h beta_i)                          linear drag, implicit in the particle
//! J_i += (k_i (v_i - u_i) - J_i) / (1 + k_i sum_a w_ia s_a)
//! ```
//!
//! with `s_a` from `couple::control_velocity`, starting at J = 0. This is a Jacobi sweep for J = k (v - u(J)), implicit in
//! particles and nodes. The denominator is an upper bound of the row sum of the matrix. Every sweep therefore reduces the
//! kinetic energy, however strong the drag and however light the nodes. Momentum is conserved at any number of sweeps. Where
//! velocities and weights are uniform the first sweep is exact.
//!
//! Differs from the paper, where the drag is explicit. At the permeability of a real sponge the rate beta is thousands per
//! second: an explicit drag would need steps of microseconds.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
    vector::{minus, plus, times},
};

use super::impulses::{weight_inside, weighted};

declare! {
    needs: [Fluid, Sponge],
    reads: [
        FluidVelocity, FluidControls, FluidControlWeights, FluidDragRate, FluidDrag,
        ControlVelocity,
    ],
    writes: [FluidDrag],
    oracle: crate::oracle::couple::drag,
    bound: 2e-6,
    // Weights are computed where they are needed.
    twin_reads: [FluidPosition, ControlPosition],
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Fluid { velocity, controls: lists, control_weights, drag_rate, drag, .. } = &mut columns.fluid;
    let control_velocity = &columns.controls.velocity;
    let (step, mass) = (params.step, params.fluid.particle_mass);
    cpu.for_chunks(&mut drag[..], |first, drag| {
        let (lists, weights) = (lists.chunk(first), control_weights.chunk(first));
        with_lanes!(cpu, simd => {
            let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
            for row in (0..drag.len()).step_by(LANES) {
                let group = lists.group(row);
                if group.is_empty() {
                    drag[row..row + LANES].fill([0.0; 4]);
                    continue;
                }
                let [vx, vy, vz, _] = lanes::load_rows(simd, velocity, first + row);
                let sum = weighted(simd, control_velocity, group, &weights[lists.range(row)]);
                let [rate, _, _, chi] = lanes::load_rows(simd, drag_rate, first + row);
                let inverse = weight_inside(simd, chi);
                let sponge = times([sum[0], sum[1], sum[2]], inverse);
                let rate = rate * step;
                let strength = rate / (one + rate) * mass;
                // The column holds impulses over chi.
                let [jx, jy, jz, _] = lanes::load_rows(simd, drag, row);
                let old = [jx, jy, jz];
                let lacking = minus(times(minus([vx, vy, vz], sponge), strength * inverse), old);
                let new = plus(old, times(lacking, one / (one + strength * (sum[3] * inverse))));
                lanes::store_rows(drag, row, [new[0], new[1], new[2], zero]);
            }
        });
    });
}
