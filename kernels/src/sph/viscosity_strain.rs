//! Iteration of the implicit viscosity by the rate of strain: the deceleration of the direction, which `sph::viscosity_product` takes from
//! the place of the product; see `strain`.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    kernel::declare,
    params::Params,
};

use super::strain::Field;

declare! {
    needs: [Fluid, StrainRate, ImplicitViscosity],
    reads: [FluidPosition, FluidViscosityDirection, FluidNeighbors, FluidSpin],
    writes: [FluidViscosityProduct],
    oracle: crate::oracle::strain::viscosity_strain,
    bound: 2e-6,
    twin: [pass("sph::strain_rate", Fluid).from("deceleration").on(&[
        ("fluid_velocity", "fluid_viscosity_direction"),
        ("fluid_acceleration", "fluid_viscosity_product"),
    ])],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Fluid {
        position, viscosity_direction: direction, neighbors, spin, viscosity_product: product, ..
    } = &mut columns.fluid;
    product.clear();
    product.resize(position.len(), [0.0; 4]);
    Field { position, vectors: direction }.add_strains(cpu, params, (neighbors, spin), -1.0, product);
}
