//! Everything that rays can meet, and what they meet next.

use super::beads::Beads;
use super::ground::Ground;
use super::optics::Medium;
use super::skin::{facet, is_notched};
use super::tree::{Hit, Tree, Triangle};
use crate::render::{
    Look,
    colour::smooth,
    number::{greater, lesser},
    shapes::{Solid, Span},
    stage::Stage,
    water::Field,
};
use glam::Vec3;

/// Thickness of water over a sponge that is wetness alone, and from which on it is water alone, in spacings.
const FILM_ON_SPONGE: (f32, f32) = (0.2, 1.2);
/// The same over the floor.
const FILM_ON_FLOOR: (f32, f32) = (0.2, 0.5);
/// A narrower gap between water and a solid is water, in spacings.
const GAP: f32 = 1.0;
/// Cosine of rays to the outer surface of a sponge that may pass through a pore, and the longest way of them in it (m).
const GRAZING: f32 = 0.5;
const NOTCH: f32 = 0.006;
/// Nearer things belong to the place where a ray starts (m).
pub(super) const NEAR: f32 = 1e-6;

#[cfg(feature = "gpu")]
shared_with_shaders!(SETTING: FILM_ON_SPONGE, FILM_ON_FLOOR, GAP, GRAZING, NOTCH, NEAR);

/// What rays see.
pub(super) struct Setting<'a> {
    pub(super) stage: &'a Stage<'a>,
    /// The water; nothing without free water.
    pub(super) field: Option<Field>,
    /// How much water covers each node of the sponges, 0 to 1; empty for none.
    pub(super) films: Vec<f32>,
    /// The sponges.
    pub(super) tree: Tree<Triangle>,
    /// Balls of a view that shows particles or nodes, with their colours.
    pub(super) beads: Option<Beads>,
    /// How sponges look.
    pub(super) coat: Coat,
    pub(super) medium: Medium,
    pub(super) ground: Ground,
    /// Solids that rays end at, and those that they pass: indices in the list of the stage.
    pub(super) opaque: Vec<usize>,
    pub(super) clear: Vec<usize>,
    /// Distance that a new ray starts from a surface of water (m).
    pub(super) nudge: f32,
    /// Side of a tile of the floor (m).
    pub(super) pitch: f32,
    /// Middle and diagonal of the box that the scene is in (m).
    pub(super) centre: Vec3,
    pub(super) size: f32,
    /// Side of a pixel at a distance of 1 m (m).
    pub(super) pixel: f32,
}

/// Something that ends a ray.
#[derive(Clone, Copy, Debug)]
pub(super) enum Matter {
    Floor,
    Sponge(Hit<[f32; 2]>),
    Body(usize, Vec3),
    Bead(Hit<Vec3>),
}

/// How sponges look.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Coat {
    /// Pores, and the colour of wetness.
    Skin,
    /// The colour of a map of the saturation.
    Map,
}

/// What a ray meets, with its distance (m).
#[derive(Clone, Copy, Debug)]
pub(super) enum Event {
    Nothing,
    /// A solid, and whether it is below a film of water.
    Matter(f32, Matter, bool),
    /// A body that lets light through.
    Clear(usize, Span),
    /// The surface of the water.
    Surface(f32, Face),
}

/// A surface of water.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// Normal, against the ray.
    pub(super) normal: Vec3,
    /// Whether it is at a wall of the container.
    pub(super) is_wall: bool,
    /// How much it bends and mirrors light: less than 1 where thin water becomes wetness.
    pub(super) strength: f32,
}

impl Face {
    fn free(normal: Vec3, direction: Vec3, strength: f32) -> Self {
        let cosine = normal.dot(direction);
        let turned = (normal - direction * (cosine + 0.02)).normalize_or(-direction);
        Self { normal: if cosine < -0.02 { normal } else { turned }, is_wall: false, strength }
    }

    fn wall(outward: Vec3) -> Self {
        Self { normal: outward, is_wall: true, strength: 1.0 }
    }
}

impl Event {
    pub(super) fn distance(&self) -> f32 {
        match self {
            Self::Nothing => f32::INFINITY,
            Self::Matter(distance, ..) | Self::Surface(distance, ..) => *distance,
            Self::Clear(_, span) => span.enter,
        }
    }
}

/// Where a ray enters and leaves a box, if it does so in front of its start.
pub(super) fn boxed(low: Vec3, high: Vec3, origin: Vec3, direction: Vec3) -> Option<(f32, f32)> {
    let (mut enter, mut leave) = (f32::NEG_INFINITY, f32::INFINITY);
    for axis in 0..3 {
        let inverse = 1.0 / direction[axis];
        let (a, b) = ((low[axis] - origin[axis]) * inverse, (high[axis] - origin[axis]) * inverse);
        enter = greater(lesser(a, b), enter);
        leave = lesser(greater(a, b), leave);
    }
    (enter < leave && leave > 0.0).then_some((enter, leave))
}

impl<'a> Setting<'a> {
    pub(super) fn body(&self, index: usize) -> &Solid<'a> {
        &self.stage.solids[index]
    }

    pub(super) fn is_wire(&self, index: usize) -> bool {
        self.body(index).look == Look::Wire
    }

    /// The nearest solid on a ray that is nearer than a distance.
    pub(super) fn solid(&self, origin: Vec3, direction: Vec3, mut nearest: f32) -> Option<(f32, Matter)> {
        let mut best = None;
        if self.ground.is_seen && direction.y < 0.0 {
            let distance = ((self.ground.height - origin.y) / direction.y).max(0.0);
            if distance < nearest {
                nearest = distance;
                best = Some((distance, Matter::Floor));
            }
        }
        for index in &self.opaque {
            if let Some(span) = self.body(*index).span(origin, direction)
                && span.enter > NEAR
                && span.enter < nearest
            {
                nearest = span.enter;
                best = Some((span.enter, Matter::Body(*index, span.normal)));
            }
        }
        if let Some(hit) = self.sponge_on(origin, direction, nearest) {
            nearest = hit.distance;
            best = Some((nearest, Matter::Sponge(hit)));
        }
        let bead = self.beads.as_ref().and_then(|beads| beads.tree.hit(origin, direction, nearest));
        bead.map(|hit| (hit.distance, Matter::Bead(hit))).or(best)
    }

    /// The nearest place of a sponge on a ray that is nearer than a distance. A ray that grazes a pore may pass.
    pub(super) fn sponge_on(&self, origin: Vec3, direction: Vec3, nearest: f32) -> Option<Hit<[f32; 2]>> {
        let hit = self.tree.hit(origin, direction, nearest)?;
        let sponge = &self.stage.sponge;
        if self.coat != Coat::Skin || -direction.dot(facet(sponge, &hit).1) > GRAZING {
            return Some(hit);
        }
        // Where it leaves the sponge, if that is near, is where a ray of the other direction would enter.
        let behind = origin + direction * (hit.distance + NOTCH);
        let Some(entry) = self.tree.hit(behind, -direction, NOTCH) else { return Some(hit) };
        let exit = NOTCH - entry.distance;
        if !is_notched(sponge, &hit, direction, exit) {
            return Some(hit);
        }
        let passed = hit.distance + exit + 10.0 * NEAR;
        let next = self.tree.hit(origin + direction * passed, direction, nearest - passed)?;
        Some(Hit { distance: next.distance + passed, ..next })
    }

    /// Outward normal of the wall of the container that a point is nearest to.
    pub(super) fn face(&self, point: Vec3) -> Vec3 {
        let Some((low, high)) = self.stage.container else { return Vec3::Y };
        let (a, b) = ((point - low).abs(), (point - high).abs());
        let least = a.min(b).min_element();
        for axis in 0..3 {
            if a[axis] == least {
                return -Vec3::AXES[axis];
            }
            if b[axis] == least {
                return Vec3::AXES[axis];
            }
        }
        Vec3::Y
    }

    /// Whether a point is in the water.
    pub(super) fn is_wet(&self, point: Vec3) -> bool {
        let inside = |(low, high): (Vec3, Vec3)| point.cmpgt(low).all() && point.cmplt(high).all();
        self.stage.container.is_none_or(inside)
            && self.field.as_ref().is_some_and(|field| field.value(point) > 0.0)
    }

    /// The next event of a ray in air or water, and where it passes the container.
    pub(super) fn next(&self, origin: Vec3, direction: Vec3, wet: bool) -> (Event, Option<(f32, f32)>) {
        let solid = self.solid(origin, direction, f32::INFINITY);
        let mut limit = solid.map_or(f32::INFINITY, |(distance, _)| distance);
        let mut event =
            solid.map_or(Event::Nothing, |(distance, matter)| Event::Matter(distance, matter, false));
        for index in &self.clear {
            if let Some(span) = self.body(*index).span(origin, direction)
                && span.enter > NEAR
                && span.enter < limit
            {
                limit = span.enter;
                event = Event::Clear(*index, span);
            }
        }
        let passage = self.stage.container.and_then(|(low, high)| boxed(low, high, origin, direction));
        let Some(field) = &self.field else { return (event, passage) };
        let (enter, leave) = match (self.stage.container, passage) {
            (Some(_), None) => return (event, None),
            (_, passage) => passage.unwrap_or((0.0, f32::INFINITY)),
        };
        let end = leave.min(limit);
        let found = if wet {
            self.leave(field, origin, direction, (end, leave, limit))
        } else {
            self.enter(field, origin, direction, (enter, end), &event)
        };
        (found.unwrap_or(event), passage)
    }

    /// Where a ray in air enters the water.
    fn enter(
        &self,
        field: &Field,
        origin: Vec3,
        direction: Vec3,
        (enter, end): (f32, f32),
        event: &Event,
    ) -> Option<Event> {
        let start = enter.max(0.0);
        if start >= end {
            return None;
        }
        if enter > NEAR {
            let point = origin + direction * enter;
            if field.value(point) > 0.0 {
                return Some(Event::Surface(enter, Face::wall(self.face(point))));
            }
        }
        let distance = field.march(origin, direction, (start, end), false)?;
        let mut strength = 1.0;
        if let Event::Matter(depth, matter, _) = event {
            let layers = (depth - distance) / field.spacing;
            strength = match matter {
                Matter::Sponge(_) => smooth(FILM_ON_SPONGE.0, FILM_ON_SPONGE.1, layers),
                Matter::Floor => smooth(FILM_ON_FLOOR.0, FILM_ON_FLOOR.1, layers),
                Matter::Body(..) | Matter::Bead(_) => 1.0,
            };
            if strength <= 0.0 {
                return Some(Event::Matter(*depth, *matter, true));
            }
        }
        let normal = field.normal(origin + direction * distance);
        Some(Event::Surface(distance, Face::free(normal, direction, strength)))
    }

    /// Where a ray in water leaves it.
    fn leave(
        &self,
        field: &Field,
        origin: Vec3,
        direction: Vec3,
        (end, leave, limit): (f32, f32, f32),
    ) -> Option<Event> {
        let found = field.march(origin, direction, (0.0, end), true);
        // Particles keep away from solids: what is between them and the solid is no air.
        if found.is_some_and(|distance| limit - distance < GAP * field.spacing) {
            return None;
        }
        if let Some(distance) = found {
            let normal = -field.normal(origin + direction * distance);
            return Some(Event::Surface(distance, Face::free(normal, direction, 1.0)));
        }
        let is_wall = leave.is_finite() && leave < limit - 1e-5;
        is_wall.then(|| Event::Surface(leave, Face::wall(-self.face(origin + direction * leave))))
    }
}
