//! Lists of the images that particles see.
//!
//! The image of j in walls is nowhere nearer to i than j itself. Along a mirrored axis they are apart by the sum of both distances from
//! the wall instead of by their difference. Images in walls are therefore found among the neighbours, without a search. Images in
//! bodies can be nearer than their particle, and are searched for.

use glam::Vec3;

use super::{
    image_rows::{IMAGE_RATIO, Images, NO_BODY},
    walls::{MIRRORS, NearWalls, mirrors_of, rank},
};
use crate::{
    column::{FAR_ROW, padded},
    cpu::{CHUNK, Cpu},
    grid::{
        cells::{Cells, Domain},
        neighbors::Neighbors,
        weighted::WeightedLists,
    },
    lanes::{self, LANES, Simd, f32x8, prelude::*},
    params::Params,
    periodic::{Space, with_space},
    vector::Vec3x8,
};

/// The images in bodies that particles see.
#[derive(Clone, Debug, Default)]
pub(crate) struct OfBodies {
    cells: Cells,
    /// Positions of the images \[m\], then the same in the order of the cells.
    position: [Vec<[f32; 4]>; 2],
    /// Their rows.
    rows: [Vec<u32>; 2],
    /// For every particle, places in the order of the cells.
    near: Neighbors,
}

impl OfBodies {
    /// Makes the lists of `count` particles.
    pub(super) fn search(
        &mut self,
        cpu: &Cpu,
        params: &Params,
        (particles, count): (&[[f32; 4]], usize),
        images: &Images,
    ) {
        let radius = params.fluid.smoothing.support_radius;
        let Self { cells, position: [found, position], rows: [of, rows], near } = self;
        [&mut *of, rows].into_iter().for_each(Vec::clear);
        [&mut *found, position].into_iter().for_each(Vec::clear);
        of.extend((0..images.count() as u32).filter(|row| images.body[*row as usize] != NO_BODY));
        found.extend(of.iter().map(|row| images.position[*row as usize]));
        // Images may lie behind walls.
        let domain = match params.domain {
            Domain::Bounded { minimum, maximum } => {
                Domain::Bounded { minimum: minimum - radius, maximum: maximum + radius }
            }
            Domain::Unbounded => Domain::Unbounded,
        };
        cells.build(cpu, found, radius, domain);
        position.extend(cells.order.iter().map(|place| found[*place as usize]));
        rows.extend(cells.order.iter().map(|place| of[*place as usize]));
        let used = position.len();
        position.resize(padded(used), FAR_ROW);
        near.build(cpu, (particles, count), (position, used), cells, (radius, params.periodic.as_ref()));
    }

    /// The images that a particle sees.
    fn of(&self, particle: usize) -> impl Iterator<Item = u32> {
        let rows = &self.rows[1];
        self.near.of(particle, rows.len()).map(|place| rows[place as usize])
    }
}

/// What lists of images are made from.
pub(super) struct Seekers<'a> {
    pub(super) params: &'a Params,
    pub(super) position: &'a [[f32; 4]],
    pub(super) count: usize,
    pub(super) neighbors: &'a Neighbors,
}

impl Seekers<'_> {
    /// Makes the lists, and the volume of every entry's image times the gradient of W over the distance vector. `of_bodies` are those of
    /// the images in bodies alone.
    pub(super) fn find(&self, cpu: &Cpu, images: &mut Images, of_bodies: Option<&OfBodies>) {
        let Images { near, pairs, position, first, near_walls, .. } = images;
        let padding = first.last().copied().unwrap_or(0);
        near.fill_weighted(cpu, self.position.len(), padding, pairs, |row, lists| {
            let used = self.count.saturating_sub(row).min(LANES);
            let walls = near_walls.iter().skip(row).take(used).fold(0, |all, own| all | own);
            if walls != 0 {
                with_space!(cpu, self.params, simd, space =>
                    self.in_walls((simd, space), (row, walls), (first, near_walls), lists));
            }
            let Some(of_bodies) = of_bodies else { return };
            for lane in 0..used {
                let point = &self.position[row + lane];
                lists.reserve(of_bodies.of(row + lane).count());
                for image in of_bodies.of(row + lane) {
                    lists.push(lane, image, self.value(point, &position[image as usize]));
                }
            }
        });
    }

    /// Images in walls that eight particles see.
    #[inline(always)]
    fn in_walls<S: Simd>(
        &self,
        (simd, space): (S, impl Space<S>),
        (row, walls): (usize, NearWalls),
        (first, near_walls): (&[u32], &[NearWalls]),
        lists: &mut WeightedLists,
    ) {
        let fluid = &self.params.fluid;
        let kernel = fluid.smoothing.lanes(simd);
        let gradient = kernel.gradient_scale() * fluid.rest_volume();
        let square_radius = lanes::splat(simd, fluid.smoothing.support_radius.powi(2));
        let Some((low, high)) = self.params.walls else { return };
        let [x, y, z, _] = lanes::load_rows(simd, self.position, row);
        let point = [x, y, z];
        // A point at which the lower, or the upper wall mirrors.
        let mirrored = [low, high].map(|wall| std::array::from_fn(|axis| point[axis] - 2.0 * wall[axis]));
        let (mut mirrors, mut used) = ([0; MIRRORS], 0);
        for by in (1..MIRRORS).filter(|by| rank(walls, *by).is_some()) {
            mirrors[used] = by;
            used += 1;
        }
        let entries = self.neighbors.chunk(row).group(row % CHUNK);
        lists.reserve(entries.len() * used);
        for entry in entries {
            let [xj, yj, zj, _] = lanes::gather_rows(simd, self.position, entry);
            let squares = Squares::new(point, &mirrored, [xj, yj, zj], space);
            for by in &mirrors[..used] {
                let square = squares.of(*by);
                let mut seen = square.simd_lt(square_radius).to_bitmask();
                if seen == 0 {
                    continue;
                }
                let u = kernel.closeness(square);
                let values = (gradient * (u * u * u)).to_array();
                while seen != 0 {
                    let lane = seen.trailing_zeros() as usize;
                    seen &= seen - 1;
                    let source = entry[lane] as usize;
                    if let Some(rank) = near_walls.get(source).and_then(|near| rank(*near, *by)) {
                        // The point itself has rank 0, and is no image.
                        lists.push(lane, first[source] + rank - 1, values[lane]);
                    }
                }
            }
        }
    }

    fn value(&self, point: &[f32; 4], image: &[f32; 4]) -> f32 {
        let fluid = &self.params.fluid;
        let apart = Vec3::new(point[0] - image[0], point[1] - image[1], point[2] - image[2]);
        let apart = self.params.periodic.map_or(apart, |periodic| periodic.nearest(apart));
        image[IMAGE_RATIO] * (fluid.rest_volume() * fluid.smoothing.gradient_at(apart.length()))
    }
}

/// Squares of the distances along the axes between points and others, and between them and the images of those in both walls.
struct Squares<S: Simd>([[f32x8<S>; 3]; 3]);

impl<S: Simd> Squares<S> {
    #[inline(always)]
    fn new(point: Vec3x8<S>, mirrored: &[[f32x8<S>; 3]; 2], other: Vec3x8<S>, space: impl Space<S>) -> Self {
        let apart = space.apart(point, other);
        let square = |axis: usize, by: usize| {
            let along = if by == 0 { apart[axis] } else { mirrored[by - 1][axis] + other[axis] };
            along * along
        };
        Self(std::array::from_fn(|axis| std::array::from_fn(|by| square(axis, by))))
    }

    /// Square of the distance from the image by the mirrors.
    #[inline(always)]
    fn of(&self, mirrors: usize) -> f32x8<S> {
        let along = |axis: usize| self.0[axis][mirrors_of(mirrors, axis)];
        along(0) + along(1) + along(2)
    }
}
