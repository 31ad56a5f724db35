//! The mouse in the picture: what it takes, and the camera for everything else.

use std::sync::mpsc::Sender;

use egui::{Key, PointerButton, Pos2, Rect, Response, Ui};
use sorb::{Ray, glam::Vec3, render::Camera};

use super::send;
use crate::{
    facts::Facts,
    orbit::{self, Orbit},
    simulation::Request,
};

/// Angle of a turn over the way of the mouse \[rad per point\].
const TURN: f32 = 0.006;

/// Zoom over the way of a wheel \[1 per point\].
const ZOOM: f32 = 0.0022;

/// What the mouse does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Mode {
    #[default]
    Idle,
    /// The simulation thread was asked what is there.
    Asking,
    /// It holds something that was taken at this place.
    Holding(Vec3),
    Turning,
    Panning,
    Pouring,
}

/// The mouse in the picture.
#[derive(Clone, Debug, Default)]
pub(super) struct Pointer {
    mode: Mode,
    /// The button that began it; none for a key.
    button: Option<PointerButton>,
    /// Number of the last question.
    question: u64,
    /// Name of what is held.
    held: String,
}

/// How the picture is seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Viewport {
    pub(super) camera: Camera,
    pub(super) rect: Rect,
}

impl Viewport {
    pub(super) fn aspect(&self) -> f32 {
        self.rect.width() / self.rect.height().max(1.0)
    }

    /// The ray through a place of the window.
    fn ray(&self, at: Pos2) -> Ray {
        let place = (at - self.rect.center()) / (0.5 * self.rect.size());
        orbit::ray(&self.camera, self.aspect(), [place.x, -place.y])
    }
}

impl Pointer {
    /// What is held; empty if nothing is.
    pub(super) fn held(&self) -> &str {
        if matches!(self.mode, Mode::Holding(_)) { &self.held } else { "" }
    }

    /// Whether the mouse is in the middle of something.
    pub(super) fn is_busy(&self) -> bool {
        self.mode != Mode::Idle
    }

    /// Follows the mouse for a frame of the window.
    pub(super) fn follow(
        &mut self,
        ui: &Ui,
        response: &Response,
        viewport: &Viewport,
        orbit: &mut Orbit,
        facts: &Facts,
        requests: &Sender<Request>,
    ) {
        let at = ui.input(|input| input.pointer.latest_pos());
        if let (Mode::Asking, Some((number, found))) = (self.mode, &facts.held)
            && *number == self.question
        {
            self.mode = found.as_ref().map_or(Mode::Turning, |(place, _)| Mode::Holding(*place));
            self.held = found.as_ref().map(|(_, name)| name.clone()).unwrap_or_default();
            // What the mouse did while the simulation thread was asked counts as well.
            if let (Some((place, _)), Some(at)) = (found, at) {
                send(requests, Request::Reach(orbit::in_plane(&viewport.camera, &viewport.ray(at), *place)));
            }
        }
        self.end(ui, requests);
        if self.mode == Mode::Idle
            && let Some(at) = at.filter(|_| response.contains_pointer())
        {
            self.begin(ui, viewport, at, facts, requests);
        }
        let moved = ui.input(|input| input.pointer.delta());
        match (self.mode, at) {
            (Mode::Turning, _) => orbit.turn(-moved.x * TURN, moved.y * TURN),
            (Mode::Panning, _) => {
                let height = viewport.rect.height().max(1.0);
                orbit.pan(moved.x / height, -moved.y / height, viewport.aspect());
            }
            (Mode::Holding(place), Some(at)) if moved != egui::Vec2::ZERO => {
                let point = orbit::in_plane(&viewport.camera, &viewport.ray(at), place);
                send(requests, Request::Reach(point));
            }
            (Mode::Pouring, Some(at)) if moved != egui::Vec2::ZERO => {
                send(requests, Request::Pour(Some(viewport.ray(at))));
            }
            _ => {}
        }
        let wheel = ui.input(|input| input.smooth_scroll_delta.y);
        if response.contains_pointer() && wheel != 0.0 {
            orbit.zoom(libm::expf(-wheel * ZOOM));
        }
    }

    fn begin(&mut self, ui: &Ui, viewport: &Viewport, at: Pos2, facts: &Facts, requests: &Sender<Request>) {
        let pressed = |button| ui.input(|input| input.pointer.button_pressed(button));
        let (control, shift) = ui.input(|input| (input.modifiers.command, input.modifiers.shift));
        let pours = ui.input(|input| input.key_pressed(Key::P));
        self.button = [PointerButton::Primary, PointerButton::Secondary, PointerButton::Middle]
            .into_iter()
            .find(|button| pressed(*button));
        self.mode = match self.button {
            Some(PointerButton::Primary) if control => Mode::Pouring,
            Some(PointerButton::Primary) if shift => Mode::Panning,
            Some(PointerButton::Primary) if facts.played.is_none() => Mode::Asking,
            Some(PointerButton::Middle) => Mode::Panning,
            Some(_) => Mode::Turning,
            None if pours => Mode::Pouring,
            None => Mode::Idle,
        };
        match self.mode {
            Mode::Asking => {
                self.question += 1;
                send(requests, Request::Take(self.question, viewport.ray(at)));
            }
            Mode::Pouring => send(requests, Request::Pour(Some(viewport.ray(at)))),
            _ => {}
        }
    }

    /// Ends what the button or the key began that is up now.
    fn end(&mut self, ui: &Ui, requests: &Sender<Request>) {
        let is_down = match self.button {
            Some(button) => ui.input(|input| input.pointer.button_down(button)),
            None => ui.input(|input| input.key_down(Key::P)),
        };
        if is_down || self.mode == Mode::Idle {
            return;
        }
        match self.mode {
            // What is taken before the answer comes is let go as well: the simulation thread keeps the order.
            Mode::Asking | Mode::Holding(_) => send(requests, Request::LetGo),
            Mode::Pouring => send(requests, Request::Pour(None)),
            _ => {}
        }
        self.mode = Mode::Idle;
    }
}
