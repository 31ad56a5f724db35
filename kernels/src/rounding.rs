//! Bodies with rounded edges, as the images of particles see them (`divergence::images`).
//!
//! A *core* is swept by a ball. The core of a cuboid and of a hull is smaller than the shape. The faces are moved outwards a little to keep
//! the volume. A sharp edge has no image: water would leak into it.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};

use crate::shape::Shape;

/// Radius of edges over the spacing of the particles: smaller ones rub (docs/history.md, friction of edges).
const EDGE_RADIUS: f32 = 2.0;

/// The same at most, over the smallest distance of a face from the centre, unless the core is thick without that: water leaks between thin
/// plates with rounder edges.
const THIN_RADIUS: f32 = 0.4;

/// Distance of the nearest face of a core from the centre over the spacing that suffices in any case.
const THICK_CORE: f32 = 2.2;

/// Steps of Newton's method for the volume.
const NEWTON_STEPS: usize = 20;

/// A core that is swept by a ball.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rounding {
    /// Radius of the ball \[m\].
    pub radius: f32,
    /// Half extents of the core of a cuboid \[m\]; half the length of the segment of a capsule \[m\]. Size of the core of a hull over
    /// that of the hull \[1\].
    pub core: Vec3,
}

impl Rounding {
    /// That of a shape in water of particles at a spacing \[m\].
    #[must_use]
    pub fn new(shape: &Shape, spacing: f32) -> Self {
        match shape {
            Shape::Plane => Self::default(),
            Shape::Sphere { radius } => Self { radius: *radius, core: Vec3::ZERO },
            Shape::Capsule { half_height, radius } => Self { radius: *radius, core: Vec3::Y * *half_height },
            Shape::Cuboid { half_extents } => cuboid(*half_extents, spacing),
            Shape::Hull { planes, vertices, triangles } => hull(planes, vertices, triangles, spacing),
            // Each part has its own.
            Shape::Compound(_) => Self::default(),
        }
    }

    /// The core of a shape, and the radius of the ball that sweeps it \[m\]; round shapes as they are, and 0.
    #[must_use]
    pub fn core_of(&self, shape: &Shape) -> (Shape, f32) {
        match shape {
            Shape::Plane | Shape::Sphere { .. } | Shape::Capsule { .. } | Shape::Compound(_) => {
                (shape.clone(), 0.0)
            }
            Shape::Cuboid { .. } => (Shape::Cuboid { half_extents: self.core }, self.radius),
            Shape::Hull { planes, vertices, triangles } => {
                let size = self.core.x;
                let planes = planes.iter().map(|(normal, offset)| (*normal, size * offset)).collect();
                let vertices = vertices.iter().map(|vertex| size * *vertex).collect();
                (Shape::Hull { planes, vertices, triangles: triangles.clone() }, self.radius)
            }
        }
    }
}

/// Radius of the ball \[m\] by the smallest distance of a face from the centre and the spacing of the particles \[m\].
fn edge_radius(thinnest: f32, spacing: f32) -> f32 {
    let most = (THIN_RADIUS * thinnest).max(thinnest - THICK_CORE * spacing);
    most.min(EDGE_RADIUS * spacing)
}

fn cuboid(half_extents: Vec3, spacing: f32) -> Rounding {
    let radius = edge_radius(half_extents.min_element(), spacing);
    let (half, r) = (half_extents.as_dvec3(), f64::from(radius));
    let faces = |k: DVec3| k.x * k.y + k.y * k.z + k.z * k.x;
    let volume = |k: DVec3| {
        let (prisms, edges) = (8.0 * r * faces(k), 2.0 * PI * r * r * k.element_sum());
        8.0 * k.element_product() + prisms + edges + 4.0 / 3.0 * PI * r * r * r
    };
    let mut core = half - r;
    for _ in 0..NEWTON_STEPS {
        core += (8.0 * half.element_product() - volume(core)) / (8.0 * faces(half));
    }
    Rounding { radius, core: core.as_vec3() }
}

fn hull(planes: &[(Vec3, f32)], vertices: &[Vec3], triangles: &[[u32; 3]], spacing: f32) -> Rounding {
    let thinnest = planes.iter().map(|(_, offset)| *offset).fold(f32::INFINITY, f32::min);
    let radius = edge_radius(thinnest, spacing);
    let r = f64::from(radius);
    // Steiner's formula: the volume of a convex solid that is swept by a ball.
    let (volume, area, curvature) = measures(vertices, triangles);
    let swept =
        |k: f64| k * k * k * volume + k * k * area * r + k * curvature * r * r + 4.0 / 3.0 * PI * r * r * r;
    let mut scale = 1.0 - r / f64::from(thinnest);
    for _ in 0..NEWTON_STEPS {
        scale += (volume - swept(scale)) / (3.0 * volume);
    }
    Rounding { radius, core: Vec3::splat(scale as f32) }
}

/// Volume, area and integral of the mean curvature of a convex solid: half the sum over edges of length times the angle outside.
fn measures(vertices: &[Vec3], triangles: &[[u32; 3]]) -> (f64, f64, f64) {
    let corner = |index: u32| vertices.get(index as usize).map_or(DVec3::ZERO, |vertex| vertex.as_dvec3());
    let (mut volume, mut area, mut curvature) = (0.0, 0.0, 0.0);
    let normal = |[a, b, c]: [u32; 3]| (corner(b) - corner(a)).cross(corner(c) - corner(a));
    let mut edges = std::collections::BTreeMap::new();
    for triangle in triangles {
        let [a, b, c] = *triangle;
        volume += corner(a).dot(corner(b).cross(corner(c))) / 6.0;
        area += 0.5 * normal(*triangle).length();
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let own = normal(*triangle).normalize_or_zero();
            match edges.remove(&(to, from)) {
                Some(other) => {
                    let cosine = own.dot(other).clamp(-1.0, 1.0);
                    curvature += 0.5 * libm::acos(cosine) * (corner(to) - corner(from)).length();
                }
                None => {
                    edges.insert((from, to), own);
                }
            }
        }
    }
    (volume, area, curvature)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same box as planes, vertices and triangles.
    fn box_hull(half: Vec3) -> Shape {
        let vertices: Vec<Vec3> = (0..8)
            .map(|corner| {
                let sign = |bit: u32| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
                half * Vec3::new(sign(0), sign(1), sign(2))
            })
            .collect();
        let quads = [[1, 3, 7, 5], [0, 4, 6, 2], [2, 6, 7, 3], [0, 1, 5, 4], [4, 5, 7, 6], [0, 2, 3, 1]];
        let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        let planes = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z];
        let planes = planes.map(|normal| (normal, (normal * half).element_sum().abs())).to_vec();
        Shape::Hull { planes, vertices, triangles }
    }

    /// Volume of a rounded box, by counting points.
    fn counted(half: Vec3, rounding: &Rounding) -> f64 {
        let n = 201;
        let reach = half * 1.237;
        let at = |i: i32| (i as f32 + 0.5) / n as f32 * 2.0 - 1.0;
        let mut inside = 0;
        for (i, j, k) in (0..n).flat_map(|i| (0..n).flat_map(move |j| (0..n).map(move |k| (i, j, k)))) {
            let point = reach * Vec3::new(at(i), at(j), at(k));
            let core = rounding.core;
            inside += i32::from((point - point.clamp(-core, core)).length() < rounding.radius);
        }
        f64::from(inside) / f64::from(n).powi(3) * f64::from((2.0 * reach).element_product())
    }

    #[test]
    fn rounded_boxes_keep_their_volume() {
        let half = Vec3::new(0.03, 0.025, 0.04);
        let volume = f64::from((2.0 * half).element_product());
        let rounding = Rounding::new(&Shape::Cuboid { half_extents: half }, 0.005);
        assert!((rounding.radius - 0.01).abs() < 1e-7);
        assert!((counted(half, &rounding) / volume - 1.0).abs() < 0.01);
        // Negative control: faces that are not moved outwards leave too little.
        let sunk = Rounding { core: half - rounding.radius, ..rounding };
        assert!(counted(half, &sunk) / volume < 0.97);
        // The edges of thin boxes are less round.
        let thin = Rounding::new(&Shape::Cuboid { half_extents: Vec3::new(0.03, 0.004, 0.03) }, 0.005);
        assert!((thin.radius - 0.0016).abs() < 1e-7 && thin.core.min_element() > 0.0);
        // A core of 2.2 spacings is thick enough.
        assert!((edge_radius(0.02, 0.005) - 0.009).abs() < 1e-7);
    }

    #[test]
    fn a_box_is_rounded_alike_as_a_hull() {
        let half = Vec3::new(0.03, 0.025, 0.04);
        let (volume, area, curvature) = match box_hull(half) {
            Shape::Hull { vertices, triangles, .. } => measures(&vertices, &triangles),
            _ => unreachable!("a hull"),
        };
        let size = (2.0 * half).as_dvec3();
        assert!((volume / size.element_product() - 1.0).abs() < 1e-6);
        let faces = 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
        assert!((area / faces - 1.0).abs() < 1e-6);
        assert!((curvature / (PI * size.element_sum()) - 1.0).abs() < 1e-6);
        let rounding = Rounding::new(&box_hull(half), 0.005);
        let core = half * rounding.core.x;
        let as_box = Rounding { core, ..rounding };
        assert!((counted(half, &as_box) / volume - 1.0).abs() < 0.01);
    }
}
