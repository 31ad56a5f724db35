//! Applies the drag: particles lose what nodes gain.
//!
//! ```text
//! v_i -= J_i / m,   u_a = u0_a + sum_i w_ia J_i / m_a
//! ```
//!
//! Both sides use the same J_i, so that momentum is kept at any number of sweeps of the filter.

use crate::{
    columns::{Column::*, Columns},
    cpu::Cpu,
    kernel::{Kernel, Need},
    lanes::{self, LANES, with_lanes},
    params::Params,
};

/// `couple::exchange`.
pub static KERNEL: Kernel = Kernel {
    name: "couple::exchange",
    needs: &[Need::Fluid, Need::Sponge],
    reads: &[
        FluidPosition,
        FluidVelocity,
        FluidInterior,
        FluidDrag,
        ControlNode,
        ControlPosition,
        ControlUnfiltered,
        ControlFluid,
        NodeVelocity,
    ],
    writes: &[FluidVelocity, ControlVelocity, NodeVelocity],
    cpu,
};

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let (fluid, controls, nodes) = (&mut columns.fluid, &mut columns.controls, &mut columns.nodes);
    let (position, unfiltered, lists) = (&controls.position, &controls.unfiltered, &controls.fluid);
    let (particles, drag, interior) = (&fluid.position, &fluid.drag, &fluid.interior);
    cpu.for_chunks(&mut controls.velocity[..], |first, velocity| {
        let lists = lists.chunk(first);
        with_lanes!(cpu, simd => {
            let kernel = params.coupling.lanes(simd);
            for row in (0..velocity.len()).step_by(LANES) {
                let [ox, oy, oz, w] = lanes::load_rows(simd, unfiltered, first + row);
                let received = super::velocity_filter::received(
                    simd, kernel, (position, first + row), (particles, drag), lists, row,
                );
                let new = [ox + w * received[0], oy + w * received[1], oz + w * received[2], w];
                lanes::store_rows(velocity, row, new);
            }
        });
    });
    let inverse_mass = 1.0 / params.fluid.particle_mass;
    cpu.for_chunks(&mut fluid.velocity[..], |first, velocity| {
        for ((v, drag), chi) in velocity.iter_mut().zip(&drag[first..]).zip(&interior[first..]) {
            let scale = chi * inverse_mass;
            (0..3).for_each(|axis| v[axis] -= drag[axis] * scale);
        }
    });
    for (node, velocity) in controls.node.iter().zip(&controls.velocity) {
        let v = &mut nodes.velocity[*node as usize];
        (v[0], v[1], v[2]) = (velocity[0], velocity[1], velocity[2]);
    }
}
