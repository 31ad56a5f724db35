//! The path of a ray from the eye: reflections, refractions, absorption.

use super::matter::Arrival;
use super::optics::{INDEX, reflect, refract};
use super::room;
use super::setting::{Event, Face, NEAR, Setting};
use crate::render::{
    Look,
    colour::smooth,
    shapes::{Solid, Span},
};
use glam::Vec3;

/// Most events of a path.
const EVENTS: usize = 9;
/// Share of the scattered light that a path through water gathers.
const SCATTERED: f32 = 0.55;
/// Distance that a ray starts behind a body that it has passed (m).
const BEHIND: f32 = 1e-5;

#[cfg(feature = "gpu")]
shared_with_shaders!(PATH: EVENTS, SCATTERED, BEHIND);

/// What a path met: the colours of two neighbours with equal signatures may be mixed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Signature {
    met: u32,
    tile: u32,
}

impl Signature {
    pub(super) fn meet(&mut self, what: u32) {
        self.met = (self.met ^ what).wrapping_mul(0x9E37_79B1).rotate_left(13);
    }

    pub(super) fn tile(&mut self, tile: u32) {
        self.tile ^= tile;
    }

    /// Sixteen bits of what it met, and above them sixteen of the tile of the floor.
    pub(super) fn fold(self) -> u32 {
        let fold = |x: u32| (x ^ x >> 16) & 0xffff;
        fold(self.met) | fold(self.tile) << 16
    }
}

/// A ray on its way.
struct Path {
    origin: Vec3,
    direction: Vec3,
    /// Share of the light from here on that reaches the eye.
    through: Vec3,
    /// Light gathered so far.
    light: Vec3,
    wet: bool,
    /// Way from the eye (m).
    way: f32,
    signature: Signature,
}

impl Path {
    fn at(&self, distance: f32) -> Vec3 {
        self.origin + self.direction * distance
    }

    fn arrival(&self, distance: f32, film: bool) -> Arrival {
        Arrival {
            point: self.at(distance),
            direction: self.direction,
            way: self.way + distance,
            film,
            wet: self.wet,
        }
    }
}

impl Setting<'_> {
    /// Light that comes to a point against a direction, and the signature of its path.
    pub(super) fn radiance(&self, origin: Vec3, direction: Vec3) -> (Vec3, Signature) {
        let mut path = Path {
            origin,
            direction,
            through: Vec3::ONE,
            light: Vec3::ZERO,
            wet: self.is_wet(origin),
            way: 0.0,
            signature: Signature::default(),
        };
        for count in 0..EVENTS {
            let (event, passage) = self.next(path.origin, path.direction, path.wet);
            let length = event.distance();
            if path.wet {
                let left = self.medium.left(length);
                path.light += path.through * self.medium.scatter * (Vec3::ONE - left) * SCATTERED;
                path.through *= left;
            } else if let Some((enter, leave)) = passage {
                for at in [enter, leave] {
                    if at > BEHIND && at < length + NEAR {
                        self.pane(&mut path, at);
                    }
                }
            }
            match event {
                Event::Nothing => {
                    path.signature.meet(2);
                    path.light += path.through * room::background(path.direction);
                    return (path.light, path.signature);
                }
                Event::Matter(distance, matter, film) => {
                    let arrival = path.arrival(distance, film);
                    let light = self.shine(&matter, &arrival, &mut path.signature);
                    path.signature.meet(u32::from(film));
                    return (path.light + path.through * light, path.signature);
                }
                Event::Clear(index, span) => {
                    if self.pass(&mut path, index, &span) {
                        return (path.light, path.signature);
                    }
                }
                Event::Surface(distance, face) => self.bend(&mut path, distance, &face, count < 3),
            }
            if path.through.max_element() < 0.01 {
                break;
            }
        }
        path.signature.meet(4);
        (path.light + path.through * self.medium.scatter * 1.5, path.signature)
    }

    /// The surface of the water: the mirrored ray is gathered, the refracted one goes on.
    fn bend(&self, path: &mut Path, distance: f32, face: &Face, mirrors: bool) {
        let Face { normal, is_wall: wall, strength } = *face;
        let point = path.at(distance);
        path.way += distance;
        path.signature.meet(10 + u32::from(wall) * 2 + u32::from(path.wet));
        if wall {
            path.signature.meet(wall_code(normal));
            if path.wet {
                self.edge(path, point);
            }
        }
        let ratio = if path.wet { INDEX } else { 1.0 / INDEX };
        let Some((refracted, share)) = refract(path.direction, normal, ratio) else {
            path.signature.meet(3);
            path.direction = reflect(path.direction, normal);
            path.origin = point + normal * self.nudge;
            return;
        };
        let mirrored = if path.wet {
            self.medium.scatter
        } else {
            let direction = reflect(path.direction, normal);
            if share > 0.024 && mirrors {
                self.mirror(point + normal * self.nudge, direction, path.way)
            } else {
                room::light(direction)
            }
        };
        let share = share * strength;
        path.light += path.through * mirrored * share;
        path.through *= 1.0 - share;
        path.direction = path.direction.lerp(refracted, strength).normalize();
        path.origin = point - normal * self.nudge;
        path.wet = !path.wet;
    }

    /// Light along a mirrored ray: of solids, else of the room.
    fn mirror(&self, origin: Vec3, direction: Vec3, way: f32) -> Vec3 {
        let Some((distance, matter)) = self.solid(origin, direction, f32::INFINITY) else {
            return room::light(direction);
        };
        let point = origin + direction * distance;
        let arrival = Arrival { point, direction, way: way + distance, film: false, wet: false };
        self.shine(&matter, &arrival, &mut Signature::default())
    }

    /// The two shells of a body that lets light through, without refraction: it shows what it squeezes. Whether the path
    /// ends in it.
    fn pass(&self, path: &mut Path, index: usize, span: &Span) -> bool {
        let body = self.body(index);
        path.signature.meet(40 + index as u32);
        let wire = self.is_wire(index);
        let tint = tint(body);
        let pixel = self.pixel * (path.way + span.enter);
        for (shell, (distance, normal)) in
            [(span.enter, span.normal), (span.exit, -span.exit_normal)].into_iter().enumerate()
        {
            if shell == 1 {
                let inner = span.exit - span.enter;
                if let Some((distance, matter)) =
                    self.solid(path.at(span.enter + BEHIND), path.direction, inner)
                {
                    let arrival = path.arrival(span.enter + BEHIND + distance, false);
                    path.light += path.through * self.shine(&matter, &arrival, &mut path.signature);
                    return true;
                }
                if !distance.is_finite() {
                    break;
                }
            }
            let point = path.at(distance);
            let cosine = (-path.direction.dot(normal)).clamp(0.0, 1.0);
            let slant = (1.0 - cosine) * (1.0 - cosine);
            let mut share = if shell == 0 { 1.0 } else { 0.45 } * if path.wet { 0.8 } else { 1.0 };
            share *= if wire { 0.0 } else { 0.045 + 0.9 * slant * slant };
            let line = 0.004 * body.radius.min(0.3 * self.size).max(0.05 * self.size);
            let gap = if wire { body.wire_distance(point) } else { body.edge_distance(point) };
            let rim = (1.0 - smooth(line, line + 1.5 * pixel, gap)) * if wire { 0.9 } else { 0.5 };
            let ink = if wire { body.colour() } else { Vec3::new(0.75, 0.82, 0.82) };
            let seen = room::light(reflect(path.direction, normal));
            path.light += path.through * (seen * share + ink * rim);
            path.through *= tint * ((1.0 - share) * (1.0 - rim));
        }
        let exit = if span.exit.is_finite() { span.exit } else { span.enter };
        path.way += exit;
        path.origin = path.at(exit + BEHIND);
        path.wet = self.is_wet(path.origin + path.direction * (20.0 * BEHIND));
        false
    }

    /// A pane of the container between air and air: a weak mirror, with the edges of the container.
    fn pane(&self, path: &mut Path, distance: f32) {
        let Some((_, high)) = self.stage.container else { return };
        let point = path.at(distance);
        let normal = self.face(point);
        path.signature.meet(wall_code(normal));
        let is_lid = (high.y - point.y).abs() < 1e-5;
        if !is_lid {
            let cosine = path.direction.dot(normal);
            let slant = 1.0 - cosine.abs();
            let slant = slant * slant;
            let share = 0.035 * (0.5 + 4.0 * slant * slant);
            // The near pane mirrors the room, the far pane the inside of the container.
            let seen =
                if cosine < 0.0 { room::light(reflect(path.direction, normal)) } else { Vec3::splat(0.55) };
            path.light += path.through * seen * (share * 0.6);
            path.through *= 1.0 - share;
        }
        path.way += distance;
        self.edge(path, point);
        path.way -= distance;
    }

    /// Lines along the edges of the container.
    fn edge(&self, path: &mut Path, point: Vec3) {
        let Some((low, high)) = self.stage.container else { return };
        let gap = (point - low).abs().min((point - high).abs());
        // The smallest belongs to the wall of the point, the next one to the edge.
        let gap = gap.x.min(gap.y).max(gap.x.max(gap.y).min(gap.z));
        let pixel = (path.way * self.pixel).max(1e-5);
        let line = 0.0022 * self.size;
        let cover = 0.5 * (1.0 - smooth(line, line + 1.2 * pixel, gap));
        if cover > 0.0 {
            path.signature.meet(0x55);
            path.light += path.through * Vec3::new(0.42, 0.50, 0.50) * cover;
            path.through *= 1.0 - cover;
        }
    }
}

/// Light that each shell of a clear body lets through.
pub(in crate::render) fn tint(body: &Solid<'_>) -> Vec3 {
    if body.look == Look::Wire {
        return Vec3::ONE;
    }
    const TINTS: [Vec3; 3] =
        [Vec3::new(0.80, 0.90, 0.88), Vec3::new(0.84, 0.88, 0.93), Vec3::new(0.9, 0.88, 0.82)];
    body.own_colour().map_or(TINTS[body.index % TINTS.len()], |colour| Vec3::splat(0.7) + colour * 0.3)
}

/// A number for each of the six directions of walls.
fn wall_code(normal: Vec3) -> u32 {
    (normal.dot(Vec3::new(3.0, 5.0, 7.0)) + 120.0) as u32
}
