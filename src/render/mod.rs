//! Pictures of a scene, drawn on the CPU. They read views of the state and write nothing back.
//!
//! [`draw`] turns a [`Picture`] (borrowed positions, triangles and bodies) and a [`Camera`] into an [`Image`].
//! An [`Animation`] appends images to one animated PNG file. The pixels are the same for every number of threads.

#[macro_use]
#[cfg(feature = "gpu")]
mod shared;

mod animation;
mod bands;
mod camera;
mod colour;
mod error;
#[cfg(feature = "film")]
mod film;
#[cfg(feature = "gpu")]
mod gpu;
mod image;
mod legend;
mod number;
mod rays;
mod section;
mod shapes;
mod sponge;
mod stage;
mod steady;
mod water;
mod world;

pub use animation::Animation;
pub use camera::Camera;
pub use error::RenderError;
#[cfg(feature = "film")]
pub use film::Film;
#[cfg(feature = "gpu")]
pub use gpu::{Frame, Renderer};
pub use image::Image;
pub use steady::Steady;
pub use world::draw_world;

pub use crate::scene::Look;

use crate::rigid::{BodyState, Shape};
use glam::Vec3;

/// What a picture shows. Figure 1 of the paper has the views a to d.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum View {
    /// Rays from the eye: refraction, reflection, absorption and soft shadows (the default; the paper's figure 1 d).
    #[default]
    Realistic,
    /// Water by the depth of its particles, which bends a ray once: the quickest view of surfaces.
    Fast,
    /// Particles of the water (figure 1 c).
    Particles,
    /// Nodes of the sponges (figure 1 a).
    Nodes,
    /// Surfaces of water and sponges that let light through (figure 1 b).
    Superimposed,
    /// Saturation of the sponges as a colour map, without water.
    Saturation,
    /// Pressure of the particles as a colour map.
    Pressure,
    /// Speed of the particles as a colour map.
    Speed,
    /// A section through the sponges, with the water in them.
    Cutaway,
}

impl View {
    /// All views, the default first.
    pub const ALL: [Self; 9] = [
        Self::Realistic,
        Self::Fast,
        Self::Particles,
        Self::Nodes,
        Self::Superimposed,
        Self::Saturation,
        Self::Pressure,
        Self::Speed,
        Self::Cutaway,
    ];

    /// Title of the legend with the unit, for a view that is a colour map.
    fn map(self) -> Option<&'static str> {
        match self {
            Self::Saturation => Some("saturation (1)"),
            Self::Pressure => Some("pressure (Pa)"),
            Self::Speed => Some("speed (m/s)"),
            _ => None,
        }
    }
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
    /// Pressures of the particles (Pa), for that view: as long as `particles`, or empty.
    pub pressures: &'a [f32],
    /// Lowest and highest value of a colour map, in its unit; default 0 to 1.
    pub range: (f32, f32),
    /// A point (m) and the normal of the plane of a section, for that view; the side that the normal points to is left out.
    pub section: Option<(Vec3, Vec3)>,
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
    /// Further triangles of that kind, which are drawn as they are: of `triangles` the steps of the lattice are smoothed. Default none.
    pub skin: &'a [[u32; 3]],
    /// Rigid bodies.
    pub bodies: &'a [DrawnBody<'a>],
    /// Lowest and highest corner of a box container: drawn as a floor with a grid and as thin edges.
    pub container: Option<(Vec3, Vec3)>,
    /// Absorption of red, green and blue light by the water (1/m); default (8, 2, 1.1), that of water of a light blue.
    pub absorption: Vec3,
    /// Linear red, green and blue of deep water, 0 to 1; default (0.03, 0.17, 0.22).
    pub scatter: Vec3,
    /// What is shown.
    pub view: View,
}

impl Default for Picture<'_> {
    fn default() -> Self {
        Self {
            particles: &[],
            velocities: &[],
            pressures: &[],
            range: (0.0, 1.0),
            section: None,
            interior: &[],
            particle_radius: 0.0,
            nodes: &[],
            wetness: &[],
            rest: &[],
            triangles: &[],
            skin: &[],
            bodies: &[],
            container: None,
            absorption: Vec3::new(8.0, 2.0, 1.1),
            scatter: Vec3::new(0.03, 0.17, 0.22),
            view: View::default(),
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
    let mut image = rays::draw(picture, camera, width, height);
    if let Some(title) = picture.view.map() {
        legend::draw(&mut image, title, picture.range);
    }
    image
}
