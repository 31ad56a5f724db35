//! Pixels from rays: few where the picture is smooth, more at edges.
//!
//! A ray for every fourth pixel of every fourth row. Between neighbours with equal paths and similar colours their mean, else
//! a ray; the same at every second pixel. Then more rays where neighbours differ. A pixel depends on its own surroundings
//! only, so that bands may be drawn in any order.

use super::path::Signature;
use crate::render::{bands, colour::smooth};
use glam::Vec3;

/// What samples may differ in that are mixed.
#[derive(Clone, Copy, Debug)]
struct Likeness {
    /// Difference of a channel, of [`MOST`].
    tolerance: u64,
    /// The bits of the path that must be equal.
    path: u32,
}

/// How many rays a picture takes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effort {
    /// At every second pixel, and between them.
    likeness: [Likeness; 2],
    /// Rays that a pixel at an edge gets: their places in pixels.
    pub(super) added: &'static [(f32, f32)],
}

impl Effort {
    /// No difference to a ray for every pixel that an eye would see.
    pub(super) const FULL: Self = Self {
        likeness: [Likeness { tolerance: 48, path: u32::MAX }, Likeness { tolerance: 64, path: u32::MAX }],
        added: &[(0.34, 0.17), (-0.34, -0.17)],
    };
    /// Pores and joints of tiles are a little blurred.
    pub(super) const LITTLE: Self = Self {
        likeness: [Likeness { tolerance: 80, path: u32::MAX }, Likeness { tolerance: 200, path: 0xffff }],
        added: &[(0.34, 0.25)],
    };
}

/// Differences of neighbours, with equal and with different paths: from the first on a pixel gets more rays, at the second it takes them
/// fully. A pixel at the limit must not jump from frame to frame.
const CONTRAST: (f32, f32) = (0.2, 0.32);
const PATHS: (f32, f32) = (0.07, 0.12);
/// A smaller difference has no effect, of [`MOST`].
const LEAST: u64 = (PATHS.0 * MOST as f32) as u64;
/// Largest value of a channel.
const MOST: u32 = 1023;

#[cfg(feature = "gpu")]
shared_with_shaders!(PIXELS: CONTRAST, PATHS, MOST);
/// Pixels from one ray of the first pass to the next.
pub(super) const STRIDE: usize = 4;

/// Colour of a place and the signature of its path.
#[derive(Clone, Copy, Debug, Default)]
struct Sample {
    /// Red, green and blue, 0 to [`MOST`], in 16 bits each: one instruction compares all of them.
    colour: u64,
    path: u32,
}

/// One in each channel, and the bit above its value.
const ONES: u64 = 0x0001_0001_0001;
const GUARDS: u64 = ONES << 15;

impl Sample {
    fn new(colour: Vec3, path: u32) -> Self {
        let [r, g, b] = colour.to_array().map(|channel| (channel * MOST as f32 + 0.5) as u64);
        Self { colour: r | g << 16 | b << 32, path }
    }

    fn channels(self) -> [u32; 3] {
        [0, 16, 32].map(|shift| (self.colour >> shift) as u32 & MOST)
    }

    fn colour(self) -> Vec3 {
        let [r, g, b] = self.channels();
        Vec3::new(r as f32, g as f32, b as f32) / MOST as f32
    }

    /// The colour in eight bits a channel.
    fn bytes(self) -> [u8; 3] {
        self.channels().map(|channel| ((channel * 1021 + 2048) >> 12) as u8)
    }

    /// Largest difference of a channel, 0 to [`MOST`].
    fn difference(self, other: Self) -> u32 {
        let ([a, b, c], [d, e, f]) = (self.channels(), other.channels());
        a.abs_diff(d).max(b.abs_diff(e)).max(c.abs_diff(f))
    }

    /// Whether every channel differs by less than a limit.
    #[inline]
    fn is_like(self, other: Self, limit: u64) -> bool {
        // The guard of a channel is set from a difference of one less than the limit below zero on. It is cleared again where the
        // difference reaches the limit.
        let above = (self.colour | GUARDS) - other.colour + ONES * (limit - 1);
        above & !(above - ONES * (2 * limit - 1)) & GUARDS == GUARDS
    }
}

/// A picture of `width` x `height` pixels, three bytes each.
///
/// `ray` gives the colour (0 to 1, as displayed) and the path of a place in pixels. `watched` blocks of [`STRIDE`] pixels, row
/// by row, hold things that may be smaller than the distance of rays: each of their pixels gets one.
pub(super) fn pixels(
    (width, height): (usize, usize),
    watched: &[bool],
    effort: Effort,
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
    bands::each_row(&mut samples, columns, 1, |y, row| {
        row.iter_mut().enumerate().for_each(|(x, sample)| *sample = shoot(x * STRIDE, y * STRIDE));
    });
    let mut stride = STRIDE;
    for likeness in effort.likeness {
        stride /= 2;
        let finer = (width.div_ceil(stride), height.div_ceil(stride));
        let mut fine = vec![Sample::default(); finer.0 * finer.1];
        bands::each_row(&mut fine, finer.0, 4, |y, row| {
            let coarse = |j: usize| &samples[j.min(rows - 1) * columns..][..columns];
            let (above, below) = (coarse(y / 2), coarse(y / 2 + y % 2));
            for (x, sample) in row.iter_mut().enumerate() {
                let (left, right) = (x / 2, (x / 2 + 1).min(columns - 1));
                let mean = match (x % 2, y % 2) {
                    (0, 0) => {
                        *sample = above[left];
                        continue;
                    }
                    (0, _) => mixed(above[left], below[left], likeness),
                    (_, 0) => mixed(above[left], above[right], likeness),
                    _ => mixed_of_four([above[left], above[right], below[left], below[right]], likeness),
                };
                let (x, y) = (x * stride, y * stride);
                *sample = mean.filter(|_| !is_watched(x, y)).unwrap_or_else(|| shoot(x, y));
            }
        });
        samples = fine;
        (columns, rows) = finer;
    }
    let mut bytes = vec![0; width * height * 3];
    bands::each_row(&mut bytes, width * 3, 4, |y, row| {
        let at = |y: usize| &samples[y.min(height - 1) * width..][..width];
        let (above, own, below) = (at(y.saturating_sub(1)), at(y), at(y + 1));
        let mut edges = vec![false; width];
        mark(above, own, &mut edges);
        mark(below, own, &mut edges);
        mark(&own[..width - 1], &own[1..], &mut edges[1..]);
        mark(&own[1..], &own[..width - 1], &mut edges[..width - 1]);
        for (x, (pixel, is_edge)) in row.as_chunks_mut::<3>().0.iter_mut().zip(edges).enumerate() {
            *pixel = if is_edge {
                let around = [own[x.saturating_sub(1)], own[(x + 1).min(width - 1)], above[x], below[x]];
                let colour = refined(own[x], around, effort.added, |dx, dy| {
                    ray(x as f32 + 0.5 + dx, y as f32 + 0.5 + dy).0
                });
                colour.to_array().map(|channel| (channel * 255.0 + 0.5) as u8)
            } else {
                own[x].bytes()
            };
        }
    });
    bytes
}

/// Marks samples whose colour differs from that of a neighbour so much that it may have an effect.
fn mark(neighbours: &[Sample], own: &[Sample], edges: &mut [bool]) {
    for ((edge, own), neighbour) in edges.iter_mut().zip(own).zip(neighbours) {
        *edge |= !own.is_like(*neighbour, LEAST);
    }
}

/// The mean of two samples with equal paths and similar colours.
fn mixed(a: Sample, b: Sample, likeness: Likeness) -> Option<Sample> {
    let colour = ((a.colour + b.colour + ONES) >> 1) & (ONES * u64::from(MOST));
    likeness.holds(a, b).then_some(Sample { colour, path: a.path })
}

/// The same of four.
fn mixed_of_four([a, b, c, d]: [Sample; 4], likeness: Likeness) -> Option<Sample> {
    let pairs = [(a, b), (a, c), (a, d), (b, c), (b, d), (c, d)];
    let colour = ((a.colour + b.colour + c.colour + d.colour + 2 * ONES) >> 2) & (ONES * u64::from(MOST));
    pairs.iter().all(|(a, b)| likeness.holds(*a, *b)).then_some(Sample { colour, path: a.path })
}

impl Likeness {
    fn holds(self, a: Sample, b: Sample) -> bool {
        (a.path ^ b.path) & self.path == 0 && a.is_like(b, self.tolerance)
    }
}

/// Colour of a pixel, with more rays where its neighbours differ.
fn refined(own: Sample, around: [Sample; 4], added: &[(f32, f32)], ray: impl Fn(f32, f32) -> Vec3) -> Vec3 {
    let mut share = 0.0_f32;
    for other in around {
        let limits = if (other.path ^ own.path) & 0xffff == 0 { CONTRAST } else { PATHS };
        let difference = own.difference(other) as f32 / MOST as f32;
        share = share.max(smooth(limits.0, limits.1, difference));
    }
    let colour = own.colour();
    if share <= 0.0 {
        return colour;
    }
    let sum = added.iter().fold(colour, |sum, (dx, dy)| sum + ray(*dx, *dy));
    colour.lerp(sum * (1.0 / (added.len() + 1) as f32), share)
}
