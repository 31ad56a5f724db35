//! Pictures of a world.

use super::{Camera, DrawnBody, Image, Picture, Style, draw};
use crate::body::BodyKind;
use crate::scene::{self, Domain};
use crate::{World, glam::Vec3};

/// Draws a world as `camera` sees it into an image of `width` x `height` pixels.
///
/// Bodies of prescribed motion are translucent, so that a plate does not hide what it squeezes. Take
/// `world.scene().viewpoint().into()` for the scene's own camera.
#[must_use]
pub fn draw_world(world: &World, camera: &Camera, style: Style, width: u32, height: u32) -> Image {
    let bodies: Vec<DrawnBody<'_>> = world
        .bodies()
        .iter()
        .map(|body| DrawnBody {
            shape: &body.shape,
            state: body.state,
            translucent: body.kind == BodyKind::Kinematic,
        })
        .collect();
    let wetness = wetness(world);
    let picture = Picture {
        particles: world.particle_positions(),
        velocities: world.particle_velocities(),
        particle_radius: 0.5 * world.params().fluid.spacing,
        nodes: world.node_positions(),
        wetness: &wetness,
        triangles: &world.lattice().triangles,
        bodies: &bodies,
        container: match world.scene().domain {
            Domain::Box { minimum, maximum } => Some((minimum, maximum)),
            Domain::Open => None,
        },
        style,
    };
    draw(&picture, camera, width, height)
}

/// How wet each node is; before the first step, what the scene says.
fn wetness(world: &World) -> Vec<f32> {
    let saturations = world.node_saturations();
    if saturations.is_empty() {
        let sponges = &world.scene().sponges;
        let owners = &world.lattice().node_sponge;
        return owners.iter().map(|&sponge| sponges[sponge as usize].saturation).collect();
    }
    saturations.iter().map(|saturation| saturation.clamp(0.0, 1.0)).collect()
}

impl From<scene::Camera> for Camera {
    fn from(camera: scene::Camera) -> Self {
        Self {
            eye: camera.eye,
            target: camera.target,
            up: Vec3::Y,
            field_of_view: camera.field_of_view_degrees.to_radians(),
        }
    }
}
