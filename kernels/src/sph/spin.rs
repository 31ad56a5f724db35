//! Spin of the fluid around every particle: the rotation that fits the velocities of its neighbours best; see `strain`.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    kernel::declare,
    params::Params,
};

use super::strain::Field;

declare! {
    needs: [Fluid, StrainRate, ExplicitViscosity],
    reads: [FluidPosition, FluidVelocity, FluidNeighbors],
    writes: [FluidSpin],
    oracle: crate::oracle::strain::spin,
    bound: 2e-5,
    // Few particles in a row leave the rotation about it open, which no pair feels: 6.1e-4.
    twin_bound: 8e-4,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Fluid { position, velocity, neighbors, spin, .. } = &mut columns.fluid;
    spin.resize(position.len(), [0.0; 4]);
    Field { position, vectors: velocity }.spins(cpu, params, neighbors, spin);
}
