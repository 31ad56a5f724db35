//! Bodies of several convex parts.

use std::borrow::Cow;

use glam::Vec3;

use crate::body::{Body, Shape};

/// A convex part of a compound.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvexPart {
    /// Place of its centre in the frame of the body \[m\].
    pub centre: Vec3,
    /// A [`Shape::Hull`] about its centre.
    pub hull: Shape,
    /// The points of the hull that are at least `radius` below all of its faces, as a hull about the same centre. Images of particles
    /// see this, swept by a ball.
    pub core: Shape,
    /// Radius of the ball \[m\].
    pub radius: f32,
}

impl ConvexPart {
    /// Outward unit normals and offsets of the faces \[m\], about the centre.
    #[must_use]
    pub fn planes(&self) -> &[(Vec3, f32)] {
        match &self.hull {
            Shape::Hull { planes, .. } => planes,
            _ => &[],
        }
    }

    /// The largest distance of a point of the body's frame from a face plane \[m\], negative inside.
    #[must_use]
    pub fn distance(&self, point: Vec3) -> f32 {
        self.distance_and_normal(point).0
    }

    /// The same, and the normal of that face.
    #[must_use]
    pub fn distance_and_normal(&self, point: Vec3) -> (f32, Vec3) {
        let local = point - self.centre;
        let faces = self.planes().iter().map(|(normal, offset)| (normal.dot(local) - offset, *normal));
        faces.fold((f32::MIN, Vec3::Y), |best, face| if face.0 > best.0 { face } else { best })
    }
}

/// A union of convex hulls, which may overlap: one rigid body, which need not be convex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Compound {
    /// The hulls.
    pub parts: Vec<ConvexPart>,
    /// Corners of the closed surface of the union \[m\].
    pub vertices: Vec<Vec3>,
    /// Its triangles, outward winding: mass and inertia are those of what it encloses.
    pub triangles: Vec<[u32; 3]>,
}

impl Compound {
    pub(crate) fn bounding_radius(&self) -> f32 {
        let parts = self.parts.iter().map(|part| part.centre.length() + part.hull.bounding_radius());
        parts.fold(0.0, f32::max)
    }

    pub(crate) fn reach(&self, range: f32) -> f32 {
        let parts = self.parts.iter().map(|part| part.centre.length() + part.hull.reach(range));
        parts.fold(0.0, f32::max)
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

    /// The piece as [`Placed::of_piece`](crate::body::Placed::of_piece) takes it.
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
