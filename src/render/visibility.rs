//! Visible share of sky and key light of each pixel.
//!
//! Computed once per pixel with patterns that differ between neighbours, then averaged over surfaces. This is a quarter of
//! the work of sampling per sample, and leaves no noise.

use super::bands::{self, BAND};
use super::layer::{Item, Layer};
use super::light::{SPIRAL, Shadows};
use super::shade;
use super::stage::Stage;
use glam::Vec3;

/// Light that reaches a point: from the sky and from the key light, both 0..=1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Light {
    pub(super) sky: f32,
    pub(super) key: f32,
    /// Depth the values belong to.
    depth: f32,
}

/// Longest distance from a pixel to a sample of its surroundings, in heights of the picture.
const REACH: f32 = 0.08;

const CLEAR: Light = Light { sky: 1.0, key: 1.0, depth: f32::INFINITY };

/// Light of every pixel.
pub(super) struct Visibility {
    width: usize,
    light: Vec<Light>,
}

/// Sines and cosines of the sixteen rotations of the pattern.
type Turns = [(f32, f32); 16];

impl Visibility {
    pub(super) fn new(stage: &Stage<'_>, layer: &Layer, shadows: &Shadows) -> Self {
        let (width, height) = (stage.raster.width / 2, stage.raster.height / 2);
        let turns = std::array::from_fn(|i| (i as f32 * (std::f32::consts::TAU / 16.0)).sin_cos());
        let open = Open::new(stage, layer);
        let mut light = vec![CLEAR; width * height];
        bands::each_band(&mut light, width, BAND, |first, band| {
            for (row, pixels) in band.chunks_mut(width).enumerate() {
                for (x, pixel) in pixels.iter_mut().enumerate() {
                    *pixel = gather(stage, layer, shadows, (&turns, &open), (x, first + row));
                }
            }
        });
        let sideways = even_out(&light, width, true);
        let light = even_out(&sideways, width, false);
        Self { width, light }
    }

    /// Light at a sample: that of its pixel, or at an edge that of the neighbour nearest in depth.
    pub(super) fn at(&self, x: usize, y: usize, depth: f32) -> Light {
        let (px, py) = (x / 2, y / 2);
        let height = self.light.len() / self.width;
        let own = self.light[py * self.width + px];
        if (own.depth - depth).abs() < 0.004 * depth {
            return own;
        }
        let mut best = own;
        for ny in py.saturating_sub(1)..(py + 2).min(height) {
            for nx in px.saturating_sub(1)..(px + 2).min(self.width) {
                let other = self.light[ny * self.width + nx];
                if (other.depth - depth).abs() < (best.depth - depth).abs() {
                    best = other;
                }
            }
        }
        best
    }
}

fn gather(
    stage: &Stage<'_>,
    layer: &Layer,
    shadows: &Shadows,
    (turns, open): (&Turns, &Open),
    (x, y): (usize, usize),
) -> Light {
    let raster = &stage.raster;
    let at = 2 * y * raster.width + 2 * x;
    let (item, depth) = (Item::from_code(layer.code[at]), layer.depth[at]);
    if item == Item::Nothing {
        return CLEAR;
    }
    let ray = raster.ray(2 * x, 2 * y);
    let point = raster.eye + ray * depth;
    let normal = shade::normal(stage, item, point, ray);
    // Sixteen patterns in a square of 4 by 4 pixels.
    const ORDER: [[usize; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];
    let turn = turns[ORDER[y % 4][x % 4]];
    let key = shadows.light(point, normal, turn);
    if item == Item::Floor && open.at(x, y) {
        return Light { sky: 1.0, key, depth };
    }
    let sky = sky(stage, layer, (x, y), depth, normal, turn);
    Light { sky, key, depth }
}

/// Tiles of pixels with nothing but floor and sky within the reach of a sample.
struct Open {
    columns: usize,
    tiles: Vec<bool>,
}

impl Open {
    /// Pixels along a side of a tile.
    const TILE: usize = 16;

    fn new(stage: &Stage<'_>, layer: &Layer) -> Self {
        let side = 2 * Self::TILE;
        let (columns, rows) = (stage.raster.width.div_ceil(side), stage.raster.height.div_ceil(side));
        let mut empty = vec![true; columns * rows];
        for (y, row) in layer.code.chunks(stage.raster.width).enumerate() {
            for (x, codes) in row.chunks(side).enumerate() {
                let bare = |&code: &u32| matches!(Item::from_code(code), Item::Floor | Item::Nothing);
                empty[y / side * columns + x] &= codes.iter().all(bare);
            }
        }
        let margin = super::colour::index(REACH * stage.raster.height as f32) / side + 1;
        let around = |i: usize, limit: usize| i.saturating_sub(margin)..(i + margin + 1).min(limit);
        let open = |i: usize| {
            around(i / columns, rows).all(|y| around(i % columns, columns).all(|x| empty[y * columns + x]))
        };
        Self { columns, tiles: (0..columns * rows).map(open).collect() }
    }

    fn at(&self, x: usize, y: usize) -> bool {
        self.tiles[y / Self::TILE * self.columns + x / Self::TILE]
    }
}

/// Ambient occlusion from the depths around a pixel: every sample above the tangent plane takes light away.
fn sky(
    stage: &Stage<'_>,
    layer: &Layer,
    (x, y): (usize, usize),
    depth: f32,
    normal: Vec3,
    (sine, cosine): (f32, f32),
) -> f32 {
    let raster = &stage.raster;
    let reach = 0.055 * stage.size;
    let radius = (reach * raster.focal / depth).min(REACH * raster.height as f32).max(4.0);
    let place = |x: f32, y: f32, depth: f32| {
        let (right, up) = raster.slopes(x, y);
        Vec3::new(right * depth, up * depth, depth)
    };
    let point = place(2.0 * x as f32, 2.0 * y as f32, depth);
    let normal = Vec3::new(normal.dot(raster.right), normal.dot(raster.up), normal.dot(raster.forward));
    let (nearby, softening) = (1.0 / (4.0 * reach * reach), 0.02 * reach);
    let mut hidden = 0.0;
    for [u, v] in SPIRAL {
        let sx = 2.0 * x as f32 + 0.5 + radius * (u * cosine - v * sine);
        let sy = 2.0 * y as f32 + 0.5 + radius * (u * sine + v * cosine);
        if sx < 0.0 || sy < 0.0 || sx >= raster.width as f32 || sy >= raster.height as f32 {
            continue;
        }
        let (sx, sy) = (super::colour::index(sx), super::colour::index(sy));
        let other = layer.depth[sy * raster.width + sx];
        if other == f32::INFINITY {
            continue;
        }
        let offset = place(sx as f32, sy as f32, other) - point;
        let (square, rise) = (offset.length_squared(), offset.dot(normal));
        let rise = rise - 0.002 * depth;
        if rise > 0.0 {
            hidden += rise * (1.0 - square * nearby).max(0.0) / (square.sqrt() + softening);
        }
    }
    (1.0 - 1.55 * hidden / SPIRAL.len() as f32).clamp(0.08, 1.0)
}

/// Mean over five pixels of a row or column that lie on the same surface.
fn even_out(light: &[Light], width: usize, sideways: bool) -> Vec<Light> {
    let height = light.len() / width;
    let mut result = light.to_vec();
    bands::each_band(&mut result, width, BAND, |first, band| {
        for (row, pixels) in band.chunks_mut(width).enumerate() {
            let y = first + row;
            for (x, pixel) in pixels.iter_mut().enumerate() {
                if pixel.depth == f32::INFINITY {
                    continue;
                }
                let (mut sky, mut key, mut count) = (0.0, 0.0, 0.0);
                let (at, limit) = if sideways { (x, width) } else { (y, height) };
                for i in at.saturating_sub(2)..(at + 3).min(limit) {
                    let other = if sideways { light[y * width + i] } else { light[i * width + x] };
                    if (other.depth - pixel.depth).abs() < 0.012 * pixel.depth {
                        // The two outermost of the five share one place in the pattern of four.
                        let weight = if i.abs_diff(at) == 2 { 0.5 } else { 1.0 };
                        sky += weight * other.sky;
                        key += weight * other.key;
                        count += weight;
                    }
                }
                if count > 0.0 {
                    (pixel.sky, pixel.key) = (sky / count, key / count);
                }
            }
        }
    });
    result
}

impl Light {
    /// No occlusion.
    pub(super) fn clear() -> Self {
        CLEAR
    }
}
