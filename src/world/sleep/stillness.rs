//! How far parts of a scene have moved.

use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

use super::{Kind, Sleep};
use crate::{water::ranks, world::World};

/// Largest speed of a single particle or node over the mean. Thin films glide on floors with slip, but a falling drop or a
/// swinging corner is awake.
pub(super) const LARGEST: f64 = 100.0;

/// Positions at a time \[s\].
#[derive(Clone, Debug, Default)]
pub(super) struct Places {
    pub(super) time: f64,
    /// In the order of their identities.
    pub(super) particles: Vec<Vec3>,
    pub(super) nodes: Vec<Vec3>,
    pub(super) bodies: Vec<(Vec3, Quat)>,
}

impl Places {
    /// Takes over other places in the same memory.
    pub(super) fn copy(&mut self, from: &Self) {
        self.time = from.time;
        self.particles.clone_from(&from.particles);
        self.nodes.clone_from(&from.nodes);
        self.bodies.clone_from(&from.bodies);
    }
}

/// How far a part has moved between two times.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Way {
    /// Sum over its rows \[m\]; zero for a body.
    sum: f64,
    /// Number of rows.
    count: f64,
    /// The largest \[m\].
    largest: f64,
}

impl Way {
    /// Of rows of particles or nodes.
    fn of(ways: impl Iterator<Item = f32>) -> Self {
        let (mut sum, mut count, mut largest) = (0.0_f64, 0.0_f64, 0.0_f32);
        for own in ways {
            sum += f64::from(own);
            count += 1.0;
            largest = if own < largest { largest } else { own };
        }
        Self { sum, count, largest: f64::from(largest) }
    }

    /// Of a body.
    fn of_body(before: (Vec3, Quat), now: (Vec3, Quat)) -> Self {
        // Radians count as metres of a body of one metre.
        let angle = 2.0 * (now.1 - before.1).length().min((now.1 + before.1).length());
        Self { largest: f64::from(before.0.distance(now.0).max(angle)), ..Self::default() }
    }

    /// Whether that is no more than `way` \[m\].
    fn is_still(&self, kind: Kind, way: f64) -> bool {
        match kind {
            Kind::Body(_) => self.largest <= way,
            _ => self.sum <= way * self.count && self.largest <= LARGEST * way,
        }
    }
}

impl Sleep {
    /// Distance between two positions, across a periodic side where that is shorter.
    fn way(&self, before: Vec3, now: Vec3) -> f32 {
        let (apart, periods) = (now - before, self.rules.periods);
        let turns = Vec3::select(periods.cmpgt(Vec3::ZERO), (apart / periods).round(), Vec3::ZERO);
        (apart - turns * periods).length()
    }
}

impl World {
    /// How far every part has moved, in the order of the parts.
    pub(super) fn ways(&self, before: &Places, now: &Places) -> Vec<Way> {
        let sleep = &self.sleep;
        let way = |part: &super::PartState| match part.kind {
            // Parts that sleep stay where they are.
            _ if part.is_asleep => Way::default(),
            Kind::Fluid => {
                let pairs = before.particles.iter().zip(&now.particles);
                Way::of(pairs.map(|(before, now)| sleep.way(*before, *now)))
            }
            Kind::Sponge(index) => {
                let rows = self.node_rows(index).into_iter().flatten();
                let pairs = rows.filter_map(|row| before.nodes.get(row).zip(now.nodes.get(row)));
                Way::of(pairs.map(|(before, now)| sleep.way(*before, *now)))
            }
            Kind::Body(index) => Way::of_body(before.bodies[index], now.bodies[index]),
        };
        sleep.parts.iter().map(way).collect()
    }

    /// Whether a part kept its place at all checks in a time \[s\], and is slow.
    pub(super) fn is_still(&self, index: usize, kind: Kind, now: &[Way], time: f64) -> bool {
        let (sleep, way) = (&self.sleep, self.sleep.speed * time);
        let is_slow = |speed: f32| f64::from(speed) <= LARGEST * sleep.speed;
        let mut looks = sleep.between.iter().map(Vec::as_slice).chain([now]);
        let mut are_still = || looks.all(|ways| ways.get(index).is_some_and(|own| own.is_still(kind, way)));
        match kind {
            Kind::Fluid => is_slow(self.clock.fluid_speed) && are_still(),
            Kind::Sponge(sponge) => {
                let rows = self.node_rows(sponge).into_iter().flatten();
                let velocities = self.node_velocities();
                let square =
                    |row: usize| velocities.get(row).map_or(0.0, |[x, y, z, _]| x * x + y * y + z * z);
                is_slow(rows.map(square).fold(0.0, f32::max).sqrt()) && are_still()
            }
            Kind::Body(_) => are_still(),
        }
    }

    /// Where everything is now, in the spare memory.
    pub(super) fn places(&mut self) -> Places {
        let mut places = std::mem::take(&mut self.sleep.spare);
        let place = |row: &[f32; 4]| Vec3::new(row[0], row[1], row[2]);
        let ranks = ranks(self.particle_ids());
        places.time = self.clock.time;
        places.particles.clear();
        places.particles.resize(ranks.len(), Vec3::ZERO);
        for (rank, row) in ranks.iter().zip(self.particle_positions()) {
            if let Some(particle) = places.particles.get_mut(*rank as usize) {
                *particle = place(row);
            }
        }
        places.nodes.clear();
        places.nodes.extend(self.node_positions().iter().map(place));
        places.bodies.clear();
        places.bodies.extend(self.bodies().iter().map(|body| (body.state.position, body.state.rotation)));
        places
    }
}
