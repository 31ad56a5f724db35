//! Rows of images: counted for every chunk of particles, then written at their places.

use glam::Vec3;

use super::{
    image_rows::{Image, Images, InBody, NO_BODY, along_open_axes, signs},
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
        let mut by_chunk = std::mem::take(&mut self.by_chunk);
        by_chunk.resize_with(count.div_ceil(CHUNK), Default::default);
        self.near_walls.resize(count, 0);
        let rows = (&mut self.near_walls[..], PerChunk(&mut by_chunk));
        cpu.for_chunks(rows, |first, (near_walls, found)| {
            let (found, images) = &mut found.0[0];
            found.clear();
            *images = 0;
            let rows = first..first + near_walls.len();
            let near = near(bodies, &particles[rows.clone()], params.fluid.smoothing.support_radius);
            let mirrors = Mirrors::new(params, bodies, &near);
            for (row, near_walls) in rows.zip(near_walls) {
                let [x, y, z, _] = particles[row];
                let point = Vec3::new(x, y, z);
                *near_walls = walls::near_walls(params, point);
                *images += walls::count(*near_walls) - 1;
                mirrors.visit(point, |body, mirrored| {
                    found.push(InBody { row: row as u32, body, mirrored });
                    *images += walls::count(walls::near_walls(params, mirrored.position));
                });
            }
        });
        let images = by_chunk.iter().map(|(_, images)| images).sum();
        self.resize(images, particles.len(), by_chunk.iter().any(|(found, _)| !found.is_empty()));
        self.first[count..].fill(images as u32);
        let scatter = Scatter { cpu, params, particles, near_walls: &self.near_walls };
        let rows = Slices {
            position: &mut self.position[..images],
            lift: &mut self.lift[..images],
            axes: &mut self.axes[..images],
            source: &mut self.source,
            body: &mut self.body,
            first: &mut self.first[..count],
            maps: [&mut self.foot, &mut self.along, &mut self.between, &mut self.in_bodies],
            gravity: along_open_axes(params),
        };
        scatter.divide(cpu.threads(), (&by_chunk, [0; 2]), rows);
        self.by_chunk = by_chunk;
    }

    /// Takes over images that are known, in the order of the particles, each with the row of its particle.
    #[cfg(any(test, feature = "oracles"))]
    pub(crate) fn take(&mut self, found: &[(u32, Image)], particles: &[[f32; 4]], params: &Params) {
        self.resize(found.len(), particles.len(), found.iter().any(|(_, image)| image.body != NO_BODY));
        for (row, first) in self.first.iter_mut().enumerate() {
            *first = found.partition_point(|(source, _)| (*source as usize) < row) as u32;
        }
        let images = found.len();
        let mut rows = Slices {
            position: &mut self.position[..images],
            lift: &mut self.lift[..images],
            axes: &mut self.axes[..images],
            source: &mut self.source,
            body: &mut self.body,
            first: &mut [],
            maps: [&mut self.foot, &mut self.along, &mut self.between, &mut self.in_bodies],
            gravity: along_open_axes(params),
        };
        for (at, (source, image)) in found.iter().enumerate() {
            rows.put(at, (*source, particles), *image, params);
        }
    }

    fn resize(&mut self, images: usize, particles: usize, has_bodies: bool) {
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
        self.first.resize(particles + 1, 0);
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
            let image = mirror.image(point, BODY_REACH * self.params.fluid.spacing);
            let is_inside = |x: Vec3| self.params.walls.is_none_or(|walls| within(walls, x));
            if let Some(image) = image.filter(|image| is_inside(image.position)) {
                visit(*index, image);
            }
        }
    }
}

/// Rows of the columns of images, and of the particles that they are of.
struct Slices<'a> {
    position: &'a mut [[f32; 4]],
    lift: &'a mut [[f32; 4]],
    axes: &'a mut [u32],
    source: &'a mut [u32],
    body: &'a mut [u32],
    first: &'a mut [u32],
    /// Position in the body, map along and between the axes, place for those in bodies; empty where there are no bodies.
    maps: [&'a mut [[f32; 4]]; 4],
    /// Gravity along the axes that do not repeat \[m/s^2\].
    gravity: Vec3,
}

impl Slices<'_> {
    /// The rows before image `at` and particle `row`, and the others.
    fn split(self, at: usize, row: usize) -> (Self, Self) {
        let Self { position, lift, axes, source, body, first, maps, gravity } = self;
        let (position, position_after) = position.split_at_mut(at);
        let (lift, lift_after) = lift.split_at_mut(at);
        let (axes, axes_after) = axes.split_at_mut(at);
        let (source, source_after) = source.split_at_mut(at);
        let (body, body_after) = body.split_at_mut(at);
        let (first, first_after) = first.split_at_mut(row);
        let [a, b, c, d] = maps.map(|rows| rows.split_at_mut(at.min(rows.len())));
        let (maps, maps_after) = ([a.0, b.0, c.0, d.0], [a.1, b.1, c.1, d.1]);
        let after = Slices {
            position: position_after,
            lift: lift_after,
            axes: axes_after,
            source: source_after,
            body: body_after,
            first: first_after,
            maps: maps_after,
            gravity,
        };
        (Slices { position, lift, axes, source, body, first, maps, gravity }, after)
    }

    /// Writes an image of the particle at row `source`.
    fn put(
        &mut self,
        at: usize,
        (source, particles): (u32, &[[f32; 4]]),
        Image { position, axes, body, mirrored }: Image,
        params: &Params,
    ) {
        let [x, y, z, _] = particles[source as usize];
        let (signs, foot) = (signs(axes), mirrored.position);
        self.lift[at] = if body == NO_BODY {
            let slope = 0.5 * (signs - 1.0) * self.gravity;
            [slope.x, slope.y, slope.z, 0.5 * self.gravity.dot(position - signs * foot)]
        } else {
            [0.0, 0.0, 0.0, -0.5 * self.gravity.dot(position - Vec3::new(x, y, z))]
        };
        let mut place = [position.x, position.y, position.z, mirrored.volume_ratio];
        if let Some(periodic) = &params.periodic {
            periodic.wrap(&mut place);
        }
        self.position[at] = place;
        (self.axes[at], self.source[at], self.body[at]) = (axes, source, body);
        let [feet, along, between, in_bodies] = &mut self.maps;
        if !feet.is_empty() {
            feet[at] = foot.extend(0.0).to_array();
            along[at] = mirrored.along.extend(0.0).to_array();
            between[at] = mirrored.between.extend(0.0).to_array();
            in_bodies[at] = if body == NO_BODY { FAR_ROW } else { [place[0], place[1], place[2], 0.0] };
        }
    }
}

struct Scatter<'a> {
    cpu: &'a Cpu,
    params: &'a Params,
    particles: &'a [[f32; 4]],
    near_walls: &'a [walls::NearWalls],
}

/// Images in bodies of every chunk, and the number of its images.
type ByChunk<'a> = &'a [(Vec<InBody>, usize)];

impl Scatter<'_> {
    /// Writes the images of the chunks, the first of which begins at an image and a particle, with as many `parts` at the same time.
    fn divide(&self, parts: usize, (chunks, [image, row]): (ByChunk<'_>, [usize; 2]), mut rows: Slices<'_>) {
        if parts <= 1 || chunks.len() <= 1 {
            self.write(chunks, [image, row], &mut rows);
            return;
        }
        let left_parts = parts / 2;
        let (before, after) = chunks.split_at(chunks.len() * left_parts / parts);
        let images: usize = before.iter().map(|(_, images)| images).sum();
        let particles = rows.first.len().min(before.len() * CHUNK);
        let (left, right) = rows.split(images, particles);
        self.cpu.join(
            || self.divide(left_parts, (before, [image, row]), left),
            || self.divide(parts - left_parts, (after, [image + images, row + particles]), right),
        );
    }

    fn write(&self, chunks: ByChunk<'_>, [image, row]: [usize; 2], rows: &mut Slices<'_>) {
        let mut in_bodies = chunks.iter().flat_map(|(found, _)| found).peekable();
        let mut at = 0;
        for index in 0..rows.first.len() {
            rows.first[index] = (image + at) as u32;
            let source = row + index;
            let near = self.near_walls[source];
            if near != 0 {
                let [x, y, z, _] = self.particles[source];
                let itself = Mirrored::none(Vec3::new(x, y, z));
                self.put_all(rows, &mut at, source as u32, (NO_BODY, near, itself));
            }
            while let Some(InBody { body, mirrored, .. }) =
                in_bodies.next_if(|image| image.row as usize == source)
            {
                let near = walls::near_walls(self.params, mirrored.position);
                self.put_all(rows, &mut at, source as u32, (*body, near, *mirrored));
            }
        }
    }

    /// Writes the images in the walls near a point in a body, and that point; in walls alone without it.
    #[inline(always)]
    fn put_all(
        &self,
        rows: &mut Slices<'_>,
        at: &mut usize,
        source: u32,
        (body, near, mirrored): (u32, walls::NearWalls, Mirrored),
    ) {
        walls::visit(self.params, mirrored.position, near, |position, axes| {
            if body == NO_BODY && axes == 0 {
                return;
            }
            rows.put(*at, (source, self.particles), Image { position, axes, body, mirrored }, self.params);
            *at += 1;
        });
    }
}
