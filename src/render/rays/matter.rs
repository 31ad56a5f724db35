//! Light that leaves the floor, sponges and bodies.

use super::foam::foam;
use super::optics::{reflect, schlick};
use super::path::Signature;
use super::room::{self, FAR, KEY, hemisphere, key_direction};
use super::setting::{Coat, Matter, Setting};
use super::skin::{covered, facet, skin};
use super::tree::Hit;
use crate::render::{
    colour::{colour_map, smooth, unit},
    number::whole,
};
use glam::Vec3;

const FLOOR_COLOUR: Vec3 = Vec3::new(0.60, 0.591, 0.579);

/// Light that a wet floor loses. Rays are widened as they leave water, by the square of its index. What the surface of the water
/// reflects back to the floor makes up for a part of it.
const WET_FLOOR: f32 = 0.22;
/// How far the surface of a film follows pores.
const FILM_RELIEF: f32 = 0.35;
/// Largest share of the light that a film mirrors: it is rough at flat angles.
const FILM_MIRROR: f32 = 0.12;
/// Brightness of the window in a film.
const FILM_GLEAM: f32 = 0.6;

#[cfg(feature = "gpu")]
shared_with_shaders!(MATTER: FLOOR_COLOUR, WET_FLOOR, FILM_RELIEF, FILM_MIRROR, FILM_GLEAM);

/// How a ray arrives at a solid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrival {
    pub(super) point: Vec3,
    pub(super) direction: Vec3,
    /// Whole way from the eye (m).
    pub(super) way: f32,
    /// Whether water thinner than a layer of particles is on the solid.
    pub(super) film: bool,
    /// Whether the ray comes through water.
    pub(super) wet: bool,
}

impl Setting<'_> {
    /// Light from a solid along a ray. The signature takes note of it.
    pub(super) fn shine(&self, matter: &Matter, arrival: &Arrival, signature: &mut Signature) -> Vec3 {
        match matter {
            Matter::Floor => {
                signature.meet(5);
                self.floor(arrival, signature)
            }
            Matter::Sponge(hit) => {
                signature.meet(6);
                match self.coat {
                    Coat::Skin => self.sponge(hit, arrival),
                    Coat::Map => {
                        let (wetness, normal) = facet(&self.stage.sponge, hit);
                        self.matt(colour_map(wetness), normal, arrival)
                    }
                }
            }
            Matter::Bead(hit) => {
                signature.meet(8);
                signature.tile(hit.index.wrapping_mul(0x9E37_79B1));
                let colour = self.beads.as_ref().map_or(Vec3::ONE, |beads| beads.colours[hit.index as usize]);
                let gloss = schlick(0.03, -arrival.direction.dot(hit.place)) * 0.4;
                let mirrored = room::light(reflect(arrival.direction, hit.place));
                self.matt(colour, hit.place, arrival) * (1.0 - gloss) + mirrored * gloss
            }
            Matter::Body(index, normal) => {
                signature.meet(7 + *index as u32);
                self.painted(*index, *normal, arrival)
            }
        }
    }

    fn sponge(&self, hit: &Hit<[f32; 2]>, arrival: &Arrival) -> Vec3 {
        let width = arrival.way * self.pixel;
        let film = covered(&self.stage.sponge, hit, &self.films).max(f32::from(u8::from(arrival.film)));
        let skin = skin(&self.stage.sponge, foam(), hit, arrival.direction, width, film);
        let (lit, wet) = self.ground.shadow(arrival.point);
        // The material scatters, so that light reaches around it.
        let wrap = ((skin.normal.dot(key_direction()) + 0.25) / 1.25).max(0.0);
        let reach = 0.1 * self.size;
        let near_floor = 0.65 + 0.35 * smooth(0.0, reach, arrival.point.y - self.ground.height);
        let key = KEY * (wrap * lit * (0.35 + 0.65 * skin.open)) * self.medium.left(wet);
        let around = hemisphere(skin.normal) * ((0.12 + 0.88 * skin.open) * near_floor);
        let half = (key_direction() - arrival.direction).normalize_or_zero();
        // A film in the open cells glints a little; it is too rough to mirror.
        let glint = 0.24 * lit * smooth(0.4, 0.9, skin.wet) * skin.open;
        let glint = glint * skin.normal.dot(half).max(0.0).powi(28);
        let inner = skin.albedo * (key + around * self.medium.left(0.8 * wet));
        if arrival.wet {
            return inner;
        }
        // A film over the cells is smooth, and fills pores in part.
        let sheet = (skin.outer + skin.normal * FILM_RELIEF).normalize_or(skin.outer);
        let share = film * schlick(0.02, -arrival.direction.dot(sheet)).min(FILM_MIRROR);
        let mirrored = room::light(reflect(arrival.direction, sheet)) * near_floor;
        let gleam = FILM_GLEAM * film * lit * sheet.dot(half).max(0.0).powi(120);
        inner * (1.0 - share) + mirrored * share + KEY * (glint + gleam)
    }

    /// A matt colour in the light that arrives.
    fn matt(&self, colour: Vec3, normal: Vec3, arrival: &Arrival) -> Vec3 {
        let (lit, wet) = self.ground.shadow(arrival.point);
        let key = KEY * (normal.dot(key_direction()).max(0.0) * lit) * self.medium.left(wet);
        colour * (key + hemisphere(normal) * self.medium.left(0.8 * wet))
    }

    /// Paint with a clear coat.
    fn painted(&self, index: usize, normal: Vec3, arrival: &Arrival) -> Vec3 {
        let body = self.body(index);
        if body.is_plane() {
            let ground = self.matt(body.own_colour().unwrap_or(FLOOR_COLOUR), normal, arrival);
            return ground.lerp(FAR, self.fade(arrival.point));
        }
        let diffuse = self.matt(body.colour(), normal, arrival);
        let mirrored = reflect(arrival.direction, normal);
        let dim = if mirrored.y < 0.0 { 0.72 } else { 0.9 };
        let share = schlick(0.04, -arrival.direction.dot(normal)) * if arrival.wet { 0.1 } else { 1.0 };
        diffuse * (1.0 - share) + room::light(mirrored) * (share * dim)
    }

    /// How much a place of the ground looks as it does far away, 0 to 1.
    fn fade(&self, point: Vec3) -> f32 {
        smooth(1.1 * self.size, 4.4 * self.size, (point - self.centre).length())
    }

    fn floor(&self, arrival: &Arrival, signature: &mut Signature) -> Vec3 {
        let (point, direction) = (arrival.point, arrival.direction);
        let fade = self.fade(point);
        let width = arrival.way * self.pixel / (-direction.y).max(0.05);
        let albedo = FLOOR_COLOUR * (1.0 + (self.tiles(point, width, signature) - 1.0) * (1.0 - fade));
        let arriving = self.ground.arriving(point);
        let wetness = arriving.w.max(f32::from(u8::from(arrival.wet))).min(1.0);
        let mut light = albedo * (1.0 - WET_FLOOR * wetness) * arriving.truncate();
        if wetness > 0.02 && !arrival.wet {
            let gloss = schlick(0.02, -direction.y) * 0.5 * wetness;
            light += room::light(reflect(direction, Vec3::Y)) * gloss;
        }
        light.lerp(FAR, fade)
    }

    /// Lightness of the tiles of the floor, 1 in the mean, where a pixel has a width (m).
    fn tiles(&self, point: Vec3, width: f32, signature: &mut Signature) -> f32 {
        let pitch = self.pitch;
        let clear = 1.0 - smooth(0.15, 0.6, width / pitch);
        if clear <= 0.0 {
            return 1.0;
        }
        let ((i, u), (j, v)) = (whole(point.x / pitch), whole(point.z / pitch));
        let [i, j] = [i.cast_unsigned(), j.cast_unsigned()];
        if clear > 0.2 {
            signature.tile(i.wrapping_mul(73_856_093) ^ j.wrapping_mul(19_349_663));
        }
        // From light to dark within a pixel, or a tile would jump from sample to sample.
        let firm = |t: f32| smooth(0.0, width / pitch, t.min(1.0 - t));
        let sign = if i.wrapping_add(j) & 1 == 0 { 0.1 } else { -0.1 };
        let check = 1.0 + sign * firm(u) * firm(v);
        let shade = 0.97 + 0.06 * unit(i.wrapping_mul(7919) ^ j.wrapping_mul(104_729));
        let joint = |t: f32| t.min(1.0 - t) * pitch;
        let half = 0.0175 * pitch;
        let blur = (0.5 * width).max(0.01 * pitch);
        let line = 1.0 - smooth(half, half + 2.0 * blur, joint(u).min(joint(v)));
        let line = line * (0.0225 * pitch / (0.0125 * pitch + blur)).min(1.0);
        1.0 + (check * shade * (1.0 - 0.35 * line) - 1.0) * clear
    }
}
