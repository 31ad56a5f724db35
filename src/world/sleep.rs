//! Sleep: a scene that has come to rest is left as it is, and costs nothing, until a script moves a body.
//!
//! A scene is at rest if in `time.sleep_after` seconds its particles, its nodes and every body have moved by no more than
//! `time.sleep_speed` would take them, in the mean; if none of them is a hundred times as fast; and if no script moved. What counts first
//! is the way between two looks, not the speed: single particles of a pool tremble for ever, and go nowhere. Velocities and pressures
//! stay as they were, so that the step after waking is the step that would have come next.

use glam::{Quat, Vec3};

use crate::{
    scene::{Scene, Time},
    world::World,
};

/// Largest speed of a single particle or node over the mean: thin films glide on floors that they do not stick to, but a drop that
/// falls, or a corner that swings, is awake.
const LARGEST: f64 = 100.0;

/// Whether the scene sleeps, and what that is decided by.
#[derive(Clone, Debug)]
pub(crate) struct Sleep {
    after: f64,
    speed: f64,
    /// Lengths of the box along axes on which it repeats, else zero.
    periods: Vec3,
    /// Times at which scripts move bodies, from and to.
    motions: Vec<(f64, f64)>,
    is_asleep: bool,
    /// Where everything was at the last look.
    before: Option<Places>,
}

#[derive(Clone, Debug)]
struct Places {
    time: f64,
    /// By identity.
    particles: Vec<Vec3>,
    nodes: Vec<Vec3>,
    bodies: Vec<(Vec3, Quat)>,
}

impl Sleep {
    pub(super) fn new(scene: &Scene, periods: Vec3) -> Self {
        let Time { sleep_after, sleep_speed, .. } = scene.time;
        let interval = |(from, to): (f32, f32)| (f64::from(from), f64::from(to));
        let motions = scene.bodies.iter().flat_map(|body| &body.motions);
        Self {
            after: f64::from(sleep_after),
            speed: f64::from(sleep_speed),
            periods,
            motions: motions.map(|motion| interval(motion.interval())).collect(),
            is_asleep: false,
            before: None,
        }
    }

    /// Whether a script moves a body between two times.
    fn moves(&self, from: f64, to: f64) -> bool {
        self.motions.iter().any(|(start, end)| *start < to && *end > from)
    }

    /// How long it can sleep on, at most `left`; none if it is awake \[s\].
    fn rest(&self, time: f64, left: f64) -> Option<f64> {
        let next = self.motions.iter().filter(|(_, end)| *end > time).map(|(start, _)| *start - time);
        let rest = next.fold(left, f64::min);
        (self.is_asleep && rest > 0.0).then_some(rest)
    }

    /// Distance between two places, across the seam of a box that repeats.
    fn way(&self, before: Vec3, now: Vec3) -> f32 {
        let apart = now - before;
        let turns = Vec3::select(self.periods.cmpgt(Vec3::ZERO), (apart / self.periods).round(), Vec3::ZERO);
        (apart - turns * self.periods).length()
    }

    /// Whether all places are where they were.
    fn is_still(&self, before: &Places, now: &Places) -> bool {
        let way = self.speed * (now.time - before.time);
        let set = |before: &[Vec3], now: &[Vec3]| {
            let (mut sum, mut largest) = (0.0_f64, 0.0_f32);
            for (before, now) in before.iter().zip(now) {
                let way = self.way(*before, *now);
                sum += f64::from(way);
                largest = if way < largest { largest } else { way };
            }
            sum <= way * before.len() as f64 && f64::from(largest) <= LARGEST * way
        };
        let body = |((from, turned), (to, turn)): (&(Vec3, Quat), &(Vec3, Quat))| {
            // Radians, as metres of something a metre large.
            let angle = 2.0 * (*turn - *turned).length().min((*turn + *turned).length());
            f64::from(from.distance(*to).max(angle)) <= way
        };
        !self.moves(before.time, now.time)
            && set(&before.particles, &now.particles)
            && set(&before.nodes, &now.nodes)
            && before.bodies.iter().zip(&now.bodies).all(body)
    }
}

impl World {
    /// Whether the scene has come to rest and is left as it is; see [`Time::sleep_after`].
    #[must_use]
    pub fn is_asleep(&self) -> bool {
        self.sleep.is_asleep
    }

    /// Sleeps until a time \[s\], or until a script moves a body, if the scene is asleep; whether the time is reached.
    pub(super) fn sleep_until(&mut self, end: f64) -> bool {
        let slept = self.sleep_within(end - self.clock.time);
        slept.is_some() && end - self.clock.time <= 1e-9
    }

    /// Sleeps as long as a step may be, but no longer than `left`, nor until a script moves a body, if the scene is asleep; the time
    /// slept \[s\].
    pub(super) fn sleep_within(&mut self, left: f64) -> Option<f64> {
        let left = if left.is_finite() { left } else { f64::from(self.scene.time.maximum_step) };
        let time = self.sleep.rest(self.clock.time, left);
        self.sleep.is_asleep = time.is_some();
        let time = time?;
        self.engine.wait(time);
        self.clock.time += time;
        Some(time)
    }

    /// Looks, once in `sleep_after`, whether anything has moved.
    pub(super) fn watch(&mut self) {
        let time = self.clock.time;
        let due = self.sleep.before.as_ref().is_none_or(|before| time - before.time >= self.sleep.after);
        if self.sleep.after == 0.0 || !due {
            return;
        }
        let now = self.places();
        let fastest = f64::from(self.clock.fluid_speed.max(self.clock.node_speed));
        let is_slow = fastest <= LARGEST * self.sleep.speed;
        let is_still = |before| self.sleep.is_still(before, &now);
        self.sleep.is_asleep = is_slow && self.sleep.before.as_ref().is_some_and(is_still);
        self.sleep.before = Some(now);
    }

    fn places(&self) -> Places {
        let place = |row: &[f32; 4]| Vec3::new(row[0], row[1], row[2]);
        let ids = self.particle_ids();
        let mut particles = vec![Vec3::ZERO; ids.len()];
        for (id, row) in ids.iter().zip(self.particle_positions()) {
            if let Some(particle) = particles.get_mut(*id as usize) {
                *particle = place(row);
            }
        }
        Places {
            time: self.clock.time,
            particles,
            nodes: self.node_positions().iter().map(place).collect(),
            bodies: self.bodies().iter().map(|body| (body.state.position, body.state.rotation)).collect(),
        }
    }
}
