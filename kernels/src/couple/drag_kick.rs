//! Applies the drag to the particles: they lose the impulses that the nodes gain.
//!
//! ```text
//! v_i -= J_i / m
//! ```

use crate::{
    columns::{Columns, Fluid, lane},
    cpu::Cpu,
    kernel::declare,
    params::Params,
};

declare! {
    needs: [Fluid, Sponge, Smoothed],
    reads: [FluidVelocity, FluidDragRate, FluidDrag],
    writes: [FluidVelocity],
    oracle: crate::oracle::couple::drag_kick,
    bound: 2e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Fluid { velocity, drag, drag_rate, .. } = &mut columns.fluid;
    let inverse_mass = 1.0 / params.fluid.particle_mass;
    cpu.for_chunks(&mut velocity[..], |first, velocity| {
        for ((v, drag), rate) in velocity.iter_mut().zip(&drag[first..]).zip(&drag_rate[first..]) {
            let scale = rate[lane::fluid::drag_rate::NODE_WEIGHT] * inverse_mass;
            (0..3).for_each(|axis| v[axis] -= drag[axis] * scale);
        }
    });
}
