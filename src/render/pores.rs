//! Drawn pores in the surface of the sponge, tied to the material: they stretch and move with it.
//!
//! Each triangle carries the points of a regular grid in its barycentric coordinates. The nodes next to a point on a corner
//! or a side are its key, so that both triangles draw the same pore.

use super::colour::{floor, smooth, unit};
use glam::Vec3;

/// Effect of the pores at a point of the surface.
pub(super) struct Pit {
    /// Fraction of the light that remains, 0..=1.
    pub(super) openness: f32,
    /// Tilt of the normal, in the triangle's plane.
    pub(super) tilt: Vec3,
}

/// A triangle of the surface: corners (m) and the keys of its nodes.
pub(super) struct Patch {
    pub(super) corners: [Vec3; 3],
    pub(super) nodes: [u32; 3],
    pub(super) key: u32,
}

/// Pores of two sizes at barycentric coordinates `at`; `pores` coarse ones fit along a side. Detail below `blur` (in
/// triangle sides per pixel) is left out.
pub(super) fn pit(patch: &Patch, at: [f32; 3], pores: f32, blur: f32) -> Pit {
    let mut pit = Pit { openness: 1.0, tilt: Vec3::ZERO };
    for (layer, count, depth, chance) in
        [(0, pores, 0.78, 0.55), (1, pores * 2.0, 0.62, 0.6), (2, pores * 5.0, 0.42, 0.7)]
    {
        // A pore is about half a grid cell wide: fade it out from three pixels to one.
        let visible = smooth(0.9, 0.3, count * blur);
        if visible > 0.0 {
            grid(patch, at, count, layer, (depth * visible, chance), &mut pit);
        }
    }
    pit
}

/// Pores of one size.
fn grid(patch: &Patch, at: [f32; 3], count: f32, layer: u32, (depth, chance): (f32, f32), pit: &mut Pit) {
    let scaled = at.map(|b| b.clamp(0.0, 1.0) * count);
    let base = scaled.map(f32::floor);
    let rest: f32 = count - base.iter().sum::<f32>();
    // The three corners of the cell. The fractional parts of upright cells sum to one, those of inverted cells to two.
    let points: [[f32; 3]; 3] = std::array::from_fn(|i| {
        let mut point = base;
        if rest < 1.5 {
            point[i] += 1.0;
        } else {
            point = point.map(|b| b + 1.0);
            point[i] -= 1.0;
        }
        point
    });
    for point in points {
        let key = key(patch, point, layer);
        if unit(key) > chance {
            continue;
        }
        let radius = 0.30 + 0.5 * unit(key ^ 0x5bd1_e995);
        let [u, v, w] = std::array::from_fn(|i| scaled[i] - point[i]);
        // Squared length in units of the grid, as if the triangle were equilateral.
        let distance = (-(u * v + v * w + w * u)).max(0.0).sqrt() / radius;
        if distance < 1.0 {
            let shade = depth * smooth(1.0, 0.45, distance);
            pit.openness *= 1.0 - shade;
            let [a, b, c] = patch.corners;
            let outward = (a * u + b * v + c * w).normalize_or_zero();
            // The wall of a pore leans to its middle.
            let wall = smooth(0.0, 0.6, distance) * smooth(1.0, 0.7, distance);
            pit.tilt -= outward * (0.9 * depth * wall);
        }
    }
}

/// A key of a grid point that depends on the material only.
fn key(patch: &Patch, point: [f32; 3], layer: u32) -> u32 {
    let inside = |i: usize| point[i] > 0.5;
    let whole = |i: usize| floor(point[i]).unsigned_abs();
    let mut key = layer.wrapping_mul(0x27D4_EB2F);
    match (inside(0), inside(1), inside(2)) {
        (true, true, true) => {
            key ^= patch.key.wrapping_mul(0x1656_67B1) ^ 0x8000_0000;
            for i in 0..3 {
                key = key.wrapping_mul(31).wrapping_add(whole(i));
            }
        }
        _ => {
            // Sum of a term per corner: the order of the corners, which differs between triangles, does not matter.
            for i in (0..3).filter(|&i| inside(i)) {
                key = key.wrapping_add(
                    patch.nodes[i]
                        .wrapping_mul(0x0100_0193)
                        .wrapping_add(whole(i))
                        .wrapping_mul(whole(i).wrapping_mul(2).wrapping_add(0x9E37_79B1)),
                );
            }
        }
    }
    key
}
