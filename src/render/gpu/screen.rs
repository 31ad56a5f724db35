//! The fast view: the depth of the particles on the picture, smoothed, and their thickness.

use sorb_kernels::gpu::GpuError;

use super::Renderer;
use super::passes::{Work, groups_of, tiles_of};
use super::scene::Scene;
use crate::render::rays::PASSES;

impl Renderer {
    /// Room for the samples of the screen.
    pub(super) fn prepare_screen(&mut self, scene: &Scene) -> Result<(), GpuError> {
        let samples = u64::from(scene.screen_width) * u64::from(scene.screen_height);
        for name in ["depths", "thicknesses"] {
            self.buffers.reserve(name, 4 * samples)?;
        }
        for name in ["water", "other_water", "sheets"] {
            self.buffers.reserve(name, 16 * samples)?;
        }
        for (axis, name) in [(0, "axis_x"), (1, "axis_y")] {
            self.buffers.write_uniform(name, &[axis, 0, 0, 0])?;
        }
        Ok(())
    }
}

/// The water on the screen.
pub(super) fn screen(work: &mut Work<'_>, scene: &Scene) -> Result<(), GpuError> {
    let samples = u64::from(scene.screen_width) * u64::from(scene.screen_height);
    let tiles = tiles_of(scene.screen_width, scene.screen_height);
    for name in ["depths", "thicknesses"] {
        work.clear(name, 4 * samples);
    }
    if scene.particles > 0 {
        work.run("render::screen_splat", &[], groups_of(u64::from(scene.particles)))?;
    }
    work.run("render::screen_begin", &[], tiles)?;
    for _ in 0..PASSES {
        work.run("render::screen_even", &[("axis", "axis_x"), ("after", "other_water")], tiles)?;
        let names = [("axis", "axis_y"), ("water", "other_water"), ("after", "water")];
        work.run("render::screen_even", &names, tiles)?;
    }
    work.run("render::screen_normal", &[], tiles)
}
