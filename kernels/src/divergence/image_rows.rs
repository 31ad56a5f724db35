//! Rows of images: what particles near walls and bodies see behind them.

use glam::Vec3;

use super::mirror::{Mirror, Mirrored};
use crate::{
    body::Body,
    column::{ColumnData, FAR_ROW, padded},
    grid::{
        cells::Cells,
        neighbors::{ListValues, Neighbors},
    },
    lanes::LANES,
    layout::constants,
    params::Params,
};

constants! {
    /// No body: the image is one in walls alone.
    pub(crate) const NO_BODY: u32 = u32::MAX;
    /// Distance from a body at which particles have images in it, over the spacing.
    const BODY_REACH: f32 = 1.6;
}

/// An image of a particle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Image {
    pub(crate) position: Vec3,
    /// Its position in the body, before the walls.
    pub(crate) foot: Vec3,
    /// -1 along the axes whose walls mirror it, else 1.
    pub(crate) signs: Vec3,
    /// Map of velocities by the body.
    pub(crate) along: Vec3,
    pub(crate) between: Vec3,
    pub(crate) volume_ratio: f32,
    pub(crate) body: u32,
}

/// The images of all particles, in the order of those, and the lists of neighbours between both.
#[derive(Clone, Debug, Default)]
pub struct Images {
    /// Position \[m\]; w: volume over that of the particle \[1\].
    pub(crate) position: Vec<[f32; 4]>,
    /// Position in the body before the walls \[m\]; w: sign along z.
    pub(crate) foot: Vec<[f32; 4]>,
    /// Map of velocities by the body, along the axes: xx, yy, zz; w: sign along x.
    pub(crate) along: Vec<[f32; 4]>,
    /// The same between the axes: yz, zx, xy; w: sign along y.
    pub(crate) between: Vec<[f32; 4]>,
    /// Row of the particle.
    pub(crate) source: Vec<u32>,
    /// Body, or [`NO_BODY`].
    pub(crate) body: Vec<u32>,
    /// First image of every particle, and of the row after the last.
    pub(crate) first: Vec<u32>,
    pub(crate) cells: Cells,
    /// For every particle, the images within the support radius.
    pub(crate) near: Neighbors,
    /// For every entry, volume ratio times volume times the gradient of W, over the distance vector \[1/m^2\].
    pub(crate) pairs: ListValues,
    /// For every image in a body, the particles within the support radius; none for those in walls alone.
    pub(crate) particles: Neighbors,
    /// The same for those.
    pub(crate) particle_pairs: ListValues,
    /// Whether any image is one in a body.
    pub(crate) has_bodies: bool,
    /// Images of each chunk of particles; kept so that a step allocates nothing.
    pub(crate) by_chunk: Vec<Vec<(u32, Image)>>,
    /// Positions of the images in bodies, and far away those of the others.
    pub(crate) in_bodies: Vec<[f32; 4]>,
    /// Positions of the particles that can see images, and far away those of the others.
    pub(crate) seekers: Vec<[f32; 4]>,
    /// Half of the difference of the potential of gravity between the image and its particle \[m^2/s^2\].
    pub(crate) lift: Vec<f32>,
    /// The same between the image of another particle in the same walls and that particle at x: the product of the vector with x, and w.
    pub(crate) lift_at: Vec<[f32; 4]>,
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
    pub(crate) fn signs(&self, image: usize) -> Vec3 {
        Vec3::new(self.along[image][3], self.between[image][3], self.foot[image][3])
    }

    /// The transposed map of the image of a vector back to the particle, `R Q v`.
    pub(crate) fn back(&self, image: usize, vector: Vec3) -> Vec3 {
        self.mapped(image, self.signs(image) * vector)
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

    /// Takes over the images of the chunks in their order. Images beyond the sides of a box that repeats are on the other side of it.
    pub(crate) fn collect(&mut self, particles: &[[f32; 4]], params: &Params) {
        let Self { position, foot, along, between, source, body, first, in_bodies, lift, lift_at, .. } = self;
        for column in [&mut *position, foot, along, between, in_bodies, lift_at] {
            column.clear();
        }
        [&mut *source, body, first].into_iter().for_each(Vec::clear);
        lift.clear();
        let gravity = along_open_axes(params);
        for (row, image) in self.by_chunk.iter().flatten() {
            while first.len() <= *row as usize {
                first.push(source.len() as u32);
            }
            let Image { position: x, foot: b, signs, along: r, between: s, volume_ratio, body: of } = *image;
            let [sx, sy, sz, _] = particles[*row as usize];
            lift.push(0.5 * gravity.dot(x - Vec3::new(sx, sy, sz)));
            let turned = 0.5 * (signs - 1.0) * gravity;
            lift_at.push([turned.x, turned.y, turned.z, 0.5 * gravity.dot(x - signs * b)]);
            let mut place = [x.x, x.y, x.z, volume_ratio];
            if let Some(periodic) = &params.periodic {
                periodic.wrap(&mut place);
            }
            position.push(place);
            foot.push([b.x, b.y, b.z, signs.z]);
            along.push([r.x, r.y, r.z, signs.x]);
            between.push([s.x, s.y, s.z, signs.y]);
            in_bodies.push(if of == NO_BODY { FAR_ROW } else { [place[0], place[1], place[2], 0.0] });
            source.push(*row);
            body.push(of);
        }
        self.has_bodies = body.iter().any(|body| *body != NO_BODY);
        first.resize(particles.len() + 1, source.len() as u32);
        let padded = padded(source.len());
        position.resize(padded, FAR_ROW);
        in_bodies.resize(padded, FAR_ROW);
        lift.resize(padded, 0.0);
        for column in [foot, along, between, lift_at] {
            column.resize(padded, [0.0; 4]);
        }
    }
}

/// Gravity without its part along axes on which space repeats: there is no bottom.
pub(crate) fn along_open_axes(params: &Params) -> Vec3 {
    let periods = params.periodic.map_or(Vec3::ZERO, |periodic| periodic.periods());
    Vec3::select(periods.cmpgt(Vec3::ZERO), Vec3::ZERO, params.gravity)
}

/// What particles are mirrored by.
pub(super) struct Mirrors<'a> {
    walls: Option<(Vec3, Vec3)>,
    bodies: Vec<(u32, Mirror<'a>)>,
    /// Distance from walls and from bodies at which there are images \[m\].
    reach: [f32; 2],
}

impl<'a> Mirrors<'a> {
    /// The walls, and those of the bodies that are `near`.
    pub(super) fn new(params: &Params, bodies: &'a [Body], near: &[usize]) -> Self {
        let bodies = near.iter().map(|body| (*body as u32, Mirror::new(&bodies[*body])));
        // Images in walls reach so far that a particle that sees one has one of its own: only then is the force by mirrored pressures the
        // transpose of the divergence.
        let reach = [params.fluid.smoothing.support_radius, BODY_REACH * params.fluid.spacing];
        Self { walls: params.walls, bodies: bodies.collect(), reach }
    }

    /// Whether there is anything near a point.
    fn is_free(&self, point: Vec3) -> bool {
        let far = |(low, high): (Vec3, Vec3)| (point - low).min(high - point).min_element() >= self.reach[0];
        self.bodies.is_empty() && self.walls.is_none_or(far)
    }

    /// Calls `visit` with all images of a point.
    pub(super) fn visit(&self, point: Vec3, mut visit: impl FnMut(Image)) {
        if self.is_free(point) {
            return;
        }
        let itself = Mirrored { position: point, along: Vec3::ONE, between: Vec3::ZERO, volume_ratio: 1.0 };
        self.in_walls(itself, NO_BODY, &mut visit);
        for (index, mirror) in &self.bodies {
            let image = mirror.image(point, self.reach[1]);
            if let Some(image) = image.filter(|image| self.is_inside(image.position)) {
                self.in_walls(image, *index, &mut visit);
            }
        }
    }

    fn is_inside(&self, point: Vec3) -> bool {
        self.walls.is_none_or(|(low, high)| point.cmpgt(low).all() && point.cmplt(high).all())
    }

    /// All combinations of the walls along the axes; without any, a particle is no image of itself.
    fn in_walls(&self, base: Mirrored, body: u32, visit: &mut impl FnMut(Image)) {
        let Mirrored { position, along, between, volume_ratio } = base;
        let mut places = [[(0.0, 1.0); 3]; 3];
        let mut counts = [1; 3];
        for axis in 0..3 {
            places[axis][0] = (position[axis], 1.0);
            let Some((low, high)) = self.walls else { continue };
            for wall in [low[axis], high[axis]] {
                if (position[axis] - wall).abs() < self.reach[0] {
                    places[axis][counts[axis]] = (2.0 * wall - position[axis], -1.0);
                    counts[axis] += 1;
                }
            }
        }
        for (i, x) in places[0][..counts[0]].iter().enumerate() {
            for (j, y) in places[1][..counts[1]].iter().enumerate() {
                for (k, z) in places[2][..counts[2]].iter().enumerate() {
                    if body == NO_BODY && i + j + k == 0 {
                        continue;
                    }
                    visit(Image {
                        position: Vec3::new(x.0, y.0, z.0),
                        foot: position,
                        signs: Vec3::new(x.1, y.1, z.1),
                        along,
                        between,
                        volume_ratio,
                        body,
                    });
                }
            }
        }
    }
}

impl ColumnData for Images {
    fn visit_words(&self, _rows: usize, visit: &mut dyn FnMut(u32)) {
        for column in [&self.position, &self.foot, &self.along, &self.between] {
            column.iter().take(self.count()).flatten().for_each(|value| visit(value.to_bits()));
        }
        [&self.source, &self.body, &self.first].into_iter().flatten().for_each(|word| visit(*word));
        self.near.visit_words(0, visit);
        self.pairs.visit_words(0, visit);
        self.particles.visit_words(0, visit);
        self.particle_pairs.visit_words(0, visit);
    }
    fn poison(&mut self) {
        for column in [&mut self.position, &mut self.foot, &mut self.along, &mut self.between] {
            column.fill([f32::NAN; 4]);
        }
        [&mut self.source, &mut self.body, &mut self.first]
            .into_iter()
            .for_each(|words| words.fill(u32::MAX));
        self.near.poison();
        self.pairs.poison();
        self.particles.poison();
        self.particle_pairs.poison();
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
