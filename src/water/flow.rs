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

/// A layer of an emitter: where, and with what velocity, after it has fallen freely for some time \[s\].
pub(crate) fn layer(emitter: &Emitter, spacing: f32, gravity: Vec3, time: f32) -> (Vec<Vec3>, Vec3) {
    let (across, up) = emitter.velocity.normalize().any_orthonormal_pair();
    let centre = emitter.position + (emitter.velocity + 0.5 * time * gravity) * time;
    let most = (emitter.radius / spacing) as i32;
    let mut points = Vec::new();
    for row in -most..=most {
        for column in -most..=most {
            let offset = (across * column as f32 + up * row as f32) * spacing;
            if offset.length_squared() <= emitter.radius * emitter.radius {
                points.push(centre + offset);
            }
        }
    }
    (points, emitter.velocity + gravity * time)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_layer_is_a_disc_that_falls() {
        let emitter = Emitter { velocity: Vec3::X, radius: 0.051, ..Emitter::default() };
        let (points, velocity) = layer(&emitter, 0.005, Vec3::NEG_Y * 10.0, 0.1);
        let area = points.len() as f32 * 0.005 * 0.005;
        assert!((area / (std::f32::consts::PI * 0.051 * 0.051) - 1.0).abs() < 0.05, "{area}");
        let centre = points.iter().sum::<Vec3>() / points.len() as f32;
        assert!(centre.distance(Vec3::new(0.1, -0.05, 0.0)) < 1e-4, "{centre}");
        assert!(points.iter().all(|point| (point.x - 0.1).abs() < 1e-5), "across the stream");
        assert_eq!(velocity, Vec3::new(1.0, -1.0, 0.0));
        let thin = Emitter { radius: 0.001, ..emitter };
        assert_eq!(layer(&thin, 0.005, Vec3::ZERO, 0.0).0.len(), 1);
    }
}
