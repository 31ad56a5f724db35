//! From the picture to pixels, stage by stage.

use super::bands::{self, BAND};
use super::camera::Camera;
use super::colour::{Encoder, tone};
use super::layer::{self, Ball, Item, Layer, overlap};
use super::light::Shadows;
use super::stage::Stage;
use super::visibility::Visibility;
use super::{Image, Picture, Style, shade, surface};
use glam::Vec3;

/// Samples a pixel along each side.
pub(super) const SAMPLES: usize = 2;

pub(super) fn draw(picture: &Picture<'_>, camera: &Camera, width: u32, height: u32) -> Image {
    let (columns, rows) = (width as usize * SAMPLES, height as usize * SAMPLES);
    let stage = Stage::new(picture, camera, columns, rows);
    let shadows = Shadows::new(&stage);
    let balls = match picture.style {
        Style::Spheres => balls(&stage, 1.0),
        Style::Surface | Style::Realistic => Vec::new(),
    };
    let layer = Layer::opaque(&stage, &balls);
    let visibility = Visibility::new(&stage, &layer, &shadows);
    let mut samples = vec![Vec3::ZERO; columns * rows];
    bands::each_band(&mut samples, columns, BAND, |first, band| {
        solid_colours(&stage, &layer, &visibility, first, band);
    });
    let mut depth = layer.depth;
    if picture.style == Style::Surface {
        (samples, depth) = surface::pour(&stage, &shadows, &samples, depth);
    }
    overlays(&stage, &depth, &mut samples);
    Image { width, height, pixels: develop(&samples, columns) }
}

/// The visible particles, with scaled radius.
pub(super) fn balls(stage: &Stage<'_>, scale: f32) -> Vec<Ball> {
    let ball = |(i, &(_, centre)): (usize, &(usize, Vec3))| {
        Ball::new(&stage.raster, i, centre, stage.radius * scale)
    };
    stage.particles.iter().enumerate().filter_map(ball).collect()
}

/// Colours of whole rows of pixels: one per pixel if all its samples see one thing, else one per sample.
fn solid_colours(stage: &Stage<'_>, layer: &Layer, visibility: &Visibility, first: usize, band: &mut [Vec3]) {
    let columns = stage.raster.width;
    for row in (0..band.len() / columns).step_by(SAMPLES) {
        for x in (0..columns).step_by(SAMPLES) {
            let y = first + row;
            let places = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
            let codes = places.map(|(x, y)| layer.code[y * columns + x]);
            let item = Item::from_code(codes[0]);
            // Bodies have sharp edges and painted marks inside one item.
            let one = codes.iter().all(|&code| code == codes[0]) && !matches!(item, Item::Body(_));
            let colour = |(x, y): (usize, usize)| {
                let (at, ray) = (y * columns + x, stage.raster.ray(x, y));
                let depth = layer.depth[at];
                let light = visibility.at(x, y, depth);
                shade::colour(
                    stage,
                    Item::from_code(layer.code[at]),
                    stage.raster.eye + ray * depth,
                    ray,
                    light,
                )
            };
            let colours = if one { [colour(places[0]); 4] } else { places.map(colour) };
            for ((x, y), colour) in places.into_iter().zip(colours) {
                band[(y - first) * columns + x] = colour;
            }
        }
    }
}

/// Translucent bodies from far to near, then the container's edges.
fn overlays(stage: &Stage<'_>, depth: &[f32], samples: &mut [Vec3]) {
    let raster = &stage.raster;
    let mut order: Vec<usize> = (0..stage.solids.len()).filter(|&i| stage.solids[i].is_clear()).collect();
    let distance = |i: &usize| stage.solids[*i].position.distance(raster.eye);
    order.sort_by(|a, b| distance(b).total_cmp(&distance(a)));
    let frames: Vec<_> = order.iter().map(|&i| (i, layer::frame(raster, &stage.solids[i]))).collect();
    let wires = wires(stage);
    bands::each_band(samples, raster.width, BAND, |first, band| {
        let rows = band.len() / raster.width;
        for (solid, (columns, lines)) in &frames {
            for y in overlap(lines, first, rows) {
                for x in columns.clone() {
                    let Some((colour, opacity)) =
                        shade::glass(stage, *solid, raster.ray(x, y), depth[y * raster.width + x])
                    else {
                        continue;
                    };
                    let sample = &mut band[(y - first) * raster.width + x];
                    *sample = sample.lerp(colour, opacity);
                }
            }
        }
        for y in first..first + rows {
            let row = y * raster.width..(y + 1) * raster.width;
            let start = (y - first) * raster.width;
            for wire in &wires {
                wire.row(y, &depth[row.clone()], &mut band[start..start + raster.width]);
            }
        }
    });
}

/// An edge of the container on the raster.
struct Wire {
    from: (f32, f32),
    to: (f32, f32),
    /// One over the depth at both ends: linear on the raster.
    inverse: (f32, f32),
}

fn wires(stage: &Stage<'_>) -> Vec<Wire> {
    let (Some(floor), raster) = (&stage.floor, &stage.raster) else {
        return Vec::new();
    };
    let corner = |bits: usize| {
        let pick = |bit: usize, low: f32, high: f32| if bits & bit == 0 { low } else { high };
        let (a, b) = (floor.low, floor.high);
        raster.local(Vec3::new(pick(1, a.x, b.x), pick(2, a.y, b.y), pick(4, a.z, b.z)))
    };
    let mut wires = Vec::new();
    for bits in 0..8 {
        for bit in [1, 2, 4].into_iter().filter(|bit| bits & bit == 0) {
            let (mut a, mut b) = (corner(bits), corner(bits | bit));
            if a.z > b.z {
                (a, b) = (b, a);
            }
            if b.z <= raster.near {
                continue;
            }
            if a.z < raster.near {
                a = a.lerp(b, (raster.near - a.z) / (b.z - a.z)).with_z(raster.near);
            }
            wires.push(Wire {
                from: raster.project(a),
                to: raster.project(b),
                inverse: (1.0 / a.z, 1.0 / b.z),
            });
        }
    }
    wires
}

impl Wire {
    /// Blends the part of the wire in one row of samples, where nothing is nearer.
    fn row(&self, y: usize, depth: &[f32], samples: &mut [Vec3]) {
        // Half the width of the line in samples.
        const HALF: f32 = 1.15;
        let ink = Vec3::new(0.10, 0.12, 0.15);
        let (ax, ay, bx, by) = (self.from.0, self.from.1, self.to.0, self.to.1);
        let (dx, dy) = (bx - ax, by - ay);
        let length = dx.hypot(dy);
        let centre = y as f32 + 0.5;
        if length < 1e-3 || centre < ay.min(by) - HALF || centre > ay.max(by) + HALF {
            return;
        }
        // Columns where the row is within the line's width.
        let slack = HALF * length / dy.abs().max(1e-6);
        let middle = ax + dx * (centre - ay) / if dy.abs() < 1e-6 { 1e-6 } else { dy };
        let low = (middle - slack).max(ax.min(bx) - HALF);
        let high = (middle + slack).min(ax.max(bx) + HALF);
        for x in layer::range(low - 1.0, high, samples.len()) {
            let (px, py) = (x as f32 + 0.5 - ax, centre - ay);
            let t = ((px * dx + py * dy) / (length * length)).clamp(0.0, 1.0);
            let off = (px - dx * t).hypot(py - dy * t);
            let cover = (HALF + 0.5 - off).clamp(0.0, 1.0);
            let inverse = self.inverse.0 + (self.inverse.1 - self.inverse.0) * t;
            if cover > 0.0 && 1.0 < 1.002 * depth[x] * inverse {
                samples[x] = samples[x].lerp(ink, 0.5 * cover);
            }
        }
    }
}

/// Mean of a pixel's samples, as bytes.
fn develop(samples: &[Vec3], columns: usize) -> Vec<u8> {
    let encoder = Encoder::new();
    let width = columns / SAMPLES;
    let mut pixels = vec![0; samples.len() / (SAMPLES * SAMPLES) * 3];
    bands::each_band(&mut pixels, width * 3, BAND, |first, band| {
        for (row, line) in band.chunks_mut(width * 3).enumerate() {
            let y = (first + row) * SAMPLES;
            for (x, pixel) in line.as_chunks_mut::<3>().0.iter_mut().enumerate() {
                let at = y * columns + x * SAMPLES;
                // Toned before the mean: a bright sample next to a dark one still gives a smooth edge.
                let sum = tone(samples[at])
                    + tone(samples[at + 1])
                    + tone(samples[at + columns])
                    + tone(samples[at + columns + 1]);
                *pixel = encoder.encode(sum * 0.25);
            }
        }
    });
    pixels
}
