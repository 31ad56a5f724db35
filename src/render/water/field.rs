//! Values, normals and crossings of the density of the water.

use super::bricks::{BRICK, Bricks, Content};
use super::grid::Grid;
use glam::Vec3;

/// Longest change of the value over a spacing, inverted: how far a ray may step from a value, in spacings.
const SAFE: f32 = 1.3;
/// Steps of regula falsi after a change of sign.
const ROUNDS: usize = 3;

/// The density of the water less the level of the surface: positive inside.
#[derive(Debug)]
pub(in crate::render) struct Field {
    pub(super) grid: Grid,
    pub(super) values: Vec<f32>,
    pub(super) bricks: Bricks,
    /// Distance of particles (m).
    pub(in crate::render) spacing: f32,
}

impl Field {
    /// Side of the shortest cell (m).
    pub(in crate::render) fn cell(&self) -> f32 {
        self.grid.cell.min_element()
    }

    /// The first of the eight nodes around a point, and the place between them, 0 to 1.
    fn locate(&self, point: Vec3) -> (usize, Vec3) {
        self.nodes((point - self.grid.origin) * self.grid.inverse)
    }

    /// The same for a place in cells.
    #[inline]
    fn nodes(&self, place: Vec3) -> (usize, Vec3) {
        let [nx, ny, nz] = self.grid.sides;
        let last = Vec3::new(nx as f32 - 2.01, ny as f32 - 2.01, nz as f32 - 2.01);
        let place = place.max(Vec3::ONE).min(last);
        let (x, y, z) = (place.x as i32, place.y as i32, place.z as i32);
        let whole = Vec3::new(x as f32, y as f32, z as f32);
        ((z as usize * ny + y as usize) * nx + x as usize, place - whole)
    }

    /// The value at a point, linear between nodes.
    pub(in crate::render) fn value(&self, point: Vec3) -> f32 {
        self.between(self.locate(point))
    }

    /// The value between eight nodes.
    #[inline]
    fn between(&self, (at, f): (usize, Vec3)) -> f32 {
        let (nx, layer) = (self.grid.sides[0], self.grid.layer());
        let nodes = &self.values[at..at + layer + nx + 2];
        let row = |i: usize| nodes[i] + (nodes[i + 1] - nodes[i]) * f.x;
        let (a, b, c, d) = (row(0), row(nx), row(layer), row(layer + nx));
        let (near, far) = (a + (b - a) * f.y, c + (d - c) * f.y);
        near + (far - near) * f.z
    }

    /// Outward normal: central differences at the corners of the cell, linear between them, so that it is continuous.
    pub(in crate::render) fn normal(&self, point: Vec3) -> Vec3 {
        let (at, f) = self.locate(point);
        let (nx, layer) = (self.grid.sides[0], self.grid.layer());
        let values = &self.values;
        let mut sum = Vec3::ZERO;
        for corner in 0..8 {
            let index = at + (corner & 1) + (corner >> 1 & 1) * nx + (corner >> 2) * layer;
            let weight = |bit: usize, f: f32| if corner & bit == 0 { 1.0 - f } else { f };
            let weight = weight(1, f.x) * weight(2, f.y) * weight(4, f.z);
            let (low, high) = (index.max(layer), index.min(values.len() - layer - 1));
            sum += Vec3::new(
                values[high + 1] - values[low - 1],
                values[high + nx] - values[low - nx],
                values[high + layer] - values[low - layer],
            ) * weight;
        }
        -(sum * self.grid.inverse).normalize_or(Vec3::NEG_Y)
    }

    /// Where a ray first leaves the water (`inside`) or enters it, between two distances.
    pub(in crate::render) fn march(
        &self,
        origin: Vec3,
        direction: Vec3,
        (from, to): (f32, f32),
        inside: bool,
    ) -> Option<f32> {
        let scale = self.grid.inverse / BRICK as f32;
        let start = (origin - self.grid.origin) * scale;
        let slope = direction * scale;
        let inverse = slope.to_array().map(|s| if s.abs() < 1e-12 { 1e-12_f32.copysign(s) } else { s });
        let inverse = Vec3::from(inverse).recip();
        let [nx, ny, nz] = self.grid.sides.map(|nodes| (nodes as f32 - 1.0) / BRICK as f32);
        let (a, b) = (-start * inverse, (Vec3::new(nx, ny, nz) - start) * inverse);
        let mut t = a.min(b).max_element().max(from);
        let to = a.max(b).min_element().min(to);
        let own = if inside { Content::Water } else { Content::Air };
        let nudge = 0.0135 * self.cell();
        while t < to {
            // Places are not negative, but for rounding.
            let brick = (start + slope * t).to_array().map(|place| place.max(0.0) as i32);
            let place: [usize; 3] =
                std::array::from_fn(|axis| (brick[axis] as usize).min(self.bricks.sides[axis] - 1));
            let (content, skip) = self.bricks.at(place);
            let skip = f32::from(skip);
            let leave = |axis: usize| {
                let low = place[axis] as f32;
                let far = if inverse[axis] > 0.0 { low + skip } else { low + 1.0 - skip };
                (far - start[axis]) * inverse[axis]
            };
            let exit = leave(0).min(leave(1)).min(leave(2)).max(t) + nudge;
            if content == own {
                t = exit;
                continue;
            }
            if content != Content::Surface {
                return Some(t);
            }
            match self.cross(origin, direction, (t, exit.min(to)), inside) {
                Some(found) => return Some(found),
                None => t = exit.min(to),
            }
        }
        None
    }

    /// The first change of sign between two distances, in steps that follow the value.
    fn cross(&self, origin: Vec3, direction: Vec3, (mut t, end): (f32, f32), inside: bool) -> Option<f32> {
        let side = if inside { 1.0 } else { -1.0 };
        let (start, slope) = ((origin - self.grid.origin) * self.grid.inverse, direction * self.grid.inverse);
        let value = |t: f32| self.between(self.nodes(start + slope * t)) * side;
        let least = 0.9 * self.cell();
        // Rays start within rounding of the surface.
        let mut here = value(t).max(1e-6);
        while t < end {
            let next = (t + (here * SAFE * self.spacing).max(least)).min(end);
            let there = value(next);
            if there < 0.0 {
                let (mut a, mut b, mut va, mut vb) = (t, next, here, there);
                for _ in 0..ROUNDS {
                    let middle = a + (b - a) * (va / (va - vb)).clamp(0.05, 0.95);
                    let v = value(middle);
                    if v < 0.0 {
                        (b, vb) = (middle, v);
                    } else {
                        (a, va) = (middle, v);
                    }
                }
                return Some(a + (b - a) * (va / (va - vb)));
            }
            (t, here) = (next, there);
        }
        None
    }
}
