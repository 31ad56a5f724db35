//! What rays meet: bodies, sponges and water.

use glam::{DVec3, Vec3};
use sorb_kernels::body::Body;

use super::{
    QueryError, WaterField,
    error::{bounds, checked_rays},
    field::clip,
};
use crate::world::World;

/// Looks along a ray at a body: their distances become short only where it glides along the body.
const MOST_LOOKS: usize = 256;

/// Distance at which a ray has met a body \[m\], and more for far ones.
const NEAR: f32 = 1e-6;

/// A ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it begins. Range -1000 to 1000 m.
    pub origin: Vec3,
    /// Its direction, of any length but zero.
    pub direction: Vec3,
    /// Its length. Range 0 to 2000 m.
    pub length: f32,
}

/// What rays may meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Targets {
    /// Rigid bodies.
    pub bodies: bool,
    /// The outer surfaces of sponges.
    pub sponges: bool,
    /// The surface of the water; also that in sponges.
    pub water: bool,
}

impl Targets {
    /// Everything.
    pub const ALL: Self = Self { bodies: true, sponges: true, water: true };
    /// Everything but water.
    pub const SOLID: Self = Self { water: false, ..Self::ALL };
}

/// What a ray has met.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Surface {
    /// A body, by its number in the scene.
    Body(usize),
    /// A sponge, by its number in the scene.
    Sponge(usize),
    /// Water.
    Water,
}

/// Where a ray meets something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance from the origin of the ray \[m\].
    pub distance: f32,
    /// The place \[m\].
    pub point: Vec3,
    /// Outward normal of the surface there, of unit length. The faces of sponges that are blocks have pits, half a cell deep.
    pub normal: Vec3,
    /// What it is.
    pub surface: Surface,
}

pub(super) fn cast(world: &World, rays: &[Ray], targets: Targets) -> Result<Vec<Option<Hit>>, QueryError> {
    let rays = checked_rays(rays)?;
    let ends: Vec<Vec3> =
        rays.iter().flat_map(|ray| [ray.origin, ray.origin + ray.direction * ray.length]).collect();
    let has_sponges = targets.sponges && !world.lattice().tets.is_empty();
    let water = if targets.water {
        // Sponges are met on the host, which then has the water as well.
        let hits = if has_sponges { None } else { world.water_on_device(&rays) };
        hits.map_or_else(|| Water::Field(WaterField::new(world, bounds(&ends))), Water::Hits)
    } else {
        Water::Nothing
    };
    let boxes = if has_sponges { sponge_boxes(world) } else { Vec::new() };
    let first = |(index, ray): (usize, &Ray)| {
        let mut nearest: Option<Hit> = None;
        // Of equal distances the first counts.
        let mut take = |found: Option<Hit>| {
            if let Some(hit) = found.filter(|hit| nearest.is_none_or(|own| hit.distance < own.distance)) {
                nearest = Some(hit);
            }
        };
        if targets.bodies {
            let bodies = world.bodies().iter().enumerate();
            bodies.for_each(|(index, body)| take(meets_body(ray, index, body)));
        }
        if has_sponges {
            take(meets_sponges(world, ray, &boxes));
        }
        take(water.meets(index, ray));
        nearest
    };
    Ok(rays.iter().enumerate().map(first).collect())
}

/// The water that rays may meet.
enum Water {
    Nothing,
    Field(WaterField),
    /// Where each ray meets it, as a device said.
    Hits(Vec<Option<(f32, Vec3)>>),
}

impl Water {
    fn meets(&self, index: usize, ray: &Ray) -> Option<Hit> {
        let at = |distance: f32| ray.origin + ray.direction * distance;
        let (distance, normal) = match self {
            Self::Nothing => None,
            Self::Field(field) => field.meets(ray).map(|distance| (distance, field.normal(at(distance)))),
            Self::Hits(hits) => hits.get(index).copied().flatten(),
        }?;
        Some(Hit { distance, point: at(distance), normal, surface: Surface::Water })
    }
}

/// The distance from a body never exceeds the way to it.
fn meets_body(ray: &Ray, index: usize, body: &Body) -> Option<Hit> {
    let mut way = 0.0;
    for _ in 0..MOST_LOOKS {
        let point = ray.origin + ray.direction * way;
        let (distance, normal) = body.distance_and_normal(point);
        if distance <= NEAR * (1.0 + way) {
            return Some(Hit { distance: way, point, normal, surface: Surface::Body(index) });
        }
        way += distance;
        // Not a number as well.
        let is_on = way <= ray.length;
        if !is_on {
            return None;
        }
    }
    None
}

/// Boxes of the surfaces of all sponges.
fn sponge_boxes(world: &World) -> Vec<(Vec3, Vec3)> {
    let (lattice, nodes) = (world.lattice(), world.node_positions());
    let mut boxes = vec![(Vec3::INFINITY, Vec3::NEG_INFINITY); world.scene().sponges.len()];
    for ([x, y, z, _], sponge) in nodes.iter().zip(&lattice.node_sponge) {
        let (point, (low, high)) = (Vec3::new(*x, *y, *z), &mut boxes[*sponge as usize]);
        (*low, *high) = (low.min(point), high.max(point));
    }
    boxes
}

fn meets_sponges(world: &World, ray: &Ray, boxes: &[(Vec3, Vec3)]) -> Option<Hit> {
    let lattice = world.lattice();
    let mut nearest: Option<Hit> = None;
    for (index, (summary, (low, high))) in lattice.sponges.iter().zip(boxes).enumerate() {
        let Some((first, _)) = clip(ray, *low - NEAR, *high + NEAR) else { continue };
        if nearest.is_some_and(|hit| hit.distance < first) {
            continue;
        }
        let own = summary.triangles.start as usize..summary.triangles.end as usize;
        for triangle in &lattice.triangles[own] {
            let nodes = world.node_positions();
            let corners = triangle.map(|node| {
                let [x, y, z, _] = nodes[node as usize];
                Vec3::new(x, y, z).as_dvec3()
            });
            let Some((distance, normal)) = meets_triangle(ray, corners) else { continue };
            if nearest.is_none_or(|hit| distance < hit.distance) {
                let point = ray.origin + ray.direction * distance;
                nearest = Some(Hit { distance, point, normal, surface: Surface::Sponge(index) });
            }
        }
    }
    nearest
}

/// Distance to a triangle, from either side, and its normal (Möller and Trumbore).
fn meets_triangle(ray: &Ray, [a, b, c]: [DVec3; 3]) -> Option<(f32, Vec3)> {
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let (ab, ac, ao) = (b - a, c - a, origin - a);
    let across = direction.cross(ac);
    let volume = ab.dot(across);
    if volume == 0.0 {
        return None;
    }
    let u = ao.dot(across) / volume;
    let beside = ao.cross(ab);
    let v = direction.dot(beside) / volume;
    let distance = ac.dot(beside) / volume;
    let is_in = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && (0.0..=f64::from(ray.length)).contains(&distance);
    is_in.then(|| (distance as f32, ab.cross(ac).normalize_or_zero().as_vec3()))
}
