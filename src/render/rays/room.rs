//! The surroundings: a room with windows, and the light that comes from them.

use crate::render::{colour::smooth, number::whole};
use glam::Vec3;

/// Light from the brightest window.
pub(super) const KEY: Vec3 = Vec3::new(1.155, 1.075, 0.945);
/// Tangent of half the angle of that window.
pub(super) const LAMP: f32 = 0.07;
/// Light from everywhere else, on the floor.
pub(super) const AMBIENT: Vec3 = Vec3::new(0.44, 0.47, 0.51);
/// The floor far away.
pub(super) const FAR: Vec3 = Vec3::new(0.74, 0.755, 0.78);
/// Half sides of the room and its height; only directions matter.
const HALF: Vec3 = Vec3::new(2.2, 1.9, 2.2);

#[cfg(feature = "gpu")]
shared_with_shaders!(ROOM: KEY, LAMP, AMBIENT, FAR, HALF);

/// Towards the brightest window.
pub(in crate::render) fn key_direction() -> Vec3 {
    Vec3::new(-0.42, 1.0, 0.36).normalize()
}

/// Light that reaches a surface from above and below.
pub(super) fn hemisphere(normal: Vec3) -> Vec3 {
    Vec3::new(0.40, 0.38, 0.36).lerp(Vec3::new(0.62, 0.66, 0.72), 0.5 + 0.5 * normal.y)
}

/// Light from a direction.
pub(super) fn light(direction: Vec3) -> Vec3 {
    if direction.y < 0.0 {
        let floor = Vec3::new(0.60, 0.59, 0.58);
        return floor.lerp(Vec3::new(0.74, 0.75, 0.77), smooth(0.0, 0.35, -direction.y));
    }
    let place = direction * (HALF / direction.abs().max(Vec3::splat(1e-5))).min_element();
    if place.y > HALF.y - 0.01 {
        return Vec3::new(0.74, 0.745, 0.75);
    }
    let wall = Vec3::new(0.42, 0.43, 0.45).lerp(Vec3::new(0.62, 0.63, 0.66), place.y / HALF.y);
    let (along, has_windows) =
        if direction.x.abs() > direction.z.abs() { (place.z, direction.x < 0.0) } else { (place.x, true) };
    if !has_windows {
        return wall;
    }
    // Two rows of three panes. They end high above the floor, or flat water would mirror nothing but white.
    let pane = |x: f32, pitch: f32, frame: f32| {
        let cell = whole(x / pitch).1 - 0.5;
        smooth(-0.03, 0.07, 0.5 * pitch - frame - cell.abs() * pitch)
    };
    let inside = smooth(0.0, 0.15, 1.5 - along.abs())
        * smooth(0.0, 0.35, place.y - 0.74)
        * smooth(0.0, 0.2, 1.86 - place.y);
    let glow = inside * pane(along + 0.48, 0.96, 0.04) * pane(place.y - 0.86, 0.48, 0.03);
    wall * (1.0 - 0.5 * inside) + Vec3::new(2.0, 2.2, 2.4) * (glow * (0.7 + 0.3 * place.y))
}

/// Light of the background: the room, or the floor far away below the horizon.
pub(super) fn background(direction: Vec3) -> Vec3 {
    FAR.lerp(light(direction), smooth(0.0, 0.3, direction.y))
}
