//! Pictures of a scene, drawn on the CPU. They read views of the state and write nothing back.
//!
//! [`draw`] turns a [`Picture`] (borrowed positions, triangles and bodies) and a [`Camera`] into an [`Image`].
//! An [`Animation`] appends images to one animated PNG file. The pixels are the same for every number of threads.

#![expect(
    clippy::disallowed_methods,
    reason = "pictures do not feed the simulation: the platform's sine will do"
)]

mod animation;
mod bands;
mod camera;
mod colour;
mod compose;
mod error;
mod image;
mod layer;
mod light;
mod pores;
mod shade;
mod shapes;
mod sponge;
mod stage;
mod surface;
mod visibility;
mod world;

pub use animation::Animation;
pub use camera::Camera;
pub use error::RenderError;
pub use image::Image;
pub use world::draw_world;

use crate::rigid::{BodyState, Shape};
use glam::Vec3;

/// How the water is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Style {
    /// Every particle is a shaded droplet of its own (the default).
    #[default]
    Spheres,
    /// The particles' depth is smoothed into one transparent surface.
    Surface,
}

/// A rigid body to draw.
#[derive(Clone, Copy, Debug)]
pub struct DrawnBody<'a> {
    /// Geometry, in the body's own frame (m).
    pub shape: &'a Shape,
    /// Pose; the velocities are not read.
    pub state: BodyState,
    /// Blends the body over what lies behind it, so that a plate does not hide what it squeezes.
    pub translucent: bool,
}

/// What to draw, borrowed from the world; y is up and lengths are in m.
///
/// Empty slices draw nothing. Particles, nodes and bodies whose position is not finite are left out.
#[derive(Clone, Copy, Debug, Default)]
pub struct Picture<'a> {
    /// Positions of the fluid particles: xyz, w is ignored.
    pub particles: &'a [[f32; 4]],
    /// Velocities of the particles (m/s), w is ignored: as long as `particles`, or empty. Fast water is drawn paler.
    pub velocities: &'a [[f32; 4]],
    /// Drawn radius of a particle in m, about half the rest spacing; nothing is drawn unless it is above 0.
    pub particle_radius: f32,
    /// Positions of the sponge nodes: xyz, w is ignored.
    pub nodes: &'a [[f32; 4]],
    /// Wetness of each node, 0 (dry) to 1 (soaked): as long as `nodes`, or empty for dry.
    pub wetness: &'a [f32],
    /// Outer surface of the sponges as indices into `nodes`, wound counter-clockwise seen from outside.
    pub triangles: &'a [[u32; 3]],
    /// Rigid bodies.
    pub bodies: &'a [DrawnBody<'a>],
    /// Lowest and highest corner of a box container: drawn as a floor with a grid and as thin edges.
    pub container: Option<(Vec3, Vec3)>,
    /// How the water is drawn.
    pub style: Style,
}

/// Draws `picture` as seen by `camera` into an image of `width` x `height` pixels.
///
/// The result depends on the arguments alone, never on the number of threads. A width or height of 0 gives an
/// empty image.
#[must_use]
pub fn draw(picture: &Picture<'_>, camera: &Camera, width: u32, height: u32) -> Image {
    if width == 0 || height == 0 {
        return Image { width, height, pixels: Vec::new() };
    }
    compose::draw(picture, camera, width, height)
}
