//! Emitters and drains that run.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::scene::{Drain, Emitter, Scene};

/// An emitter or a drain that has not ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Flow {
    /// Its number, which no other has before or after it.
    pub(crate) number: u32,
    pub(crate) kind: FlowKind,
    /// Time of the next layer of an emitter, and time up to which a drain has taken its share \[s\].
    pub(crate) due: f64,
    /// Mass that a drain may take beside that of the next step \[kg\].
    pub(crate) spare: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum FlowKind {
    Emitter(Emitter),
    Drain(Drain),
}

impl Flow {
    pub(crate) fn new(number: u32, kind: FlowKind, now: f64) -> Self {
        let start = match kind {
            FlowKind::Emitter(Emitter { start, .. }) | FlowKind::Drain(Drain { start, .. }) => start,
        };
        Self { number, kind, due: now.max(f64::from(start)), spare: 0.0 }
    }

    pub(crate) fn end(&self) -> f64 {
        match self.kind {
            FlowKind::Emitter(Emitter { end, .. }) | FlowKind::Drain(Drain { end, .. }) => f64::from(end),
        }
    }

    /// What is impossible, if anything is.
    #[cfg(feature = "serde")]
    pub(super) fn defect(&self) -> Option<String> {
        let problems = match &self.kind {
            FlowKind::Emitter(emitter) => emitter.problems("emitter."),
            FlowKind::Drain(drain) => drain.problems("drain."),
        };
        if let Some(problem) = problems.first() {
            return Some(problem.to_string());
        }
        let is_possible = self.due >= 0.0 && self.due.is_finite() && self.spare >= 0.0 && self.spare < 1e9;
        (!is_possible).then(|| format!("a flow at {} s with {} kg", self.due, self.spare))
    }
}

/// The flows of a scene: its emitters, then its drains.
pub(super) fn of_scene(scene: &Scene) -> Vec<Flow> {
    let emitters = scene.emitters.iter().map(|emitter| FlowKind::Emitter(*emitter));
    let kinds = emitters.chain(scene.drains.iter().map(|drain| FlowKind::Drain(*drain)));
    (0..).zip(kinds).map(|(number, kind)| Flow::new(number, kind, 0.0)).collect()
}

/// Part of an interval by which a place of the disc is ahead of its layer. The parts are evenly spread over places that are near each other
/// (Roberts's sequence in two dimensions). Layers in which all places are equal fall apart into discs.
fn phase(row: i32, column: i32) -> f32 {
    let number = 0.754_877_7 * row as f32 + 0.569_840_3 * column as f32;
    number - number.floor()
}

/// A layer of an emitter: places and velocities, some time \[s\] after it came. Places of the disc follow each other within the way to the
/// next layer, and each has fallen freely since it was at the disc.
pub(crate) fn layer(emitter: &Emitter, spacing: f32, gravity: Vec3, time: f32) -> Vec<(Vec3, Vec3)> {
    let (across, up) = emitter.velocity.normalize().any_orthonormal_pair();
    let interval = spacing / emitter.velocity.length();
    let most = (emitter.radius / spacing) as i32;
    let mut layer = Vec::new();
    for row in -most..=most {
        for column in -most..=most {
            let offset = (across * column as f32 + up * row as f32) * spacing;
            if offset.length_squared() > emitter.radius * emitter.radius {
                continue;
            }
            let time = time + phase(row, column) * interval;
            let way = (emitter.velocity + 0.5 * time * gravity) * time;
            layer.push((emitter.position + offset + way, emitter.velocity + gravity * time));
        }
    }
    layer
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_layer_is_a_disc_that_falls_and_has_no_gap_to_the_next() {
        let emitter = Emitter { velocity: Vec3::X, radius: 0.051, ..Emitter::default() };
        let gravity = Vec3::NEG_Y * 10.0;
        let points = layer(&emitter, 0.005, gravity, 0.1);
        let area = points.len() as f32 * 0.005 * 0.005;
        assert!((area / (std::f32::consts::PI * 0.051 * 0.051) - 1.0).abs() < 0.05, "{area}");
        let mut parts = [0_usize; 4];
        for (place, velocity) in &points {
            // At a speed of 1 m/s along x, the time since it was at the disc.
            let time = place.x;
            assert!((0.1..0.105).contains(&time), "{place}");
            parts[((time - 0.1) / 0.00125) as usize % 4] += 1;
            assert!(velocity.distance(Vec3::X + gravity * time) < 1e-5, "{velocity} at {place}");
            let in_disc = *place - Vec3::X * time - 0.5 * gravity * time * time;
            assert!(in_disc.length() < 0.0511 && in_disc.x.abs() < 1e-6, "{place}");
        }
        // The control: a layer without phases has all in the first part.
        let even = points.len() / 4;
        assert!(parts.iter().all(|count| count.abs_diff(even) <= even / 5), "{parts:?}");
        let thin = Emitter { radius: 0.001, ..emitter };
        assert_eq!(layer(&thin, 0.005, Vec3::ZERO, 0.0).len(), 1);
    }
}
