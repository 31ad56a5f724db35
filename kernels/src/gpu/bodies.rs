//! Bodies as shaders have them.

use glam::{Mat3, Vec3};

use super::layout::Value;
use crate::{
    body::{Body, Shape},
    layout::{enumeration, layout},
};

/// Bytes of a body that go up before a step.
pub const BODY_BYTES: u64 = DeviceBody::BYTES;

enumeration! {
    /// Shapes of bodies.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub(super) enum ShapeKind {
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
    }
}

impl DeviceBody {
    /// A body; its face planes and triangles are put behind those of the others.
    fn new(body: &Body, planes: &mut Vec<[f32; 4]>) -> Self {
        let first_plane = planes.len() as u32;
        let (mut first_triangle, mut triangles) = (first_plane, 0);
        let (shape, extents, radius) = match &body.shape {
            Shape::Plane => (ShapeKind::Plane, Vec3::ZERO, 0.0),
            Shape::Sphere { radius } => (ShapeKind::Sphere, Vec3::ZERO, *radius),
            Shape::Cuboid { half_extents } => (ShapeKind::Cuboid, *half_extents, 0.0),
            Shape::Capsule { half_height, radius } => (ShapeKind::Capsule, Vec3::X * *half_height, *radius),
            Shape::Hull { planes: faces, vertices, triangles: corners } => {
                planes.extend(faces.iter().map(|(normal, offset)| [normal.x, normal.y, normal.z, *offset]));
                first_triangle = planes.len() as u32;
                let corner = |index: &u32| vertices[*index as usize].extend(0.0).to_array();
                planes.extend(corners.iter().flatten().map(corner));
                triangles = corners.len() as u32;
                (ShapeKind::Hull, Vec3::ZERO, 0.0)
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
            first_plane,
            planes: if shape == ShapeKind::Hull { first_triangle - first_plane } else { 0 },
            first_triangle,
            triangles,
            size: 1.0,
            touches_nodes: body.touches_nodes,
            friction: body.friction,
            no_slip: body.no_slip,
        }
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
    let planes = |body: &Body| match &body.shape {
        Shape::Hull { planes, triangles, .. } => planes.len() + 3 * triangles.len(),
        _ => 0,
    };
    bodies.iter().map(planes).sum()
}
