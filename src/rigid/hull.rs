use super::Shape;
use super::mass::Solid;
use glam::{DVec3, Vec3};
use rapier3d::parry::transformation::try_convex_hull;
use std::collections::BTreeMap;

/// Largest number of corners of a hull.
///
/// Contacts slow down with every corner, and facets that meet at less than about a degree confuse the contact search.
/// Simplify the mesh first.
pub const MAX_HULL_VERTICES: usize = 1024;

/// Thickness over length below which points count as lying in one plane.
const FLATNESS: f64 = 1e-3;

/// Facets whose normals have this cosine, at this distance over the length of the hull, are one plane.
const SAME_NORMAL: f64 = 1.0 - 1e-6;
const SAME_OFFSET: f64 = 1e-4;

/// Largest distance of the centre of mass from the origin, over the length of the hull.
const CENTRED: f64 = 1e-3;

/// Why there is no usable hull.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum HullError {
    /// A point is not a number.
    #[error("point {index} = {value} is not finite")]
    NotFinite {
        /// Number of the point.
        index: usize,
        /// Its value.
        value: String,
    },
    /// Fewer than four different points.
    #[error("{found} different points: a hull needs at least 4")]
    TooFewPoints {
        /// Number of different points.
        found: usize,
    },
    /// All points lie in one plane, or nearly so.
    #[error("the points lie in one plane: the thickness must exceed 1/1000 of the length")]
    Flat,
    /// More corners than the contact search handles well.
    #[error("{found} corners: at most {MAX_HULL_VERTICES}")]
    TooManyVertices {
        /// Number of corners.
        found: usize,
    },
    /// The triangles do not close a solid with outward faces.
    #[error("the triangles do not close a solid with outward faces")]
    NotClosed,
    /// The centre of mass is not at the origin.
    #[error("the centre of mass {centre} is not at the origin: build the shape with `convex_hull`")]
    NotCentred {
        /// The centre of mass.
        centre: String,
    },
    /// The hull search failed numerically.
    #[error("no hull found: {message}")]
    Failed {
        /// Message of the search.
        message: String,
    },
}

/// A hull in its own frame, and the place of that frame.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvexHull {
    /// A [`Shape::Hull`] with the centre of mass at the origin.
    pub shape: Shape,
    /// Centre of mass in the frame of the points \[m\]: point = `offset` + vertex.
    pub offset: Vec3,
}

/// Builds the convex hull of `points` \[m\], at uniform density.
///
/// The planes are free of duplicates: one per flat face, largest first. Every vertex lies on or below every
/// plane.
///
/// # Errors
/// Points that are not finite, fewer than four, all in one plane, or with more than [`MAX_HULL_VERTICES`]
/// corners on the hull.
pub fn convex_hull(points: &[Vec3]) -> Result<ConvexHull, HullError> {
    let points = distinct(points)?;
    if points.len() < 4 {
        return Err(HullError::TooFewPoints { found: points.len() });
    }
    let length = thickness(&points)?;
    let (vertices, triangles) =
        try_convex_hull(&points).map_err(|error| HullError::Failed { message: error.to_string() })?;
    if vertices.len() > MAX_HULL_VERTICES {
        return Err(HullError::TooManyVertices { found: vertices.len() });
    }
    check_closed(vertices.len(), &triangles)?;
    // Integrals about a corner of the hull keep their precision at any distance from the world's origin.
    let base = vertices[0].as_dvec3();
    let solid = Solid::new(|i| vertices[i as usize].as_dvec3() - base, &triangles);
    if solid.volume <= 0.0 {
        return Err(HullError::NotClosed);
    }
    let centre = base + solid.centroid();
    let offset = centre.as_vec3();
    let vertices: Vec<Vec3> = vertices.iter().map(|v| (v.as_dvec3() - centre).as_vec3()).collect();
    let planes = planes(&vertices, &triangles, length);
    if planes.len() < 4 || planes.iter().any(|&(_, offset)| offset <= 0.0) {
        return Err(HullError::Flat);
    }
    Ok(ConvexHull { shape: Shape::Hull { planes, vertices, triangles }, offset })
}

/// Checks a hull from outside this module; vertex numbers and finiteness are checked already.
pub(super) fn check_hull(
    planes: &[(Vec3, f32)],
    vertices: &[Vec3],
    triangles: &[[u32; 3]],
) -> Result<(), HullError> {
    if vertices.len() < 4 {
        return Err(HullError::TooFewPoints { found: vertices.len() });
    }
    if vertices.len() > MAX_HULL_VERTICES {
        return Err(HullError::TooManyVertices { found: vertices.len() });
    }
    check_closed(vertices.len(), triangles)?;
    let length = thickness(vertices)?;
    if planes.len() < 4 || planes.iter().any(|&(_, offset)| offset <= 0.0) {
        return Err(HullError::NotClosed);
    }
    let solid = Solid::new(|i| vertices[i as usize].as_dvec3(), triangles);
    if solid.volume <= 0.0 {
        return Err(HullError::NotClosed);
    }
    let centre = solid.centroid();
    if centre.length() > CENTRED * length {
        return Err(HullError::NotCentred { centre: centre.to_string() });
    }
    Ok(())
}

/// The different points, in the order of their first occurrence.
fn distinct(points: &[Vec3]) -> Result<Vec<Vec3>, HullError> {
    let mut numbered = Vec::with_capacity(points.len());
    for (index, point) in points.iter().enumerate() {
        if !point.is_finite() {
            return Err(HullError::NotFinite { index, value: point.to_string() });
        }
        // Adding zero makes -0 and +0 the same point.
        numbered.push((*point + Vec3::ZERO, index));
    }
    numbered.sort_by(|(a, i), (b, j)| {
        let coordinates = a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z));
        coordinates.then(i.cmp(j))
    });
    numbered.dedup_by(|(a, _), (b, _)| a == b);
    numbered.sort_by_key(|&(_, index)| index);
    Ok(numbered.into_iter().map(|(point, _)| point).collect())
}

/// The length of the point set, or an error if it has almost no thickness.
fn thickness(points: &[Vec3]) -> Result<f64, HullError> {
    let base = points[0].as_dvec3();
    let farthest = |distance: &dyn Fn(DVec3) -> f64| {
        let mut best = (0.0, DVec3::ZERO);
        for point in points {
            let arm = point.as_dvec3() - base;
            let found = distance(arm);
            if found > best.0 {
                best = (found, arm);
            }
        }
        best
    };
    let (length, along) = farthest(&DVec3::length);
    let along = along / length;
    let (width, across) = farthest(&|arm| (arm - along * arm.dot(along)).length());
    let normal = along.cross(across / width);
    let (height, _) = farthest(&|arm| arm.dot(normal).abs());
    // Written so that a length or width of zero fails as well.
    if width > FLATNESS * length && height > FLATNESS * length { Ok(length) } else { Err(HullError::Flat) }
}

/// Every edge must appear once in each direction, and every vertex must be used.
fn check_closed(vertex_count: usize, triangles: &[[u32; 3]]) -> Result<(), HullError> {
    let mut edges: BTreeMap<(u32, u32), u32> = BTreeMap::new();
    let mut used = vec![false; vertex_count];
    for &[a, b, c] in triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry((from, to)).or_insert(0) += 1;
            used[from as usize] = true;
        }
    }
    let paired =
        edges.iter().all(|(&(from, to), &count)| from != to && count == 1 && edges.contains_key(&(to, from)));
    if paired && !edges.is_empty() && used.iter().all(|&used| used) {
        Ok(())
    } else {
        Err(HullError::NotClosed)
    }
}

/// One plane per flat face, largest facet first.
fn planes(vertices: &[Vec3], triangles: &[[u32; 3]], length: f64) -> Vec<(Vec3, f32)> {
    let corner = |i: u32| vertices[i as usize].as_dvec3();
    let mut facets: Vec<(f64, DVec3, f64)> = Vec::with_capacity(triangles.len());
    for &[a, b, c] in triangles {
        let (a, b, c) = (corner(a), corner(b), corner(c));
        let normal = (b - a).cross(c - a);
        let area = normal.length();
        // The normal of a sliver is noise; its neighbours span the same face.
        if area > 1e-10 * length * length {
            let normal = normal / area;
            facets.push((area, normal, normal.dot((a + b + c) / 3.0)));
        }
    }
    facets.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut faces: Vec<(DVec3, f64)> = Vec::new();
    for &(_, normal, offset) in &facets {
        let known = faces.iter().any(|&(other, distance)| {
            normal.dot(other) >= SAME_NORMAL && (offset - distance).abs() <= SAME_OFFSET * length
        });
        if !known {
            faces.push((normal, offset));
        }
    }
    let plane = |&(normal, _): &(DVec3, f64)| {
        let normal = normal.as_vec3();
        // The farthest vertex decides, so that rounding leaves no vertex outside.
        let offset = vertices.iter().map(|v| normal.dot(*v)).fold(f32::NEG_INFINITY, f32::max);
        (normal, offset)
    };
    faces.iter().map(plane).collect()
}
