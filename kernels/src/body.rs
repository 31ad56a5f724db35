//! Rigid bodies as the kernels see them: signed distances, poses and velocities.

use std::borrow::Cow;

use glam::{Mat3, Quat, Vec3};

use crate::{
    lanes::{self, Simd, f32x8},
    rounding::Rounding,
    surface::surface,
    vector::{self, Vec3x8, cross, dot, minus, plus, times},
};

pub use crate::shape::{Compound, ConvexPart, Shape};
pub use crate::wrench::Wrench;
pub(crate) use crate::wrench::by_chunk;

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

/// A convex piece of a body: all of it, or a part.
#[derive(Clone, Debug)]
pub(crate) struct Piece<'a> {
    /// Number of the body.
    pub(crate) body: usize,
    pub(crate) shape: Cow<'a, Shape>,
    /// Place of its centre in the frame of the body, where that is not the origin \[m\].
    pub(crate) centre: Option<Vec3>,
    /// Radius of the ball that sweeps it \[m\].
    pub(crate) radius: f32,
}

impl<'a> Piece<'a> {
    /// The pieces of all bodies, in their order.
    pub(crate) fn of_all(bodies: &'a [Body]) -> impl Iterator<Item = Self> {
        Self::of_each(bodies, |body| (Cow::Borrowed(&body.shape), 0.0))
    }

    /// The cores of rounded bodies, and the balls that sweep them. The parts of compounds are as they are: no face of a part is outside of
    /// its core with the ball.
    pub(crate) fn cores_of_all(bodies: &'a [Body]) -> impl Iterator<Item = Self> {
        Self::of_each(bodies, |body| {
            let (shape, radius) = body.rounding.core_of(&body.shape);
            (Cow::Owned(shape), radius)
        })
    }

    fn of_each(
        bodies: &'a [Body],
        convex: impl Fn(&'a Body) -> (Cow<'a, Shape>, f32) + Copy,
    ) -> impl Iterator<Item = Self> {
        bodies.iter().enumerate().flat_map(move |(index, body)| {
            let (whole, parts) = match &body.shape {
                Shape::Compound(compound) => (None, &compound.parts[..]),
                _ => (Some(convex(body)), &[][..]),
            };
            let whole =
                whole.map(|(shape, radius)| Self { body: index, shape, centre: None, radius }).into_iter();
            whole.chain(parts.iter().map(move |part| Self {
                body: index,
                shape: Cow::Borrowed(&part.hull),
                centre: Some(part.centre),
                radius: 0.0,
            }))
        })
    }

    /// The piece as [`Placed::of_piece`] takes it.
    pub(crate) fn geometry(&self) -> (&Shape, Option<Vec3>) {
        (&self.shape, self.centre)
    }
}

/// The convex pieces of bodies, each as a body of its own, and the radius of the ball that sweeps it \[m\]. These are their cores with that
/// radius, or as they are with zero.
#[must_use]
pub fn pieces(bodies: &[Body], as_cores: bool) -> Vec<(Body, f32)> {
    let body = |piece: Piece<'_>| {
        let mut body = bodies[piece.body].clone();
        body.shape = piece.shape.into_owned();
        body.state.position += piece.centre.map_or(Vec3::ZERO, |centre| body.state.rotation * centre);
        (body, piece.radius)
    };
    if as_cores {
        Piece::cores_of_all(bodies).map(body).collect()
    } else {
        Piece::of_all(bodies).map(body).collect()
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
