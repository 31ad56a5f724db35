//! Before the rounds of the pressure solve: what is to be compressed in the step, if there is no pressure, and the pressure to begin with.
//!
//! ```text
//! r_i = h t_i - h div v*_i,   B_i = -L_i z_i
//! ```
//!
//! with the velocities v* by all other forces, and their images in bodies that move at `divergence::expect`. A particle with less than
//! three
//! quarters of a neighbourhood has no pressure.

use crate::{
    columns::{Columns, lane},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES},
    params::Params,
    periodic::with_space,
    vector::negative,
};

use super::{
    rate::{Field, SPARSE},
    reflect::{reflect, twists},
    symmetric::Symmetric,
};

declare! {
    needs: [Fluid, Divergence],
    reads: [
        FluidPosition, FluidVelocity, FluidNeighbors, FluidPairs, FluidRenormalisation, FluidRenormalisationBetween, FluidMoment,
        FluidImages, FluidPressureSolve, BodyStates, BodyExpected, BodyExpectedSpin,
    ],
    writes: [FluidFactors, FluidPressureRows, FluidImageVectors],
    oracle: crate::oracle::divergence::begin,
    bound: 1e-5,
    twin: [],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    if params.fluid.divergence().is_none() {
        return;
    }
    let count = columns.rows.fluid;
    let (fluid, store) = (&mut columns.fluid, &columns.bodies);
    let bodies = &store.states.0;
    let mut vectors = std::mem::take(&mut fluid.image_vectors);
    let mut factors = std::mem::take(&mut fluid.factors);
    let mut pressure_rows = std::mem::take(&mut fluid.pressure_rows);
    factors.resize(fluid.position.len(), [0.0; 4]);
    pressure_rows.resize(fluid.position.len(), [0.0, 0.0, 1.0, 0.0]);
    let twists = twists(&store.expected, &store.expected_spin);
    reflect(cpu, &fluid.images, (&fluid.position, &fluid.velocity), (bodies, &twists), &mut vectors);
    let field = Field { fluid, values: &fluid.velocity, images: &vectors };
    let scale = fluid.pressure_solve.target_scale();
    cpu.for_chunks((&mut factors[..], &mut pressure_rows[..]), |first, (factors, rows)| {
        with_space!(cpu, params, simd, space => {
            for row in (0..factors.len()).step_by(LANES) {
                let rate = field.rate((simd, space), (first, row));
                let [xx, yy, zz, _] = lanes::load_rows(simd, &fluid.renormalisation, first + row);
                let [yz, zx, xy, target] = lanes::load_rows(simd, &fluid.renormalisation_between, first + row);
                let [mx, my, mz, _] = lanes::load_rows(simd, &fluid.moment, first + row);
                let inverse = Symmetric { along: [xx, yy, zz], between: [yz, zx, xy] };
                let [bx, by, bz] = negative(inverse.times([mx, my, mz]));
                lanes::store_rows(factors, row, [bx, by, bz, target * scale + rate * params.step]);
            }
        });
        let used = count.saturating_sub(first).min(factors.len());
        let square = params.step * params.step;
        for (row, (factors, stored)) in factors.iter_mut().zip(rows.iter_mut()).take(used).enumerate() {
            let is_active = fluid.renormalisation[first + row][lane::fluid::renormalisation::DENSITY] >= SPARSE;
            if !is_active {
                factors[lane::fluid::factors::COMPRESSION] = 0.0;
            }
            let pressure =
                if is_active { fluid.velocity[first + row][lane::fluid::velocity::PRESSURE] } else { 0.0 };
            let diagonal = fluid.moment[first + row][lane::fluid::moment::DIAGONAL] * square;
            *stored = [pressure, 0.0, diagonal, factors[lane::fluid::factors::COMPRESSION]];
        }
        factors[used..].fill([0.0; 4]);
        rows[used..].fill([0.0, 0.0, 1.0, 0.0]);
    });
    (fluid.image_vectors, fluid.factors, fluid.pressure_rows) = (vectors, factors, pressure_rows);
}
