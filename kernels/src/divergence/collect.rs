//! Rows of images: counted for every chunk of particles, then written at their places.

use glam::Vec3;

use super::{
    image_rows::{Image, Images, InBody, NO_BODY, OfParticles, along_open_axes, signs},
    mirror::{Mirror, Mirrored},
    walls,
};
use crate::{
    body::Body,
    column::{FAR_ROW, padded},
    cpu::{CHUNK, Cpu, PerChunk},
    layout::constants,
    params::Params,
    sph::obstacles::near,
};

constants! {
    /// Distance from a body at which particles have images in it, over the spacing.
    const BODY_REACH: f32 = 1.6;
}

impl Images {
    /// Finds the images of `count` particles. Those beyond the sides of a box that repeats are on the other side of it.
    pub(super) fn find(
        &mut self,
        cpu: &Cpu,
        params: &Params,
        (particles, count): (&[[f32; 4]], usize),
        bodies: &[Body],
    ) {
        let mut by_chunk = std::mem::take(&mut self.in_bodies_by_chunk);
        by_chunk.resize_with(count.div_ceil(CHUNK), Vec::new);
        self.near_walls.resize(count, 0);
        self.first.resize(particles.len() + 1, 0);
        let rows = (&mut self.near_walls[..], &mut self.first[..count], PerChunk(&mut by_chunk));
        cpu.for_chunks(rows, |first, (near_walls, numbers, found)| {
            let found = &mut found.0[0];
            found.clear();
            let rows = first..first + near_walls.len();
            let near = near(bodies, &particles[rows.clone()], params.fluid.smoothing.support_radius);
            let mirrors = Mirrors::new(params, bodies, &near);
            for ((row, near_walls), number) in rows.zip(near_walls).zip(numbers) {
                let [x, y, z, _] = particles[row];
                let point = Vec3::new(x, y, z);
                *near_walls = walls::near_walls(params, point);
                *number = walls::count(*near_walls) - 1;
                mirrors.visit(point, |body, mirrored| {
                    found.push(InBody { row: row as u32, body, mirrored });
                    *number += walls::count(walls::near_walls(params, mirrored.position));
                });
            }
        });
        let mut images = 0;
        for first in &mut self.first[..count] {
            images += std::mem::replace(first, images);
        }
        self.first[count..].fill(images);
        self.resize(images as usize, by_chunk.iter().any(|found| !found.is_empty()));
        let near_walls = std::mem::take(&mut self.near_walls);
        let sources = Sources { params, particles, near_walls: &near_walls, in_bodies: &by_chunk };
        self.write(cpu, (particles, count), &sources);
        (self.near_walls, self.in_bodies_by_chunk) = (near_walls, by_chunk);
    }

    fn write(&mut self, cpu: &Cpu, (particles, count): (&[[f32; 4]], usize), sources: &Sources<'_>) {
        let images = self.source.len();
        let first = &self.first[..=count];
        let gravity = along_open_axes(sources.params);
        let rows = (
            OfParticles::new(&mut self.position[..images], first),
            OfParticles::new(&mut self.lift[..images], first),
            OfParticles::new(&mut self.axes[..images], first),
            (OfParticles::new(&mut self.source, first), OfParticles::new(&mut self.body, first)),
        );
        cpu.for_chunks(rows, |chunk, (mut places, mut lifts, mut axes, (mut source, mut body))| {
            for (index, particle) in particles[chunk..count.min(chunk + CHUNK)].iter().enumerate() {
                let row = chunk + index;
                let (places, lifts, axes) = (places.of(index), lifts.of(index), axes.of(index));
                source.of(index).fill(row as u32);
                let body = body.of(index);
                let mut at = 0;
                sources.visit(row, |image| {
                    places[at] = place(&image, sources.params);
                    lifts[at] = lift((image.body, image.axes), image.position, particle, gravity);
                    (axes[at], body[at]) = (image.axes, image.body);
                    at += 1;
                });
            }
        });
        if !self.has_bodies {
            return;
        }
        let rows = (
            OfParticles::new(&mut self.foot[..images], first),
            OfParticles::new(&mut self.along[..images], first),
            OfParticles::new(&mut self.between[..images], first),
            OfParticles::new(&mut self.in_bodies[..images], first),
        );
        cpu.for_chunks(rows, |chunk, (mut feet, mut along, mut between, mut in_bodies)| {
            for row in chunk..count.min(chunk + CHUNK) {
                let index = row - chunk;
                let (feet, along) = (feet.of(index), along.of(index));
                let (between, in_bodies) = (between.of(index), in_bodies.of(index));
                let mut at = 0;
                sources.visit(row, |image| {
                    [feet[at], along[at], between[at], in_bodies[at]] = map(&image, sources.params);
                    at += 1;
                });
            }
        });
    }

    /// Takes over images that are known, in the order of the particles, each with the row of its particle.
    #[cfg(any(test, feature = "oracles"))]
    pub(crate) fn take(&mut self, found: &[(u32, Image)], particles: &[[f32; 4]], params: &Params) {
        self.first.resize(particles.len() + 1, 0);
        self.resize(found.len(), found.iter().any(|(_, image)| image.body != NO_BODY));
        for (row, first) in self.first.iter_mut().enumerate() {
            *first = found.partition_point(|(source, _)| (*source as usize) < row) as u32;
        }
        let gravity = along_open_axes(params);
        for (at, (source, image)) in found.iter().enumerate() {
            self.position[at] = place(image, params);
            let particle = &particles[*source as usize];
            self.lift[at] = lift((image.body, image.axes), image.position, particle, gravity);
            (self.axes[at], self.source[at], self.body[at]) = (image.axes, *source, image.body);
            if self.has_bodies {
                [self.foot[at], self.along[at], self.between[at], self.in_bodies[at]] = map(image, params);
            }
        }
    }

    fn resize(&mut self, images: usize, has_bodies: bool) {
        let rows = padded(images);
        let of_bodies = if has_bodies { rows } else { 0 };
        for (column, rows) in [
            (&mut self.lift, rows),
            (&mut self.foot, of_bodies),
            (&mut self.along, of_bodies),
            (&mut self.between, of_bodies),
        ] {
            column.resize(rows, [0.0; 4]);
            column[images.min(rows)..].fill([0.0; 4]);
        }
        for (column, rows) in [(&mut self.position, rows), (&mut self.in_bodies, of_bodies)] {
            column.resize(rows, FAR_ROW);
            column[images.min(rows)..].fill(FAR_ROW);
        }
        self.axes.resize(rows, 0);
        self.axes[images..].fill(0);
        self.source.resize(images, 0);
        self.body.resize(images, NO_BODY);
        self.has_bodies = has_bodies;
    }
}

/// The bodies near some points, as mirrors.
struct Mirrors<'a> {
    params: &'a Params,
    bodies: Vec<(u32, Mirror<'a>)>,
}

impl<'a> Mirrors<'a> {
    fn new(params: &'a Params, bodies: &'a [Body], near: &[usize]) -> Self {
        let mirrors = near.iter().map(|body| (*body as u32, Mirror::new(&bodies[*body])));
        Self { params, bodies: mirrors.collect() }
    }

    /// Calls `visit` with the images of a point in bodies that lie within the walls.
    fn visit(&self, point: Vec3, mut visit: impl FnMut(u32, Mirrored)) {
        let within = |(low, high): (Vec3, Vec3), x: Vec3| x.cmpgt(low).all() && x.cmplt(high).all();
        for (index, mirror) in &self.bodies {
            mirror.images(point, BODY_REACH * self.params.fluid.spacing, |image| {
                if self.params.walls.is_none_or(|walls| within(walls, image.position)) {
                    visit(*index, image);
                }
            });
        }
    }
}

/// Place of an image; w: its volume over that of the particle.
fn place(image: &Image, params: &Params) -> [f32; 4] {
    let Vec3 { x, y, z } = image.position;
    let mut place = [x, y, z, image.mirrored.volume_ratio];
    if let Some(periodic) = &params.periodic {
        periodic.wrap(&mut place);
    }
    place
}

/// The row of `Images::lift` of an image in a body and by the walls along the axes, with its place and that of its particle.
pub(crate) fn lift((body, axes): (u32, u32), place: Vec3, particle: &[f32; 4], gravity: Vec3) -> [f32; 4] {
    let particle = Vec3::new(particle[0], particle[1], particle[2]);
    if body != NO_BODY {
        return [0.0, 0.0, 0.0, -0.5 * gravity.dot(place - particle)];
    }
    let signs = signs(axes);
    (0.5 * (signs - 1.0) * gravity).extend(0.5 * gravity.dot(place - signs * particle)).to_array()
}

/// Position in the body, map along and between the axes, and the place of an image in a body.
fn map(image: &Image, params: &Params) -> [[f32; 4]; 4] {
    let Mirrored { position, along, between, .. } = image.mirrored;
    let [x, y, z, _] = place(image, params);
    let place = if image.body == NO_BODY { FAR_ROW } else { [x, y, z, 0.0] };
    let row = |vector: Vec3| vector.extend(0.0).to_array();
    [row(position), row(along), row(between), place]
}

/// What the images of particles are made of.
struct Sources<'a> {
    params: &'a Params,
    particles: &'a [[f32; 4]],
    near_walls: &'a [walls::NearWalls],
    in_bodies: &'a [Vec<InBody>],
}

impl Sources<'_> {
    /// Calls `visit` with all images of a particle: first those in walls alone, then body by body.
    #[inline(always)]
    fn visit(&self, row: usize, mut visit: impl FnMut(Image)) {
        let near = self.near_walls[row];
        if near != 0 {
            let [x, y, z, _] = self.particles[row];
            let mirrored = Mirrored::none(Vec3::new(x, y, z));
            walls::visit(self.params, mirrored.position, near, |position, axes| {
                if axes != 0 {
                    visit(Image { position, axes, body: NO_BODY, mirrored });
                }
            });
        }
        for InBody { body, mirrored, .. } in
            self.in_bodies[row / CHUNK].iter().filter(|found| found.row as usize == row)
        {
            let (body, mirrored) = (*body, *mirrored);
            let near = walls::near_walls(self.params, mirrored.position);
            walls::visit(self.params, mirrored.position, near, |position, axes| {
                visit(Image { position, axes, body, mirrored });
            });
        }
    }
}
