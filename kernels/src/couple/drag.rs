//! Drag of the sponge on the particles: the impulse that each would lose to it (the paper, section 3.3).
//!
//! ```text
//! u_i = sum_a V_a W_ia u_a / chi_i                           velocity of the sponge at the particle
//! J_i = m h beta_i / (1 + h beta_i) (v_i - u_i)              linear drag, implicit in the particle
//! ```
//!
//! Differs from the paper, where the viscosity term is explicit: at the permeability of a real sponge the rate
//! beta is thousands per second, and an explicit term would need steps of microseconds.

use crate::{
    columns::{Column::*, Columns, Fluid},
    cpu::Cpu,
    kernel::{Kernel, Need},
    lanes::{self, LANES, prelude::*, select, with_lanes},
    params::Params,
    vector::{minus, times},
};

/// `couple::drag`.
pub static KERNEL: Kernel = Kernel {
    name: "couple::drag",
    needs: &[Need::Fluid, Need::Sponge],
    reads: &[
        FluidVelocity,
        FluidControls,
        FluidControlWeights,
        FluidInterior,
        FluidDragRate,
        ControlVelocity,
    ],
    writes: &[FluidDrag],
    cpu,
};

/// Interior value below which a particle feels no drag.
const OUTSIDE: f32 = 1.0e-3;

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Fluid { velocity, controls: lists, control_weights, interior, drag_rate, drag, .. } =
        &mut columns.fluid;
    let control_velocity = &columns.controls.velocity;
    let (step, mass) = (params.step, params.fluid.particle_mass);
    drag.resize(velocity.len(), [0.0; 4]);
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
                let mut sum = [zero; 3];
                for (entry, weight) in group.iter().zip(&weights[lists.range(row)]) {
                    let [ux, uy, uz, _] = lanes::gather_rows(simd, control_velocity, entry);
                    let weight = lanes::load(simd, weight, 0);
                    sum = [sum[0] + weight * ux, sum[1] + weight * uy, sum[2] + weight * uz];
                }
                let chi = lanes::load(simd, interior, first + row);
                let inside = chi.simd_gt(lanes::splat(simd, OUTSIDE));
                let inverse = one / select(inside, chi, one);
                let sponge = times(sum, inverse);
                let rate = lanes::load(simd, drag_rate, first + row) * step;
                let strength = select(inside, rate / (one + rate) * mass * inverse, zero);
                let lost = times(minus([vx, vy, vz], sponge), strength);
                lanes::store_rows(drag, row, [lost[0], lost[1], lost[2], strength]);
            }
        });
    });
}
