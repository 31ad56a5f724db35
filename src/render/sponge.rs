//! The sponge's outer surface, prepared for drawing.

use super::Picture;
use glam::Vec3;

/// The sponge's surface: only `triangles` may be used to index the other columns.
pub(super) struct Surface {
    /// Triangles that can be drawn: their index in the picture's lists, one after the other, and their corners.
    pub(super) triangles: Vec<(usize, [usize; 3])>,
    /// Drawn position of each node.
    pub(super) positions: Vec<Vec3>,
    /// Place of each node in the sponge at rest.
    pub(super) rest: Vec<Vec3>,
    /// Outward unit normal of each node of the surface.
    pub(super) normals: Vec<Vec3>,
    /// Wetness of each node, 0..=1.
    pub(super) wetness: Vec<f32>,
}

impl Surface {
    pub(super) fn new(picture: &Picture<'_>) -> Self {
        let mut positions: Vec<Vec3> = picture.nodes.iter().map(|&[x, y, z, _]| Vec3::new(x, y, z)).collect();
        let corner = |i: u32| Some(i as usize).filter(|&i| positions.get(i).is_some_and(|p| p.is_finite()));
        let drawn = |(i, &[a, b, c]): (usize, &[u32; 3])| Some((i, [corner(a)?, corner(b)?, corner(c)?]));
        let mut triangles: Vec<(usize, [usize; 3])> =
            picture.triangles.iter().enumerate().filter_map(drawn).collect();
        let first = picture.triangles.len();
        let skin: Vec<(usize, [usize; 3])> = (first..).zip(picture.skin).filter_map(drawn).collect();
        // A lattice cut along its planes has a zigzag surface, unlike a sponge. Taubin smoothing, a shrinking step and a
        // slightly larger growing step, removes it and keeps the volume.
        for weight in [0.6, -0.63, 0.6, -0.63, 0.6, -0.63] {
            relax(&mut positions, &triangles, weight);
        }
        triangles.extend(skin);
        let mut rest: Vec<Vec3> = picture.rest.iter().map(|&[x, y, z, _]| Vec3::new(x, y, z)).collect();
        if rest.len() != positions.len() || rest.iter().any(|place| !place.is_finite()) {
            rest.clone_from(&positions);
        }
        let normals = normals(&positions, &triangles);
        let wetness = (0..positions.len())
            .map(|i| picture.wetness.get(i).copied().unwrap_or(0.0))
            .map(|w| if w.is_finite() { w.clamp(0.0, 1.0) } else { 0.0 })
            .collect();
        Self { triangles, positions, rest, normals, wetness }
    }
}

/// Moves every node of the surface towards the mean of its neighbours.
fn relax(positions: &mut [Vec3], triangles: &[(usize, [usize; 3])], weight: f32) {
    let mut sums = vec![(Vec3::ZERO, 0.0_f32); positions.len()];
    for &(_, [a, b, c]) in triangles {
        let (pa, pb, pc) = (positions[a], positions[b], positions[c]);
        for (i, sum) in [(a, pb + pc), (b, pc + pa), (c, pa + pb)] {
            sums[i].0 += sum;
            sums[i].1 += 2.0;
        }
    }
    for (position, (sum, count)) in positions.iter_mut().zip(sums) {
        if count > 0.0 {
            *position += (sum / count - *position) * weight;
        }
    }
}

/// Normals weighted by area, averaged once over the neighbours.
fn normals(positions: &[Vec3], triangles: &[(usize, [usize; 3])]) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; positions.len()];
    for &(_, [a, b, c]) in triangles {
        let area = (positions[b] - positions[a]).cross(positions[c] - positions[a]);
        for i in [a, b, c] {
            normals[i] += area;
        }
    }
    let mut even = normals.clone();
    for &(_, [a, b, c]) in triangles {
        let sum = (normals[a] + normals[b] + normals[c]) * 0.15;
        for i in [a, b, c] {
            even[i] += sum;
        }
    }
    even.into_iter().map(Vec3::normalize_or_zero).collect()
}
