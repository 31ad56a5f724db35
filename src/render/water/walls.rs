//! Mirror images of the water behind the walls of a container: its surface meets them at a right angle.

use super::kernels::Kernel;
use glam::Vec3;

/// The walls of a box, or none.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Walls {
    /// Lowest and highest corner (m).
    pub(in crate::render) container: Option<(Vec3, Vec3)>,
}

/// A mirror image of a particle.
pub(super) struct Image {
    /// Row of the particle.
    pub(super) row: usize,
    pub(super) position: Vec3,
    /// Per axis the wall (m) that it was mirrored at.
    at: [Option<f32>; 3],
}

impl Walls {
    /// The images of particles nearer to walls than a distance; none above the upper wall, where there is air.
    pub(super) fn images(&self, positions: &[Vec3], reach: f32) -> Vec<Image> {
        let Some((low, high)) = self.container else { return Vec::new() };
        let mut images: Vec<Image> = Vec::new();
        for axis in 0..3 {
            let earlier = images.len();
            let mirror = |position: Vec3, row: usize, at: [Option<f32>; 3], images: &mut Vec<Image>| {
                for (wall, side) in [(low[axis], 1.0), (high[axis], -1.0)] {
                    let is_lid = axis == 1 && side < 0.0;
                    if (position[axis] - wall) * side < reach && !is_lid {
                        let (mut position, mut at) = (position, at);
                        position[axis] = 2.0 * wall - position[axis];
                        at[axis] = Some(wall);
                        images.push(Image { row, position, at });
                    }
                }
            };
            for (row, position) in positions.iter().enumerate() {
                mirror(*position, row, [None; 3], &mut images);
            }
            for index in 0..earlier {
                let Image { row, position, at } = images[index];
                mirror(position, row, at, &mut images);
            }
        }
        images
    }

    /// The place in the container that is nearest to a point.
    pub(super) fn inside(&self, point: Vec3) -> Vec3 {
        self.container.map_or(point, |(low, high)| point.clamp(low, high))
    }
}

impl Image {
    /// The mirror image of the particle's kernel.
    pub(super) fn mirror(&self, kernel: &Kernel) -> Kernel {
        let mut image = *kernel;
        let mut sign = Vec3::ONE;
        for axis in 0..3 {
            if let Some(wall) = self.at[axis] {
                image.centre[axis] = 2.0 * wall - image.centre[axis];
                sign[axis] = -1.0;
            }
        }
        image.metric[1] *= sign.x * sign.y;
        image.metric[2] *= sign.x * sign.z;
        image.metric[4] *= sign.y * sign.z;
        image
    }
}
