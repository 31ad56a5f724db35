//! An anisotropic kernel for every free particle \[YT13\]: flat along a surface, long in a jet, a ball where a drop is alone.

use super::{
    cells::{Cells, LANES},
    walls::Walls,
};
use crate::render::{bands, colour::smooth};
use glam::{Mat3, Vec3};

/// Radius of the neighbourhood that shapes a kernel, in spacings.
pub(in crate::render) const REACH: f32 = 3.0;
/// Radius of a kernel in the bulk, in spacings: the radius of the ball of the same volume.
const RADIUS: f32 = 3.0;
/// Radius of the kernel of a particle that is alone, in spacings. Its drop then has a radius of 0.56 spacings.
const ALONE: f32 = 1.05;
/// Sum of the weights of a full neighbourhood, over `REACH` cubed.
const FULL: f32 = 0.957;
/// Points at rest in the block of cells that is searched: five by five by five cells of half a reach.
const BLOCK: f32 = 2.5 * REACH * 2.5 * REACH * 2.5 * REACH;
/// Radius of a kernel deep in the bulk, in spacings, and how much more it weighs than one that is alone there.
const DEEP: f32 = 1.35;
const PACKED: f32 = 7.85;
/// Shares of a full neighbourhood, and distances of its mean over `REACH`, from which on and up to which a particle is deep.
const BULK: (f32, f32) = (0.84, 0.92);
const EVEN: (f32, f32) = (0.008, 0.016);
/// Added to the covariance, over its mean eigenvalue: bounds how flat a kernel gets, to about 7 to 1.
const ROUNDING: f32 = 0.25;
/// Share of the way from the particle to the mean of its neighbours.
const SHIFT: f32 = 0.9;
/// One over the integral of `(1 - q^2)^3` over the unit ball, times the volume of a particle.
const NORM: f32 = 1.566_68;

#[cfg(feature = "gpu")]
shared_with_shaders!(KERNELS: REACH, RADIUS, ALONE, FULL, BLOCK, DEEP, PACKED, BULK, EVEN, ROUNDING, SHIFT, NORM);
/// Particles of one task.
const CHUNK: usize = 512;

/// `mass (1 - r A r)^3` where `r A r` is below 1, with `r` from the centre.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kernel {
    /// Middle (m).
    pub(super) centre: Vec3,
    /// The symmetric metric A (1/m^2): xx, xy, xz, yy, yz, zz.
    pub(super) metric: [f32; 6],
    /// Value in the middle \[1\]; the sum of a full neighbourhood is 1.
    pub(super) mass: f32,
    /// Half sides of the box around the kernel (m).
    pub(super) extent: Vec3,
    /// Share of a full neighbourhood, 0 (alone) to 1.
    pub(super) company: f32,
}

/// Kernels of particles and of their mirror images, in the order of the particles. Particles inside of sponges have none.
///
/// `free` has the share of each particle that is free water, 0 to 1.
pub(super) fn kernels(positions: &[Vec3], free: &[f32], spacing: f32, walls: &Walls) -> Vec<Kernel> {
    let images = walls.images(positions, REACH * spacing);
    let mut points = positions.to_vec();
    points.extend(images.iter().map(|image| image.position));
    let cells = Cells::new(&points, 0.5 * REACH * spacing);
    let own = bands::map(positions.len().div_ceil(CHUNK), |chunk| {
        let rows = chunk * CHUNK..((chunk + 1) * CHUNK).min(positions.len());
        rows.map(|row| {
            // The water of sponges shows as their wetness.
            let free = free[row];
            (free > 0.0).then(|| kernel(positions[row], &cells, spacing, free))
        })
        .collect::<Vec<_>>()
    });
    let own: Vec<Option<Kernel>> = own.into_iter().flatten().collect();
    let mirrored = images.iter().filter_map(|image| Some(image.mirror(&own[image.row]?)));
    own.iter().flatten().copied().chain(mirrored).collect()
}

/// Weights of a neighbourhood.
struct Neighbourhood {
    total: f32,
    mean: Vec3,
    covariance: Mat3,
}

fn neighbourhood(point: Vec3, cells: &Cells, reach: f32) -> Neighbourhood {
    let scale = 1.0 / (reach * reach);
    // Weight, mean and covariance: xx, xy, xz, yy, yz, zz.
    let mut sums = [[0.0_f32; LANES]; 10];
    cells.around(point, |places, _| {
        let count = places.len();
        let columns = cells.coordinates(places);
        for first in (0..count).step_by(LANES) {
            let [x, y, z] = columns.map(|column| column[first..].first_chunk::<LANES>());
            let (Some(x), Some(y), Some(z)) = (x, y, z) else { break };
            for lane in 0..LANES {
                let (x, y, z) = (x[lane] - point.x, y[lane] - point.y, z[lane] - point.z);
                let share = 1.0 - (x * x + y * y + z * z) * scale;
                let is_near = share > 0.0 && first + lane < count;
                let share = if is_near { share } else { 0.0 };
                let weight = share * share;
                // Places that are nowhere are infinite.
                let [x, y, z] = [x, y, z].map(|r| if is_near { r } else { 0.0 });
                let (wx, wy, wz) = (weight * x, weight * y, weight * z);
                let terms = [weight, wx, wy, wz, wx * x, wx * y, wx * z, wy * y, wy * z, wz * z];
                for (sum, term) in sums.iter_mut().zip(terms) {
                    sum[lane] += term;
                }
            }
        }
    });
    let [total, x, y, z, xx, xy, xz, yy, yz, zz] = sums.map(|[a, b, c, d]| (a + b) + (c + d));
    let inverse = 1.0 / total.max(1e-6);
    let m = Vec3::new(x, y, z) * inverse;
    let [xx, xy, xz] = [xx * inverse - m.x * m.x, xy * inverse - m.x * m.y, xz * inverse - m.x * m.z];
    let [yy, yz, zz] = [yy * inverse - m.y * m.y, yz * inverse - m.y * m.z, zz * inverse - m.z * m.z];
    let covariance = Mat3::from_cols_array(&[xx, xy, xz, xy, yy, yz, xz, yz, zz]);
    Neighbourhood { total, mean: m, covariance }
}

fn kernel(point: Vec3, cells: &Cells, spacing: f32, free: f32) -> Kernel {
    let deep = || ball(point, DEEP * spacing, free * NORM * PACKED / (DEEP * DEEP * DEEP), 1.0);
    if cells.are_full(point, 0.88 * BLOCK) {
        return deep();
    }
    let reach = REACH * spacing;
    let Neighbourhood { total, mean, covariance } = neighbourhood(point, cells, reach);
    let full = FULL * REACH * REACH * REACH;
    let company = smooth(0.0, 1.0, (total - 1.0) / (0.35 * (full - 1.0)));
    // Deep in the bulk only the sign matters: a narrow kernel that leaves no gaps. It gets narrow little by little, or the surface
    // would jump.
    let depth = smooth(BULK.0, BULK.1, total / full) * (1.0 - smooth(EVEN.0, EVEN.1, mean.length() / reach));
    if depth >= 1.0 {
        return deep();
    }
    let wide = ALONE + (RADIUS - ALONE) * company;
    let narrow = wide + (DEEP - wide) * depth;
    let packed = 1.0 + (PACKED - 1.0) * (depth * depth) * (depth * depth);
    let (radius, mass) = (narrow * spacing, free * NORM * packed / (narrow * narrow * narrow));
    let centre = point + mean * (SHIFT * company);
    let trace = (covariance.x_axis.x + covariance.y_axis.y + covariance.z_axis.z) / 3.0;
    let floor = ROUNDING * trace + (1.0 - company) * spacing * spacing;
    let bounded = covariance + Mat3::from_diagonal(Vec3::splat(floor));
    // Yu and Turk take the covariance itself for the axes, so that its square takes the place of a squared length. Scaled to
    // the volume of a ball: no eigenvalues are needed.
    let square = bounded * bounded;
    let volume = square.determinant();
    if !(volume > 0.0 && volume.is_finite()) {
        return ball(centre, radius, mass, company);
    }
    let shape = square * (radius * radius / libm::cbrtf(volume));
    let a = shape.inverse();
    Kernel {
        centre,
        metric: [a.x_axis.x, a.x_axis.y, a.x_axis.z, a.y_axis.y, a.y_axis.z, a.z_axis.z],
        mass,
        extent: Vec3::new(shape.x_axis.x.sqrt(), shape.y_axis.y.sqrt(), shape.z_axis.z.sqrt()),
        company,
    }
}

fn ball(centre: Vec3, radius: f32, mass: f32, company: f32) -> Kernel {
    let a = 1.0 / (radius * radius);
    Kernel { centre, metric: [a, 0.0, 0.0, a, 0.0, a], mass, extent: Vec3::splat(radius), company }
}

#[cfg(test)]
impl Kernel {
    /// The kernel itself at an offset from its centre, as the paper evaluates it.
    pub(super) fn value(&self, r: Vec3) -> f32 {
        let [xx, xy, xz, yy, yz, zz] = self.metric;
        let square = r.x * (xx * r.x + 2.0 * (xy * r.y + xz * r.z))
            + r.y * (yy * r.y + 2.0 * yz * r.z)
            + zz * r.z * r.z;
        let share = (1.0 - square).max(0.0);
        self.mass * share * share * share
    }
}
