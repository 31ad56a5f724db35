//! Signed distances from shapes in their own frames.

use glam::Vec3;

use crate::{
    lanes::{self, LANES, Simd, f32x8, select},
    layout::constants,
    shape::Shape,
    vector::{self, Vec3x8, choose, dot, minus, times},
};

/// Distances of eight points from a shape in its own frame, and the outward normals.
///
/// Compiled separately, with arrays at its interface: inlining the code of all shapes into every kernel with distances takes
/// the compiler minutes.
#[inline(never)]
pub(crate) fn surface(
    level: fearless_simd::Level,
    shape: &Shape,
    [x, y, z]: &[[f32; LANES]; 3],
) -> [[f32; LANES]; 4] {
    lanes::dispatch!(level, simd => {
        let local = [lanes::load_array(simd, x), lanes::load_array(simd, y), lanes::load_array(simd, z)];
        let (distance, [nx, ny, nz]) = surface_lanes(simd, shape, local);
        [distance.to_array(), nx.to_array(), ny.to_array(), nz.to_array()]
    })
}

#[inline(always)]
fn surface_lanes<S: Simd>(simd: S, shape: &Shape, local: Vec3x8<S>) -> (f32x8<S>, Vec3x8<S>) {
    let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
    match shape {
        Shape::Plane => (local[1], [zero, one, zero]),
        Shape::Sphere { radius } => round(simd, local, *radius),
        Shape::Capsule { half_height, radius } => {
            let half = lanes::splat(simd, *half_height);
            let y = local[1];
            let on_axis = select(y.simd_gt(half), half, select(y.simd_lt(-half), -half, y));
            round(simd, [local[0], y - on_axis, local[2]], *radius)
        }
        Shape::Cuboid { half_extents } => cuboid(simd, local, *half_extents),
        Shape::Hull { planes, .. } => hull(simd, local, planes),
        Shape::Compound(compound) => {
            let mut nearest = (lanes::splat(simd, f32::MAX), [zero, one, zero]);
            for part in &compound.parts {
                let away = minus(local, vector::splat(simd, part.centre.to_array()));
                let (distance, normal) = hull(simd, away, part.planes());
                let closer = distance.simd_lt(nearest.0);
                nearest = (select(closer, distance, nearest.0), choose(closer, normal, nearest.1));
            }
            nearest
        }
    }
}

/// The largest distance from a face plane, and its normal.
#[inline(always)]
fn hull<S: Simd>(simd: S, local: Vec3x8<S>, planes: &[(Vec3, f32)]) -> (f32x8<S>, Vec3x8<S>) {
    let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
    let mut nearest = lanes::splat(simd, f32::MIN);
    let mut normal = [zero, one, zero];
    for (plane, offset) in planes {
        let direction = vector::splat(simd, plane.to_array());
        let distance = dot(local, direction) - *offset;
        let closer = distance.simd_gt(nearest);
        nearest = select(closer, distance, nearest);
        normal = choose(closer, direction, normal);
    }
    (nearest, normal)
}

constants! {
    /// Distance from the centre of a ball below which there is no direction \[m\].
    const MINIMUM_RADIUS: f32 = 1.0e-12;
}

/// Distance from a ball around the origin.
#[inline(always)]
fn round<S: Simd>(simd: S, local: Vec3x8<S>, radius: f32) -> (f32x8<S>, Vec3x8<S>) {
    let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
    let length = dot(local, local).sqrt();
    let off_centre = length.simd_gt(lanes::splat(simd, MINIMUM_RADIUS));
    let scale = one / select(off_centre, length, one);
    (length - radius, choose(off_centre, times(local, scale), [zero, one, zero]))
}

#[inline(always)]
fn cuboid<S: Simd>(simd: S, local: Vec3x8<S>, half_extents: Vec3) -> (f32x8<S>, Vec3x8<S>) {
    let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
    let half = vector::splat(simd, half_extents.to_array());
    let sign_of = |value: f32x8<S>| select(value.simd_lt(zero), -one, one);
    let sign = [sign_of(local[0]), sign_of(local[1]), sign_of(local[2])];
    let beyond = [local[0] * sign[0] - half[0], local[1] * sign[1] - half[1], local[2] * sign[2] - half[2]];
    let outside = [
        lanes::positive(simd, beyond[0]),
        lanes::positive(simd, beyond[1]),
        lanes::positive(simd, beyond[2]),
    ];
    let length = dot(outside, outside).sqrt();
    let is_outside = length.simd_gt(zero);
    let scale = one / select(is_outside, length, one);
    // Inside, the nearest face.
    let x_first = beyond[0].simd_ge(beyond[1]) & beyond[0].simd_ge(beyond[2]);
    let y_first = !x_first & beyond[1].simd_ge(beyond[2]);
    let z_first = !x_first & !y_first;
    let face = [select(x_first, one, zero), select(y_first, one, zero), select(z_first, one, zero)];
    let depth = select(x_first, beyond[0], select(y_first, beyond[1], beyond[2]));
    let unsigned = choose(is_outside, times(outside, scale), face);
    let normal = [sign[0] * unsigned[0], sign[1] * unsigned[1], sign[2] * unsigned[2]];
    (select(is_outside, length, depth), normal)
}
