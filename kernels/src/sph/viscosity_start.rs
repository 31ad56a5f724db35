//! Before the implicit viscosity begins: the velocities take the place of the direction, and zero that of the product. With viscosity by
//! the rate of strain the passes of an iteration then have the strains of the velocities for `sph::viscosity_begin`.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    kernel::declare,
    params::Params,
};

declare! {
    needs: [Fluid, ImplicitViscosity],
    reads: [FluidVelocity],
    writes: [FluidViscosityDirection, FluidViscosityProduct],
    oracle: crate::oracle::strain::viscosity_start,
    bound: 0.0,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, _params: &Params, columns: &mut Columns) {
    let count = columns.rows.fluid;
    let Fluid { velocity, viscosity_direction: direction, viscosity_product: product, .. } =
        &mut columns.fluid;
    direction.resize(velocity.len(), [0.0; 4]);
    product.clear();
    product.resize(velocity.len(), [0.0; 4]);
    cpu.for_chunks(&mut direction[..], |first, direction| {
        for (direction, velocity) in direction.iter_mut().zip(&velocity[first..]) {
            let [x, y, z, _] = *velocity;
            *direction = [x, y, z, 0.0];
        }
    });
    // Padding rows fill up the lists: they must stay zero.
    direction[count..].fill([0.0; 4]);
}
