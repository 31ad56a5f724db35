//! Compliance of the material of the sponge to the pressure change of a solve.
//!
//! ```text
//! y_i = 2 f_i sum_j c_ij f_j (dP_j - dP_i),    f^2 = min(A (1 - phi) / phi, 1)
//! ```
//!
//! The solve prescribes the motion of the nodes by the pressure of the previous step. The pressure change moves them as
//! well: a volume of sponge has `1 - phi` of material per `phi` of water, under the same pressure gradient. A solve without
//! that overshoots, and light and soft sponges tremble for ever with a period of six steps (added-mass instability,
//! docs/porous.md). Nodes that follow freely are no remedy, because elasticity and drag hold them, and the solve then errs
//! in the opposite direction. The material therefore follows as a part A of as much water would. The form is that of the
//! compact Laplacian, in which alternating pressures cannot compensate a compression.
//!
//! At rest the pressure change is zero, and so is the compliance term.

use crate::{
    columns::{Columns, Fluid, lane},
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
                if own.iter().any(|rate| rate[lane::fluid::drag_rate::COMPLIANCE] > 0.0) {
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
