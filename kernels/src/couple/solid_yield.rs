//! How far the material of the sponge gives way to what a solve changes of the pressure.
//!
//! ```text
//! y_i = 2 f_i sum_j c_ij f_j (dP_j - dP_i),    f^2 = min(A (1 - phi) / phi, 1)
//! ```
//!
//! The solve takes nodes to be where the pressure of the step before brings them. What it changes moves them as well: a volume of
//! sponge has `(1 - phi)` of material for `phi` of water, which the same slope of the pressure drives. A solve that does not know raises
//! the pressure too far, and takes it back in the next steps: light and soft sponges tremble for ever, at a sixth of the rate of the
//! steps (docs/porous.md). Nodes that follow entirely, as if nothing else held them, are no answer, because elasticity and drag do: as far
//! as the solve is wrong about that, it errs the other way. So the material follows as a part A of as much water would, in the form of
//! the compact Laplacian, which cannot make up for a compression by pressures that alternate from particle to particle.
//!
//! At rest nothing changes, and nothing yields.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
};

declare! {
    needs: [Fluid, Sponge, Incompressible, Porous],
    reads: [FluidPredicted, FluidNeighbors, FluidPairs, FluidDragRate],
    writes: [FluidSolidYield],
    oracle: crate::oracle::incompressible::solid_yield,
    bound: 4e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, _: &Params, columns: &mut Columns) {
    let Fluid { predicted, neighbors, pairs, drag_rate, solid_yield, .. } = &mut columns.fluid;
    solid_yield.resize(predicted.len(), 0.0);
    cpu.for_chunks(&mut solid_yield[..], |first, solid_yield| {
        let (lists, pairs) = (neighbors.chunk(first), pairs.chunk(first));
        with_lanes!(cpu, simd => {
            for row in (0..solid_yield.len()).step_by(LANES) {
                let own = &drag_rate[first + row..first + row + LANES];
                let mut sum = lanes::splat(simd, 0.0);
                if own.iter().any(|rate| rate[2] > 0.0) {
                    let [_, _, _, change] = lanes::load_rows(simd, predicted, first + row);
                    for (entry, c) in lists.group(row).iter().zip(&pairs[lists.range(row)]) {
                        let [_, _, _, change_j] = lanes::gather_rows(simd, predicted, entry);
                        let [_, _, follows, _] = lanes::gather_rows(simd, drag_rate, entry);
                        sum += lanes::load_array(simd, c) * follows * (change_j - change);
                    }
                    let [_, _, follows, _] = lanes::load_rows(simd, drag_rate, first + row);
                    sum = sum * follows * 2.0;
                }
                lanes::store(solid_yield, row, sum);
            }
        });
    });
}
