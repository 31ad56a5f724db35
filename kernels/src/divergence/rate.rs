//! The rate at which particles and images come closer: the opposite of the renormalised divergence of a vector field.
//!
//! ```text
//! -div v_i = sum_j c_ij (v_j - v_i) . L_i x_ij
//! ```

use crate::{
    columns::Fluid,
    cpu::Cpu,
    lanes::{self, LANES, Simd, f32x8},
    layout::constants,
    params::Params,
    periodic::{Space, with_space},
    symmetric::Symmetric,
    vector::{Vec3x8, dot, minus, plus, times},
};

use super::image_rows::{ImageRows, Images};

constants! {
    /// Density over that at rest below which a particle has no pressure.
    pub(super) const SPARSE: f32 = 0.75;
    /// Share of material from which on a particle is in a sponge.
    pub(super) const MINIMUM_MATERIAL: f32 = 0.02;
}

/// A field on particles and images.
pub(super) struct Field<'a> {
    pub(super) fluid: &'a Fluid,
    pub(super) values: &'a [[f32; 4]],
    pub(super) images: &'a ImageRows,
}

impl Field<'_> {
    /// The rate of eight particles, the first of which is `row` of the chunk that begins at `first`.
    #[inline(always)]
    pub(super) fn rate<S: Simd>(
        &self,
        (simd, space): (S, impl Space<S>),
        (first, row): (usize, usize),
    ) -> f32x8<S> {
        let fluid = self.fluid;
        let [x, y, z, _] = lanes::load_rows(simd, &fluid.position, first + row);
        let [vx, vy, vz, _] = lanes::load_rows(simd, self.values, first + row);
        let (point, own) = ([x, y, z], [vx, vy, vz]);
        // sum_j c_ij (v_j - v_i) x_ij^T, contracted with L_i once.
        let mut sums = Symmetric::splat(simd, 0.0);
        let (lists, pairs) = (fluid.neighbors.chunk(first), fluid.pairs.chunk(first));
        for (entry, c) in lists.group(row).iter().zip(&pairs[lists.range(row)]) {
            let [xj, yj, zj, _] = lanes::gather_rows(simd, &fluid.position, entry);
            let [vxj, vyj, vzj, _] = lanes::gather_rows(simd, self.values, entry);
            let apart = times(space.apart(point, [xj, yj, zj]), lanes::load_array(simd, c));
            sums.add_twice(minus([vxj, vyj, vzj], own), apart);
        }
        for (entry, c) in fluid.images.seen(first, row) {
            let [xj, yj, zj, _] = lanes::gather_rows(simd, &fluid.images.position, entry);
            let [vxj, vyj, vzj, _] = lanes::gather_rows(simd, &self.images.0, entry);
            let apart = times(space.apart(point, [xj, yj, zj]), lanes::load_array(simd, c));
            sums.add_twice(minus([vxj, vyj, vzj], own), apart);
        }
        let [xx, yy, zz, _] = lanes::load_rows(simd, &fluid.renormalisation, first + row);
        let [yz, zx, xy, _] = lanes::load_rows(simd, &fluid.renormalisation_between, first + row);
        dot(sums.along, [xx, yy, zz]) + dot(sums.between, [yz, zx, xy])
    }
}

/// Points with pressures beside them, and their renormalisation along and between the axes: what neighbours push with.
#[derive(Clone, Copy)]
pub(super) struct Pushing<'a> {
    pub(super) points: &'a [[f32; 4]],
    pub(super) along: &'a [[f32; 4]],
    pub(super) between: &'a [[f32; 4]],
}

impl Pushing<'_> {
    /// `sum_j c_j P_j L_j (x - x_j)` at eight points: the transpose of the divergence. Without `PRESSURE` all of it is 1.
    #[inline(always)]
    pub(super) fn sum<'a, S: Simd, const PRESSURE: bool>(
        self,
        (simd, space): (S, impl Space<S>),
        point: Vec3x8<S>,
        list: impl Iterator<Item = (&'a [u32; LANES], &'a [f32; LANES])>,
    ) -> Vec3x8<S> {
        let mut sum = [lanes::splat(simd, 0.0); 3];
        for (entry, c) in list {
            let [xj, yj, zj, pressure] = lanes::gather_rows(simd, self.points, entry);
            let [xx, yy, zz, _] = lanes::gather_rows(simd, self.along, entry);
            let [yz, zx, xy, _] = lanes::gather_rows(simd, self.between, entry);
            let other = Symmetric { along: [xx, yy, zz], between: [yz, zx, xy] };
            let c = lanes::load_array(simd, c);
            let push = if PRESSURE { c * pressure } else { c };
            sum = plus(sum, times(other.times(space.apart(point, [xj, yj, zj])), push));
        }
        sum
    }

    /// What images in bodies receive: by the pressures, or without `PRESSURE` by the weight of the water between them and their particles.
    pub(super) fn on_images<const PRESSURE: bool>(
        self,
        cpu: &Cpu,
        params: &Params,
        images: &Images,
        force: &mut ImageRows,
    ) {
        force.0.resize(images.position.len(), [0.0; 4]);
        if !images.has_bodies {
            force.0.fill([0.0; 4]);
            return;
        }
        cpu.for_chunks(&mut force.0[..], |first, force| {
            with_space!(cpu, params, simd, space => {
                for row in (0..force.len()).step_by(LANES) {
                    let [x, y, z, _] = lanes::load_rows(simd, &images.position, first + row);
                    let sum = self.sum::<_, PRESSURE>((simd, space), [x, y, z], images.seen_by(first, row));
                    let [x, y, z] = if PRESSURE {
                        sum
                    } else {
                        let [.., lift] = lanes::load_rows(simd, &images.lift, first + row);
                        times(sum, -lift)
                    };
                    lanes::store_rows(force, row, [x, y, z, lanes::splat(simd, 0.0)]);
                }
            });
        });
    }
}
