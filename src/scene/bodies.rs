//! Rigid bodies of a scene.

use glam::{Quat, Vec3};

use super::{BodyKind, Mesh, Motion, Shape};

/// A rigid body.
///
/// The default is a dynamic ball of 3 cm.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "serde", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct Body {
    /// Name, unique among sponges and bodies: letters, digits, `_` and `-`, starting with a letter. Required in files.
    pub name: String,
    /// Geometry. Required in files.
    pub shape: ShapeKind,
    /// What moves it: forces (`dynamic`), nothing (`fixed`) or its `motions` (`kinematic`); default `dynamic`.
    #[serde(with = "KindKey")]
    #[cfg_attr(feature = "serde", schemars(with = "KindKey"))]
    pub kind: BodyKind,
    /// Density of a dynamic body. A body of less than a quarter of the density of what touches it keeps its weight, but has
    /// the inertia of a quarter. Range 1 to 100000 kg/m^3; default 1000.
    pub density: f32,
    /// Centre of mass (plane: a point of the surface). Range -1000 to 1000 m; default (0, 0, 0).
    #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
    pub position: Vec3,
    /// Orientation at time zero; default no rotation.
    pub rotation: Rotation,
    /// Velocity of a dynamic body at time zero. Range -100 to 100 m/s; default (0, 0, 0).
    #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
    pub linear_velocity: Vec3,
    /// Angular velocity of a dynamic body at time zero. Range -1000 to 1000 rad/s; default (0, 0, 0).
    #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
    pub angular_velocity: Vec3,
    /// Coulomb friction. Range 0 to 10; default 0.5.
    pub friction: f32,
    /// Whether water sticks to its surface (no-slip); default false: water slides along it (free slip).
    pub no_slip: bool,
    /// Coefficient of restitution: share of the approach speed after a bounce. Range 0 to 1; default 0.1.
    pub restitution: f32,
    /// Scripted motions of a kinematic body; default none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub motions: Vec<Motion>,
    /// Whether a fixed or kinematic body holds the sponge nodes that are inside it at time zero (a grip); default false.
    pub grip: bool,
    /// How pictures show it; default `glass` for a kinematic body, which shows what it squeezes, else `solid`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub look: Option<Look>,
    /// Colour in pictures: linear red, green and blue. Range 0 to 1; default by the place in the list of bodies.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "serde", schemars(with = "Option<[f32; 3]>"))]
    pub colour: Option<Vec3>,
}

/// How pictures show a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "serde", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Look {
    /// Paint that hides what is behind.
    #[default]
    Solid,
    /// Two thin shells without refraction, which show what the body squeezes.
    Glass,
    /// Edges and lines alone.
    Wire,
}

impl Default for Body {
    fn default() -> Self {
        Self {
            name: "body".to_owned(),
            shape: ShapeKind::Sphere { radius: 0.03 },
            kind: BodyKind::Dynamic,
            density: 1000.0,
            position: Vec3::ZERO,
            rotation: Rotation::default(),
            linear_velocity: Vec3::ZERO,
            angular_velocity: Vec3::ZERO,
            friction: 0.5,
            no_slip: false,
            restitution: 0.1,
            motions: Vec::new(),
            grip: false,
            look: None,
            colour: None,
        }
    }
}

impl Body {
    /// Dynamic body.
    #[must_use]
    pub fn dynamic(name: &str, shape: ShapeKind, position: Vec3, density: f32) -> Self {
        Self { name: name.to_owned(), shape, position, density, ..Self::default() }
    }

    /// Body that never moves.
    #[must_use]
    pub fn fixed(name: &str, shape: ShapeKind, position: Vec3) -> Self {
        Self { name: name.to_owned(), shape, position, kind: BodyKind::Fixed, ..Self::default() }
    }

    /// Body that follows a script.
    #[must_use]
    pub fn kinematic(name: &str, shape: ShapeKind, position: Vec3, motions: Vec<Motion>) -> Self {
        Self { name: name.to_owned(), shape, position, kind: BodyKind::Kinematic, motions, ..Self::default() }
    }
}

/// Where removed bodies and sponges are \[m\].
pub(super) const NOWHERE: Vec3 = Vec3::splat(1000.0);

/// What all names of removed bodies and sponges begin with.
pub(crate) const REMOVED: &str = "removed-";

impl Body {
    /// What a removed body leaves behind: a body that nothing can meet.
    pub(crate) fn removed(index: usize) -> Self {
        Self::fixed(&format!("{REMOVED}{index}"), ShapeKind::Sphere { radius: 1e-4 }, NOWHERE)
    }

    /// Whether it is what [`Command::RemoveBody`](crate::Command::RemoveBody) has left behind.
    #[must_use]
    pub fn is_removed(&self) -> bool {
        self.position == NOWHERE && self.kind == BodyKind::Fixed && self.name.starts_with(REMOVED)
    }
}

// The type itself belongs to a crate without serde, so its keys in files are declared here.
/// What moves a body.
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(remote = "BodyKind", rename_all = "snake_case")]
#[cfg_attr(feature = "serde", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", schemars(rename = "BodyKind"))]
pub(crate) enum KindKey {
    /// Moved by forces.
    Dynamic,
    /// Never moves.
    Fixed,
    /// Moved by its `motions` only.
    Kinematic,
}

/// Geometry of a body, in its own frame, centre of mass at the origin.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "serde", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum ShapeKind {
    /// Solid half-space below the local plane y = 0. Fixed or kinematic bodies only.
    Plane,
    /// Ball.
    Sphere {
        /// Radius. Range 1e-4 to 100 m.
        radius: f32,
    },
    /// Box with faces at plus and minus the half extents.
    Cuboid {
        /// Half of the edge lengths. Range 1e-4 to 100 m.
        #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
        half_extents: Vec3,
    },
    /// Capsule along local y: a segment, swept by a ball.
    Capsule {
        /// Half of the segment's length. Range 0 to 100 m.
        half_height: f32,
        /// Radius of the ball. Range 1e-4 to 100 m.
        radius: f32,
    },
    /// Convex hull of at least four points that are not all in one plane.
    Hull {
        /// The points, about the body's position. Range -100 to 100 m.
        #[cfg_attr(feature = "serde", schemars(with = "Vec<[f32; 3]>"))]
        vertices: Vec<Vec3>,
    },
    /// Open cup along local y, which holds water: a prism of 24 sides that stands on the body's position.
    Cup {
        /// Inner radius, of a round cup that holds as much. Range 1e-4 to 100 m.
        radius: f32,
        /// Height in all, above `thickness`. Range 1e-4 to 100 m.
        height: f32,
        /// Thickness of wall and bottom; 1.6 times `fluid.spacing` keeps the water on both sides apart. Range 1e-4 to 100 m.
        thickness: f32,
    },
    /// Convex parts of a mesh.
    Mesh {
        /// The surface, about the body's position.
        mesh: Mesh,
        /// Most convex parts that it is taken apart into; with 1 the body is the convex hull. Range 1 to 256; default 1.
        #[serde(default = "one")]
        parts: u32,
    },
}

fn one() -> u32 {
    1
}

impl ShapeKind {
    /// The solver's shape, or `None` for those whose faces must be computed first: hulls, cups and meshes.
    #[must_use]
    pub fn primitive(&self) -> Option<Shape> {
        match *self {
            Self::Plane => Some(Shape::Plane),
            Self::Sphere { radius } => Some(Shape::Sphere { radius }),
            Self::Cuboid { half_extents } => Some(Shape::Cuboid { half_extents }),
            Self::Capsule { half_height, radius } => Some(Shape::Capsule { half_height, radius }),
            Self::Hull { .. } | Self::Cup { .. } | Self::Mesh { .. } => None,
        }
    }

    /// Largest distance of the shape from its origin \[m\]; `None` for a plane, which is unbounded.
    #[must_use]
    pub fn reach(&self) -> Option<f32> {
        match self {
            Self::Plane => None,
            Self::Sphere { radius } => Some(*radius),
            Self::Cuboid { half_extents } => Some(half_extents.length()),
            Self::Capsule { half_height, radius } => Some(half_height + radius),
            Self::Hull { vertices } => {
                Some(vertices.iter().map(|vertex| vertex.length()).fold(0.0, f32::max))
            }
            Self::Cup { radius, height, thickness } => {
                Some(Vec3::new(radius + thickness, *height, 0.0).length())
            }
            Self::Mesh { mesh, .. } => Some(mesh.reach()),
        }
    }
}

/// Orientation as an axis and an angle; the default is no rotation.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "serde", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct Rotation {
    /// Axis of rotation, of any length but zero. Range -1000 to 1000; default (0, 1, 0).
    #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
    pub axis: Vec3,
    /// Angle, counter-clockwise seen from the tip of the axis. Range -3600 to 3600 degrees; default 0.
    pub degrees: f32,
}

impl Default for Rotation {
    fn default() -> Self {
        Self { axis: Vec3::Y, degrees: 0.0 }
    }
}

impl Rotation {
    /// Rotation by some degrees about an axis.
    #[must_use]
    pub fn new(axis: Vec3, degrees: f32) -> Self {
        Self { axis, degrees }
    }

    /// The unit quaternion, with the same bits on every platform. A zero axis gives the identity.
    #[must_use]
    pub fn quaternion(self) -> Quat {
        turn(self.axis, f64::from(self.degrees).to_radians())
    }
}

/// Unit quaternion of a rotation by an angle \[rad\] about an axis of any length.
///
/// In f64 and through the portable `libm`, because the sine of the platform differs from machine to machine.
fn turn(axis: Vec3, angle: f64) -> Quat {
    let Some(unit) = axis.as_dvec3().try_normalize() else {
        return Quat::IDENTITY;
    };
    let imaginary = (unit * libm::sin(0.5 * angle)).as_vec3();
    #[expect(clippy::cast_possible_truncation, reason = "rounds a cosine to f32")]
    let real = libm::cos(0.5 * angle) as f32;
    Quat::from_xyzw(imaginary.x, imaginary.y, imaginary.z, real)
}
