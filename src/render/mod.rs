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
mod rays;
mod shade;
mod shapes;
mod sponge;
mod stage;
mod surface;
mod visibility;
mod water;
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
    /// Rays from the eye: refraction, reflection, absorption and soft shadows.
    Realistic,
}

/// How a body is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Look {
    /// Paint that hides what is behind (the default).
    #[default]
    Solid,
    /// Two thin shells without refraction, which show what the body squeezes.
    Glass,
    /// Edges and lines alone.
    Wire,
}

/// A rigid body to draw.
#[derive(Clone, Copy, Debug)]
pub struct DrawnBody<'a> {
    /// Geometry, in the body's own frame (m).
    pub shape: &'a Shape,
    /// Pose; the velocities are not read.
    pub state: BodyState,
    /// How it is drawn.
    pub look: Look,
    /// Linear red, green and blue, 0 to 1; without one, a colour by the place in the list.
    pub colour: Option<Vec3>,
}

/// What to draw, borrowed from the world; y is up and lengths are in m.
///
/// Empty slices draw nothing. Particles, nodes and bodies whose position is not finite are left out.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a> {
    /// Positions of the fluid particles: xyz, w is ignored.
    pub particles: &'a [[f32; 4]],
    /// Velocities of the particles (m/s), w is ignored: as long as `particles`, or empty. Fast water is drawn paler.
    pub velocities: &'a [[f32; 4]],
    /// Share of each particle that a sponge holds, 0 to 1: as long as `particles`, or empty for 0. The realistic view draws the water
    /// of sponges as their wetness.
    pub interior: &'a [f32],
    /// Drawn radius of a particle in m, about half the rest spacing; nothing is drawn unless it is above 0.
    pub particle_radius: f32,
    /// Positions of the sponge nodes: xyz, w is ignored.
    pub nodes: &'a [[f32; 4]],
    /// Wetness of each node, 0 (dry) to 1 (soaked): as long as `nodes`, or empty for dry.
    pub wetness: &'a [f32],
    /// Places of the nodes in the sponges at rest (m), w is ignored: as long as `nodes`, or empty. Pores are tied to them.
    pub rest: &'a [[f32; 4]],
    /// Outer surface of the sponges as indices into `nodes`, wound counter-clockwise seen from outside.
    pub triangles: &'a [[u32; 3]],
    /// Rigid bodies.
    pub bodies: &'a [DrawnBody<'a>],
    /// Lowest and highest corner of a box container: drawn as a floor with a grid and as thin edges.
    pub container: Option<(Vec3, Vec3)>,
    /// Absorption of red, green and blue light by the water (1/m); default (8, 2, 1.1), that of water of a light blue.
    pub absorption: Vec3,
    /// Linear red, green and blue of deep water, 0 to 1; default (0.03, 0.17, 0.22).
    pub scatter: Vec3,
    /// How the water is drawn.
    pub style: Style,
}

impl Default for Picture<'_> {
    fn default() -> Self {
        Self {
            particles: &[],
            velocities: &[],
            interior: &[],
            particle_radius: 0.0,
            nodes: &[],
            wetness: &[],
            rest: &[],
            triangles: &[],
            bodies: &[],
            container: None,
            absorption: Vec3::new(8.0, 2.0, 1.1),
            scatter: Vec3::new(0.03, 0.17, 0.22),
            style: Style::default(),
        }
    }
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
    match picture.style {
        Style::Realistic => rays::draw(picture, camera, width, height),
        Style::Spheres | Style::Surface => compose::draw(picture, camera, width, height),
    }
}
