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

/// Radius of a ball over the spacing: those of neighbours must overlap.
const BALL: f32 = 0.62;
/// Volume of a particle over that of its ball.
const FILLING: f32 = 1.0;
/// Rows of a task.
const BAND: usize = 16;
/// The filter: reach along a row, in spacings and in samples, and the range of depths that mix, in spacings.
const REACH: f32 = 1.6;
const MOST_SAMPLES: f32 = 8.0;
const RANGE: f32 = 2.5;
/// What is farther behind counts as this far behind, in spacings.
const BEHIND: f32 = 0.5;
/// Passes of the filter, each along rows and along columns.
const PASSES: usize = 2;

/// Pixels of the picture along a side of a sample of the screen.
const COARSE: usize = 2;

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

impl Screen {
    /// The free water as the raster sees it.
    pub(super) fn new(stage: &Stage<'_>) -> Self {
        let raster = stage.raster.coarser(COARSE);
        let (width, height, spacing) = (raster.width, raster.height, 2.0 * stage.radius);
        let radius = BALL * spacing;
        let free = stage.particles.iter().filter(|(index, _)| stage.interior(*index) < 0.7);
        let discs: Vec<Disc> = free.filter_map(|(_, place)| disc(&raster, *place, radius)).collect();
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
        let rows = bands::map(height, |y| (0..width).map(|x| screen.slope(x, y)).collect::<Vec<_>>());
        screen.normal = rows.into_iter().flatten().collect();
        screen
    }

    /// One pass of the filter along rows or columns.
    fn even_out(&mut self, sideways: bool) {
        let (width, height) = (self.width, self.height);
        let (near, behind) = (RANGE * self.spacing, BEHIND * self.spacing);
        let scale = REACH * self.spacing * self.raster.focal;
        let (depth, thickness) = (&self.depth, &self.thickness);
        let mut result: Vec<(f32, f32)> = vec![(f32::INFINITY, 0.0); width * height];
        bands::each_band(&mut result, width, BAND, |first, band| {
            for (index, out) in band.iter_mut().enumerate() {
                let (x, y) = (index % width, first + index / width);
                let own = y * width + x;
                let here = depth[own];
                if here == f32::INFINITY {
                    continue;
                }
                let reach = (scale / here).clamp(1.0, MOST_SAMPLES);
                let taps = reach as usize;
                let (at, limit, stride) = if sideways { (x, width, 1) } else { (y, height, width) };
                // As far to one side as to the other, or a slope would shrink.
                let taps = taps.min(at).min(limit - 1 - at);
                let (mut sum, mut water, mut total) = (here, thickness[own], 1.0);
                for tap in 1..=taps {
                    let (a, b) = (depth[own - tap * stride], depth[own + tap * stride]);
                    // In front of the range is another sheet; a pair keeps the filter even.
                    if a < here - near || b < here - near {
                        continue;
                    }
                    let share = tap as f32 / (reach + 1.0);
                    let weight = 1.0 - share * share;
                    let clamp = |depth: f32| if depth > here + near { here + behind } else { depth };
                    sum += weight * (clamp(a) + clamp(b));
                    water += weight * (thickness[own - tap * stride] + thickness[own + tap * stride]);
                    total += 2.0 * weight;
                }
                *out = (sum / total, water / total);
            }
        });
        (self.depth, self.thickness) = result.into_iter().unzip();
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

/// Draws the part of a ball that is in a band of rows.
fn splat(raster: &Raster, disc: &Disc, radius: f32, first: usize, depth: &mut [f32], thickness: &mut [f32]) {
    let end = first + depth.len() / raster.width;
    let c = disc.centre;
    for y in disc.rows.start.max(first)..disc.rows.end.min(end) {
        let (_, dy) = raster.slopes(0.0, y as f32);
        let across = dy * c.z - c.y;
        let row = (y - first) * raster.width;
        for x in disc.columns.clone() {
            let (dx, _) = raster.slopes(x as f32, 0.0);
            let (p, q) = (dx * c.z - c.x, dx * c.y - dy * c.x);
            let a = 1.0 + dx * dx + dy * dy;
            let square = a * radius * radius - (p * p + across * across + q * q);
            if square > 0.0 {
                let (root, inverse) = (square.sqrt(), 1.0 / a);
                let near = (dx * c.x + dy * c.y + c.z - root) * inverse;
                let (depth, thickness) = (&mut depth[row + x], &mut thickness[row + x]);
                *depth = depth.min(near);
                *thickness += 2.0 * root * inverse * a.sqrt() * FILLING;
            }
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
                // Balls reach through walls: there the wall is the surface.
                let (enter, leave) = boxed(low, high, origin, direction)?;
                if distance > leave {
                    return None;
                }
                if distance < enter {
                    (distance, normal) = (enter, self.face(origin + direction * enter));
                }
            }
            let solid = self.solid(origin, direction, f32::INFINITY).map_or(f32::INFINITY, |hit| hit.0);
            let thickness = thickness.min(solid - distance);
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
