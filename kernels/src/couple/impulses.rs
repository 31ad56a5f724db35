//! Impulses of the drag between particles and nodes.

use crate::{
    columns::Fluid,
    cpu::Cpu,
    grid::neighbors::ChunkLists,
    lanes::{self, LANES, Simd, f32x8, select},
    layout::constants,
    params::Params,
    vector::{self, Vec3x8, plus, times},
};

constants! {
    /// Interior value below which a particle feels no drag.
    const LEAST_INTERIOR: f32 = 1.0e-3;
}

/// 1 / chi, or 0 where there is no drag.
#[inline(always)]
pub(super) fn weight_inside<S: Simd>(simd: S, chi: f32x8<S>) -> f32x8<S> {
    let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
    let inside = chi.simd_gt(lanes::splat(simd, LEAST_INTERIOR));
    select(inside, one / select(inside, chi, one), zero)
}

/// Sum over the particles of eight controls of `V_a W_ia` times the drag row.
#[inline(always)]
pub(super) fn received<S: Simd>(
    simd: S,
    drag: &[[f32; 4]],
    lists: &ChunkLists,
    weights: &[[f32; LANES]],
    row: usize,
) -> Vec3x8<S> {
    let mut sum = vector::splat(simd, [0.0; 3]);
    for (entry, weight) in lists.group(row).iter().zip(&weights[lists.range(row)]) {
        let [jx, jy, jz, _] = lanes::gather_rows(simd, drag, entry);
        sum = plus(sum, times([jx, jy, jz], lanes::load(simd, weight, 0)));
    }
    sum
}

/// Subtracts the impulses from the particles.
pub(super) fn kick(cpu: &Cpu, params: &Params, fluid: &mut Fluid) {
    let Fluid { velocity, drag, interior, .. } = fluid;
    let inverse_mass = 1.0 / params.fluid.particle_mass;
    cpu.for_chunks(&mut velocity[..], |first, velocity| {
        for ((v, drag), chi) in velocity.iter_mut().zip(&drag[first..]).zip(&interior[first..]) {
            let scale = chi * inverse_mass;
            (0..3).for_each(|axis| v[axis] -= drag[axis] * scale);
        }
    });
}
