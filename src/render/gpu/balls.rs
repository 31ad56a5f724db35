//! Balls of the views that show particles or nodes.

use glam::Vec3;
use sorb_kernels::gpu::GpuError;

use super::Renderer;
use super::passes::{Work, groups_of};
use super::read::Bounds;
use super::scene::Scene;
use crate::render::{View, rays::node_balls, stage::Stage};

/// Most cells of the grid that balls are in.
const CELLS: f32 = 8e6;
/// Side of a cell in radii of balls. A ball reaches into at most eight cells.
const SIDE: f32 = 3.0;

impl Renderer {
    /// Room for the balls of a view; those that show nodes are uploaded.
    pub(super) fn prepare_balls(
        &mut self,
        scene: &mut Scene,
        stage: &Stage<'_>,
        particles: Option<Bounds>,
        shows_particles: bool,
    ) -> Result<(), GpuError> {
        let mut around = particles.filter(|_| shows_particles);
        let (mut count, mut radius) = (u64::from(scene.particles), stage.radius);
        if stage.picture.view == View::Nodes {
            let (balls, colours) = node_balls(stage);
            let rows: Vec<[[f32; 4]; 2]> = balls
                .iter()
                .zip(&colours)
                .map(|((place, radius), colour)| {
                    [place.extend(*radius).to_array(), colour.extend(0.0).to_array()]
                })
                .collect();
            self.buffers.write("balls", bytemuck::cast_slice(&rows))?;
            around = balls.iter().fold(None, |around: Option<Bounds>, (place, _)| {
                Some(around.map_or((*place, *place), |(low, high)| (low.min(*place), high.max(*place))))
            });
            (count, radius) = (rows.len() as u64, balls.first().map_or(radius, |(_, radius)| *radius));
        }
        let Some((low, high)) = around.filter(|_| count > 0) else {
            return Ok(());
        };
        scene.has_balls = 1;
        let border = Vec3::splat(1.5 * radius);
        scene.set_cells((low - border, high + border), SIDE * radius, count as u32, 2, CELLS);
        self.buffers.reserve("balls", 32 * count)?;
        self.reserve_cells(scene, 8 * count)
    }
}

/// Places and colours of the particles that a view shows.
pub(super) fn colours(work: &mut Work<'_>, scene: &Scene) -> Result<(), GpuError> {
    work.run("render::beads", &[], groups_of(u64::from(scene.particles)))
}
