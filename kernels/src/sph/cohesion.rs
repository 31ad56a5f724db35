//! Surface tension: force on the particles by a surface energy.
//!
//! ```text
//! E = k sum_i V f(e_i),   f' = w
//! a_i = -dE/dx_i / m = k V^2 / m sum_j (w_i / phi_i + w_j / phi_j) grad W_ij
//! ```
//!
//! with the deficits e of `sph::deficit`, their weights w, and the part phi of a neighbourhood that walls leave. The fluid keeps its
//! volume, so that this energy grows with its surface alone. Forces are equal and opposite and act along the line between particles,
//! which conserves momentum and angular momentum. Deep inside there are none, so that the fluid stays fluid.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    grid::neighbors::ChunkLists,
    kernel::declare,
    lanes::{self, LANES, Simd},
    params::{Cohesion, Params},
    periodic::{Space, with_space},
    vector::{dot, plus, times},
};

declare! {
    needs: [Fluid, Cohesion],
    reads: [FluidPosition, FluidNeighbors, FluidDeficit, FluidAcceleration],
    writes: [FluidAcceleration],
    oracle: crate::oracle::surface::cohesion,
    // Weights of deficits are a tenth of the sums whose differences they are.
    bound: 1.5e-4,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(cohesion) = &params.fluid.cohesion else { return };
    let Fluid { position, neighbors, deficit, acceleration, .. } = &mut columns.fluid;
    let mass = params.fluid.particle_mass;
    cpu.for_chunks(&mut acceleration[..], |first, acceleration| {
        let lists = neighbors.chunk(first);
        with_space!(cpu, params, simd, space =>
            chunk((simd, space), (cohesion, mass), first, (position, deficit), lists, acceleration));
    });
}

#[inline(always)]
fn chunk<S: Simd>(
    (simd, space): (S, impl Space<S>),
    (cohesion, mass): (&Cohesion, f32),
    first: usize,
    (position, deficit): (&[[f32; 4]], &[f32]),
    lists: &ChunkLists,
    acceleration: &mut [[f32; 4]],
) {
    let kernel = cohesion.smoothing.lanes(simd);
    let scale = kernel.gradient_scale() * (cohesion.stiffness * cohesion.volume * (cohesion.volume / mass));
    for row in (0..acceleration.len()).step_by(LANES) {
        let [x, y, z, _] = lanes::load_rows(simd, position, first + row);
        let weight = lanes::load(simd, deficit, first + row);
        let mut sum = [lanes::splat(simd, 0.0); 3];
        for entry in lists.group(row) {
            let [xj, yj, zj, _] = lanes::gather_rows(simd, position, entry);
            let apart = space.apart([x, y, z], [xj, yj, zj]);
            let u = kernel.closeness(dot(apart, apart));
            let both = weight + lanes::gather(simd, deficit, entry);
            sum = plus(sum, times(apart, u * u * u * both));
        }
        let pull = times(sum, scale);
        let [ax, ay, az, aw] = lanes::load_rows(simd, acceleration, row);
        lanes::store_rows(acceleration, row, [ax - pull[0], ay - pull[1], az - pull[2], aw]);
    }
}
