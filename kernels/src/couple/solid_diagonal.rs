//! The diagonal of the pressure solve in sponges, where drag holds the water and nodes respond.
//!
//! ```text
//! D_i <- B_i D_i + h^2 N_i |L_i|^2
//! ```
//!
//! with the mobility B and the part N of the nodes of `couple::solid_moments`. The mobility of the particle stands for that of its
//! neighbours.

use crate::{
    columns::{Columns, Fluid, lane},
    cpu::Cpu,
    kernel::declare,
    params::Params,
};

declare! {
    needs: [Fluid, Sponge, Divergence, Porous, Smoothed],
    reads: [FluidMobility, FluidRenormalisation, FluidRenormalisationBetween, FluidPressureRows],
    writes: [FluidPressureRows],
    oracle: crate::oracle::solid::diagonal,
    bound: 1e-5,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Fluid { mobility, renormalisation, renormalisation_between, pressure_rows, .. } = &mut columns.fluid;
    let square = params.step * params.step;
    cpu.for_chunks(&mut pressure_rows[..], |first, rows| {
        let inverses = renormalisation[first..].iter().zip(&renormalisation_between[first..]);
        for ((row, mobility), (a, b)) in rows.iter_mut().zip(&mobility[first..]).zip(inverses) {
            let along = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
            let between = b[0] * b[0] + b[1] * b[1] + b[2] * b[2];
            let of_nodes = mobility[lane::fluid::mobility::DIAGONAL] * (along + 2.0 * between);
            let diagonal = &mut row[lane::fluid::pressure_rows::DIAGONAL];
            *diagonal = mobility[lane::fluid::mobility::WITH_NODES] * *diagonal + square * of_nodes;
        }
    });
}
