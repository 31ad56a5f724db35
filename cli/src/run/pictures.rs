//! PNG frames, the film and the animation.

use std::{fs, ops::RangeInclusive, path::PathBuf, thread};

use sorb::{
    World,
    render::{self, Camera, Steady, View},
    scene::Scene,
};

use super::{folder::Folder, options::Drawing};
use crate::{error::CliError, render::sink::Sink};

/// PNG frames, the film and the animation, while they are written.
#[derive(Debug)]
pub(crate) struct Pictures {
    frames: PathBuf,
    sinks: Vec<Sink>,
    camera: Camera,
    view: View,
    steady: Option<Steady>,
    size: (u32, u32),
    /// Simulated frames from one picture to the next.
    every: usize,
}

impl Pictures {
    /// Creates the folder of the frames, the film and the animation.
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
        let size = (drawing.picture.size.0, drawing.picture.size.1);
        // At least two, so that one picture is an animation too.
        let count = (frames.end() / every + 1 - frames.start().div_ceil(every)).max(2);
        let rate = rate / every as f32;
        let is_film = cfg!(feature = "film");
        let mut files = Vec::new();
        if is_film {
            files.push(folder.film());
        }
        if drawing.animation || !is_film {
            files.push(folder.animation());
        }
        let sinks =
            files.iter().map(|file| Sink::create(file, size, rate, count)).collect::<Result<_, _>>()?;
        Ok(Self {
            frames: folder.frames(),
            sinks,
            camera: scene.viewpoint().into(),
            view: drawing.picture.view.into(),
            steady: drawing.picture.steady.then(Steady::default),
            size,
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
        let image = match &mut self.steady {
            Some(steady) => steady.draw_world(world, &self.camera, self.view, self.size.0, self.size.1),
            None => render::draw_world(world, &self.camera, self.view, self.size.0, self.size.1),
        };
        let path = self.frames.join(format!("{:05}.png", frame / self.every));
        let (image, sinks) = (&image, &mut self.sinks);
        // Each file on a thread of its own: none of the formats is written on more than one.
        thread::scope(|scope| {
            let others: Vec<_> =
                sinks.iter_mut().map(|sink| scope.spawn(move || sink.append(image))).collect();
            image.write_png(path)?;
            others.into_iter().try_for_each(|other| match other.join() {
                Ok(written) => written,
                Err(panic) => std::panic::resume_unwind(panic),
            })
        })
    }

    /// Completes film and animation.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(crate) fn finish(self) -> Result<(), CliError> {
        self.sinks.into_iter().try_for_each(Sink::finish)
    }
}
