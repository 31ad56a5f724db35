//! Pictures that follow small motions slowly: particles and nodes at rest still tremble, and refraction magnifies it.

use std::collections::BTreeMap;

use super::world::{Seen, draw_positions};
use super::{Camera, Image, View, colour::smooth};
use crate::World;
use glam::Vec3;

/// Share of a small motion that a picture takes.
const SLOW: f32 = 0.04;
/// Motions that are small, and those that are taken fully, in spacings of the particles.
const SMALL: (f32, f32) = (0.01, 0.05);

/// Draws the pictures of a film. A picture depends on those before it; the state does not.
#[derive(Clone, Debug, Default)]
pub struct Steady {
    /// By identity.
    particles: BTreeMap<u32, Vec3>,
    nodes: Vec<Vec3>,
}

impl Steady {
    /// Draws the next picture of a film, as [`draw_world`](super::draw_world) does.
    #[must_use]
    pub fn draw_world(
        &mut self,
        world: &World,
        camera: &Camera,
        view: View,
        width: u32,
        height: u32,
    ) -> Image {
        let spacing = world.params.fluid.spacing.max(1e-6);
        let (rows, ids) = (world.particle_positions(), world.particle_ids());
        if self.nodes.len() != world.node_positions().len() {
            self.nodes = vec![Vec3::INFINITY; world.node_positions().len()];
        }
        let mut particles = rows.to_vec();
        let before = std::mem::take(&mut self.particles);
        for (row, id) in particles.iter_mut().zip(ids) {
            // What has come, and what was removed, has no picture before or after.
            let mut shown = before.get(id).copied().unwrap_or(Vec3::INFINITY);
            follow(&mut shown, row, spacing);
            self.particles.insert(*id, shown);
        }
        let mut nodes = world.node_positions().to_vec();
        for (row, shown) in nodes.iter_mut().zip(&mut self.nodes) {
            follow(shown, row, spacing);
        }
        let seen = Seen { particles: &particles, nodes: &nodes, ..Seen::of(world) };
        draw_positions(world, &seen, camera, view, (width, height))
    }
}

/// Moves what is shown towards a position, and the position to what is shown.
fn follow(shown: &mut Vec3, row: &mut [f32; 4], spacing: f32) {
    let change = Vec3::new(row[0], row[1], row[2]) - *shown;
    let share = SLOW + (1.0 - SLOW) * smooth(SMALL.0, SMALL.1, change.length() / spacing);
    // The first picture, and what is far away, shows the position itself.
    if share < 1.0 {
        *shown += change * share;
    } else {
        *shown = Vec3::new(row[0], row[1], row[2]);
    }
    [row[0], row[1], row[2]] = shown.to_array();
}
