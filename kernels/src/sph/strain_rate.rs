//! Viscosity by the rate of strain: what neighbours move relative to each other beside the rotation of the fluid; see `strain`.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    kernel::declare,
    params::Params,
};

use super::strain::Field;

declare! {
    needs: [Fluid, StrainRate, ExplicitViscosity],
    reads: [FluidPosition, FluidVelocity, FluidNeighbors, FluidSpin, FluidAcceleration],
    writes: [FluidAcceleration],
    oracle: crate::oracle::strain::strain_rate,
    bound: 2e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Fluid { position, velocity, neighbors, spin, acceleration, .. } = &mut columns.fluid;
    Field { position, vectors: velocity }.add_strains(cpu, params, (neighbors, spin), 1.0, acceleration);
}
