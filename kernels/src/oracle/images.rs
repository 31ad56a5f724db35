//! Images of particles in walls and bodies.

use glam::{DMat3, DVec3, Vec3};

use super::{apart, incompressible::factor, row, shapes, vector, vectors};
use crate::{
    body::{Body, ConvexPart, Shape},
    columns::{Columns, Fluid},
    divergence::{
        image_rows::{IMAGE_RATIO, Image, Images, NO_BODY},
        mirror::Mirrored,
    },
    grid::neighbors::Neighbors,
    params::Params,
};

/// The closest point of a core, and the curvature of the surface there. That is its only straight direction, if there is one, and whether
/// it is curved at all.
type Closest = (DVec3, Option<DVec3>, bool);

/// Where the image of a point in a body is, its map of velocities, and its volume over that of the point.
type InBody = (DVec3, DMat3, f64);

fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

/// The closest point of a core, and the directions in which the surface is curved there: none, all but one, all.
fn closest(shape: &Shape, core: DVec3, point: DVec3) -> Option<Closest> {
    match shape {
        Shape::Plane => Some((DVec3::new(point.x, 0.0, point.z), None, false)),
        Shape::Sphere { .. } => Some((DVec3::ZERO, None, true)),
        Shape::Capsule { .. } => {
            let y = point.y.clamp(-core.y, core.y);
            let straight = (y == point.y).then_some(DVec3::Y);
            Some((DVec3::Y * y, straight, true))
        }
        Shape::Cuboid { .. } => {
            let nearest = point.clamp(-core, core);
            let axes = [DVec3::X, DVec3::Y, DVec3::Z];
            let inside: Vec<DVec3> =
                axes.into_iter().filter(|axis| (point - nearest).dot(*axis) == 0.0).collect();
            match inside.len() {
                3 => None,
                2 => Some((nearest, None, false)),
                1 => Some((nearest, Some(inside[0]), true)),
                _ => Some((nearest, None, true)),
            }
        }
        Shape::Hull { vertices, triangles, .. } => {
            let corners: Vec<DVec3> = vertices.iter().map(|vertex| core.x * vertex.as_dvec3()).collect();
            of_hull(point, &corners, triangles)
        }
        Shape::Compound(_) => None,
    }
}

/// Faces before edges before corners.
fn of_hull(point: DVec3, corners: &[DVec3], triangles: &[[u32; 3]]) -> Option<Closest> {
    let mut best: Option<(f64, Closest)> = None;
    let mut offer = |nearest: DVec3, straight: Option<DVec3>, is_curved: bool| {
        let square = point.distance_squared(nearest);
        if best.as_ref().is_none_or(|(least, _)| square < least * (1.0 - 1e-9)) {
            best = Some((square, (nearest, straight, is_curved)));
        }
    };
    let faces = triangles.iter().map(|triangle| triangle.map(|index| corners[index as usize]));
    let is_outside = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).dot(point - a) > 0.0;
    if !faces.clone().any(is_outside) {
        return None;
    }
    for [a, b, c] in faces.clone() {
        let normal = (b - a).cross(c - a).normalize();
        let foot = point - normal * normal.dot(point - a);
        let within = |from: DVec3, to: DVec3| (to - from).cross(foot - from).dot(normal) >= 0.0;
        if is_outside([a, b, c]) && within(a, b) && within(b, c) && within(c, a) {
            offer(foot, None, false);
        }
    }
    for [a, b, c] in faces.clone() {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let part = (point - from).dot(to - from) / (to - from).length_squared();
            if (0.0..=1.0).contains(&part) {
                offer(from + part * (to - from), Some((to - from).normalize()), true);
            }
        }
    }
    faces.flatten().for_each(|corner| offer(corner, None, true));
    best.map(|(_, found)| found)
}

/// From the closest point of the core of a piece to a point in the frame of the body, and the directions as in [`closest`].
struct Reached {
    away: DVec3,
    straight: Option<DVec3>,
    is_curved: bool,
    radius: f64,
}

impl Reached {
    fn of(shape: &Shape, (core, radius): (Vec3, f32), local: DVec3) -> Option<Self> {
        let (nearest, straight, is_curved) = closest(shape, core.as_dvec3(), local)?;
        Some(Self { away: local - nearest, straight, is_curved, radius: f64::from(radius) })
    }

    fn distance(&self) -> f64 {
        self.away.length() - self.radius
    }
}

/// The images of a point in a body.
fn in_body(params: &Params, body: &Body, x: DVec3) -> Vec<InBody> {
    let rotation = shapes::rotation(body);
    let local = rotation.transpose() * (x - body.state.position.as_dvec3());
    let Shape::Compound(compound) = &body.shape else {
        let found = Reached::of(&body.shape, (body.rounding.core, body.rounding.radius), local);
        return found.and_then(|found| mirrored(params, &rotation, x, &found)).into_iter().collect();
    };
    let reached =
        |part: &ConvexPart| Reached::of(&part.core, (Vec3::ONE, part.radius), local - part.centre.as_dvec3());
    let cover = 0.06 * 1.6 * f64::from(params.fluid.spacing);
    let mut found = Vec::new();
    for (index, part) in compound.parts.iter().enumerate() {
        let Some(own) = reached(part) else { continue };
        let foot = local - own.away * (own.distance() / own.away.length());
        let covers = |(other, part): (usize, &ConvexPart)| {
            let depth = shapes::local(&part.hull, foot - part.centre.as_dvec3()).0;
            let distance = reached(part).map_or(f64::MIN, |of| of.distance());
            let is_nearer = distance < own.distance() || distance == own.distance() && other < index;
            other != index && depth < cover && is_nearer
        };
        if !compound.parts.iter().enumerate().any(covers) {
            found.extend(mirrored(params, &rotation, x, &own));
        }
    }
    found
}

fn mirrored(params: &Params, rotation: &DMat3, x: DVec3, found: &Reached) -> Option<InBody> {
    let Reached { away, straight, is_curved, radius } = *found;
    let distance = found.distance();
    let reach = 1.6 * f64::from(params.fluid.spacing);
    if distance <= 0.0 || distance >= reach || (is_curved && distance >= 0.95 * radius) {
        return None;
    }
    let normal = *rotation * away.normalize();
    let straight = straight.map(|direction| *rotation * direction);
    let ratio = (radius - distance) / (radius + distance);
    let across = DMat3::IDENTITY - outer(normal);
    let (volume, tangential) = match (is_curved, straight) {
        (false, _) => (1.0, across),
        (true, Some(t)) => (ratio, (outer(t) + (across - outer(t)) * ratio) * (1.0 / ratio)),
        (true, None) => (ratio * ratio, across * (1.0 / ratio)),
    };
    Some((x - 2.0 * distance * normal, tangential - outer(normal) * (1.0 / volume), volume))
}

/// All images of a point, in the order of bodies and walls.
fn images_of(params: &Params, bodies: &[Body], x: DVec3) -> Vec<Image> {
    let corners = params.walls.map(|(low, high)| (low.as_dvec3(), high.as_dvec3()));
    let inside = |x: DVec3| corners.is_none_or(|(low, high)| x.cmpgt(low).all() && x.cmplt(high).all());
    let mut bases = vec![(NO_BODY, (x, DMat3::IDENTITY, 1.0))];
    for (index, body) in bodies.iter().enumerate() {
        let found = in_body(params, body, x).into_iter().filter(|image| inside(image.0));
        bases.extend(found.map(|image| (index as u32, image)));
    }
    let reach = f64::from(params.fluid.smoothing.support_radius);
    let mut found = Vec::new();
    for (body, (foot, map, volume)) in bases {
        let places = |axis: usize| {
            let mut places = vec![(foot[axis], 1.0)];
            let walls = corners.map_or_else(Vec::new, |(low, high)| vec![low[axis], high[axis]]);
            let near = walls.into_iter().filter(|wall| (foot[axis] - wall).abs() < reach);
            places.extend(near.map(|wall| (2.0 * wall - foot[axis], -1.0)));
            places
        };
        for (x, qx) in places(0) {
            for (y, qy) in places(1) {
                for (z, qz) in places(2) {
                    if body == NO_BODY && qx * qy * qz > 0.0 && qx + qy + qz > 2.0 {
                        continue;
                    }
                    let axes = [qx, qy, qz].into_iter().enumerate();
                    found.push(Image {
                        position: DVec3::new(x, y, z).as_vec3(),
                        axes: axes.map(|(axis, sign)| u32::from(sign < 0.0) << axis).sum(),
                        body,
                        mirrored: Mirrored {
                            position: foot.as_vec3(),
                            along: DVec3::new(map.x_axis.x, map.y_axis.y, map.z_axis.z).as_vec3(),
                            between: DVec3::new(map.y_axis.z, map.z_axis.x, map.x_axis.y).as_vec3(),
                            volume_ratio: volume as f32,
                        },
                    });
                }
            }
        }
    }
    found
}

pub(crate) fn images(params: &Params, columns: &mut Columns) {
    let (count, rows) = (columns.rows.fluid, columns.fluid.position.len());
    let x = vectors(&columns.fluid.position, count);
    let fluid = &mut columns.fluid;
    for moment in [&mut fluid.moment, &mut fluid.renormalisation, &mut fluid.renormalisation_between] {
        *moment = vec![[0.0; 4]; rows];
    }
    let bodies = &columns.bodies.states.0;
    let mut images = std::mem::take(&mut columns.fluid.images);
    let found = x
        .iter()
        .enumerate()
        .flat_map(|(row, x)| images_of(params, bodies, *x).into_iter().map(move |image| (row as u32, image)));
    images.take(&found.collect::<Vec<_>>(), &columns.fluid.position, params);
    let used = images.count();
    let at: Vec<DVec3> = images.position[..used].iter().map(|row| vector(*row)).collect();
    let radius = params.fluid.smoothing.support_radius;
    images.near = super::grid::lists(params, &x, &at, rows, radius);
    let volume = |image: usize| f64::from(images.position[image][IMAGE_RATIO]);
    let c = |row: usize, image: usize| volume(image) * factor(params, apart(params, x[row], at[image]));
    images.pairs.fill(
        &images.near,
        |row, image| if row < count && image < used { c(row, image) as f32 } else { 0.0 },
    );
    let is_in_body = |image: usize| images.body[image] != NO_BODY;
    let square = f64::from(radius).powi(2);
    let near = |image: usize| -> Vec<u32> {
        let is_near = |row: &usize| apart(params, x[*row], at[image]).length_squared() < square;
        (0..count).filter(|row| is_in_body(image) && is_near(row)).map(|row| row as u32).collect()
    };
    let mut particles: Vec<Vec<u32>> = (0..used).map(near).collect();
    particles.resize(images.position.len(), Vec::new());
    images.particles = Neighbors::from_lists(&particles, count as u32);
    let of_image =
        |image: usize, row: usize| if row < count && image < used { c(row, image) as f32 } else { 0.0 };
    images.particle_pairs.fill(&images.particles, of_image);
    columns.fluid.images = images;
}

/// An image as oracles see it.
pub(super) struct Seen {
    pub(super) position: DVec3,
    pub(super) foot: DVec3,
    pub(super) source: usize,
    pub(super) body: Option<usize>,
    pub(super) volume: f64,
    /// `Q R`, from a vector of the particle to that of the image.
    pub(super) map: DMat3,
    pub(super) signs: DVec3,
}

/// The images that are there.
pub(super) fn seen(images: &Images) -> Vec<Seen> {
    let one = |image: usize| {
        let signs = images.signs(image).as_dvec3();
        // Without bodies there are no maps.
        let is_in_body = images.body[image] != NO_BODY;
        let source = vector(images.position[image]);
        let (foot, along) = if is_in_body {
            let ([xx, yy, zz, _], [yz, zx, xy, _]) =
                (images.along[image].map(f64::from), images.between[image].map(f64::from));
            let x = DVec3::new(xx, xy, zx);
            let (y, z) = (DVec3::new(xy, yy, yz), DVec3::new(zx, yz, zz));
            (vector(images.foot[image]), DMat3::from_cols(x, y, z))
        } else {
            (source, DMat3::IDENTITY)
        };
        Seen {
            position: vector(images.position[image]),
            foot,
            source: images.source[image] as usize,
            body: (images.body[image] != NO_BODY).then_some(images.body[image] as usize),
            volume: f64::from(images.position[image][IMAGE_RATIO]),
            map: DMat3::from_diagonal(signs) * along,
            signs,
        }
    };
    (0..images.count()).map(one).collect()
}

/// Velocity and angular velocity of a body, or their rates.
pub(super) type Twist = (DVec3, DVec3);

fn at(bodies: &[Body], twists: &[Twist], body: usize, point: DVec3) -> DVec3 {
    let (linear, angular) = twists[body];
    linear + angular.cross(point - bodies[body].state.position.as_dvec3())
}

/// Images of vectors.
pub(super) fn reflected(
    fluid: &Fluid,
    images: &[Seen],
    v: &[DVec3],
    bodies: &[Body],
    twists: &[Twist],
) -> Vec<DVec3> {
    let one = |image: &Seen| match image.body {
        None => image.map * v[image.source],
        Some(body) => {
            let own = v[image.source] - at(bodies, twists, body, vector(fluid.position[image.source]));
            image.map * own + image.signs * at(bodies, twists, body, image.foot)
        }
    };
    images.iter().map(one).collect()
}

pub(super) fn store_images(rows: &mut Vec<[f32; 4]>, padded: usize, values: &[DVec3]) {
    *rows = values.iter().map(|value| row(*value, 0.0)).collect();
    rows.resize(padded, [0.0; 4]);
}
