//! The loop of the window.

use std::{
    collections::VecDeque,
    sync::{Arc, Mutex, mpsc::Sender},
    time::{Duration, Instant},
};

use egui::{ColorImage, TextureHandle, TextureOptions, ViewportId};
use sorb::render::View;
use winit::{
    application::ApplicationHandler,
    dpi::PhysicalSize,
    event::WindowEvent,
    event_loop::{ActiveEventLoop, ControlFlow},
    window::{Window, WindowId},
};

use super::{
    Wake, panels,
    pointer::{Pointer, Viewport},
    send,
    surface::Surface,
};
use crate::{
    Report, Setup, ViewError,
    drawing::{DrawingThread, Picture, PictureRequest},
    facts::Facts,
    orbit::Orbit,
    quality::Quality,
    simulation::{self, Request},
};

/// Shortest time between two looks at facts that come without a picture.
const LOOK: Duration = Duration::from_millis(50);

/// What the panels show and change.
pub(super) struct UiState {
    pub(super) requests: Sender<Request>,
    pub(super) view: View,
    /// Whether all pictures are drawn in full quality.
    pub(super) full: bool,
    /// Whether the panels are shown.
    pub(super) has_panel: bool,
    /// Whether the window shall close.
    pub(super) closes: bool,
    pub(super) orbit: Option<Orbit>,
    pub(super) pointer: Pointer,
    pub(super) texture: Option<TextureHandle>,
    /// The picture in the texture.
    pub(super) picture: Option<Shown>,
    /// When the last pictures came.
    pub(super) recent: VecDeque<Instant>,
    /// What draws the window.
    pub(super) surface: String,
    pub(super) viewport: Option<Viewport>,
}

/// The picture that is shown.
#[derive(Clone, Debug)]
pub(super) struct Shown {
    pub(super) quality: Quality,
    pub(super) renderer: String,
    pub(super) size: (u32, u32),
    pub(super) time: Duration,
    frames: u64,
    is_still: bool,
}

/// The window and what draws it.
struct Place {
    window: Arc<Window>,
    input: egui_winit::State,
    surface: Surface,
}

/// The window.
pub(super) struct App<'a> {
    setup: &'a Setup,
    facts: Arc<Mutex<Facts>>,
    drawing: DrawingThread,
    context: egui::Context,
    place: Option<Place>,
    ui_state: UiState,
    /// Number of the sliders of the scene whose camera this is.
    name: String,
    pictures: u64,
    looked: Instant,
    failure: Option<ViewError>,
}

impl<'a> App<'a> {
    pub(super) fn new(
        setup: &'a Setup,
        facts: Arc<Mutex<Facts>>,
        requests: Sender<Request>,
        drawing: DrawingThread,
    ) -> Self {
        let ui_state = UiState {
            requests,
            view: setup.view,
            full: false,
            has_panel: true,
            closes: false,
            orbit: None,
            pointer: Pointer::default(),
            texture: None,
            picture: None,
            recent: VecDeque::new(),
            surface: String::new(),
            viewport: None,
        };
        Self {
            setup,
            facts,
            drawing,
            context: egui::Context::default(),
            place: None,
            ui_state,
            name: String::new(),
            pictures: 0,
            looked: Instant::now(),
            failure: None,
        }
    }

    /// Asks the simulation thread to end.
    pub(super) fn close(&self) {
        send(&self.ui_state.requests, Request::Close);
    }

    /// What the window did.
    ///
    /// # Errors
    /// What went wrong with the window.
    pub(super) fn end(self, report: Report) -> Result<Report, ViewError> {
        self.failure.map_or(Ok(Report { pictures: self.pictures, ..report }), Err)
    }

    fn begin(&mut self, event_loop: &ActiveEventLoop) -> Result<(), ViewError> {
        let attributes = Window::default_attributes()
            .with_title("sorb")
            .with_inner_size(PhysicalSize::new(self.setup.size.0, self.setup.size.1));
        let window =
            event_loop.create_window(attributes).map_err(|error| ViewError::Window(error.to_string()))?;
        let window = Arc::new(window);
        let is_kept = self.setup.screenshot.is_some();
        let surface = Surface::new(&self.context, Arc::clone(&window), self.setup.software, is_kept)?;
        self.ui_state.surface = surface.name();
        let scale = Some(window.scale_factor() as f32);
        let longest = surface.longest_side();
        let input =
            egui_winit::State::new(self.context.clone(), ViewportId::ROOT, &*window, scale, None, longest);
        window.request_redraw();
        self.place = Some(Place { window, input, surface });
        Ok(())
    }

    /// Draws the window.
    fn frame(&mut self, event_loop: &ActiveEventLoop) -> Result<(), ViewError> {
        self.drawing.check();
        self.take_picture();
        self.looked = Instant::now();
        let facts = simulation::lock(&self.facts).clone();
        let Some(place) = &mut self.place else { return Ok(()) };
        if self.name != facts.name {
            self.name.clone_from(&facts.name);
            place.window.set_title(&format!("sorb: {}", facts.name));
        }
        let raw = place.input.take_egui_input(&place.window);
        let ui_state = &mut self.ui_state;
        let output = self.context.run_ui(raw, |ui| panels::show(ui, ui_state, &facts));
        place.input.handle_platform_output(&place.window, output.platform_output);
        let scale = output.pixels_per_point;
        let primitives = self.context.tessellate(output.shapes, scale);
        place.surface.paint(primitives, output.textures_delta, scale)?;
        if let Some(viewport) = &ui_state.viewport {
            let side = |points: f32| ((points * scale).round() as u32).clamp(16, 8192);
            let size = (side(viewport.rect.width()), side(viewport.rect.height()));
            let camera = viewport.camera;
            self.drawing.show(PictureRequest {
                camera,
                view: ui_state.view,
                size,
                full: ui_state.full,
                runs: facts.runs,
            });
        }
        let is_shown =
            ui_state.picture.as_ref().is_some_and(|own| own.is_still && own.frames >= facts.frames);
        if ui_state.closes || (facts.is_done && is_shown) {
            self.leave(event_loop)?;
        }
        let delay = output.viewport_output.get(&ViewportId::ROOT).map(|own| own.repaint_delay);
        self.wait(event_loop, delay.unwrap_or(Duration::MAX));
        Ok(())
    }

    fn wait(&self, event_loop: &ActiveEventLoop, delay: Duration) {
        if delay.is_zero() {
            self.redraw();
            return;
        }
        let until = Instant::now().checked_add(delay.min(Duration::from_secs(3600)));
        event_loop.set_control_flow(until.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
    }

    fn redraw(&self) {
        if let Some(place) = &self.place {
            place.window.request_redraw();
        }
    }

    /// Takes the last picture of the thread that draws.
    fn take_picture(&mut self) {
        let Some(Picture { image, quality, renderer, time, frames, is_still }) = self.drawing.picture()
        else {
            return;
        };
        let size = (image.width, image.height);
        let image = ColorImage::from_rgb([image.width as usize, image.height as usize], &image.pixels);
        match &mut self.ui_state.texture {
            Some(texture) => texture.set(image, TextureOptions::LINEAR),
            None => {
                self.ui_state.texture =
                    Some(self.context.load_texture("picture", image, TextureOptions::LINEAR))
            }
        }
        self.ui_state.picture = Some(Shown { quality, renderer, size, time, frames, is_still });
        self.pictures += 1;
        let now = Instant::now();
        self.ui_state.recent.push_back(now);
        self.ui_state.recent.retain(|then| now.duration_since(*then) < Duration::from_secs(1));
    }

    /// Closes the window; before that its picture is written, if that is asked for.
    fn leave(&mut self, event_loop: &ActiveEventLoop) -> Result<(), ViewError> {
        event_loop.exit();
        let (Some(path), Some(place)) = (&self.setup.screenshot, &mut self.place) else { return Ok(()) };
        if let Some(picture) = place.surface.picture() {
            picture.write_png(path)?;
        }
        Ok(())
    }

    /// Keeps what went wrong, and closes.
    fn check(&mut self, event_loop: &ActiveEventLoop, result: Result<(), ViewError>) {
        if let Err(error) = result {
            self.failure = Some(error);
            event_loop.exit();
        }
    }
}

impl ApplicationHandler<Wake> for App<'_> {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.place.is_none() {
            let begun = self.begin(event_loop);
            self.check(event_loop, begun);
        }
    }

    fn user_event(&mut self, event_loop: &ActiveEventLoop, wake: Wake) {
        match wake {
            Wake::Picture => self.redraw(),
            Wake::Facts => {
                let rest = LOOK.saturating_sub(self.looked.elapsed());
                if self.ui_state.orbit.is_none() {
                    let facts = simulation::lock(&self.facts);
                    self.ui_state.orbit = facts.camera;
                }
                if self.ui_state.pointer.is_busy() { self.redraw() } else { self.wait(event_loop, rest) }
            }
            Wake::End => event_loop.exit(),
        }
    }

    fn new_events(&mut self, _: &ActiveEventLoop, cause: winit::event::StartCause) {
        if matches!(cause, winit::event::StartCause::ResumeTimeReached { .. }) {
            self.redraw();
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(place) = &mut self.place else { return };
        match event {
            WindowEvent::RedrawRequested => {
                let drawn = self.frame(event_loop);
                self.check(event_loop, drawn);
                return;
            }
            WindowEvent::CloseRequested => {
                let left = self.leave(event_loop);
                self.check(event_loop, left);
                return;
            }
            WindowEvent::Resized(size) => place.surface.resize(size),
            _ => {}
        }
        if place.input.on_window_event(&place.window, &event).repaint {
            place.window.request_redraw();
        }
    }
}
