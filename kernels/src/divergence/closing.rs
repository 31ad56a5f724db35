//! What neighbours and images have more than a particle, of a vector and along the lines to them.

use crate::{
    columns::Fluid,
    lanes::{self, LANES, Simd},
    periodic::Space,
    vector::{Vec3x8, dot, minus, plus, times},
};

use super::image_rows::ImageRows;

/// Particles and images with their lists.
pub(super) struct Closing<'a> {
    pub(super) fluid: &'a Fluid,
    pub(super) values: &'a [[f32; 4]],
    pub(super) images: &'a ImageRows,
}

impl Closing<'_> {
    /// `sum_j c_ij (v_j - v_i) . x_ij x_ij` of eight particles, the first of which is `row` of the chunk that begins at `first`. One sum is
    /// over particles, one over images.
    #[inline(always)]
    pub(super) fn sums<S: Simd>(
        &self,
        (simd, space): (S, impl Space<S>),
        (first, row): (usize, usize),
        mut visit: impl FnMut(&[u32; LANES], Vec3x8<S>),
    ) -> Vec3x8<S> {
        let position = &self.fluid.position[..];
        let [x, y, z, _] = lanes::load_rows(simd, position, first + row);
        let [vx, vy, vz, _] = lanes::load_rows(simd, self.values, first + row);
        let (point, own) = ([x, y, z], [vx, vy, vz]);
        let mut sum = [lanes::splat(simd, 0.0); 3];
        let (lists, pairs) = (self.fluid.neighbors.chunk(first), self.fluid.pairs.chunk(first));
        for (entry, c) in lists.group(row).iter().zip(&pairs[lists.range(row)]) {
            let [xj, yj, zj, _] = lanes::gather_rows(simd, position, entry);
            let [vxj, vyj, vzj, _] = lanes::gather_rows(simd, self.values, entry);
            let apart = space.apart(point, [xj, yj, zj]);
            let along = dot(minus([vxj, vyj, vzj], own), apart);
            sum = plus(sum, times(apart, lanes::load_array(simd, c) * along));
        }
        for (entry, c) in self.fluid.images.seen(first, row) {
            let [xj, yj, zj, _] = lanes::gather_rows(simd, &self.fluid.images.position, entry);
            let [vxj, vyj, vzj, _] = lanes::gather_rows(simd, &self.images.0, entry);
            let apart = space.apart(point, [xj, yj, zj]);
            let along = dot(minus([vxj, vyj, vzj], own), apart);
            let part = times(apart, lanes::load_array(simd, c) * along);
            visit(entry, part);
            sum = plus(sum, part);
        }
        sum
    }
}
