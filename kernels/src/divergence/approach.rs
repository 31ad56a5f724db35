//! Mean velocity of the neighbours of a particle along the lines to them, relative to it.
//!
//! ```text
//! (F v)_i = 1 / m_0 sum_j c_ij (v_j - v_i) . x_ij x_ij
//! ```
//!
//! The sum includes the images of the velocities. With the second moment `m_0` of a lattice, velocities that differ by chance yield about
//! as much as they differ. `divergence::damping` takes the same of it.

use crate::{
    columns::Columns,
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES},
    params::Params,
    periodic::with_space,
    vector::times,
};

use super::{
    closing::Closing,
    reflect::{reflect, velocities},
};

declare! {
    needs: [Fluid, Divergence],
    reads: [FluidPosition, FluidNeighbors, FluidPairs, FluidVelocity, FluidImages, BodyStates],
    writes: [FluidApproach, FluidImageVectors],
    oracle: crate::oracle::divergence::approach,
    bound: 1e-5,
    twin: [
        pass("divergence::reflect", Images).from("moving").on(&[
            ("values", "fluid_velocity"),
            ("linear", "body_expected"),
            ("angular", "body_expected_spin"),
        ]),
        pass(NAME, Fluid).on(&[("values", "fluid_velocity")]),
    ],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(solve) = params.fluid.divergence() else { return };
    let bodies = &columns.bodies.states.0;
    let fluid = &mut columns.fluid;
    let mut approach = std::mem::take(&mut fluid.approach);
    let mut vectors = std::mem::take(&mut fluid.image_vectors);
    approach.resize(fluid.position.len(), [0.0; 4]);
    let values = (&fluid.position[..], &fluid.velocity[..]);
    reflect(cpu, &fluid.images, values, (bodies, &velocities(bodies)), &mut vectors);
    let closing = Closing { fluid, values: &fluid.velocity, images: &vectors };
    cpu.for_chunks(&mut approach[..], |first, approach| {
        with_space!(cpu, params, simd, space => {
            let scale = lanes::splat(simd, 1.0 / solve.lattice_moment);
            for row in (0..approach.len()).step_by(LANES) {
                let [x, y, z] = times(closing.sums((simd, space), (first, row), |_, _| ()), scale);
                lanes::store_rows(approach, row, [x, y, z, lanes::splat(simd, 0.0)]);
            }
        });
    });
    (fluid.approach, fluid.image_vectors) = (approach, vectors);
}
