//! Bodies of several convex parts: cups, and meshes that are taken apart.

use std::{f64::consts::PI, sync::Arc};

use glam::{DVec3, Vec3};
use sorb_kernels::body::{Compound, ConvexPart};

use super::{ConvexHull, HullError, Shape, convex_hull, mass::Solid};

/// Sides of a cup, which is a prism.
const SIDES: u32 = 24;

/// How far a wall of a cup reaches into the next one, over its thickness: water sees no edge between them.
const JOINT: f64 = 0.5;

/// Largest radius of the ball that sweeps the core of a part, over the distance of the nearest face from its centre.
const MAXIMUM_RADIUS: f32 = 0.4;

/// The same over the spacing of the particles.
const EDGE_RADIUS: f32 = 1.5;

/// A shape about its centre of mass, and the place of that in the frame of the description \[m\].
pub(crate) type Placed = (Shape, Vec3);

/// A cup along y that stands on the origin. Its sizes are inner radius, height in all, and thickness of wall and bottom \[m\], for water of
/// particles at a spacing \[m\]. It is a prism of 24 sides that holds as much as a round one.
pub(crate) fn cup([radius, height, thickness]: [f32; 3], spacing: f32) -> Result<Placed, HullError> {
    let [radius, height, thickness] = [radius, height, thickness].map(f64::from);
    let half_angle = PI / f64::from(SIDES);
    let tangent = libm::tan(half_angle);
    let inner = radius * (half_angle / tangent).sqrt();
    let outer = inner + thickness;
    let mut hulls = Vec::new();
    for side in 0..SIDES {
        let angle = half_angle * f64::from(2 * side + 1);
        let (out, along) = (direction(angle), direction(angle + 0.5 * PI));
        let mut points = Vec::new();
        for (distance, half) in [(inner, inner * tangent + JOINT * thickness), (outer, outer * tangent)] {
            for (sign, y) in [(-1.0, 0.0), (1.0, 0.0), (-1.0, height), (1.0, height)] {
                points.push((out * distance + along * (sign * half) + DVec3::Y * y).as_vec3());
            }
        }
        hulls.push(convex_hull(&points)?);
    }
    // The rim of the bottom is in the middle of the wall.
    let rim = ring((inner + 0.5 * thickness) / libm::cos(half_angle));
    let bottom: Vec<Vec3> =
        rim.flat_map(|point| [point.as_vec3(), (point + DVec3::Y * thickness).as_vec3()]).collect();
    hulls.push(convex_hull(&bottom)?);
    let rings = [(outer, 0.0), (outer, height), (inner, height), (inner, thickness)];
    let (vertices, triangles) = turned(rings.map(|(apothem, y)| (apothem / libm::cos(half_angle), y)));
    Ok(compound(hulls, (vertices, triangles), spacing))
}

fn direction(angle: f64) -> DVec3 {
    DVec3::new(libm::cos(angle), 0.0, libm::sin(angle))
}

/// Corners of a prism at a distance from its axis.
fn ring(radius: f64) -> impl Iterator<Item = DVec3> {
    (0..SIDES).map(move |side| direction(2.0 * PI * f64::from(side) / f64::from(SIDES)) * radius)
}

/// The closed surface of a prism with a profile of radius and height, from the axis to the axis.
fn turned<const RINGS: usize>(profile: [(f64, f64); RINGS]) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut vertices = Vec::new();
    for (radius, y) in profile {
        vertices.extend(ring(radius).map(|point| (point + DVec3::Y * y).as_vec3()));
    }
    let ends = [profile[0].1, profile[RINGS - 1].1];
    vertices.extend(ends.map(|y| (DVec3::Y * y).as_vec3()));
    let (first_end, last) = (RINGS as u32 * SIDES, (RINGS as u32 - 1) * SIDES);
    let mut triangles = Vec::new();
    for side in 0..SIDES {
        let next = (side + 1) % SIDES;
        triangles.push([first_end, side, next]);
        triangles.push([first_end + 1, last + next, last + side]);
        for ring in 0..RINGS as u32 - 1 {
            let [a, b] = [ring * SIDES, (ring + 1) * SIDES];
            triangles.push([a + side, b + side, b + next]);
            triangles.push([a + side, b + next, a + next]);
        }
    }
    (vertices, triangles)
}

/// Hulls as one body, about the centre of mass of what a closed surface encloses.
pub(super) fn compound(
    hulls: Vec<ConvexHull>,
    (vertices, triangles): (Vec<Vec3>, Vec<[u32; 3]>),
    spacing: f32,
) -> Placed {
    let base = vertices.first().map_or(DVec3::ZERO, |vertex| vertex.as_dvec3());
    let solid = Solid::new(|index| vertices[index as usize].as_dvec3() - base, &triangles);
    let centre = base + solid.centroid();
    let parts = hulls.into_iter().map(|hull| {
        let place = (hull.offset.as_dvec3() - centre).as_vec3();
        let (core, radius) = core(&hull.shape, spacing);
        ConvexPart { centre: place, hull: hull.shape, core, radius }
    });
    let parts = parts.collect();
    let vertices = vertices.iter().map(|vertex| (vertex.as_dvec3() - centre).as_vec3()).collect();
    (Shape::Compound(Arc::new(Compound { parts, vertices, triangles })), centre.as_vec3())
}

/// The points of a hull that are some distance below all faces, and that distance \[m\].
fn core(hull: &Shape, spacing: f32) -> (Shape, f32) {
    let Shape::Hull { planes, .. } = hull else { return (hull.clone(), 0.0) };
    let thinnest = planes.iter().map(|(_, offset)| *offset).fold(f32::INFINITY, f32::min);
    let radius = (EDGE_RADIUS * spacing).min(MAXIMUM_RADIUS * thinnest);
    match eroded(planes, radius) {
        Some(core) => (core, radius),
        // Faces that meet at next to no angle: a core that is smaller than it has to be.
        None => (smaller(hull, 1.0 - radius / thinnest), radius),
    }
}

/// The intersection of the half-spaces below all faces, moved inwards \[m\]: the planes of the hull of their dual points are its corners.
fn eroded(planes: &[(Vec3, f32)], by: f32) -> Option<Shape> {
    let dual: Vec<Vec3> = planes.iter().map(|(normal, offset)| *normal / (offset - by)).collect();
    let ConvexHull { shape, offset } = convex_hull(&dual).ok()?;
    let Shape::Hull { planes, .. } = shape else { return None };
    let corners: Vec<Vec3> =
        planes.iter().map(|(normal, distance)| *normal / (distance + normal.dot(offset))).collect();
    let core = convex_hull(&corners).ok()?;
    Some(moved(&core.shape, core.offset))
}

fn moved(hull: &Shape, by: Vec3) -> Shape {
    let Shape::Hull { planes, vertices, triangles } = hull else { return hull.clone() };
    Shape::Hull {
        planes: planes.iter().map(|(normal, offset)| (*normal, offset + normal.dot(by))).collect(),
        vertices: vertices.iter().map(|vertex| *vertex + by).collect(),
        triangles: triangles.clone(),
    }
}

fn smaller(hull: &Shape, size: f32) -> Shape {
    let Shape::Hull { planes, vertices, triangles } = hull else { return hull.clone() };
    Shape::Hull {
        planes: planes.iter().map(|(normal, offset)| (*normal, offset * size)).collect(),
        vertices: vertices.iter().map(|vertex| *vertex * size).collect(),
        triangles: triangles.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::MassProperties;

    #[test]
    fn a_cup_has_its_mass_and_its_parts_leave_no_gap() {
        let sizes = [0.03, 0.08, 0.006];
        let (shape, centre) = cup(sizes, 0.005).unwrap();
        let [radius, height, wall] = sizes.map(f64::from);
        let area = |apothem: f64| f64::from(SIDES) * libm::tan(PI / f64::from(SIDES)) * apothem * apothem;
        let inner = radius * (PI / area(1.0)).sqrt();
        let volume = height * area(inner + wall) - (height - wall) * PI * radius * radius;
        let mass = MassProperties::new(&shape, 1000.0).unwrap().mass;
        assert!((mass / (1000.0 * volume) - 1.0).abs() < 1e-4, "{mass} instead of {}", 1000.0 * volume);
        assert!(centre.x.abs() < 1e-5 && centre.z.abs() < 1e-5 && centre.y < 0.04, "{centre}");
        let Shape::Compound(compound) = &shape else { panic!("a compound") };
        let depth = |point: Vec3| {
            compound.parts.iter().map(|part| part.distance(point - centre)).fold(f32::MAX, f32::min)
        };
        // Just within the wall all around, also at the joints; and in the corner of the bottom.
        for step in 0..240 {
            let out = direction(f64::from(step) * PI / 120.0).as_vec3();
            for y in [0.001, 0.003, 0.04, 0.079] {
                assert!(depth(out * 0.0325 + Vec3::Y * y) < -5e-4, "{step} {y}");
                assert!(depth(out * 0.0365 + Vec3::Y * y) > 1e-4, "{step} {y}");
                let is_bottom = y < 0.006;
                assert_eq!(depth(out * 0.0295 + Vec3::Y * y) < 0.0, is_bottom, "{step} {y}");
            }
        }
    }

    #[test]
    fn the_core_is_as_deep_below_every_face() {
        let points: Vec<Vec3> = (0..8)
            .map(|corner| {
                let sign = |bit: u32| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
                Vec3::new(0.004 * sign(0), 0.05 * sign(1), 0.01 * sign(2))
            })
            .collect();
        let (core, radius) = core(&convex_hull(&points).unwrap().shape, 0.005);
        assert!((radius - 0.0016).abs() < 1e-7);
        let Shape::Hull { vertices, .. } = core else { panic!("a hull") };
        for vertex in vertices {
            let away = vertex.abs() - Vec3::new(0.0024, 0.0484, 0.0084);
            assert!(away.abs().max_element() < 1e-6, "{vertex}");
        }
    }
}
