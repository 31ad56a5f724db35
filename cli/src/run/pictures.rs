//! PNG frames and the animation.

use std::{fs, ops::RangeInclusive, path::PathBuf};

use sorb::{
    World,
    render::{self, Animation, Camera, View},
    scene::Scene,
};

use super::{folder::Folder, options::Drawing};
use crate::error::CliError;

/// PNG frames and the animation, while they are written.
#[derive(Debug)]
pub(crate) struct Pictures {
    frames: PathBuf,
    animation: Animation,
    camera: Camera,
    view: View,
    size: (u32, u32),
    /// Simulated frames from one picture to the next.
    every: usize,
}

impl Pictures {
    /// Creates the folder of the frames and the animation.
    ///
    /// # Errors
    /// The system refuses to create them.
    pub(crate) fn create(
        folder: &Folder,
        drawing: &Drawing,
        scene: &Scene,
        frames: RangeInclusive<u32>,
    ) -> Result<Self, CliError> {
        fs::create_dir_all(folder.frames()).map_err(CliError::write(folder.frames()))?;
        let rate = scene.time.frame_rate;
        // Whole frames, so that pictures are evenly spaced. Rounding up keeps the rate below the requested one.
        let every = (rate / drawing.picture_rate - 1e-3).ceil().max(1.0) as u32;
        let (width, height) = (drawing.size.0, drawing.size.1);
        let count = frames.end() / every + 1 - frames.start().div_ceil(every);
        let animation = Animation::create(
            folder.animation(),
            width,
            height,
            (rate / every as f32).clamp(0.02, 1e3),
            count,
        )?;
        Ok(Self {
            frames: folder.frames(),
            animation,
            camera: scene.viewpoint().into(),
            view: drawing.view.into(),
            size: (width, height),
            every: every as usize,
        })
    }

    /// Draws the world if a picture is due at this frame.
    ///
    /// # Errors
    /// The picture cannot be written.
    pub(crate) fn frame(&mut self, world: &World, frame: usize) -> Result<(), CliError> {
        if !frame.is_multiple_of(self.every) {
            return Ok(());
        }
        let image = render::draw_world(world, &self.camera, self.view, self.size.0, self.size.1);
        image.write_png(self.frames.join(format!("{:05}.png", frame / self.every)))?;
        self.animation.append(&image)?;
        Ok(())
    }

    /// Completes the animation.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(crate) fn finish(self) -> Result<(), CliError> {
        self.animation.finish()?;
        Ok(())
    }
}
