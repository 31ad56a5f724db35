//! Colour of the item that a sample sees.

use super::colour::{smooth, unit};
use super::layer::Item;
use super::light;
use super::pores::{self, Patch};
use super::stage::{Floor, Stage};
use super::visibility::Light;
use glam::Vec3;

pub(super) const KEY: Vec3 = Vec3::new(1.38, 1.27, 1.10);
pub(super) const SKY: Vec3 = Vec3::new(0.40, 0.47, 0.57);
const BOUNCE: Vec3 = Vec3::new(0.22, 0.20, 0.18);
const DRY: Vec3 = Vec3::new(0.90, 0.58, 0.13);
const WET: Vec3 = Vec3::new(0.34, 0.135, 0.012);
const DEEP: Vec3 = Vec3::new(0.020, 0.125, 0.36);
pub(super) const FOAM: Vec3 = Vec3::new(0.66, 0.83, 0.93);
const BODIES: [Vec3; 6] = [
    Vec3::new(0.54, 0.05, 0.032),
    Vec3::new(0.10, 0.33, 0.24),
    Vec3::new(0.19, 0.09, 0.34),
    Vec3::new(0.62, 0.25, 0.04),
    Vec3::new(0.10, 0.12, 0.16),
    Vec3::new(0.55, 0.52, 0.46),
];

/// Optical properties of a surface.
pub(super) struct Matter {
    pub(super) colour: Vec3,
    pub(super) normal: Vec3,
    /// Strength and exponent of the highlight.
    pub(super) gloss: (f32, i32),
    /// Share of the sky that it reflects at grazing angles.
    pub(super) mirror: f32,
}

/// Light from the sky in a direction.
pub(super) fn sky(direction: Vec3) -> Vec3 {
    let rise = direction.normalize_or_zero().y;
    let horizon = Vec3::new(0.76, 0.80, 0.83);
    let zenith = Vec3::new(0.26, 0.42, 0.66);
    let below = Vec3::new(0.60, 0.635, 0.665);
    if rise < 0.0 {
        horizon.lerp(below, smooth(0.0, 0.7, -rise))
    } else {
        horizon.lerp(zenith, smooth(0.0, 0.9, rise))
    }
}

/// Outward unit normal of what is seen at `point`.
pub(super) fn normal(stage: &Stage<'_>, item: Item, point: Vec3, ray: Vec3) -> Vec3 {
    match item {
        Item::Nothing | Item::Floor => Vec3::Y,
        Item::Particle(i) => (point - stage.particles[i].1) / stage.radius,
        Item::Triangle(i) => {
            let corners = stage.sponge.triangles[i].1;
            let [u, v, w] = barycentric(corners.map(|c| stage.sponge.positions[c]), point);
            let [a, b, c] = corners.map(|c| stage.sponge.normals[c]);
            let normal = (a * u + b * v + c * w).normalize_or(-ray.normalize());
            if normal.dot(ray) > 0.35 * ray.length() { -normal } else { normal }
        }
        Item::Body(i) => stage.solids[i].span(stage.raster.eye, ray).map_or(Vec3::Y, |span| span.normal),
    }
}

/// Colour of `item` at `point`, seen along `ray`, in linear light.
pub(super) fn colour(stage: &Stage<'_>, item: Item, point: Vec3, ray: Vec3, light: Light) -> Vec3 {
    if item == Item::Nothing {
        return sky(ray);
    }
    let base = normal(stage, item, point, ray);
    let matter = match item {
        Item::Particle(i) => droplet(stage, stage.particles[i].0, base),
        Item::Triangle(i) => skin(stage, i, point, base),
        Item::Body(i) => {
            let solid = &stage.solids[i];
            if solid.is_plane() {
                ground(Vec3::splat(0.51), base)
            } else {
                paint(solid.index, solid.mark(point), base)
            }
        }
        Item::Floor | Item::Nothing => match &stage.floor {
            Some(floor) => {
                ground(tiles(floor, point, stage.raster.focal / (point - stage.raster.eye).length()), base)
            }
            None => ground(Vec3::splat(0.51), base),
        },
    };
    let lit = answer(&matter, ray, light);
    let endless = match item {
        Item::Floor => true,
        Item::Body(i) => stage.solids[i].is_plane(),
        _ => false,
    };
    if endless {
        let fade = smooth(stage.fade_start(), stage.fade_end(), point.distance(stage.centre));
        return lit.lerp(sky(ray), fade);
    }
    lit
}

/// Light that a surface reflects along `ray`.
pub(super) fn answer(matter: &Matter, ray: Vec3, light: Light) -> Vec3 {
    let (normal, view, towards) = (matter.normal, -ray.normalize_or_zero(), light::direction());
    let hemisphere = BOUNCE.lerp(SKY, 0.5 + 0.5 * normal.y) * light.sky;
    let key = KEY * (normal.dot(towards).max(0.0) * light.key);
    // A little light from the eye keeps shapes visible in the shadow.
    let front = Vec3::splat(0.10 * normal.dot(view).max(0.0) * light.sky);
    let mut result = matter.colour * (hemisphere + key + front);
    let half = (view + towards).normalize_or_zero();
    let (strength, tightness) = matter.gloss;
    result += KEY * (strength * light.key * normal.dot(half).max(0.0).powi(tightness));
    if matter.mirror > 0.0 {
        let facing = normal.dot(view).clamp(0.0, 1.0);
        let fresnel = 0.03 + 0.97 * (1.0 - facing).powi(5);
        let mirrored = sky(-view + normal * (2.0 * normal.dot(view)));
        result = result.lerp(mirrored, fresnel * matter.mirror * light.sky);
    }
    result
}

fn droplet(stage: &Stage<'_>, particle: usize, normal: Vec3) -> Matter {
    let speed = stage.speed(particle);
    let colour =
        DEEP.lerp(Vec3::new(0.07, 0.33, 0.62), smooth(0.0, 0.5, speed)).lerp(FOAM, smooth(0.35, 1.0, speed));
    // Light that entered on the lit side leaves on the far side, as in a real drop.
    let through = (-normal.dot(light::direction())).max(0.0);
    Matter { colour: colour * (1.0 + 0.9 * through), normal, gloss: (0.8, 56), mirror: 0.6 }
}

fn paint(index: usize, mark: f32, normal: Vec3) -> Matter {
    let colour = BODIES[index % BODIES.len()];
    let colour = if mark > 1.0 { colour.lerp(Vec3::splat(0.85), 0.75) } else { colour };
    Matter { colour, normal, gloss: (0.22, 40), mirror: 0.35 }
}

fn ground(colour: Vec3, normal: Vec3) -> Matter {
    Matter { colour, normal, gloss: (0.0, 1), mirror: 0.0 }
}

/// The squares and grid lines of the floor, averaged where they become smaller than a pixel (`scale` samples per metre).
fn tiles(floor: &Floor, point: Vec3, scale: f32) -> Vec3 {
    let base = Vec3::new(0.50, 0.51, 0.52);
    let inside = point.x >= floor.low.x
        && point.x <= floor.high.x
        && point.z >= floor.low.z
        && point.z <= floor.high.z;
    if !inside {
        return base;
    }
    let (u, v) = ((point.x - floor.low.x) / floor.pitch, (point.z - floor.low.z) / floor.pitch);
    let odd = (u.floor() + v.floor()).rem_euclid(2.0) > 0.5;
    let clear = smooth(2.0, 10.0, floor.pitch * scale);
    let check = if odd { 1.05 } else { 0.95 };
    let edge = |t: f32| (t - t.round()).abs() * floor.pitch * scale;
    let width = (0.012 * floor.pitch * scale).max(0.8);
    let line = 1.0 - smooth(width * 0.6, width * 1.6, edge(u).min(edge(v)));
    base * (1.0 + (check - 1.0) * clear) * (1.0 - 0.16 * line * clear)
}

fn skin(stage: &Stage<'_>, triangle: usize, point: Vec3, normal: Vec3) -> Matter {
    let sponge = &stage.sponge;
    let (index, corners) = sponge.triangles[triangle];
    let positions = corners.map(|c| sponge.positions[c]);
    let at = barycentric(positions, point);
    let [u, v, w] = at;
    let [a, b, c] = corners.map(|c| sponge.wetness[c]);
    let wet = a * u + b * v + c * w;
    #[expect(clippy::cast_possible_truncation, reason = "a key for a hash; the low bits are enough")]
    let patch = Patch { corners: positions, nodes: corners.map(|c| c as u32), key: index as u32 };
    let side = (positions[1] - positions[0]).length() + (positions[2] - positions[0]).length();
    let samples = 0.5 * side * stage.raster.focal / (point - stage.raster.eye).length();
    let pit = pores::pit(&patch, at, sponge.pores, 2.0 / samples.max(1e-3));
    let shades = patch.nodes.map(|key| unit(key ^ 0x51ed_270b));
    let tint = 0.93 + 0.14 * (shades[0] * u + shades[1] * v + shades[2] * w);
    // Pores are darker and redder by multiple scattering.
    let depth = 1.0 - pit.openness;
    let stain = Vec3::new(1.0 - 0.72 * depth, 1.0 - 0.86 * depth, 1.0 - 0.93 * depth);
    let colour = DRY.lerp(WET, smooth(0.0, 1.0, wet)) * tint * stain;
    let gloss = (0.16 * smooth(0.35, 1.0, wet) * pit.openness, 24);
    Matter { colour, normal: (normal + pit.tilt).normalize_or(normal), gloss, mirror: 0.0 }
}

/// Barycentric coordinates of a point in the plane of a triangle.
fn barycentric([a, b, c]: [Vec3; 3], point: Vec3) -> [f32; 3] {
    let (ab, ac, ap) = (b - a, c - a, point - a);
    let normal = ab.cross(ac);
    let area = normal.length_squared();
    if area <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let v = (ap.cross(ac).dot(normal) / area).clamp(0.0, 1.0);
    let w = (ab.cross(ap).dot(normal) / area).clamp(0.0, 1.0 - v);
    [1.0 - v - w, v, w]
}

/// Colour and opacity of a translucent body where a ray meets it.
pub(super) fn glass(stage: &Stage<'_>, solid: usize, ray: Vec3, depth: f32) -> Option<(Vec3, f32)> {
    let (raster, solid) = (&stage.raster, &stage.solids[solid]);
    let span = solid.span(raster.eye, ray).filter(|span| span.enter > raster.near && span.enter < depth)?;
    let tint = BODIES[solid.index % BODIES.len()].lerp(Vec3::splat(0.75), 0.72);
    let clear = Light::clear();
    let matter = Matter { colour: tint, normal: span.normal, gloss: (0.3, 60), mirror: 0.6 };
    let facing = span.normal.dot(-ray.normalize_or_zero()).clamp(0.0, 1.0);
    let rim = |t: f32| {
        let width = (0.004 * stage.size).max(1.6 * t / raster.focal);
        1.0 - smooth(0.4 * width, width, solid.edge_distance(raster.eye + ray * t))
    };
    let near_rim = rim(span.enter);
    let far_rim = if span.exit < depth { 0.45 * rim(span.exit) } else { 0.0 };
    let opacity = 0.20 + 0.30 * (1.0 - facing).powi(3) + 0.45 * near_rim.max(far_rim);
    Some((answer(&matter, ray, clear), opacity.min(0.9)))
}
