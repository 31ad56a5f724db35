//! The fast view: the depth of the particles on the picture, smoothed by the narrow-range filter \[TY18\], and their thickness.
//!
//! A ray that meets this surface is bent once and ends at the solids behind it.

use super::optics::{INDEX, Medium, reflect, refract};
use super::path::Signature;
use super::room;
use super::setting::{Matter, Setting, boxed};
use crate::render::{bands, camera::Raster, colour::smooth, stage::Stage};
use glam::Vec3;
use std::ops::Range;

/// Radius of a ball over the spacing: four of a square must leave no gap.
const BALL: f32 = 0.78;
/// Volume of a particle over that of its ball.
const FILLING: f32 = 0.5;
/// Water that is nearer behind a wall touches it, in spacings.
const TOUCH: f32 = 0.25;
/// Rows of a task.
const BAND: usize = 16;
/// The filter: reach along a row, in spacings and in samples, and the range of depths that mix, in spacings.
const REACH: f32 = 2.0;
const MOST_SAMPLES: f32 = 10.0;
const RANGE: f32 = 2.5;
/// What is farther behind counts as this far behind, in spacings.
const BEHIND: f32 = 0.5;
/// Passes of the filter, each along rows and along columns.
pub(in crate::render) const PASSES: usize = 2;

/// Pixels of the picture along a side of a sample of the screen.
pub(in crate::render) const COARSE: usize = 2;

#[cfg(feature = "gpu")]
shared_with_shaders!(SCREEN: BALL, FILLING, TOUCH, REACH, MOST_SAMPLES, RANGE, BEHIND, COARSE);

/// Water on the picture, at a part of its resolution.
#[derive(Debug)]
pub(super) struct Screen {
    raster: Raster,
    width: usize,
    height: usize,
    /// Depth along the line of sight of the eye (m), infinite without water.
    depth: Vec<f32>,
    /// Length of water along the ray (m).
    thickness: Vec<f32>,
    /// Normal against the eye, in the axes of the raster.
    normal: Vec<Vec3>,
    spacing: f32,
}

/// The surface of the water on a ray.
struct Seen {
    depth: f32,
    thickness: f32,
    normal: Vec3,
}

/// A ball on the raster.
struct Disc {
    centre: Vec3,
    columns: Range<usize>,
    rows: Range<usize>,
}

/// Weighted sums of the filter along a piece of a row. Loops without branches, which a compiler turns into vectors.
#[derive(Debug, Default)]
struct Sums {
    here: Vec<f32>,
    /// Reach of the filter in samples.
    reach: Vec<f32>,
    depth: Vec<f32>,
    water: Vec<f32>,
    total: Vec<f32>,
    /// Range of depths that mix, and depth of what is farther behind (m).
    near: f32,
    behind: f32,
}

impl Sums {
    fn begin(&mut self, here: &[f32], thickness: &[f32], scale: f32, spacing: f32) {
        for (own, with) in [
            (&mut self.here, here),
            (&mut self.reach, here),
            (&mut self.depth, here),
            (&mut self.water, thickness),
            (&mut self.total, here),
        ] {
            own.clear();
            own.extend_from_slice(with);
        }
        self.reach.iter_mut().for_each(|reach| *reach = (scale / *reach).clamp(1.0, MOST_SAMPLES));
        self.total.fill(1.0);
        (self.near, self.behind) = (RANGE * spacing, BEHIND * spacing);
    }

    /// Adds the samples at a distance to both sides of a part of the piece.
    fn add(&mut self, first: usize, depth: [&[f32]; 2], thickness: [&[f32]; 2], tap: f32) {
        let count = depth[0].len();
        let part = first..first + count;
        let (here, reach) = (&self.here[part.clone()], &self.reach[part.clone()]);
        let sums = (&mut self.depth[part.clone()], &mut self.water[part.clone()], &mut self.total[part]);
        let ([a, b], [p, q]) = (depth.map(|side| &side[..count]), thickness.map(|side| &side[..count]));
        for k in 0..count {
            let (low, high) = (here[k] - self.near, here[k] + self.near);
            let share = tap / (reach[k] + 1.0);
            let weight = 1.0 - share * share;
            // In front of the range is another sheet; a pair keeps the filter even.
            let is_sheet = a[k] >= low && b[k] >= low && weight > 0.0;
            let weight = if is_sheet { weight } else { 0.0 };
            let clamp = |depth: f32| if depth > high { here[k] + self.behind } else { depth };
            sums.0[k] += weight * (clamp(a[k]) + clamp(b[k]));
            sums.1[k] += weight * (p[k] + q[k]);
            sums.2[k] += 2.0 * weight;
        }
    }

    fn finish(&self, depth: &mut [f32], thickness: &mut [f32]) {
        for (k, (depth, thickness)) in depth.iter_mut().zip(thickness).enumerate() {
            let is_water = self.here[k] < f32::INFINITY;
            *depth = if is_water { self.depth[k] / self.total[k] } else { f32::INFINITY };
            *thickness = if is_water { self.water[k] / self.total[k] } else { 0.0 };
        }
    }
}

impl Screen {
    /// The free water as the raster sees it.
    pub(super) fn new(stage: &Stage<'_>) -> Self {
        let raster = stage.raster.coarser(COARSE);
        let (width, height, spacing) = (raster.width, raster.height, 2.0 * stage.radius);
        let radius = BALL * spacing;
        let free = stage.particles.iter().zip(&stage.free).filter(|(_, free)| **free > 0.5);
        let discs: Vec<Disc> = free.filter_map(|((_, place), _)| disc(&raster, *place, radius)).collect();
        let mut bins = vec![Vec::new(); height.div_ceil(BAND)];
        for (index, disc) in discs.iter().enumerate() {
            for bin in &mut bins[disc.rows.start / BAND..=(disc.rows.end - 1) / BAND] {
                bin.push(index as u32);
            }
        }
        let mut depth = vec![f32::INFINITY; width * height];
        let mut thickness = vec![0.0_f32; width * height];
        let jobs =
            depth.chunks_mut(BAND * width).zip(thickness.chunks_mut(BAND * width)).enumerate().collect();
        bands::each(jobs, |(band, (depth, thickness)): (usize, (&mut [f32], &mut [f32]))| {
            for index in &bins[band] {
                splat(&raster, &discs[*index as usize], radius, band * BAND, depth, thickness);
            }
        });
        let mut screen = Self { raster, width, height, depth, thickness, normal: Vec::new(), spacing };
        for _ in 0..PASSES {
            screen.even_out(true);
            screen.even_out(false);
        }
        let mut normal = vec![Vec3::NEG_Z; width * height];
        bands::each_row(&mut normal, width, BAND, |y, row| {
            row.iter_mut().enumerate().for_each(|(x, normal)| *normal = screen.slope(x, y));
        });
        screen.normal = normal;
        screen
    }

    /// One pass of the filter along rows or columns.
    fn even_out(&mut self, sideways: bool) {
        let (width, height) = (self.width, self.height);
        let scale = REACH * self.spacing * self.raster.focal;
        let (depth, thickness) = (&self.depth, &self.thickness);
        let mut result = (vec![f32::INFINITY; width * height], vec![0.0; width * height]);
        let rows = result.0.chunks_mut(BAND * width).zip(result.1.chunks_mut(BAND * width)).enumerate();
        bands::each(rows.collect(), |(band, (depths, thicknesses)): (usize, (&mut [f32], &mut [f32]))| {
            let mut sums = Sums::default();
            for (row, out) in depths.chunks_mut(width).zip(thicknesses.chunks_mut(width)).enumerate() {
                let (y, own) = (band * BAND + row, (band * BAND + row) * width);
                let here = &depth[own..own + width];
                let Some(first) = here.iter().position(|depth| depth.is_finite()) else { continue };
                let end = here.iter().rposition(|depth| depth.is_finite()).map_or(first, |last| last + 1);
                sums.begin(&here[first..end], &thickness[own + first..own + end], scale, self.spacing);
                let most = sums.reach.iter().fold(1.0_f32, |most, reach| most.max(*reach));
                // As far to one side as to the other, or a slope would shrink.
                for tap in 1..=most.ceil() as usize {
                    let (range, step) = if sideways {
                        (first.max(tap)..end.min(width.saturating_sub(tap)), tap)
                    } else if tap <= y && y + tap < height {
                        (first..end, tap * width)
                    } else {
                        break;
                    };
                    if range.is_empty() {
                        break;
                    }
                    let at = |from: usize| from..from + range.len();
                    // In this order: no place is before the first sample.
                    let (before, after) = (own + range.start - step, own + range.start + step);
                    let pair = [&depth[at(before)], &depth[at(after)]];
                    let water = [&thickness[at(before)], &thickness[at(after)]];
                    sums.add(range.start - first, pair, water, tap as f32);
                }
                sums.finish(&mut out.0[first..end], &mut out.1[first..end]);
            }
        });
        (self.depth, self.thickness) = result;
    }

    /// Normal of a sample, in the axes of the raster.
    fn slope(&self, x: usize, y: usize) -> Vec3 {
        let here = self.depth[y * self.width + x];
        if here == f32::INFINITY {
            return Vec3::NEG_Z;
        }
        let place = |x: usize, y: usize| {
            let (right, up) = self.raster.slopes(x as f32, y as f32);
            Vec3::new(right, up, 1.0) * self.depth[y * self.width + x]
        };
        let own = place(x, y);
        // Between neighbours on the same sheet.
        let difference = |before: Option<(usize, usize)>, after: Option<(usize, usize)>| {
            let sheet = |at: Option<(usize, usize)>| {
                at.filter(|(x, y)| (self.depth[y * self.width + x] - here).abs() < self.spacing)
            };
            match (sheet(before), sheet(after)) {
                (Some(a), Some(b)) => place(b.0, b.1) - place(a.0, a.1),
                (Some(a), None) => own - place(a.0, a.1),
                (None, Some(b)) => place(b.0, b.1) - own,
                (None, None) => Vec3::ZERO,
            }
        };
        let across = difference((x > 0).then(|| (x - 1, y)), (x + 1 < self.width).then(|| (x + 1, y)));
        let down = difference((y > 0).then(|| (x, y - 1)), (y + 1 < self.height).then(|| (x, y + 1)));
        let normal = down.cross(across).normalize_or(Vec3::NEG_Z);
        if normal.z > 0.0 { -normal } else { normal }
    }

    /// The water at a place in pixels of the picture, between the four samples around it; nothing without water.
    fn at(&self, x: f32, y: f32) -> Option<Seen> {
        let at = |place: f32, limit: usize| {
            let place = (place / COARSE as f32 - 0.5).clamp(0.0, limit as f32 - 1.0);
            let first = place as usize;
            (first, (first + 1).min(limit - 1), place - first as f32)
        };
        let ((x0, x1, fx), (y0, y1, fy)) = (at(x, self.width), at(y, self.height));
        let samples = [
            (y0 * self.width + x0, (1.0 - fx) * (1.0 - fy)),
            (y0 * self.width + x1, fx * (1.0 - fy)),
            (y1 * self.width + x0, (1.0 - fx) * fy),
            (y1 * self.width + x1, fx * fy),
        ];
        let nearest = samples.iter().map(|(index, _)| self.depth[*index]).fold(f32::INFINITY, f32::min);
        let (mut depth, mut thickness, mut normal, mut total) = (0.0, 0.0, Vec3::ZERO, 0.0);
        for (index, weight) in samples {
            // Of the nearest sheet alone.
            if self.depth[index] < nearest + self.spacing {
                depth += weight * self.depth[index];
                thickness += weight * self.thickness[index];
                normal += self.normal[index] * weight;
                total += weight;
            }
        }
        if total < 0.5 {
            return None;
        }
        let raster = &self.raster;
        let normal = raster.right * normal.x + raster.up * normal.y + raster.forward * normal.z;
        Some(Seen {
            depth: depth / total,
            thickness: thickness / total,
            normal: normal.normalize_or(-raster.forward),
        })
    }
}

fn disc(raster: &Raster, place: Vec3, radius: f32) -> Option<Disc> {
    let local = raster.local(place);
    if local.z <= radius + raster.near {
        return None;
    }
    let (x, y) = raster.project(local);
    let reach = radius * raster.focal / (local.z - radius);
    let range = |middle: f32, limit: usize| {
        let first = ((middle - reach).max(0.0) as usize).min(limit);
        first..((middle + reach + 1.0).max(0.0) as usize).min(limit)
    };
    let (columns, rows) = (range(x, raster.width), range(y, raster.height));
    (!columns.is_empty() && !rows.is_empty()).then_some(Disc { centre: local, columns, rows })
}

/// Draws the part of a ball that is in a band of rows. Its loop over columns is without branches, as those of [`Sums`].
fn splat(raster: &Raster, disc: &Disc, radius: f32, first: usize, depth: &mut [f32], thickness: &mut [f32]) {
    let end = first + depth.len() / raster.width;
    let c = disc.centre;
    let (start, step) = (raster.slopes(0.0, 0.0).0, raster.slopes(1.0, 0.0).0 - raster.slopes(0.0, 0.0).0);
    for y in disc.rows.start.max(first)..disc.rows.end.min(end) {
        let (_, dy) = raster.slopes(0.0, y as f32);
        let across = dy * c.z - c.y;
        let row = (y - first) * raster.width;
        let columns = row + disc.columns.start..row + disc.columns.end;
        let (depth, thickness) = (&mut depth[columns.clone()], &mut thickness[columns]);
        for (x, (depth, thickness)) in depth.iter_mut().zip(thickness).enumerate() {
            let dx = start + step * (disc.columns.start + x) as i32 as f32;
            let (p, q) = (dx * c.z - c.x, dx * c.y - dy * c.x);
            let a = 1.0 + dx * dx + dy * dy;
            let square = a * radius * radius - (p * p + across * across + q * q);
            let root = if square > 0.0 { square } else { 0.0 }.sqrt();
            let near = (dx * c.x + dy * c.y + c.z - root) / a;
            let near = if square > 0.0 { near } else { f32::INFINITY };
            *depth = if near < *depth { near } else { *depth };
            *thickness += (2.0 * FILLING) * root / a.sqrt();
        }
    }
}

impl Setting<'_> {
    /// Light along the ray of a place in pixels, with the water of the screen, and its signature.
    pub(super) fn by_screen(
        &self,
        screen: &Screen,
        (x, y): (f32, f32),
        direction: Vec3,
    ) -> (Vec3, Signature) {
        let raster = &self.stage.raster;
        let origin = raster.eye;
        let found = screen.at(x, y).and_then(|Seen { depth, thickness, normal }| {
            let mut distance = depth / direction.dot(raster.forward).max(1e-3);
            let mut normal = normal;
            if let Some((low, high)) = self.stage.container {
                // The wall is the surface of water that touches it: balls there reach through it, or nearly so.
                let (enter, leave) = boxed(low, high, origin, direction)?;
                if distance > leave {
                    return None;
                }
                if distance < enter + TOUCH * screen.spacing {
                    (distance, normal) = (enter, self.face(origin + direction * enter));
                }
            }
            let solid = self.solid(origin, direction, distance + thickness);
            let thickness = solid.map_or(thickness, |(solid, _)| solid - distance);
            (thickness > 0.0).then_some((distance, thickness, normal))
        });
        let Some((distance, thickness, normal)) = found else { return self.radiance(origin, direction) };
        let mut signature = Signature::default();
        signature.meet(10);
        let point = origin + direction * distance;
        let cosine = normal.dot(direction);
        let normal = if cosine < -0.05 { normal } else { (normal - direction * (cosine + 0.05)).normalize() };
        let strength = smooth(0.1, 0.8, thickness / screen.spacing);
        let (refracted, share) = refract(direction, normal, 1.0 / INDEX).unwrap_or((direction, 0.02));
        let direction_below = direction.lerp(refracted, strength).normalize();
        let (light, way) = match self.solid(point + direction * 1e-5, direction_below, f32::INFINITY) {
            Some((way, matter)) => {
                let arrival = super::matter::Arrival {
                    point: point + direction_below * way,
                    direction: direction_below,
                    way: distance + way,
                    film: strength < 0.5 && !matches!(matter, Matter::Body(..)),
                    wet: true,
                };
                (self.shine(&matter, &arrival, &mut signature), way)
            }
            None => (room::background(direction), thickness),
        };
        let Medium { scatter, .. } = self.medium;
        let left = self.medium.left(thickness.min(way));
        let below = light * left + scatter * (Vec3::ONE - left) * 0.55;
        let share = share * strength;
        (below * (1.0 - share) + room::light(reflect(direction, normal)) * share, signature)
    }
}
