//! Flatness of the surface of a sponge around its nodes.

use glam::DVec3;

/// Slots of the face opposite to each slot, wound outwards for a positively oriented tet.
const FACE: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// Flatness of a rim over that of a face: below the first a node belongs to a rim, above the second to a face.
const RIM_FLATNESS: f64 = 0.75;
const FACE_FLATNESS: f64 = 0.95;
/// Weight of nodes of a rim: their normal counts only where they meet another rim.
const RIM_WEIGHT: f64 = 1.0e-3;

/// For every node 1 on a face of the sponge at rest, nearly 0 on rims and at corners, 0 inside.
///
/// The length of the vector sum of the surface areas around a node, over the sum of their sizes. On a face of the lattice,
/// which consists of pyramids, it is the root of a half. Where two faces meet it is at most a half.
#[must_use]
pub fn flatness(tets: &[[u32; 4]], rest: &[[f32; 4]]) -> Vec<f32> {
    let mut faces = Vec::with_capacity(tets.len() * 4);
    for tet in tets {
        for slots in FACE {
            let face = slots.map(|slot| tet[slot]);
            let mut key = face;
            key.sort_unstable();
            faces.push((key, face));
        }
    }
    faces.sort_unstable();
    let mut sums = vec![(DVec3::ZERO, 0.0); rest.len()];
    for same in faces.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() == 1) {
        let (_, face) = same[0];
        let [a, b, c] = face.map(|node| {
            let [x, y, z, _] = rest[node as usize];
            DVec3::new(f64::from(x), f64::from(y), f64::from(z))
        });
        let area = (b - a).cross(c - a);
        for node in face {
            let (sum, size) = &mut sums[node as usize];
            *sum += area;
            *size += area.length();
        }
    }
    let flatness = |(sum, size): (DVec3, f64)| {
        if size <= 0.0 {
            return 0.0;
        }
        let over_face = sum.length() / size * std::f64::consts::SQRT_2;
        ((over_face - RIM_FLATNESS) / (FACE_FLATNESS - RIM_FLATNESS)).clamp(RIM_WEIGHT, 1.0) as f32
    };
    sums.into_iter().map(flatness).collect()
}
