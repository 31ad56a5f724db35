//! Light from the brightest window on its way to the floor: shadows, tinted by the water, and caustics.
//!
//! A photon is aimed at every texel of the floor, so that open floor is exactly as bright as without anything in the way.

use super::ground::Ground;
use super::optics::{INDEX, reflect, refract};
use super::path::tint;
use super::room::{AMBIENT, KEY, LAMP, key_direction};
use super::setting::{Event, Face, Matter, Setting, boxed};
use crate::render::bands;
use glam::Vec3;

/// Most events of a photon.
const EVENTS: usize = 6;
/// Brightest place, over open floor.
const BRIGHTEST: f32 = 4.0;

#[cfg(feature = "gpu")]
shared_with_shaders!(PHOTONS: EVENTS, BRIGHTEST);

/// Where a photon ends.
#[derive(Clone, Copy, Debug)]
struct Landing {
    /// Place on the floor, and the share of the light that is left.
    floor: Option<(Vec3, Vec3)>,
    /// Ways along the light from the floor to the first solid and the first water (m).
    solid: f32,
    water: f32,
}

/// Light that came straight.
const OPEN: Landing = Landing { floor: None, solid: f32::NEG_INFINITY, water: f32::NEG_INFINITY };

impl Setting<'_> {
    /// Fills the maps of the ground.
    pub(super) fn light_up(&mut self) {
        let side = self.ground.side;
        let landings = self.landings();
        let mut light = vec![Vec3::ZERO; side * side];
        for (index, landing) in landings.into_iter().enumerate() {
            self.ground.solid[index] = landing.solid;
            self.ground.water[index] = landing.water;
            let Some((place, share)) = landing.floor else { continue };
            if let Some((k, fx, fy)) = self.ground.texels(place) {
                light[k] += share * ((1.0 - fx) * (1.0 - fy));
                light[k + 1] += share * (fx * (1.0 - fy));
                light[k + side] += share * ((1.0 - fx) * fy);
                light[k + side + 1] += share * (fx * fy);
            }
        }
        even_out(&mut light, side);
        let (contact, wetness) = bands::both(|| self.contact(), || self.wetness());
        let height = key_direction().y;
        let arriving = |index: usize| {
            let (x, y) = (index % side, index / side);
            let at_border = x < 3 || y < 3 || x + 3 >= side || y + 3 >= side;
            let key = if at_border { Vec3::ONE } else { light[index].min(Vec3::splat(BRIGHTEST)) };
            let way = if at_border { 0.0 } else { mean_water(&self.ground, index) };
            let under = self.stage.container.is_some_and(|(low, high)| {
                let place = self.ground.place(x, y);
                place.x > low.x && place.x < high.x && place.z > low.z && place.z < high.z
            });
            let around =
                self.medium.left(way * if under { 0.8 } else { 0.35 }) / (1.0 + contact[index].min(1.6));
            (KEY * height * key + AMBIENT * around).extend(wetness[index].min(1.0))
        };
        let rows = bands::map(side, |y| (y * side..(y + 1) * side).map(arriving).collect::<Vec<_>>());
        self.ground.arriving = rows.into_iter().flatten().collect();
    }

    /// What happens to the photon of every texel.
    fn landings(&self) -> Vec<Landing> {
        let (stage, side) = (self.stage, self.ground.side);
        // Only what can hold the light up: water, sponges and bodies.
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let mut grow = |centre: Vec3, reach: f32| {
            low = low.min(centre - reach);
            high = high.max(centre + reach);
        };
        stage.particles.iter().for_each(|(_, place)| grow(*place, 4.0 * stage.radius));
        for (_, corners) in &stage.sponge.triangles {
            corners.iter().for_each(|node| grow(stage.sponge.positions[*node], 0.0));
        }
        stage.solids.iter().filter(|body| !body.is_plane()).for_each(|body| grow(body.position, body.radius));
        let light = key_direction();
        let reach = (high.y.max(self.ground.height) - self.ground.height + 0.01 * self.size) / light.y;
        let across = Vec3::Y.cross(light).normalize();
        let along = light.cross(across);
        let rows = bands::map(side, |y| {
            let row = (0..side).map(|x| {
                // Nine directions over the window, one for each texel of a block of 3 by 3.
                let [i, j] = [x, y].map(|place| (place % 3) as f32 - 1.0);
                let towards = (light + (across * i + along * j) * (0.8 * LAMP)).normalize();
                let place = self.ground.place(x, y);
                if low.x > high.x || boxed(low, high, place, towards).is_none() {
                    return Landing { floor: Some((place, Vec3::ONE)), ..OPEN };
                }
                self.photon(place, towards, reach * light.y / towards.y)
            });
            row.collect::<Vec<_>>()
        });
        rows.into_iter().flatten().collect()
    }

    /// Light that would meet the floor at a place without obstacles.
    fn photon(&self, place: Vec3, towards: Vec3, reach: f32) -> Landing {
        let (mut origin, mut direction) = (place + towards * reach, -towards);
        let (mut share, mut wet, mut straight) = (Vec3::ONE, false, true);
        let mut landing = OPEN;
        let rise = |point: Vec3| (point.y - self.ground.height) / towards.y;
        for _ in 0..EVENTS {
            let (event, _) = self.next(origin, direction, wet);
            let length = event.distance();
            if length.is_finite() && wet {
                share *= self.medium.left(length);
            }
            let point = origin + direction * if length.is_finite() { length } else { 0.0 };
            match event {
                Event::Nothing => return landing,
                Event::Matter(_, Matter::Floor, _) => {
                    landing.floor = Some((point, share));
                    return landing;
                }
                Event::Matter(..) => {
                    if straight {
                        landing.solid = rise(point);
                    } else if let Some(hit) = self.tree.hit(place + towards * reach, -towards, reach) {
                        landing.solid = reach - hit.distance;
                    }
                    return landing;
                }
                Event::Clear(index, span) => {
                    if let Some((distance, matter)) =
                        self.solid(point + direction * 1e-5, direction, span.exit - length)
                        && !matches!(matter, Matter::Floor)
                    {
                        if straight {
                            landing.solid = rise(point + direction * distance);
                        }
                        return landing;
                    }
                    if !span.exit.is_finite() {
                        return landing;
                    }
                    share *= tint(self.body(index)) * if self.is_wire(index) { 1.0 } else { 0.86 };
                    origin += direction * (span.exit + 1e-5);
                    wet = self.is_wet(origin + direction * 2e-4);
                }
                Event::Surface(_, Face { normal, strength, .. }) => {
                    if straight && !wet {
                        landing.water = rise(point);
                    }
                    straight = false;
                    let ratio = if wet { INDEX } else { 1.0 / INDEX };
                    if let Some((refracted, mirrored)) = refract(direction, normal, ratio) {
                        share *= 1.0 - mirrored * strength;
                        direction = direction.lerp(refracted, strength).normalize();
                        (origin, wet) = (point - normal * self.nudge, !wet);
                    } else {
                        (direction, origin) = (reflect(direction, normal), point + normal * self.nudge);
                    }
                }
            }
        }
        landing
    }

    /// How much ambient light things near the floor take away.
    fn contact(&self) -> Vec<f32> {
        let (stage, height) = (self.stage, self.ground.height);
        let mut map = vec![0.0; self.ground.side * self.ground.side];
        let reach = 0.1 * self.size;
        let mut seen = vec![false; stage.sponge.positions.len()];
        for node in stage.sponge.triangles.iter().flat_map(|(_, corners)| *corners) {
            let place = stage.sponge.positions[node];
            let gap = place.y - height;
            if !seen[node] && gap < reach {
                splat(&self.ground, &mut map, place, reach, 0.13 * (1.0 - gap.max(0.0) / reach));
            }
            seen[node] = true;
        }
        for body in stage.solids.iter().filter(|body| !body.is_plane()) {
            let gap = (body.position.y - height).max(0.5 * body.radius);
            let share = body.radius / gap;
            splat(&self.ground, &mut map, body.position, (2.2 * gap).min(self.size), 0.45 * share * share);
        }
        map
    }

    /// How wet the floor is below the lowest water.
    fn wetness(&self) -> Vec<f32> {
        let mut map = vec![0.0; self.ground.side * self.ground.side];
        let spacing = 2.0 * self.stage.radius;
        for ((_, place), free) in self.stage.particles.iter().zip(&self.stage.free) {
            if *free > 0.5 && place.y - self.ground.height < 1.3 * spacing {
                splat(&self.ground, &mut map, *place, 1.5 * spacing, 1.2);
            }
        }
        map
    }
}

/// Adds a round hill to a map.
fn splat(ground: &Ground, map: &mut [f32], place: Vec3, radius: f32, height: f32) {
    let side = ground.side;
    let (at, reach) = ((place - ground.corner) / ground.texel, radius / ground.texel);
    let range = |centre: f32| {
        let first = ((centre - reach).max(0.0) as usize).min(side);
        first..((centre + reach).max(0.0) as usize + 1).min(side)
    };
    let scale = 1.0 / (reach * reach);
    for y in range(at.z) {
        for x in range(at.x) {
            let (dx, dy) = (x as f32 + 0.5 - at.x, y as f32 + 0.5 - at.z);
            let share = 1.0 - (dx * dx + dy * dy) * scale;
            if share > 0.0 {
                map[y * side + x] += height * share * share;
            }
        }
    }
}

/// Mean over blocks of 3 by 3, which see all directions over the window; once more, to hide the pattern.
fn even_out(light: &mut [Vec3], side: usize) {
    for _ in 0..2 {
        let mut rows = light.to_vec();
        for k in 1..light.len() - 1 {
            rows[k] = (light[k - 1] + light[k] + light[k + 1]) / 3.0;
        }
        for k in side..light.len() - side {
            light[k] = (rows[k - side] + rows[k] + rows[k + side]) / 3.0;
        }
    }
}

/// Mean way to the first water over a block of 3 by 3 (m).
fn mean_water(ground: &Ground, index: usize) -> f32 {
    let side = ground.side;
    let row = |k: usize| ground.water[k - 1..k + 2].iter().map(|way| way.max(0.0)).sum::<f32>();
    (row(index - side) + row(index) + row(index + side)) / 9.0
}
