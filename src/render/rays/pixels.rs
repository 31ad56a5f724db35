//! Pixels from rays: few where the picture is smooth, more at edges.
//!
//! A ray for every fourth pixel of every fourth row; between neighbours with equal paths and similar colours their mean, else
//! a ray; the same at every second pixel. Then more rays where neighbours differ. A pixel depends on its own surroundings
//! only, so that bands may be drawn in any order.

use super::path::Signature;
use crate::render::{bands, colour::smooth};
use glam::Vec3;

/// Difference of colours, of [`MOST`], that are not mixed.
const TOLERANCE: u32 = 48;
/// Difference of neighbours, with equal and with different paths, from which on a pixel gets more rays, and where it takes
/// them fully: a pixel at the limit must not jump from frame to frame.
const CONTRAST: (f32, f32) = (0.17, 0.27);
const PATHS: (f32, f32) = (0.05, 0.09);
/// Largest value of a channel.
const MOST: u32 = 1023;
/// Places of the rays that are added, in pixels.
const ADDED: [(f32, f32); 3] = [(0.33, 0.17), (-0.17, 0.33), (-0.33, -0.25)];
/// Pixels from one ray of the first pass to the next.
pub(super) const STRIDE: usize = 4;

/// Colour of ten bits a channel, and the signature of its path.
#[derive(Clone, Copy, Debug, Default)]
struct Sample {
    colour: u32,
    path: u32,
}

impl Sample {
    fn new(colour: Vec3, path: u32) -> Self {
        let [r, g, b] = colour.to_array().map(|channel| (channel * MOST as f32 + 0.5) as u32);
        Self { colour: r | g << 10 | b << 20, path }
    }

    fn channels(self) -> [u32; 3] {
        [self.colour & MOST, self.colour >> 10 & MOST, self.colour >> 20 & MOST]
    }

    fn colour(self) -> Vec3 {
        let [r, g, b] = self.channels();
        Vec3::new(r as f32, g as f32, b as f32) / MOST as f32
    }

    /// Largest difference of a channel, 0 to [`MOST`].
    fn difference(self, other: Self) -> u32 {
        let ([a, b, c], [d, e, f]) = (self.channels(), other.channels());
        a.abs_diff(d).max(b.abs_diff(e)).max(c.abs_diff(f))
    }
}

/// A picture of `width` x `height` pixels, three bytes each.
///
/// `ray` gives the colour (0 to 1, as displayed) and the path of a place in pixels. `watched` blocks of [`STRIDE`] pixels, row
/// by row, hold things that may be smaller than the distance of rays: each of their pixels gets one.
pub(super) fn pixels(
    (width, height): (usize, usize),
    watched: &[bool],
    ray: impl Fn(f32, f32) -> (Vec3, Signature) + Sync,
) -> Vec<u8> {
    let shoot = |x: usize, y: usize| {
        let (colour, path) = ray(x as f32 + 0.5, y as f32 + 0.5);
        Sample::new(colour, path.fold())
    };
    let (mut columns, mut rows) = (width.div_ceil(STRIDE), height.div_ceil(STRIDE));
    let blocks = columns;
    let is_watched = |x: usize, y: usize| watched[y / STRIDE * blocks + x / STRIDE];
    let mut samples = vec![Sample::default(); columns * rows];
    bands::each_band(&mut samples, columns, 1, |y, row| {
        row.iter_mut().enumerate().for_each(|(x, sample)| *sample = shoot(x * STRIDE, y * STRIDE));
    });
    let mut stride = STRIDE;
    while stride > 1 {
        stride /= 2;
        let finer = (width.div_ceil(stride), height.div_ceil(stride));
        let mut fine = vec![Sample::default(); finer.0 * finer.1];
        let coarse = |x: usize, y: usize| samples[y.min(rows - 1) * columns + x.min(columns - 1)];
        bands::each_band(&mut fine, finer.0, 4, |first, band| {
            for (index, sample) in band.iter_mut().enumerate() {
                let (x, y) = (index % finer.0, first + index / finer.0);
                let (i, j) = (x / 2, y / 2);
                *sample = if x % 2 == 0 && y % 2 == 0 {
                    coarse(i, j)
                } else {
                    let four = [
                        coarse(i, j),
                        coarse(i + x % 2, j),
                        coarse(i, j + y % 2),
                        coarse(i + x % 2, j + y % 2),
                    ];
                    let (x, y) = (x * stride, y * stride);
                    mixed(four).filter(|_| !is_watched(x, y)).unwrap_or_else(|| shoot(x, y))
                };
            }
        });
        samples = fine;
        (columns, rows) = finer;
    }
    let mut bytes = vec![0; width * height * 3];
    bands::each_band(&mut bytes, width * 3, 4, |first, band| {
        for (index, pixel) in band.as_chunks_mut::<3>().0.iter_mut().enumerate() {
            let (x, y) = (index % width, first + index / width);
            let colour = refined(&samples, (width, height), (x, y), &ray);
            *pixel = colour.to_array().map(|channel| (channel * 255.0 + 0.5) as u8);
        }
    });
    bytes
}

/// The mean of samples with equal paths and similar colours.
fn mixed(four: [Sample; 4]) -> Option<Sample> {
    let path = four[0].path;
    if four.iter().any(|sample| sample.path != path) {
        return None;
    }
    let [a, b, c, d] = four.map(Sample::channels);
    let mut colour = 0;
    for (channel, shift) in [0, 10, 20].into_iter().enumerate() {
        let four = [a[channel], b[channel], c[channel], d[channel]];
        let least = four[0].min(four[1]).min(four[2]).min(four[3]);
        let most = four[0].max(four[1]).max(four[2]).max(four[3]);
        if most - least >= TOLERANCE {
            return None;
        }
        colour |= ((four[0] + four[1] + four[2] + four[3] + 2) / 4) << shift;
    }
    Some(Sample { colour, path })
}

/// Colour of a pixel, with more rays where its neighbours differ.
fn refined(
    samples: &[Sample],
    (width, height): (usize, usize),
    (x, y): (usize, usize),
    ray: &(impl Fn(f32, f32) -> (Vec3, Signature) + Sync),
) -> Vec3 {
    let index = y * width + x;
    let own = samples[index];
    // Less than that has no effect.
    let least = (PATHS.0 * MOST as f32) as u32;
    let mut share = 0.0_f32;
    let mut compare = |other: Sample| {
        let difference = own.difference(other);
        if difference <= least {
            return;
        }
        let difference = difference as f32 / MOST as f32;
        let limits = if (other.path ^ own.path) & 0xffff == 0 { CONTRAST } else { PATHS };
        share = share.max(smooth(limits.0, limits.1, difference));
    };
    if x > 0 {
        compare(samples[index - 1]);
    }
    if x + 1 < width {
        compare(samples[index + 1]);
    }
    if y > 0 {
        compare(samples[index - width]);
    }
    if y + 1 < height {
        compare(samples[index + width]);
    }
    let colour = own.colour();
    if share <= 0.0 {
        return colour;
    }
    let (x, y) = (x as f32 + 0.5, y as f32 + 0.5);
    let sum = ADDED.iter().fold(colour, |sum, (dx, dy)| sum + ray(x + dx, y + dy).0);
    colour.lerp(sum * (1.0 / (ADDED.len() + 1) as f32), share)
}
