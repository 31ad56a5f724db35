//! Sleep: parts at rest keep their state, and cost almost nothing, until something comes near.
//!
//! A part of a scene (`parts.rs`) is at rest under three conditions. Within `time.sleep_after` seconds its particles or
//! nodes have moved by at most `time.sleep_speed` in the mean, from check to check. None of them is a hundred times as fast.
//! No script moved a body near it. A body is at rest if it moved by no more than that. The displacement between two checks
//! counts first, not the speed, because single particles of a pool tremble for ever in place. An island falls asleep when
//! all of its parts are at rest. Velocities and pressures are kept, so that the step after waking is the one that would have
//! come next.
//!
//! While all parts sleep and no script moves a body, the whole scene sleeps and takes no steps. Otherwise steps leave out
//! the sleeping parts (`waking.rs`). Where kernels are placed on both sides, the scene sleeps only as a whole.

mod bounds;
mod parts;
mod saved;
mod stillness;
#[cfg(feature = "serde")]
mod taken;
mod waking;

use glam::Vec3;
use sorb_kernels::{clock::TIME_RESOLUTION, params::Params};

use crate::{
    clock::Dormant,
    rigid::Target,
    scene::{Motion, Scene, Time},
    world::World,
};
use bounds::Bounds;
pub(crate) use parts::Kind;
use parts::{PartState, Rules};
pub(crate) use saved::Saved;
use stillness::{Places, Way};

/// Parts of the time between two checks at which positions are recorded as well. A vibration with the period of the checks, or a fraction
/// of it, has the same position at each of them (sampling alias). It has not at both of these times.
const BETWEEN: [f64; 2] = [0.236, 0.618];

/// Sleeping parts, and the data of the decision.
#[derive(Clone, Debug)]
pub(crate) struct Sleep {
    after: f64,
    speed: f64,
    rules: Rules,
    /// Motions of bodies by scripts, by the number of the body.
    motions: Vec<(usize, Motion)>,
    /// Intervals in which the container moves, or gravity changes \[s\]: everything is awake then.
    pub(crate) carried: Vec<(f64, f64)>,
    parts: Vec<PartState>,
    /// Whether the scene sleeps as a whole.
    is_asleep: bool,
    /// Positions at the last check.
    before: Option<Places>,
    /// How far every part has moved since then, at the times of [`BETWEEN`].
    between: Vec<Vec<Way>>,
    /// Sponges with nodes that commands have given to a body, which may move them from afar: they never sleep.
    pub(super) gripped: Vec<usize>,
    /// Memory for positions.
    spare: Places,
    /// Time up to which displacements are known \[s\].
    watched: f64,
    /// Largest displacement of particles and nodes since their boxes were computed \[m\].
    ways: [f32; 2],
}

impl Sleep {
    pub(crate) fn new(scene: &Scene, params: &Params) -> Self {
        let Time { sleep_after, sleep_speed, .. } = scene.time;
        let motions = scene.bodies.iter().enumerate();
        let motions = motions.flat_map(|(index, body)| body.motions.iter().map(move |own| (index, *own)));
        let periods = params.periodic.map_or(Vec3::ZERO, |periodic| periodic.periods());
        Self {
            after: f64::from(sleep_after),
            speed: f64::from(sleep_speed),
            rules: Rules { periods, has_wetting: params.has_wetting() },
            motions: motions.collect(),
            carried: Vec::new(),
            parts: Vec::new(),
            is_asleep: false,
            before: None,
            between: Vec::new(),
            gripped: Vec::new(),
            spare: Places::default(),
            watched: 0.0,
            ways: [0.0; 2],
        }
    }

    /// Parts that steps leave out.
    pub(crate) fn dormant(&self) -> Dormant {
        let mut dormant = Dormant::default();
        for part in self.parts.iter().filter(|part| part.is_asleep) {
            match part.kind {
                Kind::Fluid => dormant.fluid = true,
                Kind::Sponge(index) => dormant.sponges.push(index),
                Kind::Body(index) => dormant.bodies.push(index),
            }
        }
        dormant
    }

    /// The parts that sleep.
    pub(crate) fn asleep(&self) -> impl Iterator<Item = Kind> {
        self.parts.iter().filter(|part| part.is_asleep).map(|part| part.kind)
    }

    /// Whether a part sleeps; false for an unknown part.
    pub(crate) fn has(&self, kind: Kind) -> bool {
        self.parts.iter().any(|part| part.kind == kind && part.is_asleep)
    }

    /// All parts awake, with what commands have changed.
    pub(crate) fn anew(&self, scene: &Scene, params: &Params, targets: &[Option<Target>]) -> Self {
        let (gripped, carried) = (self.gripped.clone(), self.carried.clone());
        let mut sleep = Self { gripped, carried, ..Self::new(scene, params) };
        for (body, target) in targets.iter().enumerate() {
            target.iter().for_each(|target| sleep.follow(body, target));
        }
        sleep
    }

    /// Particles that have come, which have the last identities.
    pub(crate) fn add_particles(&mut self, rows: &[[f32; 4]]) {
        if let Some(before) = &mut self.before {
            before.particles.extend(rows.iter().map(|row| Vec3::new(row[0], row[1], row[2])));
        }
    }

    /// Keeps the particles that stay, in the order of their identities.
    pub(crate) fn keep_particles(&mut self, stays: &[bool]) {
        if let Some(before) = &mut self.before {
            let mut stays = stays.iter();
            before.particles.retain(|_| stays.next().copied().unwrap_or(false));
        }
    }

    /// Replaces the motions of a body by the way to a target.
    pub(crate) fn follow(&mut self, body: usize, target: &Target) {
        self.motions.retain(|(of, _)| *of != body);
        // Rounded outwards: the body must not move outside of it.
        let (start, end) = ((target.start as f32).next_down(), (target.end as f32).next_up());
        let (velocity, turn) = (target.velocity().as_vec3(), target.angular_velocity().as_vec3());
        self.motions.push((body, Motion::Linear { velocity, start, end, ease: 0.0 }));
        if turn != Vec3::ZERO {
            let (axis, rate) = (turn, turn.length());
            self.motions.push((body, Motion::Turn { axis, pivot: target.from, rate, start, end, ease: 0.0 }));
        }
    }

    /// Lets sponges never sleep again.
    pub(crate) fn keep_awake(&mut self, sponges: &[usize]) {
        let new = sponges.iter().filter(|sponge| !self.gripped.contains(sponge));
        let new: Vec<usize> = new.copied().collect();
        self.gripped.extend(new);
    }

    /// Whether the container moves, or gravity changes, between two times.
    pub(crate) fn is_carried(&self, from: f64, to: f64) -> bool {
        self.carried.iter().any(|(start, end)| *start < to && *end > from)
    }

    /// Whether the container or a script moves something between two times.
    fn moves(&self, from: f64, to: f64) -> bool {
        self.is_carried(from, to) || self.motions.iter().any(|(_, motion)| is_active(motion, from, to))
    }

    /// Whether no body moves in a step that begins now, nor has a velocity to lose.
    pub(crate) fn are_bodies_still(&self, time: f64, step: f32) -> bool {
        let is_dynamic = |part: &PartState| matches!(part.kind, Kind::Body(_));
        let touches = |(_, motion): &(usize, Motion)| {
            let (start, end) = interval(motion);
            start <= time + f64::from(step) && end >= time
        };
        // Before the first check there are no parts.
        self.before.is_some()
            && self.parts.iter().filter(|part| is_dynamic(part)).all(|part| part.is_asleep)
            && !self.motions.iter().any(touches)
            && !self.is_carried(time, time + f64::from(step))
    }

    /// Time for which the whole scene can sleep on, at most `left`; none if it is awake \[s\].
    fn rest(&self, time: f64, left: f64) -> Option<f64> {
        let intervals = self.motions.iter().map(|(_, motion)| interval(motion));
        let intervals = intervals.chain(self.carried.iter().copied());
        let next = intervals.filter(|(_, end)| *end > time).map(|(start, _)| start - time);
        let rest = next.fold(left, f64::min);
        (self.is_asleep && rest > 0.0).then_some(rest)
    }
}

/// Lowest and highest corner of a box around a body \[m\].
pub(crate) fn box_of(body: &sorb_kernels::body::Body) -> (Vec3, Vec3) {
    let [low, high] = Bounds::of_body(body).corners();
    (low, high)
}

/// Begin and end of a motion \[s\].
fn interval(motion: &Motion) -> (f64, f64) {
    let (start, end) = motion.interval();
    (f64::from(start), f64::from(end))
}

/// Whether a motion moves anything between two times.
fn is_active(motion: &Motion, from: f64, to: f64) -> bool {
    let (start, end) = interval(motion);
    start < to && end > from
}

impl World {
    /// Whether the whole scene is asleep; see [`Time::sleep_after`].
    #[must_use]
    pub fn is_asleep(&self) -> bool {
        self.sleep.is_asleep
    }

    /// Whether the fluid is asleep, while other parts of the scene may move; see [`Time::sleep_after`].
    #[must_use]
    pub fn is_fluid_asleep(&self) -> bool {
        self.sleep.has(Kind::Fluid)
    }

    /// The same of a sponge, by its number in the scene; false if there is no such sponge.
    #[must_use]
    pub fn is_sponge_asleep(&self, index: usize) -> bool {
        self.sleep.has(Kind::Sponge(index))
    }

    /// The same of a body, by its number in the scene; false for bodies that are fixed or that scripts move.
    #[must_use]
    pub fn is_body_asleep(&self, index: usize) -> bool {
        self.sleep.has(Kind::Body(index))
    }

    /// Whether any sponge is awake.
    pub(crate) fn has_moving_nodes(&self) -> bool {
        self.present_sponges().any(|sponge| !self.is_sponge_asleep(sponge))
    }

    /// Numbers of the sponges that commands have not removed.
    pub(crate) fn present_sponges(&self) -> impl Iterator<Item = usize> {
        (0..).zip(&self.scene.sponges).filter(|(_, sponge)| !sponge.is_removed()).map(|(index, _)| index)
    }

    /// Sleeps until a time \[s\], or until a script moves a body, if the scene is asleep; returns whether the time is
    /// reached.
    pub(crate) fn sleep_until(&mut self, end: f64) -> bool {
        let slept = self.sleep_within(end - self.clock.time);
        slept.is_some() && end - self.clock.time <= TIME_RESOLUTION
    }

    /// Sleeps for the length of a step, but no longer than `left`, nor until a script moves a body, if the scene is asleep.
    /// Returns the time \[s\].
    pub(super) fn sleep_within(&mut self, left: f64) -> Option<f64> {
        let left = if left.is_finite() { left } else { f64::from(self.scene.time.maximum_step) };
        let time = self.sleep.rest(self.clock.time, left);
        if self.sleep.is_asleep && time.is_none() {
            self.sleep.is_asleep = false;
            self.wake_what_is_reached();
        }
        let time = time?;
        self.engine.wait(time);
        self.clock.time += time;
        self.sleep.watched = self.clock.time;
        Some(time)
    }

    /// Wakes the parts that something awake comes near, and once in `sleep_after` checks for rest. Returns whether other
    /// parts sleep now.
    pub(crate) fn watch(&mut self) -> bool {
        if self.sleep.after == 0.0 {
            return false;
        }
        let has_woken = self.wake_what_is_reached();
        let time = self.clock.time;
        let since = self.sleep.before.as_ref().map_or(f64::INFINITY, |before| time - before.time);
        let next = BETWEEN.get(self.sleep.between.len());
        if since >= self.sleep.after {
            return self.detect_rest() || has_woken;
        }
        if next.is_some_and(|part| since >= part * self.sleep.after) {
            let places = self.places();
            let ways = self.sleep.before.as_ref().map(|before| self.ways(before, &places));
            self.sleep.between.extend(ways);
            self.sleep.spare = places;
        }
        has_woken
    }

    /// Lets islands fall asleep whose parts have not moved since the last check; returns whether there are any.
    fn detect_rest(&mut self) -> bool {
        let now = self.places();
        if self.sleep.before.is_none() {
            self.sleep.parts = self.parts();
        }
        self.take_bounds();
        let before = self.sleep.before.take();
        let has_changed = before.as_ref().is_some_and(|before| self.fall_asleep(before, &now));
        self.sleep.spare = before.unwrap_or_default();
        self.sleep.before = Some(now);
        self.sleep.between.clear();
        if has_changed {
            self.apply_sleep();
        }
        has_changed
    }

    /// Decides which parts fall asleep; returns whether there are any.
    fn fall_asleep(&mut self, before: &Places, now: &Places) -> bool {
        let moving = self.movers(before.time);
        let is_moved = self.sleep.moves(before.time, now.time);
        let is_carried = self.sleep.is_carried(before.time, now.time);
        let (sleep, as_a_whole) = (&self.sleep, self.sleeps_as_a_whole());
        let ways = self.ways(before, now);
        let is_still = |index: usize, part: &PartState| {
            let is_beside = if as_a_whole || is_carried {
                is_moved
            } else {
                moving.iter().any(|mover| sleep.rules.is_kept_awake(part, mover))
            };
            let is_gripped = matches!(part.kind, Kind::Sponge(own) if sleep.gripped.contains(&own));
            let is_rested = part.awake_since <= before.time && !is_beside && !is_gripped;
            part.is_asleep || is_rested && self.is_still(index, part.kind, &ways, now.time - before.time)
        };
        let mut first = sleep.rules.islands(&sleep.parts, |_| true);
        if as_a_whole {
            first.fill(0);
        }
        let mut are_still = vec![true; first.len()];
        for (index, (part, first)) in sleep.parts.iter().zip(&first).enumerate() {
            are_still[*first] &= is_still(index, part);
        }
        let mut has_changed = false;
        for (part, first) in self.sleep.parts.iter_mut().zip(&first) {
            has_changed |= are_still[*first] && !part.is_asleep;
            part.is_asleep |= are_still[*first];
        }
        self.sleep.is_asleep = !is_moved && self.sleep.parts.iter().all(|part| part.is_asleep);
        has_changed
    }
}
