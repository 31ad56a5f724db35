//! Iteration of the implicit viscosity: the product of its matrix with the direction, and the step length along it.
//!
//! ```text
//! q_i = p_i + h (D_i(p) + F_i p_i)
//! ```
//!
//! with the pairs of `viscosity` and the friction of `sph::viscosity_begin`. What `sph::viscosity_strain` left in the place of q is part
//! of D.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    grid::neighbors::ChunkLists,
    kernel::declare,
    lanes::{self, LANES, Simd},
    params::Params,
    periodic::{Space, with_space},
    vector::{plus, times},
};

use super::{viscosity::Pairs, viscosity_solve::Sums};

declare! {
    needs: [Fluid, ImplicitViscosity],
    reads: [
        FluidPosition, FluidNeighbors, FluidFriction, FluidFrictionBetween, FluidViscosityResidual,
        FluidViscosityDirection, FluidViscosityProduct, FluidViscositySolve,
    ],
    writes: [FluidViscosityProduct, FluidViscositySolve],
    oracle: crate::oracle::viscosity::product,
    bound: 1e-5,
    // Quotients of sums of either sign: 6.0e-6.
    twin_bound: 2e-5,
    twin: [pass(NAME, Fluid), pass("sph::viscosity_length", One)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let count = columns.rows.fluid;
    let Fluid {
        position,
        neighbors,
        friction,
        friction_between,
        viscosity_residual: residual,
        viscosity_direction: direction,
        viscosity_product: product,
        viscosity_solve: solve,
        ..
    } = &mut columns.fluid;
    product.resize(position.len(), [0.0; 4]);
    let rows = (&mut product[..], solve.sums(position.len()));
    cpu.for_chunks(rows, |first, (product, sums)| {
        let lists = neighbors.chunk(first);
        let friction = [&friction[first..], &friction_between[first..]];
        with_space!(cpu, params, simd, space =>
            chunk((simd, space), params, first, (position, direction), friction, lists, product));
        let used = count.saturating_sub(first).min(product.len());
        sums.0[0] = add_up(&product[..used], &direction[first..], &residual[first..]);
    });
    solve.choose();
}

#[inline(always)]
fn chunk<S: Simd>(
    (simd, space): (S, impl Space<S>),
    params: &Params,
    first: usize,
    (position, direction): (&[[f32; 4]], &[[f32; 4]]),
    [friction, between]: [&[[f32; 4]]; 2],
    lists: &ChunkLists,
    product: &mut [[f32; 4]],
) {
    let pairs = Pairs::new((simd, space), params, position);
    let is_strained = params.fluid.strain_viscosity > 0.0;
    let step = lanes::splat(simd, params.step);
    let zero = lanes::splat(simd, 0.0);
    for row in (0..product.len()).step_by(LANES) {
        let [x, y, z, _] = lanes::load_rows(simd, direction, first + row);
        let [xx, yy, zz, _] = lanes::load_rows(simd, friction, row);
        let [yz, zx, xy, _] = lanes::load_rows(simd, between, row);
        let slowed = [xx * x + xy * y + zx * z, xy * x + yy * y + yz * z, zx * x + yz * y + zz * z];
        let sum = plus(pairs.of(direction, first + row, lists.group(row)), slowed);
        let sum = if is_strained {
            let [sx, sy, sz, _] = lanes::load_rows(simd, product, row);
            plus(sum, [sx, sy, sz])
        } else {
            sum
        };
        let [qx, qy, qz] = plus([x, y, z], times(sum, step));
        lanes::store_rows(product, row, [qx, qy, qz, zero]);
    }
}

/// The sums of a chunk for the step length and the next direction.
fn add_up(product: &[[f32; 4]], direction: &[[f32; 4]], residual: &[[f32; 4]]) -> Sums {
    let mut sums = Sums::default();
    for ((product, direction), residual) in product.iter().zip(direction).zip(residual) {
        for axis in 0..3 {
            let [q, p, r] = [product, direction, residual].map(|row| f64::from(row[axis]));
            sums[0] += p * q;
            sums[1] += r * p;
            sums[2] += r * q;
            sums[3] += q * q;
        }
    }
    sums
}
