//! Sliders of the scene's numbers.

use egui::{CollapsingHeader, DragValue, Response, Slider, Ui};

use super::{app::UiState, send};
use crate::{
    facts::Facts,
    parameters::{Parameter, Value},
    simulation::Request,
};

/// Largest number over the smallest one beyond which a slider is logarithmic.
const WIDE: f32 = 500.0;

/// Largest numbers from which, and up to which, it is so as well.
const LARGE: f32 = 100.0;
const SMALL: f32 = 0.01;

/// Sliders: those that act at once, then those that act at the next reset.
pub(super) fn show(ui: &mut Ui, ui_state: &UiState, facts: &Facts) {
    if facts.parameters.is_empty() {
        ui.weak("A recording plays: its parameters are fixed.");
        return;
    }
    let (now, later): (Vec<&Parameter>, Vec<&Parameter>) =
        facts.parameters.iter().partition(|own| own.acts_at_once());
    CollapsingHeader::new("Parameters that act at once").default_open(true).show(ui, |ui| {
        groups(ui, ui_state, facts, &now, true);
    });
    if later.is_empty() {
        return;
    }
    let title = if facts.waits { "Parameters for the next reset *" } else { "Parameters for the next reset" };
    CollapsingHeader::new(title).id_salt("later").show(ui, |ui| groups(ui, ui_state, facts, &later, false));
    ui.horizontal(|ui| {
        let text = if facts.waits { "Reset with these changes" } else { "Reset" };
        if ui.button(text).clicked() {
            send(&ui_state.requests, Request::Reset);
        }
        if ui.button("Undo all changes").on_hover_text("Resets the scene as it was given.").clicked() {
            send(&ui_state.requests, Request::Restore);
        }
    });
}

fn groups(ui: &mut Ui, ui_state: &UiState, facts: &Facts, all: &[&Parameter], is_open: bool) {
    let mut names: Vec<&str> = Vec::new();
    for parameter in all {
        if !names.contains(&parameter.group.as_str()) {
            names.push(&parameter.group);
        }
    }
    for name in names {
        let own = all.iter().filter(|parameter| parameter.group == name);
        let id = (name, is_open, facts.epoch);
        let header = CollapsingHeader::new(name).id_salt(id).default_open(is_open && name != "scene");
        if name == "scene" {
            own.for_each(|parameter| row(ui, ui_state, parameter));
        } else {
            header.show(ui, |ui| own.for_each(|parameter| row(ui, ui_state, parameter)));
        }
    }
}

fn row(ui: &mut Ui, ui_state: &UiState, parameter: &Parameter) {
    let Parameter { limit, field, .. } = parameter;
    let unit = match limit.unit {
        "1" => String::new(),
        unit => format!(" {}", unit.replace("^2", "²").replace("^3", "³")),
    };
    let range = limit.minimum..=limit.maximum;
    let mut value = parameter.value;
    let label = ui.label(field.replace('_', " "));
    let is_wide = limit.minimum >= 0.0
        && (limit.maximum >= LARGE
            || limit.maximum <= SMALL
            || limit.maximum > WIDE * limit.minimum.max(SMALL));
    let response: Response = match &mut value {
        Value::Real(own) => ui.add(
            Slider::new(own, range)
                .logarithmic(is_wide)
                .smallest_positive(1e-10 * f64::from(limit.maximum))
                .custom_formatter(|value, _| digits(value))
                .suffix(unit),
        ),
        Value::Whole(own) => {
            let range = limit.minimum as u32..=limit.maximum as u32;
            ui.add(Slider::new(own, range).logarithmic(is_wide).suffix(unit))
        }
        Value::Vector(own) => ui
            .horizontal(|ui| {
                let speed = own.iter().fold(0.0_f32, |most, own| most.max(own.abs())).max(0.1) * 0.01;
                let drags = own.iter_mut().map(|own| {
                    let drag = DragValue::new(own).speed(speed).range(range.clone());
                    ui.add(drag.custom_formatter(|value, _| digits(value)))
                });
                let all = drags.reduce(|all, own| all | own);
                ui.label(unit);
                all
            })
            .inner
            .unwrap_or_else(|| label.clone()),
    };
    let default = parameter.default.map_or_else(|| "none".to_owned(), |default| default.text());
    let text = format!("{}\n\nkey {}, default {default}", parameter.text, parameter.key);
    label.on_hover_text(&text);
    if response.on_hover_text(text).changed() && value != parameter.value {
        send(&ui_state.requests, Request::Set(parameter.key.clone(), value));
    }
}

/// Three digits.
pub(super) fn digits(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e5).contains(&size) {
        return format!("{value:.2e}");
    }
    let rest = usize::try_from(2 - libm::log10(size).floor() as i32).unwrap_or(0);
    let text = format!("{value:.rest$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    #[test]
    fn numbers_have_three_digits() {
        let all = [(0.0, "0"), (5e-9, "5.00e-9"), (0.0125, "0.0125"), (9.81, "9.81"), (8000.0, "8000")];
        for (value, text) in all {
            assert_eq!(super::digits(value), text);
        }
    }
}
