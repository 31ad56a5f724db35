//! The water as a field: how much of the space around a point it fills.

use std::f64::consts::PI;

use glam::Vec3;

use super::Ray;
use crate::{scene::Domain, world::World};

/// Radius around a point, over the spacing.
pub(crate) const RADIUS: f32 = 2.0;

/// Share of the space around a point that is water at the surface.
pub(crate) const SURFACE: f64 = 0.5;

/// Way along a ray between two looks, over the spacing.
pub(crate) const STEP: f32 = 0.25;

/// A particle, or its image.
#[derive(Clone, Copy, Debug)]
struct Sample {
    /// z, y, x.
    cell: [i32; 3],
    place: Vec3,
    row: u32,
    /// Behind a wall: it fills space, and is no water.
    is_mirrored: bool,
}

/// The particles near some box by cells, with their images across periodic sides and behind walls. Water at rest fills half of the space
/// at its surface also beside a wall.
#[derive(Debug)]
pub(super) struct WaterField {
    samples: Vec<Sample>,
    /// Around all of them but mirrored ones; inverted without any.
    extent: (Vec3, Vec3),
    spacing: f32,
    radius: f32,
    volume: f64,
}

impl WaterField {
    pub(super) fn new(world: &World, (low, high): (Vec3, Vec3)) -> Self {
        let fluid = &world.params.fluid;
        let (spacing, radius) = (fluid.spacing, RADIUS * fluid.spacing);
        let volume = f64::from(fluid.particle_mass) / f64::from(fluid.rest_density);
        let (low, high) = (low - radius, high + radius);
        let extent = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let mut field = Self { samples: Vec::new(), extent, spacing, radius, volume };
        let mut images = Vec::new();
        for (row, [x, y, z, _]) in world.particle_positions().iter().enumerate() {
            images.clear();
            images.push((Vec3::new(*x, *y, *z), false));
            add_images(world, radius, &mut images);
            for (place, is_mirrored) in &images {
                if place.cmpge(low).all() && place.cmple(high).all() {
                    let (cell, row) = (field.cell(*place), row as u32);
                    field.samples.push(Sample { cell, place: *place, row, is_mirrored: *is_mirrored });
                }
            }
        }
        field.samples.sort_by_key(|sample| sample.cell);
        let real = field.samples.iter().filter(|sample| !sample.is_mirrored);
        field.extent =
            real.fold(extent, |(low, high), sample| (low.min(sample.place), high.max(sample.place)));
        field
    }

    fn cell(&self, point: Vec3) -> [i32; 3] {
        let [x, y, z] = (point / self.radius).floor().to_array();
        [z as i32, y as i32, x as i32]
    }

    /// Box around all water, images left out; none without any.
    pub(super) fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let (low, high) = self.extent;
        low.is_finite().then(|| (low - self.radius, high + self.radius))
    }

    /// Calls with the row and the share of the space around a point of every particle near it. There is no row for an image behind a wall.
    pub(super) fn around(&self, point: Vec3, mut visit: impl FnMut(Option<usize>, f64)) {
        let [z, y, x] = self.cell(point);
        let scale = self.volume * 21.0 / (2.0 * PI * f64::from(self.radius).powi(3));
        for row in 0..9 {
            let (z, y) = (z.saturating_add(row / 3 - 1), y.saturating_add(row % 3 - 1));
            let [first, last] = [[z, y, x.saturating_sub(1)], [z, y, x.saturating_add(1)]];
            let begin = self.samples.partition_point(|sample| sample.cell < first);
            for sample in self.samples[begin..].iter().take_while(|sample| sample.cell <= last) {
                let q = f64::from(sample.place.distance(point) / self.radius);
                if q < 1.0 {
                    let share = scale * (1.0 - q).powi(4) * (4.0 * q + 1.0);
                    visit((!sample.is_mirrored).then_some(sample.row as usize), share);
                }
            }
        }
    }

    /// Share of the space around a point that is water \[1\].
    pub(super) fn filled(&self, point: Vec3) -> f64 {
        let mut filled = 0.0;
        self.around(point, |_, share| filled += share);
        filled
    }

    /// Distance at which a ray of unit direction meets the surface \[m\].
    pub(super) fn meets(&self, ray: &Ray) -> Option<f32> {
        let is_in = |distance: f32| self.filled(ray.origin + ray.direction * distance) > SURFACE;
        let (first, last) = self.span(ray)?;
        if is_in(first) {
            return Some(first);
        }
        let step = STEP * self.spacing;
        let mut before = first;
        while before < last {
            let now = (before + step).min(last);
            if is_in(now) {
                let (mut out, mut inside) = (before, now);
                for _ in 0..16 {
                    let middle = 0.5 * (out + inside);
                    *(if is_in(middle) { &mut inside } else { &mut out }) = middle;
                }
                return Some(inside);
            }
            before = now;
        }
        None
    }

    /// Where a ray is near the water: it does not look elsewhere.
    fn span(&self, ray: &Ray) -> Option<(f32, f32)> {
        let (low, high) = self.bounds()?;
        clip(ray, low, high)
    }

    /// Outward normal of the surface at a point.
    pub(super) fn normal(&self, point: Vec3) -> Vec3 {
        let step = STEP * self.spacing;
        let slope =
            Vec3::AXES.map(|axis| self.filled(point - axis * step) - self.filled(point + axis * step));
        Vec3::from_array(slope.map(|slope| slope as f32)).normalize_or(Vec3::Y)
    }
}

/// The part of a ray in a box \[m\].
pub(super) fn clip(ray: &Ray, low: Vec3, high: Vec3) -> Option<(f32, f32)> {
    let (mut first, mut last) = (0.0_f32, ray.length);
    for axis in 0..3 {
        let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
        if direction == 0.0 {
            if !(low[axis]..=high[axis]).contains(&origin) {
                return None;
            }
            continue;
        }
        let (a, b) = ((low[axis] - origin) / direction, (high[axis] - origin) / direction);
        (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
    }
    (first <= last).then_some((first, last))
}

/// Images of the first place across periodic sides, and behind walls that are near.
fn add_images(world: &World, radius: f32, images: &mut Vec<(Vec3, bool)>) {
    let Domain::Box { minimum, maximum, periodic } = world.scene().domain else { return };
    for axis in 0..3 {
        for at in 0..images.len() {
            let (place, is_mirrored) = images[at];
            let (below, above) = (place[axis] - minimum[axis], maximum[axis] - place[axis]);
            let mut moved = |to: f32, mirrored: bool| {
                let mut image = place;
                image[axis] = to;
                images.push((image, is_mirrored || mirrored));
            };
            if below < radius {
                if periodic[axis] {
                    moved(place[axis] + maximum[axis] - minimum[axis], false);
                } else {
                    moved(minimum[axis] - below, true);
                }
            }
            if above < radius {
                if periodic[axis] {
                    moved(place[axis] - (maximum[axis] - minimum[axis]), false);
                } else {
                    moved(maximum[axis] + above, true);
                }
            }
        }
    }
}
