//! Shapes as masks: functions of the centroid of a tet in the unit cube of its block.

use glam::{Vec2, Vec3};

use crate::scene::Axis;

/// Keeps every tet of the block.
#[must_use]
pub fn block(_centroid: Vec3) -> bool {
    true
}

/// Keeps the tets of the ellipsoid that touches all six faces of the block.
#[must_use]
pub fn ellipsoid(centroid: Vec3) -> bool {
    // No centroid lies exactly on the rim. One of its three terms is an odd number over the cells, and three squares that
    // sum to a multiple of four are all even. Rounding therefore does not decide, and the shape is as symmetric as the
    // block.
    (2.0 * centroid - Vec3::ONE).length_squared() <= 1.0
}

/// Keeps the tets of the (elliptic) cylinder along `axis` that touches four faces of the block.
pub fn cylinder(axis: Axis) -> impl Fn(Vec3) -> bool {
    move |centroid| {
        let from_middle = 2.0 * centroid - Vec3::ONE;
        let across = match axis {
            Axis::X => Vec2::new(from_middle.y, from_middle.z),
            Axis::Y => Vec2::new(from_middle.x, from_middle.z),
            Axis::Z => Vec2::new(from_middle.x, from_middle.y),
        };
        across.length_squared() <= 1.0
    }
}
