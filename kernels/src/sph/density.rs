//! Mass density by summation \[MCG03, eq. 3\].
//!
//! ```text
//! rho_i = sum_j m W(|x_i - x_j|)
//! ```

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    grid::neighbors::ChunkLists,
    kernel::declare,
    lanes::{self, LANES, Simd},
    params::Params,
    periodic::{Space, with_space},
    vector::dot,
};

declare! {
    needs: [Fluid],
    reads: [FluidPosition, FluidNeighbors],
    writes: [FluidDensity],
    oracle: crate::oracle::sph::density,
    bound: 2e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Fluid { position, neighbors, density, .. } = &mut columns.fluid;
    density.resize(position.len(), 0.0);
    cpu.for_chunks(&mut density[..], |first, density| {
        let lists = neighbors.chunk(first);
        with_space!(cpu, params, simd, space =>
            chunk((simd, space), params, first, position, lists, density));
    });
}

#[inline(always)]
fn chunk<S: Simd>(
    (simd, space): (S, impl Space<S>),
    params: &Params,
    first: usize,
    position: &[[f32; 4]],
    lists: &ChunkLists,
    density: &mut [f32],
) {
    let kernel = params.fluid.smoothing.lanes(simd);
    let scale = kernel.value_scale() * params.fluid.particle_mass;
    for row in (0..density.len()).step_by(LANES) {
        let [x, y, z, _] = lanes::load_rows(simd, position, first + row);
        let mut sum = lanes::splat(simd, 0.0);
        for entry in lists.group(row) {
            let [xj, yj, zj, _] = lanes::gather_rows(simd, position, entry);
            let apart = space.apart([x, y, z], [xj, yj, zj]);
            sum += kernel.shape(kernel.closeness(dot(apart, apart)));
        }
        lanes::store(density, row, sum * scale);
    }
}
