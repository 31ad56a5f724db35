//! Values, normals and crossings of the density of the water.

use super::bricks::{BRICK, Bricks, Content};
use super::grid::Grid;
use crate::render::number::{greater, lesser};
use glam::Vec3;

/// Longest change of the value over a spacing, inverted: how far a ray may step from a value, in spacings.
const SAFE: f32 = 1.3;
/// Steps of regula falsi after a change of sign.
const ROUNDS: usize = 3;

#[cfg(feature = "gpu")]
shared_with_shaders!(FIELD: SAFE, ROUNDS);

/// The density of the water less the level of the surface: positive inside.
#[derive(Debug)]
pub(in crate::render) struct Field {
    pub(super) grid: Grid,
    pub(super) values: Vec<f32>,
    bricks: Bricks,
    /// Distance of particles (m).
    pub(in crate::render) spacing: f32,
    /// The last place with eight nodes around it, in cells.
    last: [f32; 3],
}

impl Field {
    /// The field of values on the nodes of a grid.
    pub(super) fn new(grid: Grid, values: Vec<f32>, spacing: f32) -> Self {
        let bricks = Bricks::new(&grid, &values);
        Self { grid, values, bricks, spacing, last: grid.sides.map(|nodes| nodes as f32 - 2.01) }
    }

    /// The values on all nodes.
    #[cfg(all(test, feature = "gpu", feature = "serde"))]
    pub(in crate::render) fn into_values(self) -> Vec<f32> {
        self.values
    }

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
        let [nx, ny, _] = self.grid.sides;
        let inside = |axis: usize| lesser(greater(place[axis], 1.0), self.last[axis]);
        let place = [inside(0), inside(1), inside(2)];
        let whole = place.map(|place| place as i32);
        let rest = |axis: usize| place[axis] - whole[axis] as f32;
        let [x, y, z] = whole.map(|whole| whole as usize);
        ((z * ny + y) * nx + x, Vec3::new(rest(0), rest(1), rest(2)))
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
        let row = |i: usize| {
            let pair = &nodes[i..i + 2];
            pair[0] + (pair[1] - pair[0]) * f.x
        };
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
        let start = ((origin - self.grid.origin) * scale).to_array();
        let slope = (direction * scale).to_array();
        let inverse = slope.map(|s| 1.0 / if s.abs() < 1e-12 { 1e-12_f32.copysign(s) } else { s });
        let (mut t, mut to) = (from, to);
        for axis in 0..3 {
            let side = (self.grid.sides[axis] as f32 - 1.0) / BRICK as f32;
            let (a, b) = (-start[axis] * inverse[axis], (side - start[axis]) * inverse[axis]);
            t = greater(t, lesser(a, b));
            to = lesser(to, greater(a, b));
        }
        let own = if inside { Content::Water } else { Content::Air };
        let nudge = 0.0135 * self.cell();
        // The value where the last brick was left.
        let mut here = None;
        while t < to {
            // Places are not negative, but for rounding.
            let brick = |axis: usize| {
                let place = greater(start[axis] + slope[axis] * t, 0.0) as i32;
                (place as usize).min(self.bricks.sides[axis] - 1)
            };
            let place = [brick(0), brick(1), brick(2)];
            let (content, skip) = self.bricks.at(place);
            let skip = f32::from(skip);
            let leave = |axis: usize| {
                let low = place[axis] as f32;
                let far = if inverse[axis] > 0.0 { low + skip } else { low + 1.0 - skip };
                (far - start[axis]) * inverse[axis]
            };
            let exit = greater(lesser(lesser(leave(0), leave(1)), leave(2)), t) + nudge;
            if content == own {
                (t, here) = (exit, None);
                continue;
            }
            if content != Content::Surface {
                return Some(t);
            }
            let end = lesser(exit, to);
            match self.cross(origin, direction, (t, end, here), inside) {
                Ok(found) => return Some(found),
                Err(value) => (t, here) = (end, Some(value)),
            }
        }
        None
    }

    /// The first change of sign between two distances, in steps that follow the value; else the value at the end. The value at
    /// the start may be known.
    fn cross(
        &self,
        origin: Vec3,
        direction: Vec3,
        (from, end, known): (f32, f32, Option<f32>),
        inside: bool,
    ) -> Result<f32, f32> {
        let side = if inside { 1.0 } else { -1.0 };
        let (start, slope) = ((origin - self.grid.origin) * self.grid.inverse, direction * self.grid.inverse);
        let value = |t: f32| self.between(self.nodes(start + slope * t)) * side;
        let least = 0.9 * self.cell();
        let (mut before, mut t) = (from, from);
        // Rays start within rounding of the surface.
        let mut here = known.unwrap_or_default();
        if known.is_some() {
            t = lesser(t + greater(here * SAFE * self.spacing, least), end);
        }
        loop {
            let there = value(t);
            if t > from && there < 0.0 {
                return Ok(narrow((before, here), (t, there), value));
            }
            (before, here) = (t, greater(there, 1e-6));
            if t >= end {
                return Err(here);
            }
            t = lesser(t + greater(here * SAFE * self.spacing, least), end);
        }
    }
}

/// The zero between a place with a value above it and one with a value below it: regula falsi.
fn narrow((mut a, mut va): (f32, f32), (mut b, mut vb): (f32, f32), value: impl Fn(f32) -> f32) -> f32 {
    for _ in 0..ROUNDS {
        let middle = a + (b - a) * (va / (va - vb)).clamp(0.05, 0.95);
        let v = value(middle);
        if v < 0.0 {
            (b, vb) = (middle, v);
        } else {
            (a, va) = (middle, v);
        }
    }
    a + (b - a) * (va / (va - vb))
}
