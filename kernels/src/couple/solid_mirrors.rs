//! The material of sponges mirrored by the walls of the container, as the water is: what eight points see of a node.
//!
//! The image of a node in walls is nowhere nearer to a particle than the node itself. A pair of both is therefore found in their lists.

use glam::Vec3;

use crate::{
    column::FAR,
    divergence::{
        image_rows::signs,
        walls::{self, MIRRORS},
    },
    lanes::{Simd, splat},
    params::Params,
    vector::Vec3x8,
};

/// One way in which walls mirror: `x' = s x + t` along every axis.
#[derive(Clone, Copy)]
pub(crate) struct Mirror {
    signs: Vec3,
    shift: Vec3,
}

impl Mirror {
    /// The image of points.
    #[inline(always)]
    pub(crate) fn image<S: Simd>(&self, simd: S, [x, y, z]: Vec3x8<S>) -> Vec3x8<S> {
        let (s, t) = (self.signs, self.shift);
        [x * s.x + splat(simd, t.x), y * s.y + splat(simd, t.y), z * s.z + splat(simd, t.z)]
    }

    /// The image of directions.
    #[inline(always)]
    pub(crate) fn turned<S: Simd>(&self, [x, y, z]: Vec3x8<S>) -> Vec3x8<S> {
        [x * self.signs.x, y * self.signs.y, z * self.signs.z]
    }
}

/// The mirrors that matter to eight points; the first is none.
pub(crate) struct Mirrors {
    all: [Mirror; MIRRORS],
    count: usize,
}

impl Mirrors {
    /// Those of the walls within the radius of the lists from any of the points. The material does not reach as far, so that a node a
    /// little outside of the walls has its image for all.
    #[inline(always)]
    pub(crate) fn near(params: &Params, points: &[[f32; 4]]) -> Self {
        let reach = params.coupling.support_radius;
        let mut all = [Mirror { signs: Vec3::ONE, shift: Vec3::ZERO }; MIRRORS];
        let inside = points.iter().filter(|point| point[0] < FAR);
        let near = inside
            .fold(0, |near, [x, y, z, _]| near | walls::walls_within(params, Vec3::new(*x, *y, *z), reach));
        let mut count = 1;
        if near != 0 {
            count = 0;
            walls::visit(params, Vec3::ZERO, near, |shift, axes| {
                all[count] = Mirror { signs: signs(axes), shift };
                count += 1;
            });
        }
        Self { all, count }
    }

    /// One after the other.
    #[inline(always)]
    pub(crate) fn iter(&self) -> std::slice::Iter<'_, Mirror> {
        self.all[..self.count].iter()
    }
}
