//! Pixels from rays: few where the picture is smooth, more at edges.
//!
//! A ray for every fourth pixel of every fourth row; between neighbours with equal paths and similar colours their mean, else
//! a ray; the same at every second pixel. Then more rays where neighbours differ. A pixel depends on its own surroundings
//! only, so that bands may be drawn in any order.

use super::path::Signature;
use crate::render::{bands, colour::smooth};
use glam::Vec3;

/// Largest difference of colours that are mixed.
const TOLERANCE: f32 = 0.045;
/// Difference of neighbours, with equal and with different paths, from which on a pixel gets more rays, and where it takes
/// them fully: a pixel at the limit must not jump from frame to frame.
const CONTRAST: (f32, f32) = (0.17, 0.27);
const PATHS: (f32, f32) = (0.05, 0.09);
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
        let [r, g, b] = colour.to_array().map(|channel| (channel * 1023.0 + 0.5) as u32);
        Self { colour: r | g << 10 | b << 20, path }
    }

    fn colour(self) -> Vec3 {
        let channel = |shift: u32| (self.colour >> shift & 1023) as f32;
        Vec3::new(channel(0), channel(10), channel(20)) / 1023.0
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
    if four.iter().any(|sample| sample.path != four[0].path) {
        return None;
    }
    let path = four[0].path;
    let four = four.map(Sample::colour);
    let least = four[0].min(four[1]).min(four[2]).min(four[3]);
    let most = four[0].max(four[1]).max(four[2]).max(four[3]);
    let mean = (four[0] + four[1] + four[2] + four[3]) * 0.25;
    ((most - least).max_element() < TOLERANCE).then(|| Sample::new(mean, path))
}

/// Colour of a pixel, with more rays where its neighbours differ.
fn refined(
    samples: &[Sample],
    (width, height): (usize, usize),
    (x, y): (usize, usize),
    ray: &(impl Fn(f32, f32) -> (Vec3, Signature) + Sync),
) -> Vec3 {
    let index = y * width + x;
    let (own, colour) = (samples[index], samples[index].colour());
    let neighbours = [
        (x > 0).then(|| index - 1),
        (x + 1 < width).then(|| index + 1),
        (y > 0).then(|| index - width),
        (y + 1 < height).then(|| index + width),
    ];
    let mut share = 0.0_f32;
    for other in neighbours.into_iter().flatten().map(|other| samples[other]) {
        if other.colour == own.colour {
            continue;
        }
        let difference = (other.colour() - colour).abs().max_element();
        share = share.max(smooth(CONTRAST.0, CONTRAST.1, difference));
        if (other.path ^ own.path) & 0xffff != 0 {
            share = share.max(smooth(PATHS.0, PATHS.1, difference));
        }
    }
    if share <= 0.0 {
        return colour;
    }
    let (x, y) = (x as f32 + 0.5, y as f32 + 0.5);
    let sum = ADDED.iter().fold(colour, |sum, (dx, dy)| sum + ray(x + dx, y + dy).0);
    colour.lerp(sum * (1.0 / (ADDED.len() + 1) as f32), share)
}
