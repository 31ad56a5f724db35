//! Regions of space.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::{scene::BlockShape, setup::mask};

/// A region of space. Its surface belongs to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum Region {
    /// A box along the axes.
    Box {
        /// Lowest corner. Range -1000 to 1000 m.
        minimum: Vec3,
        /// Highest corner, above the lowest along every axis. Range -1000 to 1000 m.
        maximum: Vec3,
    },
    /// A ball.
    Sphere {
        /// Its centre. Range -1000 to 1000 m.
        centre: Vec3,
        /// Its radius. Range 0.0001 to 100 m.
        radius: f32,
    },
    /// A cylinder around the line from one point to another.
    Cylinder {
        /// Centre of one end. Range -1000 to 1000 m.
        start: Vec3,
        /// Centre of the other end, elsewhere. Range -1000 to 1000 m.
        end: Vec3,
        /// Its radius. Range 0.0001 to 100 m.
        radius: f32,
    },
    /// A shape cut out of a box along the axes, as [`FluidBlock`](crate::scene::FluidBlock) has it.
    Block {
        /// Lowest corner of the box. Range -1000 to 1000 m.
        minimum: Vec3,
        /// Highest corner, above the lowest along every axis. Range -1000 to 1000 m.
        maximum: Vec3,
        /// The shape. A mesh needs the feature `rigid`, and vertices: a file is not read.
        #[serde(with = "crate::text")]
        shape: Box<BlockShape>,
    },
}

impl Region {
    /// Its lowest and its highest corner \[m\].
    pub(crate) fn bounds(&self) -> (Vec3, Vec3) {
        match *self {
            Self::Box { minimum, maximum } | Self::Block { minimum, maximum, .. } => (minimum, maximum),
            Self::Sphere { centre, radius } => (centre - radius, centre + radius),
            Self::Cylinder { start, end, radius } => {
                let axis = (end - start).normalize_or_zero();
                let across = (Vec3::ONE - axis * axis).max(Vec3::ZERO).map(f32::sqrt) * radius;
                (start.min(end) - across, start.max(end) + across)
            }
        }
    }

    /// Whether points lie in it. In a mesh that is none, or without the feature `rigid`, lie none.
    pub(crate) fn inside(&self) -> Box<dyn Fn(Vec3) -> bool> {
        match *self {
            Self::Box { minimum, maximum } => {
                Box::new(move |point| point.cmpge(minimum).all() && point.cmple(maximum).all())
            }
            Self::Sphere { centre, radius } => {
                Box::new(move |point| point.distance_squared(centre) <= radius * radius)
            }
            Self::Cylinder { start, end, radius } => Box::new(move |point| {
                let (axis, way) = (end - start, point - start);
                let along = way.dot(axis) / axis.length_squared();
                (0.0..=1.0).contains(&along) && (way - axis * along).length_squared() <= radius * radius
            }),
            Self::Block { minimum, maximum, ref shape } => match mask(shape, maximum - minimum, "region") {
                Ok(mask) => {
                    Box::new(move |point| BlockShape::holds(&mask, (minimum, maximum - minimum), point))
                }
                Err(_) => Box::new(|_| false),
            },
        }
    }

    /// Points of a lattice of some spacing \[m\] in it, in the order of x, then y, then z. That of a box begins half a spacing from its
    /// lowest corner; others are around the centre.
    pub(crate) fn lattice(&self, spacing: f32) -> impl Iterator<Item = Vec3> {
        let ([nx, ny, nz], corner) = self.counts(spacing);
        // The rounding of blocks of scenes.
        let point =
            move |index: [u64; 3]| corner + (Vec3::from_array(index.map(|at| at as f32)) + 0.5) * spacing;
        let rows = (0..nz).flat_map(move |z| (0..ny).map(move |y| (y, z)));
        let points = rows.flat_map(move |(y, z)| (0..nx).map(move |x| point([x, y, z])));
        let (is_box, is_inside) = (matches!(self, Self::Box { .. }), self.inside());
        // Rounding must not take the last row of a box.
        points.filter(move |point| is_box || is_inside(*point))
    }

    /// Points of the lattice in its bounds.
    pub(crate) fn lattice_size(&self, spacing: f32) -> f64 {
        self.counts(spacing).0.iter().map(|count| *count as f64).product()
    }

    /// Points along every axis, and the lowest corner of the cubes around them.
    fn counts(&self, spacing: f32) -> ([u64; 3], Vec3) {
        let (low, high) = self.bounds();
        let size = high - low;
        let is_box = matches!(self, Self::Box { .. });
        // A hundredth of a particle covers rounding of sizes that are multiples of the spacing.
        let count = |size: f32| {
            let whole = if is_box { (size / spacing + 0.01).floor() } else { (size / spacing).ceil() };
            whole.max(0.0) as u64
        };
        let counts = size.to_array().map(count);
        let extent = Vec3::from_array(counts.map(|count| count as f32)) * spacing;
        let corner = if is_box { low } else { 0.5 * (low + high) - 0.5 * extent };
        (counts, corner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lattice_fills_its_region_with_a_particle_per_cube() {
        let spacing = 0.01;
        let regions = [
            (Region::Box { minimum: Vec3::ZERO, maximum: Vec3::new(0.1, 0.2, 0.3) }, 0.1 * 0.2 * 0.3),
            (Region::Sphere { centre: Vec3::splat(0.3), radius: 0.1 }, 4.18879e-3),
            (
                Region::Cylinder { start: Vec3::ZERO, end: Vec3::new(0.2, 0.2, 0.0), radius: 0.06 },
                std::f32::consts::PI * 0.0036 * 0.282_843,
            ),
            (
                Region::Block {
                    minimum: Vec3::splat(-0.1),
                    maximum: Vec3::new(0.1, 0.0, 0.3),
                    shape: Box::new(BlockShape::Ellipsoid),
                },
                0.2 * 0.1 * 0.4 * std::f32::consts::FRAC_PI_6,
            ),
        ];
        for (region, volume) in regions {
            let points: Vec<Vec3> = region.lattice(spacing).collect();
            let filled = points.len() as f32 * spacing.powi(3);
            assert!((filled / volume - 1.0).abs() < 0.06, "{region:?} {filled} {volume}");
            assert!(points.len() as f64 <= region.lattice_size(spacing));
            let (low, high) = region.bounds();
            for point in points {
                assert!(point.cmpge(low).all() && point.cmple(high).all(), "{region:?} {point}");
                assert!(region.inside()(point), "{region:?} {point}");
            }
            // Negative control.
            assert!(!region.inside()(high + 0.01), "{region:?}");
        }
        let thin = Region::Box { minimum: Vec3::ZERO, maximum: Vec3::new(0.1, 0.005, 0.1) };
        assert_eq!(thin.lattice(spacing).count(), 0);
    }
}
