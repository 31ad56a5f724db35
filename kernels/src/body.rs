//! Rigid bodies as the kernels see them: shapes with signed distances, poses and velocities.

use std::sync::Arc;

use glam::{Mat3, Quat, Vec3};

use crate::{
    lanes::{self, Simd, f32x8},
    rounding::Rounding,
    surface::surface,
    vector::{self, Vec3x8, cross, dot, minus, plus, times},
};

pub use crate::compound::{Compound, ConvexPart, pieces};
pub use crate::wrench::Wrench;
pub(crate) use crate::wrench::by_chunk;

/// Geometry of a rigid body, in its own frame, centre of mass at the origin.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Solid half-space below the local plane y = 0 (outward normal +y). Fixed or kinematic bodies only.
    Plane,
    /// Ball around the origin.
    Sphere {
        /// Radius \[m\].
        radius: f32,
    },
    /// Box around the origin.
    Cuboid {
        /// Distance of the faces from the origin \[m\].
        half_extents: Vec3,
    },
    /// Segment along the local y axis, swept by a ball.
    Capsule {
        /// Half the length of the segment \[m\].
        half_height: f32,
        /// Radius of the ball \[m\].
        radius: f32,
    },
    /// Convex hull.
    Hull {
        /// Outward unit normals and offsets \[m\]: a point is inside where `normal . x <= offset` for all.
        planes: Vec<(Vec3, f32)>,
        /// Corners \[m\].
        vertices: Vec<Vec3>,
        /// Faces as triangles of corners, outward winding.
        triangles: Vec<[u32; 3]>,
    },
    /// Union of convex hulls, such as a cup.
    Compound(Arc<Compound>),
}

impl Shape {
    /// Radius of the bounding sphere around the origin \[m\]; infinite for a plane.
    #[must_use]
    pub fn bounding_radius(&self) -> f32 {
        match self {
            Self::Plane => f32::INFINITY,
            Self::Sphere { radius } => *radius,
            Self::Cuboid { half_extents } => half_extents.length(),
            Self::Capsule { half_height, radius } => half_height + radius,
            Self::Hull { vertices, .. } => vertices.iter().map(|vertex| vertex.length()).fold(0.0, f32::max),
            Self::Compound(compound) => compound.bounding_radius(),
        }
    }
}

impl Shape {
    /// Radius of the sphere around the origin outside of which distances are larger than `range` \[m\]. Beside its edges the
    /// distance from a hull is an underestimate.
    pub(crate) fn reach(&self, range: f32) -> f32 {
        let radius = self.bounding_radius();
        match self {
            Self::Hull { planes, .. } => {
                let minimum = planes.iter().map(|(_, offset)| *offset).fold(f32::INFINITY, f32::min);
                if minimum > 0.0 { radius * (1.0 + range / minimum) } else { f32::INFINITY }
            }
            Self::Compound(compound) => compound.reach(range),
            _ => radius + range,
        }
    }
}

/// How a body moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyKind {
    /// By forces and contacts.
    Dynamic,
    /// Not at all.
    Fixed,
    /// By a script, independent of forces.
    Kinematic,
}

/// Pose and velocity of a body at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// Centre of mass, world \[m\].
    pub position: Vec3,
    /// Rotation from the body's frame to the world.
    pub rotation: Quat,
    /// Velocity of the centre of mass \[m/s\].
    pub linear_velocity: Vec3,
    /// Angular velocity, world \[rad/s\].
    pub angular_velocity: Vec3,
}

/// One body.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Geometry.
    pub shape: Shape,
    /// How it moves.
    pub kind: BodyKind,
    /// Pose and velocity.
    pub state: BodyState,
    /// Coulomb friction against sponge nodes \[1\].
    pub friction: f32,
    /// Whether sponge nodes are kept out; a body that grips a sponge lets them in.
    pub touches_nodes: bool,
    /// Whether the fluid sticks to the surface (no-slip); otherwise it slides along it (free slip).
    pub no_slip: bool,
    /// The shape as images of particles see it.
    pub rounding: Rounding,
    /// Inverse of its mass \[1/kg\]: 0 for one that forces do not move.
    pub inverse_mass: f32,
    /// Inverse of its inertia about the centre of mass, in the world's frame \[1/(kg m^2)\].
    pub inverse_inertia: Mat3,
}

impl Body {
    /// The body at the end of a step \[s\].
    #[must_use]
    pub fn at_end(&self, step: f32) -> Self {
        let mut body = self.clone();
        let state = &mut body.state;
        state.position += step * state.linear_velocity;
        let [x, y, z] = (0.5 * step * state.angular_velocity).to_array();
        let turn = Quat::from_xyzw(x, y, z, 1.0).normalize();
        state.rotation = (turn * state.rotation).normalize();
        body
    }

    /// Largest speed of its surface \[m/s\]; of a plane, that of its reference point.
    #[must_use]
    pub fn fastest(&self) -> f32 {
        let radius = self.shape.bounding_radius();
        let radius = if radius.is_finite() { radius } else { 0.0 };
        self.state.linear_velocity.length() + radius * self.state.angular_velocity.length()
    }

    /// Signed distance of a world point from the surface \[m\], negative inside.
    #[must_use]
    pub fn distance(&self, point: Vec3) -> f32 {
        self.distance_and_normal(point).0
    }

    /// The same, and the outward normal of the surface there.
    #[must_use]
    pub fn distance_and_normal(&self, point: Vec3) -> (f32, Vec3) {
        lanes::dispatch!(lanes::baseline(), simd => {
            let (distance, [x, y, z]) =
                Placed::new(simd, self).distance(vector::splat(simd, point.to_array()));
            (distance[0], Vec3::new(x[0], y[0], z[0]))
        })
    }
}

/// All bodies.
#[derive(Clone, Debug, Default)]
pub struct Bodies(pub Vec<Body>);

/// A body placed in the world, for distance queries.
pub(crate) struct Placed<'a, S: Simd> {
    simd: S,
    shape: &'a Shape,
    position: Vec3x8<S>,
    /// Origin of the frame of the shape.
    origin: Vec3x8<S>,
    /// Columns of the rotation matrix.
    axes: [Vec3x8<S>; 3],
    linear: Vec3x8<S>,
    angular: Vec3x8<S>,
}

impl<'a, S: Simd> Placed<'a, S> {
    #[inline(always)]
    pub(crate) fn new(simd: S, body: &'a Body) -> Self {
        Self::of_piece(simd, body, (&body.shape, None))
    }

    /// A convex piece of the body, and its centre in the frame of the body if that is not its origin.
    #[inline(always)]
    pub(crate) fn of_piece(simd: S, body: &Body, (shape, centre): (&'a Shape, Option<Vec3>)) -> Self {
        let splat = |vector: Vec3| vector::splat(simd, vector.to_array());
        let matrix = Mat3::from_quat(body.state.rotation);
        let position = body.state.position;
        Self {
            simd,
            shape,
            position: splat(position),
            origin: splat(centre.map_or(position, |centre| position + matrix * centre)),
            axes: [splat(matrix.x_axis), splat(matrix.y_axis), splat(matrix.z_axis)],
            linear: splat(body.state.linear_velocity),
            angular: splat(body.state.angular_velocity),
        }
    }

    /// Velocity of the body's material at world points.
    #[inline(always)]
    pub(crate) fn velocity(&self, point: Vec3x8<S>) -> Vec3x8<S> {
        plus(self.linear, cross(self.angular, minus(point, self.position)))
    }

    /// Signed distance from the surface (negative inside) and outward normal, at world points.
    ///
    /// Beside a hull's edge the distance is that to the nearest face plane, an underestimate.
    #[inline(always)]
    pub(crate) fn distance(&self, point: Vec3x8<S>) -> (f32x8<S>, Vec3x8<S>) {
        let (distance, normal) = self.local_distance(self.local(point));
        (distance, self.turned(normal))
    }

    /// World points in the frame of the shape.
    #[inline(always)]
    pub(crate) fn local(&self, point: Vec3x8<S>) -> Vec3x8<S> {
        let arm = minus(point, self.origin);
        let [x, y, z] = self.axes;
        [dot(x, arm), dot(y, arm), dot(z, arm)]
    }

    /// Points of the frame of the shape in the world.
    #[inline(always)]
    pub(crate) fn world(&self, local: Vec3x8<S>) -> Vec3x8<S> {
        plus(self.origin, self.turned(local))
    }

    /// Directions of the body's frame in the world.
    #[inline(always)]
    pub(crate) fn turned(&self, local: Vec3x8<S>) -> Vec3x8<S> {
        let [x, y, z] = self.axes;
        plus(plus(times(x, local[0]), times(y, local[1])), times(z, local[2]))
    }

    /// [`Self::distance`] in the body's frame.
    #[inline(always)]
    pub(crate) fn local_distance(&self, local: Vec3x8<S>) -> (f32x8<S>, Vec3x8<S>) {
        let simd = self.simd;
        let local = [local[0].to_array(), local[1].to_array(), local[2].to_array()];
        let [distance, normal @ ..] = surface(simd.level(), self.shape, &local);
        let [x, y, z] = normal.each_ref().map(|lanes| lanes::load_array(simd, lanes));
        (lanes::load_array(simd, &distance), [x, y, z])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{LANES, SimdLevel, dispatch};

    fn body(shape: Shape) -> Body {
        let state = BodyState {
            position: Vec3::new(1.0, 2.0, 3.0),
            rotation: Quat::from_rotation_z(std::f32::consts::FRAC_PI_2),
            linear_velocity: Vec3::X,
            angular_velocity: Vec3::new(0.0, 0.0, 2.0),
        };
        Body {
            shape,
            kind: BodyKind::Fixed,
            state,
            friction: 0.5,
            touches_nodes: true,
            no_slip: false,
            rounding: Rounding::default(),
            inverse_mass: 0.0,
            inverse_inertia: Mat3::ZERO,
        }
    }

    /// Distance and normal at one world point, the same on every level.
    fn probe(shape: Shape, point: [f32; 3]) -> (f32, Vec3) {
        let body = body(shape);
        let mut results = Vec::new();
        for level in SimdLevel::ALL {
            let Some(token) = level.token() else { continue };
            results.push(dispatch!(token, simd => {
                let (distance, normal) =
                    Placed::new(simd, &body).distance(vector::splat(simd, point));
                let lane = LANES - 1;
                (distance[lane], Vec3::new(normal[0][lane], normal[1][lane], normal[2][lane]))
            }));
        }
        assert!(results.windows(2).all(|pair| pair[0] == pair[1]));
        results[0]
    }

    #[track_caller]
    fn assert_probe(shape: Shape, point: [f32; 3], distance: f32, normal: Vec3) {
        let found = probe(shape, point);
        assert!((found.0 - distance).abs() < 1e-5, "distance {} instead of {distance}", found.0);
        assert!(found.1.distance(normal) < 1e-5, "normal {} instead of {normal}", found.1);
    }

    #[test]
    fn distances_of_a_body_turned_by_a_quarter() {
        // The body's y axis points along -x of the world, its x axis along +y.
        assert_probe(Shape::Plane, [0.5, 0.0, 0.0], 0.5, -Vec3::X);
        assert_probe(Shape::Sphere { radius: 0.5 }, [1.0, 4.0, 3.0], 1.5, Vec3::Y);
        let capsule = Shape::Capsule { half_height: 2.0, radius: 0.25 };
        assert_probe(capsule.clone(), [-0.5, 3.0, 3.0], 0.75, Vec3::Y);
        assert_probe(capsule, [-2.0, 2.0, 3.0], 0.75, -Vec3::X);
        let cuboid = Shape::Cuboid { half_extents: Vec3::new(1.0, 0.5, 0.25) };
        assert_probe(cuboid.clone(), [1.0, 3.5, 3.0], 0.5, Vec3::Y);
        assert_probe(cuboid.clone(), [1.0, 2.0, 3.2], -0.05, Vec3::Z);
        assert_probe(cuboid, [2.0, 2.0, 3.0], 0.5, Vec3::X);
        let planes = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z].map(|n| (n, 0.5)).to_vec();
        let hull = Shape::Hull { planes, vertices: vec![Vec3::splat(0.5)], triangles: Vec::new() };
        assert_probe(hull, [1.0, 2.75, 3.1], 0.25, Vec3::Y);
    }

    #[test]
    fn the_centre_of_a_ball_has_a_normal() {
        assert_probe(Shape::Sphere { radius: 0.5 }, [1.0, 2.0, 3.0], -0.5, -Vec3::X);
    }
}
