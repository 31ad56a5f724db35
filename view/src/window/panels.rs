//! Panels, and the picture between them.

use egui::{
    Align2, CentralPanel, CollapsingHeader, Color32, ComboBox, FontId, Grid, Key, Panel, Pos2, Rect,
    RichText, ScrollArea, Sense, Slider, Stroke, Ui, Vec2, pos2,
};
use sorb::render::View;

use super::{app::UiState, pointer::Viewport, send, sliders};
use crate::{facts::Facts, simulation::Request};

/// Width of the panel in points.
const WIDTH: f32 = 310.0;

/// Share of real time from which a simulation counts as real-time.
const IN_TIME: f64 = 0.97;

/// Colours of the sponges in the plot.
const COLOURS: [Color32; 4] = [
    Color32::from_rgb(240, 196, 90),
    Color32::from_rgb(110, 190, 240),
    Color32::from_rgb(150, 220, 130),
    Color32::from_rgb(230, 130, 150),
];

const KEYS: [(&str, &str); 15] = [
    ("left drag", "pulls a sponge or a body, stirs water, else turns"),
    ("right drag", "turns the view"),
    ("middle drag, Shift + left", "moves the view"),
    ("wheel", "goes nearer or farther"),
    ("Ctrl + left, P", "pours water there"),
    ("Space", "plays or pauses"),
    (".", "one frame"),
    ("S", "one step"),
    ("R", "reset"),
    ("left, right", "a frame back or on (recordings)"),
    ("Home, End", "first or last frame (recordings)"),
    ("V, Shift + V", "next or last view"),
    ("F", "full quality while it moves"),
    ("C, H", "camera of the scene, hides the panel"),
    ("Q, Esc", "closes"),
];

/// Shows everything.
pub(super) fn show(ui: &mut Ui, ui_state: &mut UiState, facts: &Facts) {
    if ui_state.orbit.is_none() {
        ui_state.orbit = facts.camera;
    }
    if !ui.ctx().text_edit_focused() {
        keys(ui, ui_state, facts);
    }
    if ui_state.has_panel {
        let panel = Panel::right("panel").resizable(false).exact_size(WIDTH);
        panel.show(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| side(ui, ui_state, facts));
        });
    }
    if facts.played.is_some() || facts.note.is_some() || facts.failure.is_some() {
        Panel::bottom("bottom").show(ui, |ui| bottom(ui, ui_state, facts));
    }
    CentralPanel::no_frame().show(ui, |ui| picture(ui, ui_state, facts));
}

fn keys(ui: &Ui, ui_state: &mut UiState, facts: &Facts) {
    let pressed = |key| ui.input(|input| input.key_pressed(key));
    let shift = ui.input(|input| input.modifiers.shift);
    let ask = |request| send(&ui_state.requests, request);
    if pressed(Key::Space) {
        ask(Request::Run(!facts.runs));
    }
    if pressed(Key::Period) {
        ask(Request::Frame);
    }
    if pressed(Key::S) {
        ask(Request::Step);
    }
    if pressed(Key::R) {
        ask(Request::Reset);
    }
    if let Some((_, last)) = facts.played {
        let way = if shift { facts.frame_rate.round() as i64 } else { 1 };
        for (key, request) in [
            (Key::ArrowLeft, Request::Skip(-way)),
            (Key::ArrowRight, Request::Skip(way)),
            (Key::Home, Request::Seek(0)),
            (Key::End, Request::Seek(last)),
        ] {
            if pressed(key) {
                ask(request);
            }
        }
    }
    if pressed(Key::V) {
        let at = View::ALL.iter().position(|view| *view == ui_state.view).unwrap_or(0);
        let count = View::ALL.len();
        ui_state.view = View::ALL[(at + if shift { count - 1 } else { 1 }) % count];
    }
    if pressed(Key::F) {
        ui_state.full = !ui_state.full;
    }
    if pressed(Key::C) {
        ui_state.orbit = facts.camera;
    }
    if pressed(Key::H) {
        ui_state.has_panel = !ui_state.has_panel;
    }
    ui_state.closes |= pressed(Key::Q) || pressed(Key::Escape);
}

fn side(ui: &mut Ui, ui_state: &mut UiState, facts: &Facts) {
    ui.add_space(6.0);
    ui.heading(&facts.name);
    ui.label(&facts.title);
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        let text = if facts.runs { "Pause" } else { "Play" };
        for (text, hover, request) in [
            (text, "Space", Request::Run(!facts.runs)),
            ("Frame", "a frame (.)", Request::Frame),
            ("Step", "a step of the simulation (S)", Request::Step),
            ("Reset", "back to the first state (R)", Request::Reset),
        ] {
            if ui.button(text).on_hover_text(hover).clicked() {
                send(&ui_state.requests, request);
            }
        }
    });
    ui.label(RichText::new(speed_text(facts)).size(17.0).color(speed_colour(facts)));
    times(ui, facts);
    ui.separator();
    looks(ui, ui_state);
    ui.separator();
    if !facts.saturations.is_empty() {
        plot(ui, facts);
        ui.separator();
    }
    sliders::show(ui, ui_state, facts);
    ui.separator();
    phases(ui, facts);
    CollapsingHeader::new("Mouse and keys").show(ui, |ui| {
        Grid::new("keys").num_columns(2).show(ui, |ui| {
            for (key, does) in KEYS {
                ui.strong(key);
                ui.add(egui::Label::new(does).wrap());
                ui.end_row();
            }
        });
    });
}

/// Simulated over real time.
fn speed_text(facts: &Facts) -> String {
    match (facts.runs, facts.ratio) {
        _ if facts.name.is_empty() => "building the scene".to_owned(),
        (false, _) if facts.failure.is_some() => "stopped".to_owned(),
        (false, _) => "paused".to_owned(),
        (true, None) => "running".to_owned(),
        (true, Some(ratio)) => format!("{ratio:.2} x real time"),
    }
}

fn speed_colour(facts: &Facts) -> Color32 {
    match facts.ratio {
        Some(ratio) if facts.runs && ratio < IN_TIME => Color32::from_rgb(250, 180, 80),
        Some(_) if facts.runs => Color32::from_rgb(130, 220, 130),
        _ => Color32::from_gray(210),
    }
}

fn times(ui: &mut Ui, facts: &Facts) {
    Grid::new("times").num_columns(2).show(ui, |ui| {
        let mut row = |name: &str, value: String| {
            ui.weak(name);
            ui.add(egui::Label::new(value).truncate());
            ui.end_row();
        };
        row("time", format!("{:.3} s, frame {}", facts.time, facts.frames));
        if let Some(last) = &facts.last {
            let steps = if last.steps == 1 { "1 step".to_owned() } else { format!("{} steps", last.steps) };
            row("last frame", format!("{steps}, {:.1} ms", facts.frame_ms));
            if let Some(bound) = last.bound {
                let shortest = if last.shortest.is_finite() {
                    format!(", from {} ms", sliders::digits(f64::from(last.shortest) * 1e3))
                } else {
                    String::new()
                };
                row("step bound by", format!("{}{shortest}", bound.name()));
            }
            if last.speed > 0.0 {
                row("fastest", format!("{} m/s", sliders::digits(f64::from(last.speed))));
            }
        }
        let (all, absorbed) = facts.particles;
        if all > 0 {
            row("water", format!("{all} particles, {absorbed} in sponges"));
        }
        row("simulated on", facts.machine.clone());
    });
}

fn looks(ui: &mut Ui, ui_state: &mut UiState) {
    ui.horizontal(|ui| {
        let name = |view: View| format!("{view:?}").to_lowercase();
        ComboBox::from_id_salt("view").selected_text(name(ui_state.view)).show_ui(ui, |ui| {
            for view in View::ALL {
                ui.selectable_value(&mut ui_state.view, view, name(view));
            }
        });
        ui.checkbox(&mut ui_state.full, "full quality").on_hover_text(
            "Otherwise pictures become coarser while something moves, so that they follow it (F).",
        );
    });
    if let Some(shown) = &ui_state.picture {
        let view = format!("{:?}", shown.quality.view).to_lowercase();
        let (width, height) = shown.size;
        let (time, rate) = (shown.time.as_millis(), ui_state.recent.len());
        ui.weak(format!("{view}, {width} x {height} in {time} ms, {rate} pictures/s"));
        ui.weak(format!("drawn by {}, shown by {}", shown.renderer, ui_state.surface));
    }
}

/// Saturation of the sponges over time.
fn plot(ui: &mut Ui, facts: &Facts) {
    let size = Vec2::new(ui.available_width(), 96.0);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 3.0, Color32::from_gray(18));
    let area = Rect::from_min_max(rect.min + Vec2::new(30.0, 8.0), rect.max - Vec2::new(8.0, 18.0));
    let (first, last) = match (facts.saturations.first(), facts.saturations.last()) {
        (Some((first, _)), Some((last, _))) => (*first, last.max(first + 0.5)),
        _ => return,
    };
    let place = |time: f64, value: f32| {
        let share = ((time - first) / (last - first)) as f32;
        pos2(area.left() + share * area.width(), area.bottom() - value.clamp(0.0, 1.0) * area.height())
    };
    let (small, grey) = (FontId::proportional(10.0), Color32::from_gray(150));
    for value in [0.0, 0.5, 1.0] {
        let line = [place(first, value), place(last, value)];
        painter.line_segment(line, Stroke::new(0.5, Color32::from_gray(60)));
        painter.text(
            line[0] - Vec2::new(4.0, 0.0),
            Align2::RIGHT_CENTER,
            format!("{value}"),
            small.clone(),
            grey,
        );
    }
    for (sponge, colour) in (0..facts.sponges.len()).zip(COLOURS.iter().cycle()) {
        let value = |all: &[f32]| all.get(sponge).copied();
        let points: Vec<Pos2> =
            facts.saturations.iter().filter_map(|(time, all)| Some(place(*time, value(all)?))).collect();
        painter.line(points, Stroke::new(1.5, *colour));
    }
    let below = area.bottom() + 3.0;
    let text = |at: Pos2, align, text: String| painter.text(at, align, text, small.clone(), grey);
    text(pos2(area.left(), below), Align2::LEFT_TOP, format!("{first:.1} s"));
    text(pos2(area.right(), below), Align2::RIGHT_TOP, format!("{last:.1} s"));
    text(pos2(area.center().x, below), Align2::CENTER_TOP, "saturation".to_owned());
    ui.horizontal_wrapped(|ui| {
        for ((index, name), colour) in facts.sponges.iter().enumerate().zip(COLOURS.iter().cycle()) {
            let now = facts.saturations.last().and_then(|(_, all)| all.get(index)).copied().unwrap_or(0.0);
            ui.colored_label(*colour, format!("{name} {now:.2}"));
        }
    });
}

fn phases(ui: &mut Ui, facts: &Facts) {
    CollapsingHeader::new(format!("Phases of a frame, {:.1} ms", facts.frame_ms)).id_salt("phases").show(
        ui,
        |ui| {
            Grid::new("phases").num_columns(2).striped(true).show(ui, |ui| {
                for (name, time) in &facts.phases {
                    ui.monospace(*name);
                    ui.label(format!("{time:.2} ms"));
                    ui.end_row();
                }
            });
        },
    );
    CollapsingHeader::new(format!("{} phases that do not run", facts.skipped.len())).id_salt("skipped").show(
        ui,
        |ui| {
            for (name, why) in &facts.skipped {
                ui.horizontal_wrapped(|ui| {
                    ui.monospace(*name);
                    ui.weak(*why);
                });
            }
        },
    );
}

/// The time line of a recording, and what was refused.
fn bottom(ui: &mut Ui, ui_state: &UiState, facts: &Facts) {
    ui.add_space(3.0);
    if let Some((frame, last)) = facts.played {
        ui.horizontal(|ui| {
            ui.spacing_mut().slider_width = (ui.available_width() - 180.0).max(80.0);
            let mut at = frame;
            if ui.add(Slider::new(&mut at, 0..=last).text(format!("of {last} frames"))).changed() {
                send(&ui_state.requests, Request::Seek(at));
            }
        });
    }
    if let Some(failure) = &facts.failure {
        ui.colored_label(Color32::from_rgb(250, 110, 90), format!("{failure} (R resets)"));
    } else if let Some(note) = &facts.note {
        ui.colored_label(Color32::from_rgb(250, 180, 80), note);
    }
    ui.add_space(3.0);
}

fn picture(ui: &mut Ui, ui_state: &mut UiState, facts: &Facts) {
    let rect = ui.available_rect_before_wrap();
    let response = ui.allocate_rect(rect, Sense::drag());
    let painter = ui.painter_at(rect);
    if let Some(texture) = &ui_state.texture {
        painter.image(texture.id(), rect, Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0)), Color32::WHITE);
    }
    if let Some(orbit) = &mut ui_state.orbit
        && rect.is_positive()
    {
        let mut viewport = Viewport { camera: orbit.camera(rect.width() / rect.height()), rect };
        ui_state.pointer.follow(ui, &response, &viewport, orbit, facts, &ui_state.requests);
        viewport.camera = orbit.camera(viewport.aspect());
        ui_state.viewport = Some(viewport);
    }
    let at = rect.left_top() + Vec2::new(12.0, 10.0);
    let mut text = speed_text(facts);
    if !ui_state.pointer.held().is_empty() {
        text = format!("{text}, {} held", ui_state.pointer.held());
    }
    let galley = painter.layout_no_wrap(text, FontId::proportional(16.0), speed_colour(facts));
    let back = Rect::from_min_size(at, galley.size()).expand2(Vec2::new(6.0, 3.0));
    painter.rect_filled(back, 4.0, Color32::from_black_alpha(130));
    painter.galley(at, galley, Color32::WHITE);
    if ui_state.pointer.is_busy() {
        ui.ctx().request_repaint_after(std::time::Duration::from_millis(16));
    }
}
