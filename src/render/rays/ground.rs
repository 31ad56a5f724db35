//! Light that arrives on the floor, and the heights of what it meets before, on square maps.
//!
//! A place of a map stands for the ray of light that would meet the floor there.

use super::room::{AMBIENT, KEY, key_direction};
use glam::{Vec3, Vec4};

/// The floor with its maps.
#[derive(Debug)]
pub(in crate::render) struct Ground {
    /// Height of the floor (m).
    pub(super) height: f32,
    /// Whether there is a floor to see.
    pub(super) is_seen: bool,
    /// Corner of the maps (m).
    pub(in crate::render) corner: Vec3,
    /// Texels along a side of the maps.
    pub(super) side: usize,
    /// Side of a texel (m).
    pub(in crate::render) texel: f32,
    /// Way along the light from the floor to the first solid (m); negative infinity for none.
    pub(super) solid: Vec<f32>,
    /// The same to the first water.
    pub(super) water: Vec<f32>,
    /// Light that arrives on the floor, and how wet it is, 0 to 1.
    pub(super) arriving: Vec<Vec4>,
}

impl Ground {
    /// Maps without anything on them, around a box of things (m).
    pub(in crate::render) fn new(
        (height, is_seen): (f32, bool),
        side: usize,
        (low, high): (Vec3, Vec3),
    ) -> Self {
        let size = high - low;
        let half = 0.5 * size.x.max(size.z) + 0.33 * size.y;
        // Shadows fall away from the light.
        let centre = (low + high) * 0.5 + Vec3::new(0.16, 0.0, -0.13) * size.y;
        let count = side * side;
        Self {
            height,
            is_seen,
            corner: Vec3::new(centre.x - half, height, centre.z - half),
            side,
            texel: 2.0 * half / side as f32,
            solid: vec![f32::NEG_INFINITY; count],
            water: vec![f32::NEG_INFINITY; count],
            arriving: Vec::new(),
        }
    }

    /// Middle of a texel on the floor.
    pub(super) fn place(&self, x: usize, y: usize) -> Vec3 {
        self.corner + Vec3::new(x as f32 + 0.5, 0.0, y as f32 + 0.5) * self.texel
    }

    /// The first of the four texels around a point of the floor, and the place between them; nothing outside of the maps.
    pub(super) fn texels(&self, point: Vec3) -> Option<(usize, f32, f32)> {
        let at = (point - self.corner) / self.texel - 0.5;
        let last = self.side as f32 - 1.0;
        if !(at.x >= 0.0 && at.z >= 0.0 && at.x < last && at.z < last) {
            return None;
        }
        let (x, y) = (at.x as usize, at.z as usize);
        Some((y * self.side + x, at.x - x as f32, at.z - y as f32))
    }

    /// Light on the floor at a point, and how wet it is.
    pub(super) fn arriving(&self, point: Vec3) -> Vec4 {
        let map = &self.arriving;
        let inside = self.texels(point).filter(|_| !map.is_empty());
        let Some((k, fx, fy)) = inside else {
            return (KEY * key_direction().y + AMBIENT).extend(0.0);
        };
        let row = |k: usize| map[k] * (1.0 - fx) + map[k + 1] * fx;
        row(k) * (1.0 - fy) + row(k + self.side) * fy
    }

    /// Share of the key light that solids let through to a point, and the length of its way in the water (m).
    pub(super) fn shadow(&self, point: Vec3) -> (f32, f32) {
        let light = key_direction();
        let rise = (point.y - self.height) / light.y;
        let at = (point - light * rise - self.corner) / self.texel - 1.5;
        let last = self.side as f32 - 5.0;
        if !(at.x >= 0.0 && at.z >= 0.0 && at.x <= last && at.z <= last) {
            return (1.0, 0.0);
        }
        let (x, y) = (at.x as usize, at.z as usize);
        let weights = |f: f32| [1.0 - f, 1.0, 1.0, f];
        let (across, along) = (weights(at.x - x as f32), weights(at.z - y as f32));
        let edge = rise + 2.6 * self.texel;
        let (mut lit, mut wet) = (0.0, 0.0);
        for (j, along) in along.into_iter().enumerate() {
            let row = (y + j) * self.side + x;
            for (i, across) in across.into_iter().enumerate() {
                let weight = across * along;
                if self.solid[row + i] < edge {
                    lit += weight;
                }
                wet += weight * (self.water[row + i] - rise).max(0.0);
            }
        }
        (lit / 9.0, wet / 9.0)
    }
}
