//! Iteration of the implicit viscosity by the rate of strain: spins of the direction; see `strain`.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    kernel::declare,
    params::Params,
};

use super::strain::Field;

declare! {
    needs: [Fluid, StrainRate, ImplicitViscosity],
    reads: [FluidPosition, FluidViscosityDirection, FluidNeighbors],
    writes: [FluidSpin],
    oracle: crate::oracle::strain::viscosity_spin,
    bound: 2e-5,
    // As in `sph::spin`.
    twin_bound: 8e-4,
    twin: [pass("sph::spin", Fluid).on(&[("fluid_velocity", "fluid_viscosity_direction")])],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Fluid { position, viscosity_direction: direction, neighbors, spin, .. } = &mut columns.fluid;
    spin.resize(position.len(), [0.0; 4]);
    Field { position, vectors: direction }.spins(cpu, params, neighbors, spin);
}
