//! What a window is drawn on: a GPU, or the CPU without one.

use std::{num::NonZeroU32, sync::Arc};

use egui::{ClippedPrimitive, TexturesDelta, ViewportId};
use egui_wgpu::{RendererOptions, WgpuConfiguration, WgpuSetup, winit::Painter};
use sorb::render::Image;
use winit::{dpi::PhysicalSize, window::Window};

use super::rasteriser::Rasteriser;
use crate::ViewError;

/// What a window is drawn on.
pub(super) struct Surface {
    window: Arc<Window>,
    place: Place,
    /// Draws where there is no GPU, and pictures of the window.
    rasteriser: Option<Rasteriser>,
    /// What was drawn last, for a picture of the window.
    last: Option<(Vec<ClippedPrimitive>, f32)>,
}

enum Place {
    Gpu(Box<Painter>),
    CpuRenderer(softbuffer::Surface<Arc<Window>, Arc<Window>>),
}

impl Surface {
    /// Takes the best adapter, or none if there is none or `software` says so. `is_kept` keeps what a picture of the window takes.
    ///
    /// # Errors
    /// The window cannot be drawn on with either.
    pub(super) fn new(
        context: &egui::Context,
        window: Arc<Window>,
        software: bool,
        is_kept: bool,
    ) -> Result<Self, ViewError> {
        let painter = if software { None } else { painter(context, &window) };
        let is_software = painter.is_none();
        let place = match painter {
            Some(painter) => Place::Gpu(Box::new(painter)),
            None => {
                let failed = |error: softbuffer::SoftBufferError| ViewError::Window(error.to_string());
                let display = softbuffer::Context::new(Arc::clone(&window)).map_err(failed)?;
                Place::CpuRenderer(softbuffer::Surface::new(&display, Arc::clone(&window)).map_err(failed)?)
            }
        };
        let rasteriser = (is_software || is_kept).then(Rasteriser::default);
        Ok(Self { window, place, rasteriser, last: None })
    }

    /// Longest side of a texture in pixels.
    pub(super) fn longest_side(&self) -> Option<usize> {
        match &self.place {
            Place::Gpu(painter) => painter.max_texture_side(),
            Place::CpuRenderer(_) => None,
        }
    }

    /// What draws the window, for the panel.
    pub(super) fn name(&self) -> String {
        let Place::Gpu(painter) = &self.place else { return "CPU".to_owned() };
        painter.render_state().map_or_else(String::new, |state| state.adapter.get_info().name)
    }

    /// The window has another size.
    pub(super) fn resize(&mut self, size: PhysicalSize<u32>) {
        if let (Place::Gpu(painter), Some(width), Some(height)) =
            (&mut self.place, NonZeroU32::new(size.width), NonZeroU32::new(size.height))
        {
            painter.on_window_resized(ViewportId::ROOT, width, height);
        }
    }

    /// Draws panels and pictures.
    ///
    /// # Errors
    /// The system refuses it.
    pub(super) fn paint(
        &mut self,
        primitives: Vec<ClippedPrimitive>,
        mut delta: TexturesDelta,
        scale: f32,
    ) -> Result<(), ViewError> {
        if let Some(rasteriser) = &mut self.rasteriser {
            rasteriser.update(&delta);
        }
        let mut own = delta.clone();
        let shown = match &mut self.place {
            Place::Gpu(painter) => {
                let clear = [0.0, 0.0, 0.0, 1.0];
                let window = &self.window;
                let (root, captures) = (ViewportId::ROOT, Vec::new());
                painter.paint_and_update_textures(
                    root,
                    scale,
                    clear,
                    &primitives,
                    &mut own,
                    captures,
                    window,
                );
                Ok(())
            }
            Place::CpuRenderer(surface) => {
                let size = self.window.inner_size();
                let rasteriser = self.rasteriser.as_mut();
                rasteriser.map_or(Ok(()), |own| show(surface, own, size, scale, &primitives))
            }
        };
        if let Some(rasteriser) = &mut self.rasteriser {
            rasteriser.free(&delta);
            self.last = Some((primitives, scale));
        }
        // What a lost device did not take is drawn no more; egui asks for this.
        own.clear();
        delta.clear();
        shown
    }

    /// A picture of the window; none before it was drawn.
    pub(super) fn picture(&mut self) -> Option<Image> {
        let PhysicalSize { width, height } = self.window.inner_size();
        let (rasteriser, (primitives, scale)) = (self.rasteriser.as_mut()?, self.last.as_ref()?);
        let pixels = rasteriser.paint([width as usize, height as usize], *scale, primitives);
        let pixels = pixels.iter().flat_map(|pixel| [pixel.r(), pixel.g(), pixel.b()]).collect();
        Some(Image { width, height, pixels })
    }
}

fn painter(context: &egui::Context, window: &Arc<Window>) -> Option<Painter> {
    let config =
        WgpuConfiguration { wgpu_setup: WgpuSetup::without_display_handle(), ..WgpuConfiguration::default() };
    let painter = Painter::new(context.clone(), config, false, RendererOptions::default());
    let mut painter = pollster::block_on(painter);
    let set = pollster::block_on(painter.set_window(ViewportId::ROOT, Some(Arc::clone(window))));
    set.is_ok().then_some(painter)
}

fn show(
    surface: &mut softbuffer::Surface<Arc<Window>, Arc<Window>>,
    rasteriser: &mut Rasteriser,
    size: PhysicalSize<u32>,
    scale: f32,
    primitives: &[ClippedPrimitive],
) -> Result<(), ViewError> {
    let failed = |error: softbuffer::SoftBufferError| ViewError::Window(error.to_string());
    let (Some(width), Some(height)) = (NonZeroU32::new(size.width), NonZeroU32::new(size.height)) else {
        return Ok(());
    };
    surface.resize(width, height).map_err(failed)?;
    let mut buffer = surface.buffer_mut().map_err(failed)?;
    let pixels = rasteriser.paint([size.width as usize, size.height as usize], scale, primitives);
    for (out, pixel) in buffer.iter_mut().zip(pixels) {
        *out = u32::from_be_bytes([0, pixel.r(), pixel.g(), pixel.b()]);
    }
    buffer.present().map_err(failed)
}
