//! Effect of sleeping parts on the steps of the others, and waking.

use std::ops::Range;

use glam::Vec3;
use sorb_kernels::{
    asleep::Asleep,
    body::{Body, BodyKind},
    pbd,
    reduce::Wrenches,
};

use super::{Bounds, Kind, PartState, is_active};
use crate::{
    clock::{Dormant, Steps},
    scene::Motion,
    schedule::Awake,
    world::{World, fastest_body},
};

/// Allowed displacement of particles and nodes between two updates of their boxes, over that of their largest speeds \[1\].
const SPARE: f32 = 1.25;

/// Reach of the fluid, over that of a particle, which moves by a part of it in a step \[1\].
const FLUID_REACH: f32 = 1.5;

/// Reach of a body, over its radius \[1\].
const BODY_REACH: f32 = 0.1;

impl World {
    /// Whether parts cannot sleep separately, because steps run on a device and the CPU by turns.
    pub(super) fn sleeps_as_a_whole(&self) -> bool {
        self.stores.device.as_ref().is_some_and(|device| !device.has_all())
    }

    /// All parts, awake, with boxes that were never computed.
    pub(super) fn parts(&self) -> Vec<PartState> {
        self.parts_of(self.stores.host.rows.fluid > 0)
    }

    /// The same with or without water.
    pub(super) fn parts_of(&self, has_water: bool) -> Vec<PartState> {
        let (params, awake_since) = (&self.params, self.clock.time);
        let part = |kind, reach| {
            let bounds = Bounds::of(std::iter::empty());
            PartState { kind, reach, bounds, is_asleep: false, awake_since }
        };
        let mut parts = Vec::new();
        if has_water {
            parts.push(part(Kind::Fluid, FLUID_REACH * params.fluid.list_radius()));
        }
        for index in self.present_sponges() {
            let sponge = &params.sponges[index];
            let coupling = if has_water { params.coupling.support_radius } else { 0.0 };
            let touch = pbd::meeting::pair_radius(params);
            parts.push(part(Kind::Sponge(index), coupling.max(touch).max(2.0 * sponge.edge)));
        }
        for (index, body) in self.bodies().iter().enumerate() {
            if body.kind == BodyKind::Dynamic {
                parts.push(part(Kind::Body(index), BODY_REACH * body.shape.bounding_radius()));
            }
        }
        parts
    }

    /// Rows of the nodes of a sponge.
    pub(in crate::world) fn node_rows(&self, sponge: usize) -> [Range<usize>; 4] {
        let range = |color| self.lattice.node_range(color, sponge as u32);
        std::array::from_fn(|color| range(color).start as usize..range(color).end as usize)
    }

    /// Computes the boxes of all awake parts.
    pub(crate) fn take_bounds(&mut self) {
        let bounds = |kind| match kind {
            Kind::Fluid => Bounds::of(self.particle_positions().iter()),
            Kind::Sponge(index) => {
                let nodes = self.node_positions();
                Bounds::of(self.node_rows(index).into_iter().flat_map(|rows| &nodes[rows]))
            }
            Kind::Body(index) => self.body_bounds(index),
        };
        let awake = self.sleep.parts.iter().enumerate().filter(|(_, part)| !part.is_asleep);
        let taken: Vec<_> = awake.map(|(index, part)| (index, bounds(part.kind))).collect();
        for (index, bounds) in taken {
            self.sleep.parts[index].bounds = bounds;
        }
        self.sleep.ways = [0.0; 2];
    }

    /// Around a dynamic body, now and in the next step.
    fn body_bounds(&self, index: usize) -> Bounds {
        let (body, step) = (&self.bodies()[index], self.scene.time.maximum_step);
        let next = (body.fastest() + step * self.params.gravity.length()) * step;
        Bounds::of_body(body).grown(next)
    }

    /// Boxes around bodies that scripts move, from a time on until the end of a step that begins now.
    pub(super) fn movers(&self, from: f64) -> Vec<Bounds> {
        let longest = self.scene.time.maximum_step;
        let until = self.clock.time + f64::from(longest);
        let bodies = self.bodies();
        let mover = |(index, body): (usize, &Body)| {
            let own = self.sleep.motions.iter().filter(|(of, _)| *of == index);
            let active = own.filter(|(_, motion)| is_active(motion, from, until));
            let speeds: Vec<f32> = active.map(|(_, motion)| speed(motion, body)).collect();
            let way = speeds.iter().sum::<f32>() * longest;
            (!speeds.is_empty()).then(|| Bounds::of_body(body).grown(way))
        };
        bodies.iter().enumerate().filter_map(mover).collect()
    }

    /// Wakes the islands of parts that an awake part has come near; returns whether there are any.
    pub(crate) fn wake_what_is_reached(&mut self) -> bool {
        let passed = (self.clock.time - self.sleep.watched) as f32;
        self.sleep.watched = self.clock.time;
        let speeds = [self.clock.fluid_speed, self.clock.node_speed];
        self.sleep.ways.iter_mut().zip(speeds).for_each(|(way, speed)| *way += SPARE * speed * passed);
        if self.sleep.parts.iter().all(|part| !part.is_asleep) {
            return false;
        }
        let longest = f64::from(self.scene.time.maximum_step);
        if self.is_carried(self.clock.time, self.clock.time + longest) {
            self.wake(&vec![true; self.sleep.parts.len()]);
            return true;
        }
        if self.sleeps_as_a_whole() {
            let wakes = !self.sleep.is_asleep;
            if wakes {
                self.wake(&vec![true; self.sleep.parts.len()]);
            }
            return wakes;
        }
        let mut reached = self.reached();
        // Boxes that were enlarged for a while are too large.
        if reached.contains(&true) {
            self.take_bounds();
            reached = self.reached();
        }
        let has_woken = reached.contains(&true);
        if has_woken {
            self.wake(&reached);
        }
        has_woken
    }

    /// For every part whether it sleeps, and an awake part has come within its reach.
    fn reached(&self) -> Vec<bool> {
        let sleep = &self.sleep;
        let mut awake = self.movers(self.clock.time);
        for part in sleep.parts.iter().filter(|part| !part.is_asleep) {
            awake.push(match part.kind {
                Kind::Fluid => part.bounds.grown(part.reach + sleep.ways[0]),
                Kind::Sponge(_) => part.bounds.grown(part.reach + sleep.ways[1]),
                Kind::Body(index) => self.body_bounds(index).grown(part.reach),
            });
        }
        let is_reached = |part: &PartState| awake.iter().any(|awake| sleep.rules.is_reached(part, awake));
        sleep.parts.iter().map(|part| part.is_asleep && is_reached(part)).collect()
    }

    /// Wakes the islands of parts of some kinds, and ends the sleep of the whole scene.
    pub(crate) fn wake_kinds(&mut self, is_meant: impl Fn(Kind) -> bool) {
        let as_a_whole = self.sleeps_as_a_whole();
        let is_meant = |part: &PartState| part.is_asleep && (as_a_whole || is_meant(part.kind));
        let woken: Vec<bool> = self.sleep.parts.iter().map(is_meant).collect();
        if woken.contains(&true) {
            self.wake(&woken);
        }
        self.sleep.is_asleep = false;
    }

    /// Wakes the islands of some parts.
    fn wake(&mut self, reached: &[bool]) {
        let time = self.clock.time;
        let first = self.sleep.rules.islands(&self.sleep.parts, |part| part.is_asleep);
        let mut wakes = vec![false; first.len()];
        first.iter().zip(reached).for_each(|(first, reached)| wakes[*first] |= *reached);
        for (part, first) in self.sleep.parts.iter_mut().zip(&first) {
            if part.is_asleep && wakes[*first] {
                (part.is_asleep, part.awake_since) = (false, time);
            }
        }
        self.sleep.is_asleep = false;
        self.apply_sleep();
    }

    /// Awake parts of the next step.
    pub(crate) fn awake(&self) -> Awake {
        let dormant = self.sleep.dormant();
        if self.sleeps_as_a_whole() || dormant == Dormant::default() {
            return Awake::EVERYTHING;
        }
        let awake = self.present_sponges().filter(|index| !dormant.sponges.contains(index));
        let awake: Vec<u32> = awake.map(|index| index as u32).collect();
        let touch = self.params.has_touch_among(&awake);
        Awake { fluid: !dormant.fluid, sponges: !awake.is_empty(), touch }
    }

    /// Makes the next steps leave out the sleeping parts.
    pub(crate) fn apply_sleep(&mut self) {
        if self.sleeps_as_a_whole() {
            return;
        }
        let dormant = self.sleep.dormant();
        let rows = dormant.sponges.iter().flat_map(|sponge| self.node_rows(*sponge));
        self.params.asleep = Asleep::new(rows.collect());
        let are_sponges_asleep = dormant.sponges.len() == self.present_sponges().count();
        let bodies = &mut self.stores.host.bodies;
        for (index, body) in bodies.states.0.iter_mut().enumerate() {
            if body.kind == BodyKind::Dynamic {
                self.engine.hold(index, dormant.bodies.contains(&index));
                body.state = self.engine.state(index);
            }
        }
        self.clock.body_speed = fastest_body(&bodies.states.0);
        // The wrenches of phases that are left out would not be renewed.
        if dormant.fluid {
            bodies.fluid_wrenches = Wrenches::default();
        }
        if are_sponges_asleep {
            bodies.node_wrenches = Wrenches::default();
        }
        self.steps = Steps::new(&self.scene, &self.params, &bodies.states.0, &*self.engine, &dormant);
        // Awake water is in no sleeping sponge.
        let is_outside = are_sponges_asleep && !dormant.fluid;
        if is_outside {
            self.stores.host.fluid.interior.fill(0.0);
        }
        let awake = self.awake();
        if let Some(device) = &mut self.stores.device {
            device.set_asleep(awake, &self.params.asleep, &self.steps, is_outside);
        }
    }
}

/// Largest speed that a motion gives to the surface of a body at its present place \[m/s\].
fn speed(motion: &Motion, body: &Body) -> f32 {
    match *motion {
        Motion::Linear { velocity, .. } => velocity.length(),
        Motion::Shake { amplitude, frequency, ease, .. } => {
            // The amplitude grows by at most 1.5 within the time `ease`.
            let growth = if ease > 0.0 { 1.5 / ease } else { 0.0 };
            amplitude.length() * (2.0 * std::f32::consts::PI * frequency + growth)
        }
        Motion::Turn { pivot, rate, .. } => {
            let radius = body.shape.bounding_radius();
            // Boxes of planes cover all of space anyway.
            let radius = if radius.is_finite() { radius } else { 0.0 };
            rate.abs() * (Vec3::distance(body.state.position, pivot) + radius)
        }
    }
}
