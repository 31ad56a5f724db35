//! Depth and item that every sample sees.

use super::bands::{self, BAND};
use super::camera::Raster;
use super::colour::floor;
use super::shapes::Solid;
use super::stage::Stage;
use glam::Vec3;
use std::ops::Range;

/// What a sample sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Item {
    Nothing,
    Particle(usize),
    /// Index in the list of drawable triangles.
    Triangle(usize),
    /// Index in the list of solids of the stage.
    Body(usize),
    Floor,
}

const KIND: u32 = 29;
const INDEX: u32 = (1 << KIND) - 1;

impl Item {
    /// The code of the item in a layer.
    pub(super) fn code(self) -> u32 {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "masked to 29 bits; 5e8 things do not fit in memory"
        )]
        let pack = |kind: u32, index: usize| kind << KIND | (index as u32 & INDEX);
        match self {
            Self::Nothing => 0,
            Self::Particle(i) => pack(1, i),
            Self::Triangle(i) => pack(2, i),
            Self::Body(i) => pack(3, i),
            Self::Floor => pack(4, 0),
        }
    }

    pub(super) fn from_code(code: u32) -> Self {
        let index = (code & INDEX) as usize;
        match code >> KIND {
            1 => Self::Particle(index),
            2 => Self::Triangle(index),
            3 => Self::Body(index),
            4 => Self::Floor,
            _ => Self::Nothing,
        }
    }
}

/// Nearest depth (m along the view; infinite where there is nothing) and its item, for every sample.
pub(super) struct Layer {
    pub(super) depth: Vec<f32>,
    pub(super) code: Vec<u32>,
}

/// Rows of a layer.
struct Band<'a> {
    first: usize,
    width: usize,
    depth: &'a mut [f32],
    code: &'a mut [u32],
}

/// A ball as seen by the view.
pub(super) struct Ball {
    pub(super) centre: Vec3,
    pub(super) radius: f32,
    pub(super) particle: usize,
    pub(super) columns: Range<usize>,
    pub(super) rows: Range<usize>,
}

impl Ball {
    /// The ball, unless it is out of sight.
    pub(super) fn new(raster: &Raster, particle: usize, centre: Vec3, radius: f32) -> Option<Self> {
        let local = raster.local(centre);
        let (columns, rows) = bounds(raster, local, radius)?;
        (!columns.is_empty() && !rows.is_empty()).then_some(Self {
            centre: local,
            radius,
            particle,
            columns,
            rows,
        })
    }

    /// Calls `put(column, depth, chord)` for the samples of a row that see the ball; the chord is in depth, m.
    pub(super) fn row(&self, raster: &Raster, y: usize, mut put: impl FnMut(usize, f32, f32)) {
        let c = self.centre;
        let (_, dy) = raster.slopes(0.0, y as f32);
        let across = dy * c.z - c.y;
        for x in self.columns.clone() {
            let (dx, _) = raster.slopes(x as f32, 0.0);
            let (p, q) = (dx * c.z - c.x, dx * c.y - dy * c.x);
            let a = 1.0 + dx * dx + dy * dy;
            let discriminant = a * self.radius * self.radius - (p * p + across * across + q * q);
            if discriminant > 0.0 {
                let root = discriminant.sqrt();
                let inverse = 1.0 / a;
                put(x, (dx * c.x + dy * c.y + c.z - root) * inverse, 2.0 * root * inverse);
            }
        }
    }
}

/// Columns and rows that a ball at `local` covers: exact in each direction; nothing where it is not wholly in front.
fn bounds(raster: &Raster, local: Vec3, radius: f32) -> Option<(Range<usize>, Range<usize>)> {
    if local.z <= radius + raster.near {
        return None;
    }
    let extent = |side: f32| {
        let root = (side * side + (local.z - radius) * (local.z + radius)).sqrt();
        let scale = raster.focal / ((local.z - radius) * (local.z + radius));
        ((side * local.z - radius * root) * scale, (side * local.z + radius * root) * scale)
    };
    let (left, right) = extent(local.x);
    let (bottom, top) = extent(local.y);
    let (cx, cy) = (0.5 * raster.width as f32, 0.5 * raster.height as f32);
    Some((range(cx + left, cx + right, raster.width), range(cy - top, cy - bottom, raster.height)))
}

/// Samples from `low` to `high`, cut to 0..`limit`.
pub(super) fn range(low: f32, high: f32, limit: usize) -> Range<usize> {
    let cut = |value: i32| usize::try_from(value.max(0)).unwrap_or(0).min(limit);
    cut(floor(low))..cut(floor(high).saturating_add(1))
}

/// A triangle on a raster: corners and a value that is linear on the raster.
pub(super) struct Flat {
    pub(super) x: [f32; 3],
    pub(super) y: [f32; 3],
    pub(super) value: [f32; 3],
}

impl Flat {
    pub(super) fn rows(&self, height: usize) -> Range<usize> {
        let [a, b, c] = self.y;
        range(a.min(b).min(c) - 1.0, a.max(b).max(c), height)
    }

    /// Calls `put(column, value)` for the samples of a row whose centre is inside.
    pub(super) fn row(&self, y: usize, width: usize, mut put: impl FnMut(usize, f32)) {
        // Edges are widened by this much (samples), so that rounding leaves no gap between neighbours.
        const SLACK: f32 = 1e-3;
        let ([x0, x1, x2], [y0, y1, y2], [v0, v1, v2]) = (self.x, self.y, self.value);
        let area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let centre = y as f32 + 0.5;
        let (mut low, mut high) = (0.0_f32, width as f32);
        for (ax, ay, bx, by) in [(x0, y0, x1, y1), (x1, y1, x2, y2), (x2, y2, x0, y0)] {
            let (dx, dy) = ((bx - ax) * area.signum(), (by - ay) * area.signum());
            // Inside where dx * (centre - ay) - dy * (x - ax) >= 0.
            if dy == 0.0 {
                if dx * (centre - ay) < 0.0 {
                    return;
                }
            } else {
                let x = ax + dx * (centre - ay) / dy;
                if dy > 0.0 {
                    high = high.min(x + SLACK);
                } else {
                    low = low.max(x - SLACK);
                }
            }
        }
        let along = ((v1 - v0) * (y2 - y0) - (v2 - v0) * (y1 - y0)) / area;
        let down = ((v2 - v0) * (x1 - x0) - (v1 - v0) * (x2 - x0)) / area;
        let (minimum, maximum) = (v0.min(v1).min(v2), v0.max(v1).max(v2));
        let start = v0 + down * (centre - y0);
        for x in range((low - 0.5).ceil(), (high - 0.5).floor(), width) {
            put(x, (start + along * (x as f32 + 0.5 - x0)).clamp(minimum, maximum));
        }
    }
}

/// Assigns the indices of items to the bands of rows that they touch.
pub(super) fn bin(rows: impl Iterator<Item = Range<usize>>, height: usize) -> Vec<Vec<usize>> {
    let mut bins = vec![Vec::new(); height.div_ceil(BAND)];
    for (index, rows) in rows.enumerate() {
        if !rows.is_empty() {
            for bin in &mut bins[rows.start / BAND..rows.end.div_ceil(BAND)] {
                bin.push(index);
            }
        }
    }
    bins
}

/// Part of a range that lies in the rows of a band.
pub(super) fn overlap(rows: &Range<usize>, first: usize, count: usize) -> Range<usize> {
    rows.start.max(first)..rows.end.min(first + count)
}

/// Columns and rows of the raster that a solid may cover.
pub(super) fn frame(raster: &Raster, solid: &Solid<'_>) -> (Range<usize>, Range<usize>) {
    let local = raster.local(solid.position);
    if solid.radius.is_finite() {
        if local.z < -solid.radius {
            return (0..0, 0..0);
        }
        if let Some(found) = bounds(raster, local, solid.radius) {
            return found;
        }
    }
    (0..raster.width, 0..raster.height)
}

impl Layer {
    /// Nothing anywhere.
    fn empty(raster: &Raster) -> Self {
        let samples = raster.width * raster.height;
        Self { depth: vec![f32::INFINITY; samples], code: vec![0; samples] }
    }

    fn bands(&mut self, width: usize) -> Vec<Band<'_>> {
        let depth = self.depth.chunks_mut(width * BAND);
        depth
            .zip(self.code.chunks_mut(width * BAND))
            .enumerate()
            .map(|(index, (depth, code))| Band { first: index * BAND, width, depth, code })
            .collect()
    }

    /// Everything opaque; `balls` are the particles to draw as balls.
    pub(super) fn opaque(stage: &Stage<'_>, balls: &[Ball]) -> Self {
        let raster = &stage.raster;
        let flats: Vec<(usize, Flat)> = flats(stage);
        let frames: Vec<_> = stage.solids.iter().map(|solid| frame(raster, solid)).collect();
        let ball_bins = bin(balls.iter().map(|b| b.rows.clone()), raster.height);
        let flat_bins = bin(flats.iter().map(|(_, f)| f.rows(raster.height)), raster.height);
        let mut layer = Self::empty(raster);
        bands::each(layer.bands(raster.width), |mut band| {
            let index = band.first / BAND;
            for &i in &flat_bins[index] {
                let (triangle, flat) = &flats[i];
                band.flat(flat, Item::Triangle(*triangle), raster);
            }
            for &i in &ball_bins[index] {
                band.ball(&balls[i], raster);
            }
            for (i, (solid, frame)) in stage.solids.iter().zip(&frames).enumerate() {
                if !solid.is_clear() {
                    band.solid(solid, frame, Item::Body(i), stage);
                }
            }
            band.floor(stage);
        });
        layer
    }

    /// The balls alone.
    pub(super) fn balls(raster: &Raster, balls: &[Ball]) -> Self {
        let bins = bin(balls.iter().map(|b| b.rows.clone()), raster.height);
        let mut layer = Self::empty(raster);
        bands::each(layer.bands(raster.width), |mut band| {
            for &i in &bins[band.first / BAND] {
                band.ball(&balls[i], raster);
            }
        });
        layer
    }
}

fn flats(stage: &Stage<'_>) -> Vec<(usize, Flat)> {
    let raster = &stage.raster;
    let project = |i: usize| {
        let local = raster.local(stage.sponge.positions[i]);
        (local.z > raster.near).then(|| (raster.project(local), 1.0 / local.z))
    };
    let flat = |corners: [usize; 3]| {
        let [a, b, c] = corners.map(project);
        let (a, b, c) = (a?, b?, c?);
        Some(Flat { x: [a.0.0, b.0.0, c.0.0], y: [a.0.1, b.0.1, c.0.1], value: [a.1, b.1, c.1] })
    };
    let triangles = stage.sponge.triangles.iter().enumerate();
    triangles.filter_map(|(i, &(_, corners))| Some((i, flat(corners)?))).collect()
}

impl Band<'_> {
    fn rows(&self) -> usize {
        self.depth.len() / self.width
    }

    fn put(&mut self, at: usize, depth: f32, code: u32) {
        if depth < self.depth[at] {
            self.depth[at] = depth;
            self.code[at] = code;
        }
    }

    fn ball(&mut self, ball: &Ball, raster: &Raster) {
        let code = Item::Particle(ball.particle).code();
        for y in overlap(&ball.rows, self.first, self.rows()) {
            let start = (y - self.first) * self.width;
            ball.row(raster, y, |x, depth, _| self.put(start + x, depth, code));
        }
    }

    fn flat(&mut self, flat: &Flat, item: Item, raster: &Raster) {
        let code = item.code();
        for y in overlap(&flat.rows(raster.height), self.first, self.rows()) {
            let start = (y - self.first) * self.width;
            flat.row(y, self.width, |x, inverse| self.put(start + x, 1.0 / inverse, code));
        }
    }

    fn solid(
        &mut self,
        solid: &Solid<'_>,
        frame: &(Range<usize>, Range<usize>),
        item: Item,
        stage: &Stage<'_>,
    ) {
        let raster = &stage.raster;
        let reach = if solid.is_plane() { stage.fade_end() } else { f32::INFINITY };
        for y in overlap(&frame.1, self.first, self.rows()) {
            for x in frame.0.clone() {
                let ray = raster.ray(x, y);
                if let Some(span) = solid.span(raster.eye, ray) {
                    let near = reach == f32::INFINITY
                        || (raster.eye + ray * span.enter).distance(stage.centre) < reach;
                    if span.enter > raster.near && near {
                        self.put((y - self.first) * self.width + x, span.enter, item.code());
                    }
                }
            }
        }
    }

    fn floor(&mut self, stage: &Stage<'_>) {
        let (Some(floor), raster) = (&stage.floor, &stage.raster) else {
            return;
        };
        let height = raster.eye.y - floor.height;
        if height <= 0.0 {
            return;
        }
        for y in self.first..self.first + self.rows() {
            for x in 0..self.width {
                let ray = raster.ray(x, y);
                if ray.y >= 0.0 {
                    continue;
                }
                // Slightly nearer than it is, to hide a plane body at the same height.
                let depth = -height / ray.y * 0.9999;
                let at = (y - self.first) * self.width + x;
                if depth < self.depth[at]
                    && (raster.eye + ray * depth).distance(stage.centre) < stage.fade_end()
                {
                    self.put(at, depth, Item::Floor.code());
                }
            }
        }
    }
}
