//! The twin of the renderer on a GPU: the same passes and names as on the CPU, in WGSL.
//!
//! Particles stay on the device. What is one number per body, per node or per triangle of a sponge is made on the host and uploaded.
//! That is the tree over the triangles, pieces of their surface for the closure, and poses. A few bytes come back before the grid is laid:
//! the boxes around the particles and their kernels.
//!
//! Pictures differ from those of the CPU where that takes the mean of neighbours instead of a ray: here every pixel has one. The same
//! device gives the same bits in every run. Sums of many threads are in fixed point, and lists are sorted before they are summed.

mod balls;
mod buffers;
mod declarations;
mod frame;
mod layout;
mod light;
mod mesh;
mod passes;
mod read;
mod scene;
mod screen;
mod source;
#[cfg(all(test, feature = "serde"))]
mod tests;
mod water;

use std::{fmt, sync::Arc};

use sorb_kernels::gpu::{Gpu, GpuError, Profile, wgpu};

use super::{
    Camera, Image, Picture, View, legend,
    stage::{self, Stage},
    world::{Seen, range, with_picture},
};
use crate::World;
use buffers::Buffers;
use mesh::Bodies;
use passes::{Passes, Work};
use read::BOUNDS;
use scene::Scene;
use source::Source;

/// Most particles whose places tell where the middle of an open scene is.
const SAMPLES: u32 = 1024;

/// Draws pictures on a device. It keeps pipelines and buffers from picture to picture; the pixels do not depend on the picture before.
pub struct Renderer {
    gpu: Arc<Gpu>,
    passes: Passes,
    buffers: Buffers,
    profile: Option<Profile>,
    has_foam: bool,
    /// Width and height of the newest picture, and words of its rows.
    size: (u32, u32),
    row: u32,
    /// A fault that a test plants.
    #[cfg(test)]
    fault: Option<fn(&mut Scene)>,
}

/// A picture on the device.
#[derive(Debug)]
pub struct Frame<'a> {
    /// Rows from top to bottom, four bytes (sRGB red, green, blue, and 255) a pixel.
    pub buffer: &'a wgpu::Buffer,
    /// Bytes from row to row: a multiple of 256, as copies to textures want it.
    pub bytes_per_row: u32,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
}

impl Frame<'_> {
    /// Copies the picture to a texture of the format `Rgba8Unorm`, or `Rgba8UnormSrgb`, that is at least as large.
    pub fn copy_to(&self, encoder: &mut wgpu::CommandEncoder, texture: &wgpu::Texture) {
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(self.bytes_per_row),
            rows_per_image: Some(self.height),
        };
        let size = wgpu::Extent3d { width: self.width, height: self.height, depth_or_array_layers: 1 };
        let source = wgpu::TexelCopyBufferInfo { buffer: self.buffer, layout };
        encoder.copy_buffer_to_texture(source, texture.as_image_copy(), size);
    }
}

impl fmt::Debug for Renderer {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Renderer").field("gpu", &self.gpu).finish_non_exhaustive()
    }
}

/// How a view shows particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Water {
    /// As a surface with refraction, or as shells.
    Surface,
    /// By its depth on the screen.
    Screen,
    /// As balls, or not at all.
    Balls,
}

impl Water {
    fn of(view: View) -> Self {
        match view {
            View::Realistic | View::Superimposed => Self::Surface,
            View::Fast => Self::Screen,
            _ => Self::Balls,
        }
    }
}

impl Renderer {
    /// A renderer on a device; passes are compiled when they are first used.
    #[must_use]
    pub fn new(gpu: &Arc<Gpu>) -> Self {
        Self {
            gpu: Arc::clone(gpu),
            passes: Passes::default(),
            buffers: Buffers::new(gpu),
            profile: None,
            has_foam: false,
            size: (0, 0),
            row: 0,
            #[cfg(test)]
            fault: None,
        }
    }

    /// The device.
    #[must_use]
    pub fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    /// Takes the time of every pass from now on, if the device has time stamps. Each picture is waited for then.
    ///
    /// # Errors
    /// There is no memory for time stamps.
    pub fn take_times(&mut self) -> Result<(), GpuError> {
        self.profile = Profile::new(&self.gpu)?;
        Ok(())
    }

    /// Takes no times any more.
    pub fn forget_times(&mut self) {
        self.profile = None;
    }

    /// Milliseconds of every pass since the last query, in order; empty unless times are taken.
    pub fn times(&mut self) -> Vec<(&'static str, f32)> {
        self.profile.as_mut().map(Profile::take).unwrap_or_default()
    }

    /// Draws `picture` as seen by `camera` into an image of `width` x `height` pixels, as [`super::draw`] does.
    ///
    /// # Errors
    /// The device was lost, or has too little memory.
    pub fn draw(
        &mut self,
        picture: &Picture<'_>,
        camera: &Camera,
        width: u32,
        height: u32,
    ) -> Result<Image, GpuError> {
        self.frame(picture, camera, width, height)?;
        self.image(picture.view, picture.range)
    }

    /// Draws a world as [`super::draw_world`] does. Where the world is on the same device, its particles are read where they are.
    ///
    /// # Errors
    /// The device was lost, or has too little memory.
    pub fn draw_world(
        &mut self,
        world: &World,
        camera: &Camera,
        view: View,
        width: u32,
        height: u32,
    ) -> Result<Image, GpuError> {
        self.frame_of_world(world, camera, view, width, height)?;
        self.image(view, range(world, view))
    }

    /// Draws `picture` into a buffer on the device, without a legend. The picture is there once the queue is done with what was
    /// submitted.
    ///
    /// # Errors
    /// The device was lost, or has too little memory.
    pub fn frame(
        &mut self,
        picture: &Picture<'_>,
        camera: &Camera,
        width: u32,
        height: u32,
    ) -> Result<Frame<'_>, GpuError> {
        let source = Source::of_picture(&mut self.buffers, picture)?;
        self.frame_of(picture, &source, camera, (width, height))
    }

    /// Draws a world into a buffer on the device, without a legend.
    ///
    /// # Errors
    /// The device was lost, or has too little memory.
    pub fn frame_of_world(
        &mut self,
        world: &World,
        camera: &Camera,
        view: View,
        width: u32,
        height: u32,
    ) -> Result<Frame<'_>, GpuError> {
        let Some(state) = source::resident(world, &self.gpu, view)? else {
            let seen = Seen::of(world);
            let pressures = if view == View::Pressure { world.particle_pressures() } else { Vec::new() };
            with_picture(world, (&seen, &pressures), camera, view, |picture| {
                self.frame(picture, camera, width, height).map(|_| ())
            })?;
            return self.newest();
        };
        let source = Source::of_world(&mut self.buffers, world)?;
        with_picture(world, (&state.seen(), &[]), camera, view, |picture| {
            self.frame_of(picture, &source, camera, (width, height)).map(|_| ())
        })?;
        self.newest()
    }

    fn newest(&self) -> Result<Frame<'_>, GpuError> {
        let (width, height) = self.size;
        let buffer = self.buffers.get("picture")?;
        Ok(Frame { buffer, bytes_per_row: 4 * self.row, width, height })
    }

    /// The newest picture, with its legend.
    fn image(&self, view: View, range: (f32, f32)) -> Result<Image, GpuError> {
        let (width, height) = self.size;
        if width == 0 || height == 0 {
            return Ok(Image { width, height, pixels: Vec::new() });
        }
        let bytes = u64::from(self.row) * u64::from(height) * 4;
        let mut passes = Passes::default();
        let staging = Work::new(&self.gpu, &mut passes, &self.buffers).submit(&[("picture", bytes)], None)?;
        let mut image = read::image(&read::words(&self.gpu, staging)?, self.row as usize, self.size);
        if let Some(title) = view.map() {
            legend::draw(&mut image, title, range);
        }
        Ok(image)
    }

    fn frame_of(
        &mut self,
        picture: &Picture<'_>,
        source: &Source,
        camera: &Camera,
        size: (u32, u32),
    ) -> Result<Frame<'_>, GpuError> {
        (self.size, self.row) = (size, size.0.next_multiple_of(64));
        self.buffers.reserve("picture", u64::from(self.row) * u64::from(size.1) * 4)?;
        if size.0 > 0 && size.1 > 0 {
            let gpu = Arc::clone(&self.gpu);
            gpu.guarded(None, || self.draw_frame(picture, source, camera, size))??;
        }
        self.newest()
    }

    fn draw_frame(
        &mut self,
        picture: &Picture<'_>,
        source: &Source,
        camera: &Camera,
        (width, height): (u32, u32),
    ) -> Result<(), GpuError> {
        let (view, water) = (picture.view, Water::of(picture.view));
        let radius = picture.particle_radius;
        let count = if radius > 0.0 && radius.is_finite() { source.count } else { 0 };
        let is_open = stage::container(picture).is_none();
        let shows_balls = water == Water::Balls && !matches!(view, View::Nodes | View::Saturation);
        let mut scene =
            Scene { particles: count, sample_pace: count.div_ceil(SAMPLES).max(1), ..Scene::default() };
        self.buffers.write("bounds", bytemuck::cast_slice(&BOUNDS))?;
        self.buffers.reserve("sampled", 16 * u64::from(SAMPLES))?;
        // An open scene is as large as what is in it.
        let (mut around, middle) =
            if is_open || shows_balls { self.find_bounds(&scene)? } else { Default::default() };
        let corners: Vec<[f32; 4]> = around
            .iter()
            .flat_map(|(low, high)| [low, high])
            .map(|corner| corner.extend(0.0).to_array())
            .collect();
        let known = Picture { particles: if is_open { &corners } else { &[] }, interior: &[], ..*picture };
        let stage = Stage::new(&known, camera, width as usize, height as usize);
        let bodies = Bodies::new(&stage);
        let (particles, pace) = (scene.particles, scene.sample_pace);
        scene = Scene { particles, sample_pace: pace, middle, ..Scene::new(&stage, &bodies) };
        scene.lost = water::lost(&stage);
        scene.has_interior = u32::from(source.has_interior && water != Water::Balls);
        (scene.has_velocities, scene.has_pressures) =
            (u32::from(source.has_velocities), u32::from(source.has_pressures));
        self.upload(&stage, &bodies, &mut scene, water)?;
        let mut kernels = None;
        if water == Water::Surface && count > 0 {
            let inside = stage.container.or(around).unwrap_or_default();
            let lost = scene.lost;
            let near = (inside.0.max(middle - lost), inside.1.min(middle + lost));
            self.prepare_kernels(&mut scene, near)?;
            let found = self.find_kernels(&scene)?;
            (around, kernels) = (read::bounds(&found), read::bounds(&found[6..]));
        } else if count > 0 && around.is_none() {
            around = self.find_bounds(&scene)?.0;
        }
        if let Some(kernels) = kernels {
            self.prepare_grid(&mut scene, &stage, kernels)?;
        }
        match water {
            Water::Balls => self.prepare_balls(&mut scene, &stage, around, shows_balls)?,
            Water::Screen => self.prepare_screen(&scene)?,
            Water::Surface => {}
        }
        self.prepare_light(&mut scene, &stage, around)?;
        #[cfg(test)]
        if let Some(fault) = self.fault {
            fault(&mut scene);
        }
        self.finish(&scene, water, view, shows_balls)
    }
}
