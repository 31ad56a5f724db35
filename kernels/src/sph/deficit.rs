//! What particles near the surface of the fluid are short of neighbours, within twice the support radius.
//!
//! ```text
//! e_i = max(0, 0.98 - sum_j V W_ij - lambda_i)
//! ```
//!
//! with a kernel of its own, and with the share of walls and bodies in it (`sph::boundary`), so that they are no surface. The noise
//! of particles deep inside stays below the two per cent.

use crate::{
    body::Body,
    columns::{Column::*, Columns, Fluid},
    cpu::Cpu,
    grid::neighbors::ChunkLists,
    kernel::{Kernel, Need},
    lanes::{self, LANES, Simd},
    params::{Cohesion, Params},
    periodic::{Space, with_space},
    smoothing::Wendland,
    vector::dot,
};

use super::boundary::{Profile, near};

/// `sph::deficit`.
pub static KERNEL: Kernel = Kernel {
    name: "sph::deficit",
    needs: &[Need::Fluid, Need::Cohesion],
    reads: &[FluidPosition, FluidNeighbors, BodyStates],
    writes: &[FluidDeficit],
    cpu,
};

/// Share of the neighbourhood above which nothing lacks.
pub(crate) const FULL: f32 = 0.98;

/// Surface tension over the energy of the layers of a lattice that ends in a plane: particles at a surface find better places
/// than those. Measured on drops of 16 and 20 particles across, for which it is 0.85 and 0.70 (`sorb validate drop`).
const RELAXED: f64 = 0.76;

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(cohesion) = &params.fluid.cohesion else { return };
    let count = columns.rows.fluid;
    let Fluid { position, neighbors, deficit, .. } = &mut columns.fluid;
    deficit.resize(position.len(), 0.0);
    let task = Task { params, cohesion, position, bodies: &columns.bodies.states.0 };
    cpu.for_chunks(&mut deficit[..], |first, deficit| {
        let lists = neighbors.chunk(first);
        with_space!(cpu, params, simd, space => task.chunk((simd, space), first, lists, deficit));
        // Padding rows are no surface.
        let used = count.saturating_sub(first).min(deficit.len());
        deficit[used..].fill(0.0);
    });
}

struct Task<'a> {
    params: &'a Params,
    cohesion: &'a Cohesion,
    position: &'a [[f32; 4]],
    bodies: &'a [Body],
}

impl Task<'_> {
    #[inline(always)]
    fn chunk<S: Simd>(
        &self,
        (simd, space): (S, impl Space<S>),
        first: usize,
        lists: &ChunkLists,
        deficit: &mut [f32],
    ) {
        let cohesion = self.cohesion;
        let kernel = cohesion.smoothing.lanes(simd);
        let value = kernel.value_scale() * cohesion.volume;
        let profile = Profile { range: cohesion.boundary_range, share: cohesion.boundary_share };
        let near = near(self.bodies, &self.position[first..first + deficit.len()], profile.range);
        for row in (0..deficit.len()).step_by(LANES) {
            let [x, y, z, _] = lanes::load_rows(simd, self.position, first + row);
            let mut sum = lanes::splat(simd, 0.0);
            for entry in lists.group(row) {
                let [xj, yj, zj, _] = lanes::gather_rows(simd, self.position, entry);
                let apart = space.apart([x, y, z], [xj, yj, zj]);
                sum += kernel.shape(kernel.closeness(dot(apart, apart)));
            }
            let [_, _, _, mut share] = profile.walls(simd, self.params, [x, y, z]);
            for body in &near {
                share += profile.body(simd, &self.bodies[*body], [x, y, z])[3];
            }
            let lacks = lanes::splat(simd, FULL) - sum * value - share;
            lanes::store(deficit, row, lanes::positive(simd, lacks));
        }
    }
}

/// Energy density per squared deficit \[Pa\] with which a lattice that ends in a plane has the surface tension \[N/m\].
#[must_use]
pub fn cohesion_stiffness(smoothing: &Wendland, spacing: f32, tension: f32) -> f32 {
    let (radius, d) = (f64::from(smoothing.support_radius), f64::from(spacing));
    let reach = (radius / d).ceil() as i32;
    let volume = d.powi(3) / Wendland::lattice_sum(radius, d);
    let mut squares = 0.0;
    for layer in 0..reach {
        // What lies beyond the outermost layer, and is missing.
        let mut missing = 0.0;
        for (x, y, z) in (-reach..=reach)
            .flat_map(|x| (layer + 1..=reach).flat_map(move |y| (-reach..=reach).map(move |z| (x, y, z))))
        {
            let distance = f64::from(x * x + y * y + z * z).sqrt() * d;
            missing += volume * Wendland::value_f64(radius, distance);
        }
        squares += (missing + f64::from(FULL) - 1.0).max(0.0).powi(2);
    }
    (2.0 * f64::from(tension) * d * d / (RELAXED * volume * squares)) as f32
}
