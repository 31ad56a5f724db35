//! The key light and the shadows it casts.

use super::bands::{self, BAND};
use super::layer::{Flat, bin, overlap, range};
use super::stage::Stage;
use glam::Vec3;
use std::ops::Range;

/// Texels along a side of the shadow map.
const SIDE: usize = 1024;
/// Tangent of the light's angular radius: the penumbra grows by this with the distance to the occluder.
const SOFTNESS: f32 = 0.10;

/// Radius in texels of the search for occluders; less than a block.
const SEARCH: f32 = 14.0;
/// Texels along a side of a block.
const BLOCK: usize = 16;

/// Towards the key light.
pub(super) fn direction() -> Vec3 {
    Vec3::new(-0.42, 1.0, 0.36).normalize()
}

/// Height (m, towards the light) of the first surface that light meets, over a square across the light.
pub(super) struct Shadows {
    across: Vec3,
    along: Vec3,
    towards: Vec3,
    /// Corner of the map in m along `across` and `along`.
    corner: (f32, f32),
    /// Texel in m.
    texel: f32,
    height: Vec<f32>,
    /// Highest of each block of texels and its eight neighbours.
    blocks: Vec<f32>,
}

/// A ball on the map.
struct Disc {
    centre: Vec3,
    columns: Range<usize>,
    rows: Range<usize>,
}

impl Shadows {
    pub(super) fn new(stage: &Stage<'_>) -> Self {
        let towards = direction();
        let across = Vec3::Y.cross(towards).normalize();
        let along = towards.cross(across);
        let middle = (stage.centre.dot(across), stage.centre.dot(along));
        let half = 0.5 * stage.size * 1.02;
        let mut map = Self {
            across,
            along,
            towards,
            corner: (middle.0 - half, middle.1 - half),
            texel: 2.0 * half / SIDE as f32,
            height: Vec::new(),
            blocks: Vec::new(),
        };
        map.height = map.cast(stage);
        map.blocks = blocks(&map.height);
        map
    }

    /// Texel coordinates and height of a point.
    fn locate(&self, point: Vec3) -> Vec3 {
        Vec3::new(
            (point.dot(self.across) - self.corner.0) / self.texel,
            (point.dot(self.along) - self.corner.1) / self.texel,
            point.dot(self.towards),
        )
    }

    fn cast(&self, stage: &Stage<'_>) -> Vec<f32> {
        let disc = |centre: Vec3, radius: f32| {
            let (c, r) = (self.locate(centre), radius / self.texel);
            Disc { centre: c, columns: range(c.x - r, c.x + r, SIDE), rows: range(c.y - r, c.y + r, SIDE) }
        };
        let balls: Vec<Disc> = stage.particles.iter().map(|&(_, p)| disc(p, stage.radius)).collect();
        let flats: Vec<Flat> = stage.sponge.triangles.iter().map(|&(_, c)| self.flat(stage, c)).collect();
        let casters: Vec<_> = stage.solids.iter().filter(|s| !s.is_clear() && !s.is_plane()).collect();
        let frames: Vec<Disc> = casters.iter().map(|s| disc(s.position, s.radius)).collect();
        let ball_bins = bin(balls.iter().map(|b| b.rows.clone()), SIDE);
        let flat_bins = bin(flats.iter().map(|f| f.rows(SIDE)), SIDE);
        let solid_bins = bin(frames.iter().map(|f| f.rows.clone()), SIDE);
        let mut height = vec![f32::NEG_INFINITY; SIDE * SIDE];
        bands::each_band(&mut height, SIDE, BAND, |first, band| {
            let (index, rows) = (first / BAND, band.len() / SIDE);
            for &i in &flat_bins[index] {
                for y in overlap(&flats[i].rows(SIDE), first, rows) {
                    let row = &mut band[(y - first) * SIDE..][..SIDE];
                    flats[i].row(y, SIDE, |x, value| row[x] = row[x].max(value));
                }
            }
            for &i in &ball_bins[index] {
                for y in overlap(&balls[i].rows, first, rows) {
                    self.ball(&balls[i], stage.radius, y, &mut band[(y - first) * SIDE..][..SIDE]);
                }
            }
            for &i in &solid_bins[index] {
                for y in overlap(&frames[i].rows, first, rows) {
                    let row = &mut band[(y - first) * SIDE..][..SIDE];
                    for x in frames[i].columns.clone() {
                        let top = frames[i].centre.z + 2.0 * casters[i].radius;
                        let origin = self.point(x, y, top);
                        if let Some(span) = casters[i].span(origin, -self.towards) {
                            row[x] = row[x].max(top - span.enter);
                        }
                    }
                }
            }
        });
        height
    }

    /// Centre of a texel at a height.
    fn point(&self, x: usize, y: usize, height: f32) -> Vec3 {
        self.across * (self.corner.0 + (x as f32 + 0.5) * self.texel)
            + self.along * (self.corner.1 + (y as f32 + 0.5) * self.texel)
            + self.towards * height
    }

    fn flat(&self, stage: &Stage<'_>, corners: [usize; 3]) -> Flat {
        let [a, b, c] = corners.map(|i| self.locate(stage.sponge.positions[i]));
        Flat { x: [a.x, b.x, c.x], y: [a.y, b.y, c.y], value: [a.z, b.z, c.z] }
    }

    fn ball(&self, disc: &Disc, radius: f32, y: usize, row: &mut [f32]) {
        let down = (y as f32 + 0.5 - disc.centre.y) * self.texel;
        for x in disc.columns.clone() {
            let side = (x as f32 + 0.5 - disc.centre.x) * self.texel;
            let rest = radius * radius - side * side - down * down;
            if rest > 0.0 {
                row[x] = row[x].max(disc.centre.z + rest.sqrt());
            }
        }
    }

    fn sample(&self, x: f32, y: f32) -> f32 {
        let inside = |v: f32| v >= 0.0 && v < SIDE as f32;
        if inside(x) && inside(y) {
            self.height[super::colour::index(y) * SIDE + super::colour::index(x)]
        } else {
            f32::NEG_INFINITY
        }
    }

    /// Whether something near the place (in texels) is higher than `height`.
    fn any_above(&self, x: f32, y: f32, height: f32) -> bool {
        let block = |v: f32| super::colour::index(v).min(SIDE - 1) / BLOCK;
        self.blocks[block(y) * (SIDE / BLOCK) + block(x)] > height
    }

    /// Fraction of the key light that reaches a point, 0..=1; the sine and cosine
    /// rotate the pattern of samples.
    pub(super) fn light(&self, point: Vec3, normal: Vec3, (sine, cosine): (f32, f32)) -> f32 {
        const TAPS: usize = 12;
        let facing = normal.dot(self.towards);
        if facing <= 0.0 {
            return 0.0;
        }
        let here = self.locate(point + normal * (1.5 * self.texel));
        let spot = |k: usize, radius: f32| {
            let [x, y] = SPIRAL[k];
            (here.x + radius * (x * cosine - y * sine), here.y + radius * (x * sine + y * cosine))
        };
        // First the mean distance of the occluders, then a disc as wide as the penumbra there.
        if !self.any_above(here.x, here.y, here.z + self.texel * 2.0) {
            return 1.0;
        }
        let (mut gap, mut found) = (0.0, 0.0);
        for k in (0..TAPS).step_by(2) {
            let (x, y) = spot(k, SEARCH);
            let above = self.sample(x, y) - here.z;
            if above > self.texel * 2.0 {
                gap += above;
                found += 1.0;
            }
        }
        if found == 0.0 {
            return 1.0;
        }
        let radius = (gap / found * SOFTNESS / self.texel).clamp(1.2, 40.0);
        if found > 5.5 && radius <= SEARCH {
            // Covered all around: almost no part of a disc inside the search can be lit.
            return 0.0;
        }
        // A wide disc on a slope must not meet the slope itself.
        let slope = (1.0 - facing * facing).max(0.0).sqrt() / facing.max(0.15);
        let bias = self.texel * (1.0 + radius * slope.min(1.5) * 0.6);
        let lit = (0..TAPS).filter(|&k| {
            let (x, y) = spot(k, radius);
            self.sample(x, y) <= here.z + bias
        });
        lit.count() as f32 / TAPS as f32
    }
}

/// Highest value of each block and its neighbours.
fn blocks(height: &[f32]) -> Vec<f32> {
    const COUNT: usize = SIDE / BLOCK;
    let mut own = vec![f32::NEG_INFINITY; COUNT * COUNT];
    for (y, row) in height.chunks(SIDE).enumerate() {
        for (x, texels) in row.chunks(BLOCK).enumerate() {
            let block = &mut own[y / BLOCK * COUNT + x];
            *block = texels.iter().fold(*block, |a, &b| a.max(b));
        }
    }
    let widest = |i: usize| i.saturating_sub(1)..(i + 2).min(COUNT);
    let around = |x: usize, y: usize| {
        let values = widest(y).flat_map(|y| widest(x).map(move |x| (x, y))).map(|(x, y)| own[y * COUNT + x]);
        values.fold(f32::NEG_INFINITY, f32::max)
    };
    (0..COUNT * COUNT).map(|i| around(i % COUNT, i / COUNT)).collect()
}

/// Points spread evenly over the unit disc (a sunflower), from the middle outwards.
pub(super) const SPIRAL: [[f32; 2]; 12] = [
    [0.204_124, 0.0],
    [-0.260_699, 0.238_824],
    [0.039_902, -0.454_665],
    [0.328_563, 0.428_554],
    [-0.603_013, -0.106_666],
    [0.571_318, -0.363_417],
    [-0.190_922, 0.710_820],
    [-0.357_703, -0.704_992],
    [0.773_917, 0.330_856],
    [-0.795_613, 0.283_895],
    [0.365_126, -0.861_428],
    [0.336_622, 0.919_132],
];
