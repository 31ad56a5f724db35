//! Bodies as shaders have them.

use glam::{Mat3, Vec3};

use super::layout::Value;
use crate::{
    body::{Body, ConvexPart, Shape},
    layout::{constants, enumeration, layout},
};

constants! {
    /// Rows of a part of a compound. The first is its centre. The second has the radius of the ball of its core, first plane and number of
    /// planes, and the first triangle of the core. The third has the number of triangles. Numbers of rows are exact as f32.
    const PART_ROWS: u32 = 3;
}

/// Bytes of a body that go up before a step.
pub const BODY_BYTES: u64 = DeviceBody::BYTES;

enumeration! {
    /// Shapes of bodies, by the numbers that shaders have for them.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum ShapeKind {
        /// Solid half-space.
        Plane,
        /// Ball.
        Sphere,
        /// Box.
        Cuboid,
        /// Segment that is swept by a ball.
        Capsule,
        /// Convex hull.
        Hull,
        /// Union of convex hulls.
        Compound,
    }
}

layout! {
    /// A rigid body.
    #[derive(Clone, Debug)]
    pub(super) struct DeviceBody as Body {
        position: [f32; 3],
        /// Columns of the rotation matrix.
        x: [f32; 3],
        y: [f32; 3],
        z: [f32; 3],
        linear: [f32; 3],
        angular: [f32; 3],
        /// Half extents of a cuboid; x: half the length of a capsule's segment.
        extents: [f32; 3],
        radius: f32,
        /// As images of particles see it, as [`Rounding`](crate::rounding::Rounding).
        core: [f32; 3],
        rounding: f32,
        /// Columns of the inverse of its inertia.
        inverse_inertia_x: [f32; 3],
        inverse_mass: f32,
        inverse_inertia_y: [f32; 3],
        shape: ShapeKind,
        inverse_inertia_z: [f32; 3],
        first_plane: u32,
        planes: u32,
        /// Of the corners of the triangles of a hull, three rows each, behind its planes.
        first_triangle: u32,
        triangles: u32,
        /// Size of a hull over that of its planes.
        size: f32,
        /// Whether sponge nodes are kept out.
        touches_nodes: bool,
        /// Coulomb friction.
        friction: f32,
        /// Whether the fluid does not slide along it.
        no_slip: bool,
        /// Of a compound: rows of its parts behind the planes of others, [`PART_ROWS`] each.
        first_part: u32,
        /// Convex pieces that it consists of.
        parts: u32,
    }
}

impl DeviceBody {
    /// A body; its face planes and triangles are put behind those of the others.
    fn new(body: &Body, planes: &mut Vec<[f32; 4]>) -> Self {
        let first_plane = planes.len() as u32;
        let (mut faces, mut first_part, mut parts) = (Faces { first_plane, ..Faces::default() }, 0, 1);
        let (shape, extents, radius) = match &body.shape {
            Shape::Plane => (ShapeKind::Plane, Vec3::ZERO, 0.0),
            Shape::Sphere { radius } => (ShapeKind::Sphere, Vec3::ZERO, *radius),
            Shape::Cuboid { half_extents } => (ShapeKind::Cuboid, *half_extents, 0.0),
            Shape::Capsule { half_height, radius } => (ShapeKind::Capsule, Vec3::X * *half_height, *radius),
            Shape::Hull { .. } => {
                faces = Faces::put(&body.shape, &body.shape, planes);
                (ShapeKind::Hull, Vec3::ZERO, 0.0)
            }
            Shape::Compound(compound) => {
                first_part = planes.len() as u32;
                parts = compound.parts.len() as u32;
                put_parts(&compound.parts, planes);
                (ShapeKind::Compound, Vec3::ZERO, 0.0)
            }
        };
        let (state, axes) = (&body.state, Mat3::from_quat(body.state.rotation));
        Self {
            position: state.position.to_array(),
            x: axes.x_axis.to_array(),
            y: axes.y_axis.to_array(),
            z: axes.z_axis.to_array(),
            linear: state.linear_velocity.to_array(),
            angular: state.angular_velocity.to_array(),
            extents: extents.to_array(),
            radius,
            core: body.rounding.core.to_array(),
            rounding: body.rounding.radius,
            inverse_inertia_x: body.inverse_inertia.x_axis.to_array(),
            inverse_mass: body.inverse_mass,
            inverse_inertia_y: body.inverse_inertia.y_axis.to_array(),
            shape,
            inverse_inertia_z: body.inverse_inertia.z_axis.to_array(),
            first_plane: faces.first_plane,
            planes: faces.planes,
            first_triangle: faces.first_triangle,
            triangles: faces.triangles,
            size: 1.0,
            touches_nodes: body.touches_nodes,
            friction: body.friction,
            no_slip: body.no_slip,
            first_part,
            parts,
        }
    }
}

/// Where planes and triangles of a hull are.
#[derive(Clone, Copy, Debug, Default)]
struct Faces {
    first_plane: u32,
    planes: u32,
    first_triangle: u32,
    triangles: u32,
}

impl Faces {
    /// Puts the planes of a hull and the triangles of another one behind others.
    fn put(hull: &Shape, core: &Shape, rows: &mut Vec<[f32; 4]>) -> Self {
        let first_plane = rows.len() as u32;
        let Shape::Hull { planes, .. } = hull else { return Self::default() };
        let Shape::Hull { vertices, triangles, .. } = core else { return Self::default() };
        rows.extend(planes.iter().map(|(normal, offset)| [normal.x, normal.y, normal.z, *offset]));
        let first_triangle = rows.len() as u32;
        let corner = |index: &u32| vertices[*index as usize].extend(0.0).to_array();
        rows.extend(triangles.iter().flatten().map(corner));
        let (planes, triangles) = (planes.len() as u32, triangles.len() as u32);
        Self { first_plane, planes, first_triangle, triangles }
    }
}

/// Puts the table of the parts behind other rows, and their faces behind it.
fn put_parts(parts: &[ConvexPart], rows: &mut Vec<[f32; 4]>) {
    let first = rows.len();
    rows.resize(first + parts.len() * PART_ROWS as usize, [0.0; 4]);
    for (index, part) in parts.iter().enumerate() {
        let Faces { first_plane, planes, first_triangle, triangles } =
            Faces::put(&part.hull, &part.core, rows);
        let row = first + index * PART_ROWS as usize;
        rows[row] = part.centre.extend(0.0).to_array();
        rows[row + 1] = [part.radius, first_plane as f32, planes as f32, first_triangle as f32];
        rows[row + 2][0] = triangles as f32;
    }
}

/// Bodies, and the face planes and triangles of all hulls.
pub(super) fn pack(bodies: &[Body]) -> (Vec<u32>, Vec<[f32; 4]>) {
    let mut planes = Vec::new();
    let words = bodies.iter().flat_map(|body| DeviceBody::new(body, &mut planes).words()).collect();
    (words, planes)
}

/// Rows of the face planes and triangles of all hulls.
pub(super) fn plane_count(bodies: &[Body]) -> usize {
    let rows = |hull: &Shape, core: &Shape| match (hull, core) {
        (Shape::Hull { planes, .. }, Shape::Hull { triangles, .. }) => planes.len() + 3 * triangles.len(),
        _ => 0,
    };
    let planes = |body: &Body| match &body.shape {
        Shape::Compound(compound) => {
            let parts = compound.parts.iter();
            parts.map(|part| PART_ROWS as usize + rows(&part.hull, &part.core)).sum()
        }
        shape => rows(shape, shape),
    };
    bodies.iter().map(planes).sum()
}
