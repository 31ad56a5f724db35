//! Shapes of rigid bodies, in their own frames.

use std::sync::Arc;

use glam::Vec3;

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
