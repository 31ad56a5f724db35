//! Light on the floor, on the device.

use glam::Vec3;
use sorb_kernels::gpu::GpuError;

use super::Renderer;
use super::mesh::Row;
use super::passes::{Work, groups_of, tiles_of, two_dimensional};
use super::read::Bounds;
use super::scene::Scene;
use super::water::{SKIPS, densities};
use crate::render::stage::Stage;

impl Renderer {
    /// What can hold the light up, what is near to the floor, and room for the maps.
    pub(super) fn prepare_light(
        &mut self,
        scene: &mut Scene,
        stage: &Stage<'_>,
        particles: Option<Bounds>,
    ) -> Result<(), GpuError> {
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let mut grow = |corner: Vec3, reach: f32| {
            low = low.min(corner - reach);
            high = high.max(corner + reach);
        };
        if let Some((first, last)) = particles {
            grow(first, 4.0 * stage.radius);
            grow(last, 4.0 * stage.radius);
        }
        for (_, corners) in &stage.sponge.triangles {
            corners.iter().for_each(|node| grow(stage.sponge.positions[*node], 0.0));
        }
        stage.solids.iter().filter(|body| !body.is_plane()).for_each(|body| grow(body.position, body.radius));
        let floor = scene.ground_corner.y;
        let is_empty = low.x > high.x;
        (scene.lit_low, scene.lit_high) = if is_empty { (Vec3::ONE, Vec3::ZERO) } else { (low, high) };
        let top = if is_empty { floor } else { high.y.max(floor) };
        scene.light_reach = (top - floor + 0.01 * scene.size) / scene.light.y;
        let hills = hills(scene, stage);
        scene.hills = hills.len() as u32;
        self.buffers.write("hills", bytemuck::cast_slice(&hills))?;
        let texels = u64::from(scene.texels * scene.texels);
        self.buffers.reserve("ground", 32 * texels)?;
        self.buffers.reserve("landed", 12 * texels)?;
        self.buffers.reserve("hollows", 8 * texels)
    }
}

/// Places on the floor near nodes of sponges and bodies, which take ambient light away.
fn hills(scene: &Scene, stage: &Stage<'_>) -> Vec<Row> {
    let (height, reach) = (scene.ground_corner.y, 0.1 * scene.size);
    let mut hills = Vec::new();
    let mut seen = vec![false; stage.sponge.positions.len()];
    for node in stage.sponge.triangles.iter().flat_map(|(_, corners)| *corners) {
        let place = stage.sponge.positions[node];
        let gap = place.y - height;
        if !seen[node] && gap < reach {
            hills.push([place.x, place.z, reach, 0.13 * (1.0 - gap.max(0.0) / reach)]);
        }
        seen[node] = true;
    }
    for body in stage.solids.iter().filter(|body| !body.is_plane()) {
        let gap = (body.position.y - height).max(0.5 * body.radius);
        let share = body.radius / gap;
        hills.push([body.position.x, body.position.z, (2.2 * gap).min(scene.size), 0.45 * share * share]);
    }
    hills
}

/// The maps of light on the floor.
pub(super) fn light(work: &mut Work<'_>, scene: &Scene, is_water: bool) -> Result<(), GpuError> {
    let texels = u64::from(scene.texels * scene.texels);
    let tiles = tiles_of(scene.texels, scene.texels);
    work.clear("landed", 12 * texels);
    work.clear("hollows", 8 * texels);
    if is_water {
        let names = [("densities", densities(scene)), ("bricks", SKIPS), ("shadows", "ground")];
        work.run("render::photons_water", &names, tiles)?;
    } else {
        work.run("render::photons_balls", &[("shadows", "ground")], tiles)?;
    }
    if scene.hills > 0 {
        work.run("render::contact", &[], two_dimensional(u64::from(scene.hills)))?;
    }
    if scene.particles > 0 {
        work.run("render::wetness", &[], groups_of(u64::from(scene.particles)))?;
    }
    work.run("render::arriving", &[], tiles)
}
