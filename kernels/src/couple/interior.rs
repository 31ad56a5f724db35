//! How far inside a sponge every particle is, and how fast drag acts there.
//!
//! ```text
//! chi_i = sum_a V_a W_ia,    beta_i = sum_a V_a W_ia mu phi_a / (rho K_a)
//! ```
//!
//! chi is 1 deep inside and 0 outside.

use crate::{
    columns::{Column::*, Columns, Fluid},
    cpu::Cpu,
    kernel::{Kernel, Need},
    lanes::{self, LANES, with_lanes},
    params::Params,
};

/// `couple::interior`.
pub static KERNEL: Kernel = Kernel {
    name: "couple::interior",
    needs: &[Need::Fluid, Need::Sponge],
    reads: &[
        FluidPosition,
        FluidControls,
        ControlPosition,
        ControlNode,
        NodeSponge,
    ],
    writes: &[FluidInterior, FluidDragRate],
    cpu,
};

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Fluid {
        position,
        controls: lists,
        interior,
        drag_rate,
        ..
    } = &mut columns.fluid;
    let controls = &columns.controls.position;
    // One rate per control row; padding rows weigh nothing.
    let mut rate = vec![0.0; controls.len()];
    for (rate, node) in rate.iter_mut().zip(&columns.controls.node) {
        *rate = params.sponges[columns.nodes.sponge[*node as usize] as usize].drag_rate;
    }
    interior.resize(position.len(), 0.0);
    drag_rate.resize(position.len(), 0.0);
    cpu.for_chunks(
        (&mut interior[..], &mut drag_rate[..]),
        |first, (interior, drag_rate)| {
            let lists = lists.chunk(first);
            with_lanes!(cpu, simd => {
                let kernel = params.coupling.lanes(simd);
                for row in (0..interior.len()).step_by(LANES) {
                    let [x, y, z, _] = lanes::load_rows(simd, position, first + row);
                    let mut sum = lanes::splat(simd, 0.0);
                    let mut drag = lanes::splat(simd, 0.0);
                    for entry in lists.group(row) {
                        let [xa, ya, za, volume] = lanes::gather_rows(simd, controls, entry);
                        let (dx, dy, dz) = (x - xa, y - ya, z - za);
                        let weight = volume * kernel.shape(kernel.closeness(dx * dx + dy * dy + dz * dz));
                        sum += weight;
                        drag += weight * lanes::gather(simd, &rate, entry);
                    }
                    lanes::store(interior, row, sum * kernel.value_scale());
                    lanes::store(drag_rate, row, drag * kernel.value_scale());
                }
            });
        },
    );
}
