//! Iteration of the implicit viscosity: a step along the direction, and the next direction.
//!
//! ```text
//! y <- y + alpha p,   r <- r - alpha q,   p <- r + beta p
//! ```
//!
//! with `alpha` and `beta` from `sph::viscosity_product`.

use crate::{columns::Columns, cpu::Cpu, kernel::declare, params::Params};

use super::viscosity_solve::Sums;

declare! {
    needs: [Fluid, ImplicitViscosity],
    reads: [
        FluidViscosityResidual, FluidViscosityDirection, FluidViscosityProduct, FluidViscosityChange,
        FluidViscositySolve,
    ],
    writes: [FluidViscosityResidual, FluidViscosityDirection, FluidViscosityChange, FluidViscositySolve],
    oracle: crate::oracle::viscosity::update,
    bound: 1e-5,
    twin: [pass(NAME, Fluid), pass("sph::viscosity_round", One)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(implicit) = &params.fluid.implicit_viscosity else { return };
    let count = columns.rows.fluid;
    let fluid = &mut columns.fluid;
    let (length, share) = (fluid.viscosity_solve.length(), fluid.viscosity_solve.share());
    let rows = (
        &mut fluid.viscosity_residual[..count],
        &mut fluid.viscosity_direction[..count],
        &mut fluid.viscosity_change[..count],
        fluid.viscosity_solve.sums(count),
    );
    let product = &fluid.viscosity_product;
    cpu.for_chunks(rows, |first, (residual, direction, change, sums)| {
        let mut own = Sums::default();
        let rows = residual.iter_mut().zip(direction).zip(change).zip(&product[first..]);
        for (((residual, direction), change), product) in rows {
            for axis in 0..3 {
                let along = direction[axis];
                change[axis] += length * along;
                residual[axis] -= length * product[axis];
                direction[axis] = residual[axis] + share * along;
                own[0] += f64::from(residual[axis]) * f64::from(residual[axis]);
                own[1] += f64::from(change[axis]) * f64::from(change[axis]);
            }
        }
        sums.0[0] = own;
    });
    fluid.viscosity_solve.finish_round(count, implicit);
}
