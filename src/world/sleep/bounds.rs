//! Bounding boxes of parts of a scene.

use glam::{Mat3, Vec3};
use sorb_kernels::body::{Body, Shape};

/// An axis-aligned box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    low: Vec3,
    high: Vec3,
}

impl Bounds {
    /// Around points; inverted without any.
    pub(super) fn of<'a>(points: impl Iterator<Item = &'a [f32; 4]>) -> Self {
        let none = Self { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY };
        points.fold(none, |Self { low, high }, [x, y, z, _]| {
            let point = Vec3::new(*x, *y, *z);
            Self { low: low.min(point), high: high.max(point) }
        })
    }

    /// From its lowest and highest corner \[m\].
    #[cfg(feature = "serde")]
    pub(super) fn new([low, high]: [Vec3; 2]) -> Self {
        Self { low, high }
    }

    /// Its lowest and highest corner \[m\].
    pub(super) fn corners(&self) -> [Vec3; 2] {
        [self.low, self.high]
    }

    /// Around a body; all of space for a plane.
    pub(super) fn of_body(body: &Body) -> Self {
        let turned = Mat3::from_quat(body.state.rotation);
        let half = |half: Vec3| {
            turned.x_axis.abs() * half.x + turned.y_axis.abs() * half.y + turned.z_axis.abs() * half.z
        };
        let (low, high) = match &body.shape {
            Shape::Plane => (Vec3::NEG_INFINITY, Vec3::INFINITY),
            Shape::Sphere { radius } => (Vec3::splat(-radius), Vec3::splat(*radius)),
            Shape::Cuboid { half_extents } => (-half(*half_extents), half(*half_extents)),
            Shape::Capsule { half_height, radius } => {
                let half = half(Vec3::Y * *half_height) + Vec3::splat(*radius);
                (-half, half)
            }
            Shape::Hull { vertices, .. } => {
                let corners = vertices.iter().map(|vertex| turned * *vertex);
                let none = (Vec3::INFINITY, Vec3::NEG_INFINITY);
                corners.fold(none, |(low, high), corner| (low.min(corner), high.max(corner)))
            }
            Shape::Compound(compound) => {
                let none = (Vec3::INFINITY, Vec3::NEG_INFINITY);
                compound.parts.iter().fold(none, |(low, high), part| {
                    let centre = turned * part.centre;
                    let radius = part.hull.bounding_radius();
                    (low.min(centre - radius), high.max(centre + radius))
                })
            }
        };
        Self { low: low + body.state.position, high: high + body.state.position }
    }

    /// With all faces moved outwards \[m\].
    #[must_use]
    pub(super) fn grown(self, by: f32) -> Self {
        Self { low: self.low - by, high: self.high + by }
    }

    /// Whether two boxes, or an image of one along periodic axes, have a point in common. `periods` are the lengths of the
    /// box of the scene along such axes, else zero.
    pub(super) fn meets(&self, other: &Self, periods: Vec3) -> bool {
        (0..3).all(|axis| {
            let (low, high) = (other.low[axis] - self.high[axis], other.high[axis] - self.low[axis]);
            // A whole number of periods lies between the two; none where one of them is inverted.
            let period = periods[axis];
            if period > 0.0 {
                high >= low && (high / period).floor() >= (low / period).ceil()
            } else {
                low <= 0.0 && high >= 0.0
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Quat;
    use sorb_kernels::body::{BodyKind, BodyState};
    use sorb_kernels::rounding::Rounding;

    fn cube(low: f32, high: f32) -> Bounds {
        Bounds { low: Vec3::splat(low), high: Vec3::splat(high) }
    }

    #[test]
    fn boxes_meet_across_seams() {
        let (a, b) = (cube(0.0, 1.0), cube(3.0, 3.5));
        assert!(!a.meets(&b, Vec3::ZERO) && a.grown(2.0).meets(&b, Vec3::ZERO));
        assert!(a.meets(&cube(1.0, 2.0), Vec3::ZERO) && !a.meets(&cube(1.1, 2.0), Vec3::ZERO));
        // With a period of 4 the second is 0.5 below the first as well.
        let periods = Vec3::splat(4.0);
        assert!(!a.meets(&b, periods) && !b.meets(&a, periods));
        assert!(a.grown(0.6).meets(&b, periods) && b.grown(0.6).meets(&a, periods));
        assert!(!a.grown(0.6).meets(&b, Vec3::X * 4.0), "the other axes do not repeat");
        let nothing = Bounds::of(std::iter::empty());
        assert!(!a.meets(&nothing, Vec3::ZERO) && !a.meets(&nothing, periods));
        let plane = Bounds { low: Vec3::NEG_INFINITY, high: Vec3::INFINITY };
        assert!(plane.meets(&a, Vec3::ZERO) && a.meets(&plane, periods));
    }

    #[test]
    fn boxes_hold_turned_bodies() {
        let state = BodyState {
            position: Vec3::new(1.0, 2.0, 3.0),
            rotation: Quat::from_rotation_z(std::f32::consts::FRAC_PI_4),
            linear_velocity: Vec3::ZERO,
            angular_velocity: Vec3::ZERO,
        };
        let bounds = |shape| {
            let kind = BodyKind::Dynamic;
            Bounds::of_body(&Body {
                shape,
                kind,
                state,
                friction: 0.0,
                touches_nodes: true,
                no_slip: false,
                rounding: Rounding::default(),
                inverse_mass: 1.0,
                inverse_inertia: Mat3::IDENTITY,
            })
        };
        let half = 2.0_f32.sqrt() * 0.5;
        let of = |shape, expected: Vec3| {
            let found = bounds(shape);
            assert!((found.high - state.position).distance(expected) < 1e-5, "{found:?}");
            assert!((state.position - found.low).distance(expected) < 1e-5, "{found:?}");
        };
        of(Shape::Sphere { radius: 0.5 }, Vec3::splat(0.5));
        of(Shape::Cuboid { half_extents: Vec3::new(1.0, 0.0, 0.3) }, Vec3::new(half, half, 0.3));
        of(Shape::Capsule { half_height: 1.0, radius: 0.2 }, Vec3::new(half + 0.2, half + 0.2, 0.2));
    }
}
