//! The image of a point in a body.
//!
//! A point at a distance y from the surface, with the outward normal n and the principal curvatures `k_1`, `k_2` along `t_1`, `t_2`:
//!
//! ```text
//! x' = x - 2 y n,   q_a = (1 - k_a y) / (1 + k_a y),   J = q_1 q_2
//! R = -1/J n n^T + q_1/J t_1 t_1^T + q_2/J t_2 t_2^T
//! ```
//!
//! J is the volume of the image over that of the point. R is the Piola map of velocities: `J R v` is the flux that the mirror carries.
//! Therefore a field without divergence has an image without divergence. For a plane R is the reflection, for a sphere the volume alone
//! would leave 6 % of the buoyancy out (docs/pressure-solve.md).

use glam::{Mat3, Vec3};

use crate::{
    body::{Body, Compound, ConvexPart, Shape},
    layout::constants,
};

constants! {
    /// Depth over the radius of curvature beyond which there is no image: its volume would be next to nothing.
    const DEEPEST: f32 = 0.95;
    /// Relative difference of squared distances below which a face is preferred to an edge.
    const TIE: f32 = 1e-5;
    /// Distance above a part of a compound up to which it covers others, over the distance at which there are images.
    const COVER: f32 = 0.06;
}

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
pub(crate) struct Mirrored {
    pub(crate) position: Vec3,
    /// The map of velocities R, symmetric: xx, yy, zz.
    pub(crate) along: Vec3,
    /// yz, zx, xy.
    pub(crate) between: Vec3,
    /// J.
    pub(crate) volume_ratio: f32,
}

impl Mirrored {
    /// The point itself.
    pub(super) fn none(position: Vec3) -> Self {
        Self { position, along: Vec3::ONE, between: Vec3::ZERO, volume_ratio: 1.0 }
    }
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

    /// The images of a point outside in all convex pieces of the body that are nearer than `reach`.
    pub(super) fn images(&self, point: Vec3, reach: f32, mut visit: impl FnMut(Mirrored)) {
        let local = self.axes.transpose() * (point - self.body.state.position);
        if let Shape::Compound(compound) = &self.body.shape {
            for (index, part) in compound.parts.iter().enumerate() {
                let Some((away, curvature)) = closest_of_part(part, local, reach) else { continue };
                let found = (away, curvature);
                let Some(image) = self.mirrored(point, found, part.radius, reach) else { continue };
                if !is_hidden(compound, index, (local, away), reach) {
                    visit(image);
                }
            }
            return;
        }
        let radius = self.body.rounding.radius;
        let found = closest(&self.body.shape, self.body.rounding.core, local, radius + reach);
        if let Some(image) = found.and_then(|found| self.mirrored(point, found, radius, reach)) {
            visit(image);
        }
    }

    /// The image of a point in a piece that a ball sweeps. It follows from the closest point of its core, in the frame of the body.
    fn mirrored(
        &self,
        point: Vec3,
        (away, curvature): (Vec3, Curvature),
        radius: f32,
        reach: f32,
    ) -> Option<Mirrored> {
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
}

/// From the closest point of the core of a shape to a point in its frame, and the curvature there. There is none if it is farther than
/// `range` for certain.
fn closest(shape: &Shape, core: Vec3, local: Vec3, range: f32) -> Option<(Vec3, Curvature)> {
    match shape {
        Shape::Plane => Some((Vec3::Y * local.y.max(0.0), Curvature::Flat)),
        Shape::Sphere { .. } => Some((local, Curvature::Around)),
        Shape::Capsule { .. } => {
            let nearest = local.y.clamp(-core.y, core.y);
            let curvature = if nearest == local.y { Curvature::Along(Vec3::Y) } else { Curvature::Around };
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
            let is_far = planes.iter().any(|(normal, offset)| normal.dot(local) > core.x * offset + range);
            if is_far { None } else { closest_of_hull(local, core.x, vertices, triangles) }
        }
        // Its parts are asked one by one.
        Shape::Compound(_) => None,
    }
}

/// The same for a part of a compound, and a point in the frame of the body that has to be nearer than `reach`.
fn closest_of_part(part: &ConvexPart, local: Vec3, reach: f32) -> Option<(Vec3, Curvature)> {
    closest(&part.core, Vec3::ONE, local - part.centre, part.radius + reach)
}

/// Whether the surface of a part is covered by another one where it is closest to a point: that has the image then. Of two that cover each
/// other the nearer one has it.
fn is_hidden(compound: &Compound, index: usize, (local, away): (Vec3, Vec3), reach: f32) -> bool {
    let length = away.length();
    let own = length - compound.parts[index].radius;
    let foot = local - away * (own / length);
    compound.parts.iter().enumerate().any(|(other, part)| {
        if other == index || part.distance(foot) >= COVER * reach {
            return false;
        }
        // None of those whose surface is that near is farther than this.
        let distance = closest_of_part(part, local, 2.0 * reach)
            .map_or(f32::NEG_INFINITY, |(away, _)| away.length() - part.radius);
        distance < own || distance == own && other < index
    })
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

#[cfg(test)]
mod tests {
    use glam::{Mat3, Quat};

    use super::*;
    use crate::{
        body::{BodyKind, BodyState},
        rounding::Rounding,
        testing::Random,
    };

    const SPACING: f32 = 0.005;

    fn body(shape: Shape) -> Body {
        let state = BodyState {
            position: Vec3::new(0.01, -0.02, 0.005),
            rotation: Quat::from_xyzw(0.3, -0.2, 0.5, 0.8).normalize(),
            linear_velocity: Vec3::ZERO,
            angular_velocity: Vec3::ZERO,
        };
        let rounding = Rounding::new(&shape, SPACING);
        let kind = BodyKind::Fixed;
        let (inverse_mass, inverse_inertia) = (0.0, Mat3::ZERO);
        let (friction, touches_nodes, no_slip) = (0.0, true, false);
        Body { shape, kind, state, friction, touches_nodes, no_slip, rounding, inverse_mass, inverse_inertia }
    }

    fn octahedron() -> Shape {
        let size = 0.03;
        let axes = [Vec3::X, Vec3::Y, Vec3::Z];
        let vertices = axes.iter().flat_map(|axis| [-size * *axis, size * *axis]).collect();
        let signs = [-1.0_f32, 1.0];
        let normals = signs.map(|x| signs.map(|y| signs.map(|z| Vec3::new(x, y, z).normalize())));
        let planes =
            normals.as_flattened().as_flattened().iter().map(|n| (*n, size / 3.0_f32.sqrt())).collect();
        let triangles =
            vec![[1, 3, 5], [3, 0, 5], [0, 2, 5], [2, 1, 5], [3, 1, 4], [0, 3, 4], [2, 0, 4], [1, 2, 4]];
        Shape::Hull { planes, vertices, triangles }
    }

    /// Largest differences of the map of velocities times the volume ratio from the derivative of the image by the point. The second is
    /// that of the volume ratio from its determinant. The last two are those of a plain reflection.
    fn differences(shape: Shape) -> (f32, f32) {
        let (body, mut random) = (body(shape), Random(3));
        let mirror = Mirror::new(&body);
        let (mut worst, mut of_reflection, mut images) = (0.0_f32, 0.0_f32, 0);
        for _ in 0..4000 {
            let mut unit = || random.unit() - 0.5;
            let point = body.state.position + 0.1 * Vec3::new(unit(), unit(), unit());
            // Where all are on the same kind of face or edge the derivative is a difference.
            let step = 1e-4;
            let at = |offset: Vec3| {
                let mut found = None;
                mirror.images(point + offset, 1.6 * SPACING, |image| found = Some(image));
                found
            };
            let ends = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| (at(step * axis), at(-step * axis)));
            let Some(image) = at(Vec3::ZERO) else { continue };
            let columns = ends.map(|(a, b)| Some((a?, b?)));
            let [Some(x), Some(y), Some(z)] = columns else { continue };
            let is_smooth = [x, y, z].iter().all(|(a, b)| {
                let bend = a.position + b.position - 2.0 * image.position;
                bend.length() < 0.02 * step && (a.volume_ratio - b.volume_ratio).abs() < 0.2
            });
            if !is_smooth {
                continue;
            }
            images += 1;
            let of = |(a, b): (Mirrored, Mirrored)| (a.position - b.position) / (2.0 * step);
            let derivative = Mat3::from_cols(of(x), of(y), of(z));
            let (a, b) = (image.along, image.between);
            let map =
                Mat3::from_cols(Vec3::new(a.x, b.z, b.y), Vec3::new(b.z, a.y, b.x), Vec3::new(b.y, b.x, a.z));
            let far =
                |map: Mat3| (map - derivative).to_cols_array().into_iter().map(f32::abs).fold(0.0, f32::max);
            worst = worst.max(far(map * image.volume_ratio));
            worst = worst.max((image.volume_ratio + derivative.determinant()).abs());
            let n = (point - image.position).normalize();
            let reflection = Mat3::IDENTITY - 2.0 * Mat3::from_cols(n * n.x, n * n.y, n * n.z);
            of_reflection = of_reflection.max(far(reflection * image.volume_ratio));
        }
        assert!(images > 50, "{images}");
        (worst, of_reflection)
    }

    #[test]
    fn images_carry_the_flux_and_the_volume_of_what_they_mirror() {
        let shapes = [
            Shape::Sphere { radius: 0.03 },
            Shape::Capsule { half_height: 0.02, radius: 0.02 },
            Shape::Cuboid { half_extents: Vec3::new(0.03, 0.02, 0.025) },
            octahedron(),
        ];
        for shape in shapes {
            let (found, of_reflection) = differences(shape.clone());
            assert!(found < 0.03, "{found:.1e} of {shape:?}");
            // Negative control: the reflection alone.
            assert!(of_reflection > 0.3, "{of_reflection:.1e} of {shape:?}");
        }
    }
}
