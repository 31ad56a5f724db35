//! Point of view.

use glam::Vec3;

use super::{Domain, Scene};

/// Perspective camera; up is +Y.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Camera {
    /// Where the camera is. Range -10000 to 10000 m; default (0.3, 0.25, 0.5).
    #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
    pub eye: Vec3,
    /// What it looks at; not the eye. Range -10000 to 10000 m; default (0, 0.05, 0).
    #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
    pub target: Vec3,
    /// Vertical angle of view. Range 1 to 150 degrees; default 35.
    pub field_of_view_degrees: f32,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            eye: Vec3::new(0.3, 0.25, 0.5),
            target: Vec3::new(0.0, 0.05, 0.0),
            field_of_view_degrees: 35.0,
        }
    }
}

impl Scene {
    /// The camera of the scene. Without one, a camera that sees all of [`Scene::bounds`] from above and to the right.
    #[must_use]
    pub fn viewpoint(&self) -> Camera {
        if let Some(camera) = self.camera {
            return camera;
        }
        let (minimum, maximum) = self.bounds();
        let target = 0.5 * (minimum + maximum);
        // A sphere of this radius around the target fits into the default angle of view at 3.6 radii.
        let radius = 0.5 * (maximum - minimum).length();
        let direction = Vec3::new(0.45, 0.4, 0.8).normalize();
        Camera { eye: target + 3.6 * radius * direction, target, ..Camera::default() }
    }

    /// Corners of the smallest axis-aligned box around the container \[m\]. In an open scene it encloses water, sponges and
    /// bodies at time zero, without planes. An empty open scene has a box of 0.2 m around the origin.
    #[must_use]
    pub fn bounds(&self) -> (Vec3, Vec3) {
        if let Domain::Box { minimum, maximum, .. } = self.domain {
            return (minimum, maximum);
        }
        let blocks = self.fluid.iter().flat_map(|fluid| &fluid.blocks).map(|b| (b.minimum, b.maximum));
        let sponges = self.sponges.iter().map(|sponge| (sponge.position, sponge.maximum()));
        let bodies = self.bodies.iter().filter(|body| !body.is_removed()).filter_map(|body| {
            let reach = Vec3::splat(body.shape.reach()?);
            Some((body.position - reach, body.position + reach))
        });
        blocks
            .chain(sponges)
            .chain(bodies)
            .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
            .unwrap_or((Vec3::splat(-0.1), Vec3::splat(0.1)))
    }
}
