//! Shapes of a rapier3d world as scenes have them.

use glam::Vec3;
use rapier3d::prelude::{SharedShape, TypedShape};

use crate::scene::ShapeKind;

/// The shape of a collider as a scene has it, for a body with it alone at its origin. There are balls, boxes, capsules along y, convex
/// hulls and half-spaces below y. None for others.
#[must_use]
pub fn shape_of(shape: &SharedShape) -> Option<ShapeKind> {
    match shape.as_typed_shape() {
        TypedShape::Ball(ball) => Some(ShapeKind::Sphere { radius: ball.radius }),
        TypedShape::Cuboid(cuboid) => Some(ShapeKind::Cuboid { half_extents: cuboid.half_extents }),
        TypedShape::Capsule(capsule) => {
            let (a, b) = (capsule.segment.a, capsule.segment.b);
            let is_upright = a.x == 0.0 && a.z == 0.0 && b == -a;
            is_upright.then(|| ShapeKind::Capsule { half_height: a.y.abs(), radius: capsule.radius })
        }
        TypedShape::ConvexPolyhedron(hull) => Some(ShapeKind::Hull { vertices: hull.points().to_vec() }),
        TypedShape::HalfSpace(half) => (half.normal == Vec3::Y).then_some(ShapeKind::Plane),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_of_colliders_are_shapes_of_scenes() {
        let half_extents = Vec3::new(1.0, 2.0, 3.0);
        let is = |shape: SharedShape, expected: Option<ShapeKind>| assert_eq!(shape_of(&shape), expected);
        is(SharedShape::ball(0.5), Some(ShapeKind::Sphere { radius: 0.5 }));
        is(SharedShape::cuboid(1.0, 2.0, 3.0), Some(ShapeKind::Cuboid { half_extents }));
        is(SharedShape::capsule_y(0.3, 0.1), Some(ShapeKind::Capsule { half_height: 0.3, radius: 0.1 }));
        is(SharedShape::halfspace(Vec3::Y), Some(ShapeKind::Plane));
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        let hull = SharedShape::convex_hull(&corners).and_then(|hull| shape_of(&hull));
        assert!(matches!(hull, Some(ShapeKind::Hull { vertices }) if vertices.len() == 4));
        // What has no counterpart.
        is(SharedShape::capsule_x(0.3, 0.1), None);
        is(SharedShape::cylinder(1.0, 1.0), None);
    }
}
