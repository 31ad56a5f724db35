//! Water as one smooth surface: the smoothed depth of the particles, with absorption along the ray.

use super::bands::{self, BAND};
use super::colour::{floor, smooth};
use super::compose::{SAMPLES, balls};
use super::layer::{Ball, Layer, bin, overlap};
use super::light::{self, Shadows};
use super::shade::{FOAM, KEY, SKY, sky};
use super::stage::Stage;
use glam::Vec3;

/// Drawn radius of a particle in this style, in particle radii: neighbours must overlap for a closed surface.
const SWELL: f32 = 1.5;
/// Balls of half the spacing fill about half of the water's volume.
const FILLING: f32 = 1.0 / 0.52;
/// Absorption of red, green and blue over a tenth of the scene's diagonal.
const ABSORPTION: Vec3 = Vec3::new(1.5, 0.5, 0.25);

/// Water of one pixel.
#[derive(Clone, Copy)]
struct Pixel {
    /// Depth of the surface in m; infinite where there is none.
    depth: f32,
    /// Length of water along the ray, m.
    thickness: f32,
    /// Speed as `Stage::speed`, times the thickness.
    speed: f32,
    normal: Vec3,
    /// Key light that arrives.
    key: f32,
}

const DRY: Pixel = Pixel { depth: f32::INFINITY, thickness: 0.0, speed: 0.0, normal: Vec3::ZERO, key: 1.0 };

/// Draws the water over samples that show everything else; returns the samples and their new depth.
pub(super) fn pour(
    stage: &Stage<'_>,
    shadows: &Shadows,
    samples: &[Vec3],
    mut depth: Vec<f32>,
) -> (Vec<Vec3>, Vec<f32>) {
    let raster = &stage.raster;
    let layer = Layer::balls(raster, &balls(stage, SWELL));
    let width = raster.width / SAMPLES;
    let mut pixels = thickness(stage, &depth);
    for (i, pixel) in pixels.iter_mut().enumerate() {
        pixel.depth = layer.depth[SAMPLES * (i / width) * raster.width + SAMPLES * (i % width)];
    }
    for sideways in [true, false, true, false, true, false] {
        pixels = even_out(stage, &pixels, width, sideways);
    }
    let pixels = orient(stage, shadows, &pixels, width);
    let mut result = samples.to_vec();
    bands::each_band(&mut result, raster.width, BAND, |first, band| {
        for (i, sample) in band.iter_mut().enumerate() {
            let (x, y) = (i % raster.width, first + i / raster.width);
            let at = y * raster.width + x;
            if layer.depth[at] < depth[at]
                && let Some(pixel) = wet(&pixels, width, x / SAMPLES, y / SAMPLES)
            {
                *sample = water(stage, pixel, (x, y), samples, &depth);
            }
        }
    });
    for (depth, water) in depth.iter_mut().zip(&layer.depth) {
        *depth = depth.min(*water);
    }
    (result, depth)
}

/// Length of water in front of the opaque items, and its speed, per pixel.
fn thickness(stage: &Stage<'_>, depth: &[f32]) -> Vec<Pixel> {
    let raster = &stage.raster;
    let balls = balls(stage, 1.0);
    let width = raster.width / SAMPLES;
    let bins = bin(balls.iter().map(|b: &Ball| b.rows.clone()), raster.height);
    let mut pixels = vec![DRY; width * (raster.height / SAMPLES)];
    bands::each_band(&mut pixels, width, BAND / SAMPLES, |first, band| {
        let (start, rows) = (first * SAMPLES, band.len() / width * SAMPLES);
        for ball in bins[start / BAND].iter().map(|&i| &balls[i]) {
            let speed = stage.speed(stage.particles[ball.particle].0);
            for y in overlap(&ball.rows, start, rows).filter(|y| y % SAMPLES == 0) {
                let row = &mut band[(y - start) / SAMPLES * width..][..width];
                ball.row(raster, y, |x, front, chord| {
                    if x % SAMPLES == 0 && front < depth[y * raster.width + x] {
                        row[x / SAMPLES].thickness += chord * FILLING;
                        row[x / SAMPLES].speed += speed * chord * FILLING;
                    }
                });
            }
        }
    });
    pixels
}

/// One pass of an edge-preserving smoothing filter: depths more than a few particles apart do not mix.
fn even_out(stage: &Stage<'_>, pixels: &[Pixel], width: usize, sideways: bool) -> Vec<Pixel> {
    let height = pixels.len() / width;
    let apart = 3.0 * stage.radius;
    let scale = 1.7 * stage.radius * stage.raster.focal / SAMPLES as f32;
    let mut result = pixels.to_vec();
    bands::each_band(&mut result, width, BAND, |first, band| {
        for (i, pixel) in band.iter_mut().enumerate() {
            if pixel.depth == f32::INFINITY {
                continue;
            }
            let (x, y) = (i % width, first + i / width);
            let reach = (scale / pixel.depth).clamp(1.0, 14.0);
            let taps = super::colour::index(reach);
            let (at, limit) = if sideways { (x, width) } else { (y, height) };
            let (mut depth, mut thickness, mut speed, mut total) = (0.0, 0.0, 0.0, 0.0);
            for other in at.saturating_sub(taps)..(at + taps + 1).min(limit) {
                let near = if sideways { pixels[y * width + other] } else { pixels[other * width + x] };
                // A pixel far in front belongs to another sheet of water. One far behind counts as just behind.
                if near.depth == f32::INFINITY || near.depth < pixel.depth - apart {
                    continue;
                }
                let distance = other.abs_diff(at) as f32 / (reach + 1.0);
                let weight = (1.0 - distance * distance).max(0.0);
                depth += weight * near.depth.min(pixel.depth + apart);
                thickness += weight * near.thickness;
                speed += weight * near.speed;
                total += weight;
            }
            if total > 0.0 {
                (pixel.depth, pixel.thickness, pixel.speed) =
                    (depth / total, thickness / total, speed / total);
            }
        }
    });
    result
}

/// Normals from the slopes of the depth, and the key light that reaches the surface.
fn orient(stage: &Stage<'_>, shadows: &Shadows, pixels: &[Pixel], width: usize) -> Vec<Pixel> {
    let (raster, height) = (&stage.raster, pixels.len() / width);
    let apart = 3.0 * stage.radius;
    let place =
        |x: usize, y: usize| raster.eye + raster.ray(x * SAMPLES, y * SAMPLES) * pixels[y * width + x].depth;
    let mut result = pixels.to_vec();
    bands::each_band(&mut result, width, BAND, |first, band| {
        for (i, pixel) in band.iter_mut().enumerate() {
            if pixel.depth == f32::INFINITY {
                continue;
            }
            let (x, y) = (i % width, first + i / width);
            let here = place(x, y);
            let near = |nx: usize, ny: usize| {
                let depth = pixels[ny * width + nx].depth;
                ((depth - pixel.depth).abs() < apart).then(|| place(nx, ny))
            };
            // From neighbour to neighbour, or to the neighbour on the same sheet.
            let slope =
                |before: Option<Vec3>, after: Option<Vec3>| after.unwrap_or(here) - before.unwrap_or(here);
            let left = (x > 0).then(|| near(x - 1, y)).flatten();
            let right = (x + 1 < width).then(|| near(x + 1, y)).flatten();
            let above = (y > 0).then(|| near(x, y - 1)).flatten();
            let below = (y + 1 < height).then(|| near(x, y + 1)).flatten();
            let towards_eye = (raster.eye - here).normalize_or(Vec3::Y);
            pixel.normal = slope(below, above).cross(slope(left, right)).normalize_or_zero();
            pixel.normal = if pixel.normal.dot(towards_eye) < 0.0 { -pixel.normal } else { pixel.normal };
            if pixel.normal == Vec3::ZERO {
                pixel.normal = towards_eye;
            }
            let lifted = here + light::direction() * (2.5 * stage.radius);
            pixel.key = shadows.light(lifted, light::direction(), (0.0, 1.0));
        }
    });
    result
}

/// The water of a pixel, or of a neighbour where a sample at the edge of the water has none.
fn wet(pixels: &[Pixel], width: usize, x: usize, y: usize) -> Option<Pixel> {
    let height = pixels.len() / width;
    let own = pixels[y * width + x];
    if own.depth < f32::INFINITY {
        return Some(own);
    }
    (y.saturating_sub(1)..(y + 2).min(height))
        .flat_map(|y| (x.saturating_sub(1)..(x + 2).min(width)).map(move |x| pixels[y * width + x]))
        .find(|pixel| pixel.depth < f32::INFINITY)
}

/// Light that the water transmits, scatters and reflects.
fn water(stage: &Stage<'_>, pixel: Pixel, (x, y): (usize, usize), samples: &[Vec3], depth: &[f32]) -> Vec3 {
    let raster = &stage.raster;
    let ray = raster.ray(x, y);
    let (towards, normal) = (-ray.normalize_or_zero(), pixel.normal);
    // Thin water at an outline is still a drop thick.
    let thickness = pixel.thickness.max(1.5 * stage.radius);
    let shift = 0.22 * thickness.min(0.1 * stage.size) * raster.focal / pixel.depth;
    let bent = |at: usize, by: f32, limit: usize| {
        usize::try_from(floor(at as f32 + by).max(0)).unwrap_or(0).min(limit - 1)
    };
    let bx = bent(x, -normal.dot(raster.right) * shift, raster.width);
    let by = bent(y, normal.dot(raster.up) * shift, raster.height);
    let behind = if depth[by * raster.width + bx] > pixel.depth {
        by * raster.width + bx
    } else {
        y * raster.width + x
    };
    let loss = ABSORPTION * (-10.0 * thickness / stage.size);
    let left = Vec3::new(loss.x.exp(), loss.y.exp(), loss.z.exp());
    let facing = 0.35 + 0.65 * normal.dot(light::direction()).max(0.0);
    let arriving = SKY + KEY * (facing * pixel.key);
    let mut colour = samples[behind] * left + Vec3::new(0.012, 0.085, 0.165) * arriving * (Vec3::ONE - left);
    let speed = if pixel.thickness > 0.0 { pixel.speed / pixel.thickness } else { 0.0 };
    let foam = 0.65 * smooth(0.35, 1.0, speed) * smooth(0.0, 4.0, thickness / stage.radius);
    colour = colour.lerp(FOAM * arriving * 0.55, foam);
    let cosine = normal.dot(towards).clamp(0.0, 1.0);
    let fresnel = 0.02 + 0.98 * (1.0 - cosine).powi(5);
    colour = colour.lerp(sky(-towards + normal * (2.0 * cosine)), 0.85 * fresnel);
    let half = (towards + light::direction()).normalize_or_zero();
    colour + KEY * (0.9 * pixel.key * normal.dot(half).max(0.0).powi(90))
}
