use super::Shape;
use glam::{DMat3, DQuat, DVec3, Quat};
use std::f64::consts::PI;

/// Mass and inertia of a homogeneous solid, about its centre of mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// Mass \[kg\].
    pub mass: f64,
    /// Inertia in the body's frame \[kg m²\].
    pub inertia: DMat3,
}

impl MassProperties {
    /// Computes mass and inertia from the true volume of `shape` and `density` \[kg/m³\].
    ///
    /// `None` for [`Shape::Plane`], whose volume is not finite.
    #[must_use]
    pub fn new(shape: &Shape, density: f32) -> Option<Self> {
        let density = f64::from(density);
        let unit = match shape {
            Shape::Plane => return None,
            Shape::Sphere { radius } => sphere(f64::from(*radius)),
            Shape::Cuboid { half_extents } => cuboid(half_extents.as_dvec3()),
            Shape::Capsule { half_height, radius } => capsule(f64::from(*half_height), f64::from(*radius)),
            Shape::Compound(compound) => {
                let solid = Solid::new(|i| compound.vertices[i as usize].as_dvec3(), &compound.triangles);
                Self { mass: solid.volume, inertia: solid.inertia() }
            }
            Shape::Hull { vertices, triangles, .. } => {
                let solid = Solid::new(|i| vertices[i as usize].as_dvec3(), triangles);
                Self { mass: solid.volume, inertia: solid.inertia() }
            }
        };
        Some(Self { mass: unit.mass * density, inertia: unit.inertia * density })
    }

    /// Inertia about the centre of mass in the world's frame \[kg m²\].
    #[must_use]
    pub fn world_inertia(&self, rotation: Quat) -> DMat3 {
        let rotation = DMat3::from_quat(DQuat::normalize(rotation.as_dquat()));
        rotation * self.inertia * rotation.transpose()
    }
}

fn sphere(radius: f64) -> MassProperties {
    let volume = 4.0 / 3.0 * PI * radius * radius * radius;
    MassProperties {
        mass: volume,
        inertia: DMat3::from_diagonal(DVec3::splat(0.4 * volume * radius * radius)),
    }
}

fn cuboid(half: DVec3) -> MassProperties {
    let volume = 8.0 * half.x * half.y * half.z;
    let square = half * half;
    let diagonal = DVec3::new(square.y + square.z, square.z + square.x, square.x + square.y);
    MassProperties { mass: volume, inertia: DMat3::from_diagonal(diagonal * (volume / 3.0)) }
}

fn capsule(half_height: f64, radius: f64) -> MassProperties {
    let square = radius * radius;
    let cylinder = PI * square * 2.0 * half_height;
    let caps = 4.0 / 3.0 * PI * square * radius;
    let along = cylinder * 0.5 * square + caps * 0.4 * square;
    // Two half balls, each moved from its own centre of mass (3/8 of the radius above its base).
    let caps_across = 0.4 * square + half_height * half_height + 0.75 * half_height * radius;
    let across = cylinder * (square / 4.0 + half_height * half_height / 3.0) + caps * caps_across;
    MassProperties { mass: cylinder + caps, inertia: DMat3::from_diagonal(DVec3::new(across, along, across)) }
}

/// Integrals over the solid inside a closed surface of outward triangles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solid {
    /// Volume \[m³\].
    pub(super) volume: f64,
    /// Volume times centroid \[m⁴\].
    first: DVec3,
    /// Integral of the outer product of the position with itself \[m⁵\].
    second: DMat3,
}

impl Solid {
    pub(super) fn new(vertex: impl Fn(u32) -> DVec3, triangles: &[[u32; 3]]) -> Self {
        let mut solid = Self { volume: 0.0, first: DVec3::ZERO, second: DMat3::ZERO };
        for &[a, b, c] in triangles {
            let (a, b, c) = (vertex(a), vertex(b), vertex(c));
            let volume = a.dot(b.cross(c)) / 6.0;
            let sum = a + b + c;
            solid.volume += volume;
            solid.first += sum * (volume / 4.0);
            solid.second += (outer(a) + outer(b) + outer(c) + outer(sum)) * (volume / 20.0);
        }
        solid
    }

    /// Centroid \[m\].
    #[cfg(feature = "rigid")]
    pub(super) fn centroid(&self) -> DVec3 {
        self.first / self.volume
    }

    /// Inertia at unit density about the origin \[m⁵\].
    fn inertia(&self) -> DMat3 {
        let trace = self.second.x_axis.x + self.second.y_axis.y + self.second.z_axis.z;
        DMat3::from_diagonal(DVec3::splat(trace)) - self.second
    }
}

fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

/// Principal moments of a symmetric matrix and the rotation from their axes to the matrix's frame.
///
/// Jacobi's method uses square roots only, which give the same bits everywhere. It has no absolute threshold, so that the
/// inertia of a pebble is as exact as that of a house.
#[cfg(feature = "rigid")]
pub(super) fn principal_moments(matrix: DMat3) -> (DVec3, DQuat) {
    let mut a = matrix.to_cols_array_2d();
    let mut axes = DMat3::IDENTITY.to_cols_array_2d();
    let negligible = 1e-18 * (a[0][0].abs() + a[1][1].abs() + a[2][2].abs());
    // Convergence is quadratic: four sweeps reach rounding, the bound only guards against bad input.
    for _ in 0..16 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q].abs() <= negligible {
                continue;
            }
            let slope = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let tan = slope.signum() / (slope.abs() + (slope * slope + 1.0).sqrt());
            let cos = 1.0 / (tan * tan + 1.0).sqrt();
            let sin = tan * cos;
            for column in &mut a {
                (column[p], column[q]) =
                    (cos * column[p] - sin * column[q], sin * column[p] + cos * column[q]);
            }
            for row in 0..3 {
                (a[p][row], a[q][row]) =
                    (cos * a[p][row] - sin * a[q][row], sin * a[p][row] + cos * a[q][row]);
                (axes[p][row], axes[q][row]) =
                    (cos * axes[p][row] - sin * axes[q][row], sin * axes[p][row] + cos * axes[q][row]);
            }
        }
    }
    let frame = DQuat::from_mat3(&DMat3::from_cols_array_2d(&axes)).normalize();
    (DVec3::new(a[0][0], a[1][1], a[2][2]), frame)
}
