//! The image of a point in a body.
//!
//! A point at a distance y from the surface, with the outward normal n and the principal curvatures `k_1`, `k_2` along `t_1`, `t_2`:
//!
//! ```text
//! x' = x - 2 y n,   q_a = (1 - k_a y) / (1 + k_a y),   J = q_1 q_2
//! R = -1/J n n^T + q_1/J t_1 t_1^T + q_2/J t_2 t_2^T
//! ```
//!
//! J is the volume of the image over that of the point. R is the Piola map of velocities: `J R v` is the flux that the mirror carries, so
//! that a field without divergence has an image without divergence. For a plane R is the reflection, for a sphere the volume alone would
//! leave 6 % of the buoyancy out (docs/pressure-solve.md).

use glam::{Mat3, Vec3};

use crate::body::{Body, Shape};

/// Depth over the radius of curvature beyond which there is no image: its volume would be next to nothing.
const DEEPEST: f32 = 0.95;

/// Relative difference of squared distances below which a face is preferred to an edge.
const TIE: f32 = 1e-5;

/// What a surface is like where it is closest to a point.
#[derive(Clone, Copy, Debug)]
enum Curvature {
    /// In no direction.
    Flat,
    /// Across a direction.
    Along(Vec3),
    /// In all directions.
    Around,
}

/// The image of a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mirrored {
    pub(super) position: Vec3,
    /// The map of velocities R, symmetric: xx, yy, zz.
    pub(super) along: Vec3,
    /// yz, zx, xy.
    pub(super) between: Vec3,
    /// J.
    pub(super) volume_ratio: f32,
}

/// A body as a mirror.
pub(super) struct Mirror<'a> {
    pub(super) body: &'a Body,
    axes: Mat3,
}

impl<'a> Mirror<'a> {
    pub(super) fn new(body: &'a Body) -> Self {
        Self { body, axes: Mat3::from_quat(body.state.rotation) }
    }

    /// The image of a point outside, if it is nearer than `reach`.
    pub(super) fn image(&self, point: Vec3, reach: f32) -> Option<Mirrored> {
        let local = self.axes.transpose() * (point - self.body.state.position);
        let radius = self.body.rounding.radius;
        let (away, curvature) = self.closest(local, radius + reach)?;
        let length = away.length();
        let distance = length - radius;
        let is_near = distance > 0.0 && distance < reach && length > 0.0;
        let is_shallow = matches!(curvature, Curvature::Flat) || distance < DEEPEST * radius;
        if !(is_near && is_shallow) {
            return None;
        }
        let normal = self.axes * (away / length);
        let ratio = (radius - distance) / (radius + distance);
        // R = a + b n n^T + c t t^T.
        let (volume_ratio, a, b, c, t) = match curvature {
            Curvature::Flat => (1.0, 1.0, -2.0, 0.0, Vec3::ZERO),
            Curvature::Along(t) => (ratio, 1.0, -1.0 / ratio - 1.0, 1.0 / ratio - 1.0, self.axes * t),
            Curvature::Around => {
                (ratio * ratio, 1.0 / ratio, -1.0 / (ratio * ratio) - 1.0 / ratio, 0.0, Vec3::ZERO)
            }
        };
        let crossed = |v: Vec3| Vec3::new(v.y * v.z, v.z * v.x, v.x * v.y);
        Some(Mirrored {
            position: point - 2.0 * distance * normal,
            along: a + b * normal * normal + c * t * t,
            between: b * crossed(normal) + c * crossed(t),
            volume_ratio,
        })
    }

    /// From the closest point of the core to a point in the body's frame, and the curvature there; none if it is farther than
    /// `range` for certain.
    fn closest(&self, local: Vec3, range: f32) -> Option<(Vec3, Curvature)> {
        let core = self.body.rounding.core;
        match &self.body.shape {
            Shape::Plane => Some((Vec3::Y * local.y.max(0.0), Curvature::Flat)),
            Shape::Sphere { .. } => Some((local, Curvature::Around)),
            Shape::Capsule { .. } => {
                let nearest = local.y.clamp(-core.y, core.y);
                let curvature =
                    if nearest == local.y { Curvature::Along(Vec3::Y) } else { Curvature::Around };
                Some((local - Vec3::Y * nearest, curvature))
            }
            Shape::Cuboid { .. } => {
                let away = local - local.clamp(-core, core);
                let beyond = away.cmpne(Vec3::ZERO);
                let curvature = match beyond.bitmask().count_ones() {
                    0 => return None,
                    1 => Curvature::Flat,
                    2 => Curvature::Along(Vec3::select(beyond, Vec3::ZERO, Vec3::ONE)),
                    _ => Curvature::Around,
                };
                Some((away, curvature))
            }
            Shape::Hull { planes, vertices, triangles } => {
                let is_far =
                    planes.iter().any(|(normal, offset)| normal.dot(local) > core.x * offset + range);
                if is_far { None } else { closest_of_hull(local, core.x, vertices, triangles) }
            }
        }
    }
}

/// The same for a hull of a certain size; none inside of it.
fn closest_of_hull(
    point: Vec3,
    size: f32,
    vertices: &[Vec3],
    triangles: &[[u32; 3]],
) -> Option<(Vec3, Curvature)> {
    let mut best: Option<(f32, Vec3, Curvature)> = None;
    let mut is_outside = false;
    for triangle in triangles {
        let [a, b, c] = triangle.map(|index| vertices[index as usize] * size);
        let above = (b - a).cross(c - a).dot(point - a);
        if above <= 0.0 {
            continue;
        }
        is_outside = true;
        let (nearest, curvature) = closest_of_triangle(point, [a, b, c]);
        let away = point - nearest;
        let mut square = away.length_squared();
        if matches!(curvature, Curvature::Flat) {
            square *= 1.0 - TIE;
        }
        if best.is_none_or(|(least, ..)| square < least) {
            best = Some((square, away, curvature));
        }
    }
    best.filter(|_| is_outside).map(|(_, away, curvature)| (away, curvature))
}

/// The point of a triangle that is closest to another, and whether it is in its face, on an edge or a corner \[E05, 5.1.5\].
fn closest_of_triangle(point: Vec3, [a, b, c]: [Vec3; 3]) -> (Vec3, Curvature) {
    let (ab, ac, ap) = (b - a, c - a, point - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (a, Curvature::Around);
    }
    let bp = point - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (b, Curvature::Around);
    }
    let on_edge =
        |from: Vec3, edge: Vec3, part: f32| (from + part * edge, Curvature::Along(edge.normalize()));
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return on_edge(a, ab, d1 / (d1 - d3));
    }
    let cp = point - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (c, Curvature::Around);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return on_edge(a, ac, d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return on_edge(b, c - b, (d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let scale = 1.0 / (va + vb + vc);
    (a + ab * (vb * scale) + ac * (vc * scale), Curvature::Flat)
}
