//! Pictures from a GPU.

use std::sync::Arc;

use sorb::{
    World,
    gpu::Gpu,
    render::{Camera, Image, Renderer, View},
};

use crate::drawing::{CpuRenderer, WorldRenderer};

/// Draws on a GPU. The window draws copies of worlds, whose state is on the host: it goes up for every picture. After an error of the
/// device it draws with the CPU.
#[derive(Debug)]
pub struct GpuRenderer(Option<Renderer>);

impl GpuRenderer {
    /// On a device.
    #[must_use]
    pub fn new(gpu: &Arc<Gpu>) -> Self {
        Self(Some(Renderer::new(gpu)))
    }

    /// On the device of the worlds, or on the best of the machine. None if that is a program on the CPU, which is slower than
    /// [`CpuRenderer`].
    #[must_use]
    pub fn best(own: Option<&Arc<Gpu>>) -> Option<Self> {
        let gpu = own.cloned().or_else(|| Gpu::new().ok().map(Arc::new))?;
        (!gpu.report().is_software()).then(|| Self::new(&gpu))
    }
}

impl WorldRenderer for GpuRenderer {
    fn draw(&mut self, world: &World, camera: &Camera, view: View, (width, height): (u32, u32)) -> Image {
        let drawn = self.0.as_mut().map(|renderer| renderer.draw_world(world, camera, view, width, height));
        if let Some(Ok(image)) = drawn {
            return image;
        }
        self.0 = None;
        CpuRenderer.draw(world, camera, view, (width, height))
    }

    fn name(&self) -> String {
        match &self.0 {
            Some(renderer) => renderer.gpu().report().name.clone(),
            None => CpuRenderer.name(),
        }
    }
}
