//! The passes of a picture, in their order.

use glam::Vec3;
use sorb_kernels::gpu::GpuError;

use super::mesh::{Bodies, Mesh};
use super::passes::{Work, groups_of, tiles_of, two_dimensional};
use super::read::{self, BOUNDS_BYTES, BOX_BYTES, Bounds};
use super::scene::Scene;
use super::water::{SKIPS, densities};
use super::{Renderer, SAMPLES, Water, balls, light, screen, water};
use crate::render::{View, rays::foam, stage::Stage};

/// Buffers that passes bind whether or not a picture has what they are for.
const BOUND: [&str; 9] =
    ["nothing", "surfel_cells", "surfels", "cells", "balls", "densities", "sunk", "away", "other_bricks"];

/// How many pixels are at edges, and whether they are listed.
const EDGES_BYTES: u64 = 8;

impl Renderer {
    /// Uploads what the host knows of a picture.
    pub(super) fn upload(
        &mut self,
        stage: &Stage<'_>,
        bodies: &Bodies,
        scene: &mut Scene,
        water: Water,
    ) -> Result<(), GpuError> {
        let view = stage.picture.view;
        let hides_sponge = matches!(view, View::Nodes | View::Particles | View::Pressure | View::Speed);
        let mesh = Mesh::new(&stage.sponge, hides_sponge);
        scene.has_tree = u32::from(mesh.has_tree);
        (scene.triangles_at, scene.nodes_at, scene.nodes) = (mesh.triangles_at, mesh.nodes_at, mesh.nodes);
        self.buffers.write("mesh", bytemuck::cast_slice(&mesh.rows))?;
        self.buffers.write("bodies", bytemuck::cast_slice(&bodies.rows))?;
        if !self.has_foam {
            self.buffers.write("foam", bytemuck::cast_slice(foam().distances()))?;
            self.has_foam = true;
        }
        if water != Water::Balls {
            self.upload_surfels(stage, scene)?;
        }
        for name in BOUND {
            self.buffers.reserve(name, 0)?;
        }
        self.reserve_particles(scene)?;
        let (width, height) = (u64::from(scene.width), u64::from(scene.height));
        self.buffers.reserve("samples", 16 * width * height)?;
        self.buffers.reserve("edge_count", EDGES_BYTES)
    }

    /// The box around all particles, and the middle of a part of them.
    pub(super) fn find_bounds(&mut self, scene: &Scene) -> Result<(Option<Bounds>, Vec3), GpuError> {
        if scene.particles == 0 {
            return Ok((None, Vec3::ZERO));
        }
        self.buffers.write_uniform("scene", &scene.words())?;
        let mut work = Work::new(&self.gpu, &mut self.passes, &self.buffers);
        work.run("render::bounds", &[], groups_of(u64::from(scene.particles)))?;
        let samples = scene.particles.div_ceil(scene.sample_pace).min(SAMPLES);
        let copies = [("bounds", BOX_BYTES), ("sampled", 16 * u64::from(samples))];
        let found = read::words(&self.gpu, work.submit(&copies, self.profile.as_mut())?)?;
        let rows = found[6..].as_chunks::<4>().0.iter().map(|row| row.map(f32::from_bits));
        Ok((read::bounds(&found), read::median(&rows.collect::<Vec<_>>())))
    }

    /// Kernels of the free particles, and the boxes around those and all particles.
    pub(super) fn find_kernels(&mut self, scene: &Scene) -> Result<Vec<u32>, GpuError> {
        self.buffers.write_uniform("scene", &scene.words())?;
        let mut work = Work::new(&self.gpu, &mut self.passes, &self.buffers);
        work.run("render::bounds", &[], groups_of(u64::from(scene.particles)))?;
        water::pores(&mut work, scene)?;
        water::kernels(&mut work, scene)?;
        read::words(&self.gpu, work.submit(&[("bounds", BOUNDS_BYTES)], self.profile.as_mut())?)
    }

    /// Everything that needs no answer: the field, light on the floor, pixels.
    pub(super) fn finish(
        &mut self,
        scene: &Scene,
        water: Water,
        view: View,
        shows_balls: bool,
    ) -> Result<(), GpuError> {
        self.buffers.write_uniform("scene", &scene.words())?;
        let mut work = Work::new(&self.gpu, &mut self.passes, &self.buffers);
        if scene.particles > 0 && water != Water::Surface {
            water::pores(&mut work, scene)?;
        }
        if scene.has_field != 0 {
            water::field(&mut work, scene)?;
        }
        if shows_balls && scene.particles > 0 {
            balls::colours(&mut work, scene)?;
        }
        if scene.has_balls != 0 {
            water::cells(&mut work, scene, "balls")?;
        }
        light::light(&mut work, scene, water == Water::Surface)?;
        if water == Water::Screen {
            screen::screen(&mut work, scene)?;
        }
        let names = [("densities", densities(scene)), ("bricks", SKIPS)];
        let (path, names) = match (water, view) {
            (Water::Surface, View::Superimposed) => ("render::path_shells", &names[..]),
            (Water::Surface, _) => ("render::path_water", &names[..]),
            (Water::Screen, _) => ("render::path_screen", &[][..]),
            (Water::Balls, _) => ("render::path_balls", &[][..]),
        };
        let tiles = tiles_of(scene.width, scene.height);
        work.clear("edge_count", EDGES_BYTES);
        // A ray for every pixel, then more for those at edges.
        work.run(path, names, two_dimensional(tiles.map(u64::from).iter().product()))?;
        work.run("render::edges", &[], tiles)?;
        work.run(path, names, groups_of(u64::from(scene.width) * u64::from(scene.height)))?;
        work.run("render::picture", &[], tiles)?;
        work.submit(&[], self.profile.as_mut()).map(|_| ())
    }
}
