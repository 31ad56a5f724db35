//! Rows of images: what particles near walls and bodies see behind them.

use glam::Vec3;

use super::{mirror::Mirrored, near::OfBodies, walls::NearWalls};
use crate::{
    column::ColumnData,
    cpu::Rows,
    grid::neighbors::{ListValues, Neighbors},
    lanes::LANES,
    layout::constants,
    params::Params,
};

constants! {
    /// Lane of the position of an image: its volume over that of its particle.
    pub(crate) const IMAGE_RATIO: usize = 3;
    /// No body: the image is one in walls alone.
    pub(crate) const NO_BODY: u32 = u32::MAX;
}

/// An image of a particle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Image {
    pub(crate) position: Vec3,
    /// Axes whose walls mirror it, a bit each.
    pub(crate) axes: u32,
    pub(crate) body: u32,
    /// In the body, before the walls; the particle itself without one.
    pub(crate) mirrored: Mirrored,
}

/// An image in a body, and the row of its particle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InBody {
    pub(super) row: u32,
    pub(super) body: u32,
    pub(super) mirrored: Mirrored,
}

/// The images of all particles, in the order of those, and the lists of neighbours between both.
#[derive(Clone, Debug, Default)]
pub struct Images {
    /// Position \[m\]; w: volume over that of the particle \[1\].
    pub(crate) position: Vec<[f32; 4]>,
    /// Axes whose walls mirror it, a bit each.
    pub(crate) axes: Vec<u32>,
    /// Row of the particle.
    pub(crate) source: Vec<u32>,
    /// Body, or [`NO_BODY`].
    pub(crate) body: Vec<u32>,
    /// First image of every particle, and of the row after the last.
    pub(crate) first: Vec<u32>,
    /// For every particle, the images within the support radius.
    pub(crate) near: Neighbors,
    /// For every entry, volume ratio times volume times the gradient of W, over the distance vector \[1/m^2\].
    pub(crate) pairs: ListValues,
    /// For every image in a body, the particles within the support radius; none for those in walls alone.
    pub(crate) particles: Neighbors,
    /// The same for those.
    pub(crate) particle_pairs: ListValues,
    /// Half of the difference of the potential of gravity between the image of a point x in the same walls and x. It is the product of the
    /// vector with x, and w \[m^2/s^2\]. For an image in a body, w is that of the image alone, with the opposite sign.
    pub(crate) lift: Vec<[f32; 4]>,
    /// Whether any image is one in a body. Without, the rows that follow are empty.
    pub(crate) has_bodies: bool,
    /// Position in the body before the walls \[m\].
    pub(crate) foot: Vec<[f32; 4]>,
    /// Map of velocities by the body, along the axes: xx, yy, zz.
    pub(crate) along: Vec<[f32; 4]>,
    /// The same between the axes: yz, zx, xy.
    pub(crate) between: Vec<[f32; 4]>,
    /// Positions of the images in bodies, and far away those of the others.
    pub(crate) in_bodies: Vec<[f32; 4]>,
    /// The search for those in bodies.
    pub(crate) of_bodies: OfBodies,
    /// The walls near every particle.
    pub(crate) near_walls: Vec<NearWalls>,
    /// Images in bodies of each chunk of particles; kept so that a step allocates nothing.
    pub(crate) in_bodies_by_chunk: Vec<Vec<InBody>>,
}

impl Images {
    /// Number of images.
    #[must_use]
    pub fn count(&self) -> usize {
        self.source.len()
    }

    /// The images of a particle.
    pub(crate) fn of(&self, row: usize) -> std::ops::Range<usize> {
        let at = |row: usize| self.first.get(row).map_or(0, |first| *first as usize);
        at(row)..at(row + 1)
    }

    /// Entries of the lists of eight particles, the first of which is `row` of the chunk that begins at `first`, and their values.
    #[inline(always)]
    pub(crate) fn seen(
        &self,
        first: usize,
        row: usize,
    ) -> impl Iterator<Item = (&[u32; LANES], &[f32; LANES])> {
        let (lists, entries) = (self.near.chunk(first), self.near.chunk(first).group(row));
        let values = if entries.is_empty() { &[] } else { &self.pairs.chunk(first)[lists.range(row)] };
        entries.iter().zip(values)
    }

    /// The same for images, over particles.
    #[inline(always)]
    pub(crate) fn seen_by(
        &self,
        first: usize,
        row: usize,
    ) -> impl Iterator<Item = (&[u32; LANES], &[f32; LANES])> {
        let (lists, values) = (self.particles.chunk(first), self.particle_pairs.chunk(first));
        lists.group(row).iter().zip(&values[lists.range(row)])
    }

    /// Signs of an image along the axes.
    #[inline(always)]
    pub(crate) fn signs(&self, image: usize) -> Vec3 {
        signs(self.axes[image])
    }

    /// The transposed map of the image of a vector back to the particle, `R Q v`.
    #[inline(always)]
    pub(crate) fn back(&self, image: usize, vector: Vec3) -> Vec3 {
        let vector = self.signs(image) * vector;
        if self.body[image] == NO_BODY { vector } else { self.mapped(image, vector) }
    }

    /// The map of the body alone, `R v`.
    pub(crate) fn mapped(&self, image: usize, v: Vec3) -> Vec3 {
        let ([xx, yy, zz, _], [yz, zx, xy, _]) = (self.along[image], self.between[image]);
        Vec3::new(
            xx * v.x + xy * v.y + zx * v.z,
            xy * v.x + yy * v.y + yz * v.z,
            zx * v.x + yz * v.y + zz * v.z,
        )
    }
}

/// -1 along the axes whose walls mirror, else 1.
#[inline(always)]
pub(crate) fn signs(axes: u32) -> Vec3 {
    let sign = |axis: u32| if axes >> axis & 1 == 1 { -1.0 } else { 1.0 };
    Vec3::new(sign(0), sign(1), sign(2))
}

/// Gravity without its part along axes on which space repeats: there is no bottom.
pub(crate) fn along_open_axes(params: &Params) -> Vec3 {
    let periods = params.periodic.map_or(Vec3::ZERO, |periodic| periodic.periods());
    Vec3::select(periods.cmpgt(Vec3::ZERO), Vec3::ZERO, params.gravity)
}

impl ColumnData for Images {
    fn visit_words(&self, _rows: usize, visit: &mut dyn FnMut(u32)) {
        for column in [&self.position, &self.foot, &self.along, &self.between] {
            column.iter().take(self.count()).flatten().for_each(|value| visit(value.to_bits()));
        }
        let axes = &self.axes[..self.count()];
        [&self.source[..], &self.body, axes, &self.first].into_iter().flatten().for_each(|word| visit(*word));
        self.near.visit_words(0, visit);
        self.pairs.visit_words(0, visit);
        self.particles.visit_words(0, visit);
        self.particle_pairs.visit_words(0, visit);
    }
    fn poison(&mut self) {
        for column in [&mut self.position, &mut self.foot, &mut self.along, &mut self.between] {
            column.fill([f32::NAN; 4]);
        }
        [&mut self.source, &mut self.body, &mut self.axes, &mut self.first]
            .into_iter()
            .for_each(|words| words.fill(u32::MAX));
        self.near.poison();
        self.pairs.poison();
        self.particles.poison();
        self.particle_pairs.poison();
    }
}

/// Rows of images, divided among threads with the particles that they are of: a thread finds what it has just written.
pub(super) struct OfParticles<'a, T> {
    rows: &'a mut [T],
    /// First image of every particle, and of the one after the last.
    first: &'a [u32],
}

impl<'a, T> OfParticles<'a, T> {
    /// A row for every image of the particles.
    pub(super) fn new(rows: &'a mut [T], first: &'a [u32]) -> Self {
        Self { rows, first }
    }

    /// The rows of the images of the `index`-th particle.
    #[inline(always)]
    pub(super) fn of(&mut self, index: usize) -> &mut [T] {
        let start = self.first[0];
        &mut self.rows[(self.first[index] - start) as usize..(self.first[index + 1] - start) as usize]
    }

    /// All of them with the number of the first.
    pub(super) fn all(self) -> (usize, &'a mut [T]) {
        (self.first[0] as usize, self.rows)
    }
}

impl<T: Send> Rows for OfParticles<'_, T> {
    fn rows(&self) -> usize {
        self.first.len() - 1
    }
    fn split(self, at: usize) -> (Self, Self) {
        let (left, right) = self.rows.split_at_mut((self.first[at] - self.first[0]) as usize);
        (Self { rows: left, first: &self.first[..=at] }, Self { rows: right, first: &self.first[at..] })
    }
}

/// One row for every image.
#[derive(Clone, Debug, Default)]
pub struct ImageRows(pub(crate) Vec<[f32; 4]>);

impl ColumnData for ImageRows {
    fn visit_words(&self, _rows: usize, visit: &mut dyn FnMut(u32)) {
        self.0.iter().flatten().for_each(|value| visit(value.to_bits()));
    }
    fn poison(&mut self) {
        self.0.fill([f32::NAN; 4]);
    }
}
