//! Meshes as bodies: convex hulls, and convex decomposition.

use rapier3d::parry::transformation::vhacd::{VHACD, VHACDParameters};

use super::{
    HullError,
    compound::{Placed, compound},
    convex_hull,
};
use crate::mesh::Mesh;

/// Cells along the longest side of a mesh that is taken apart.
const RESOLUTION: u32 = 64;

/// Concavity up to which a part counts as convex, over the size of the mesh.
const CONCAVITY: f32 = 0.002;

/// A mesh as its convex hull, or as at most so many convex parts, for water of particles at a spacing \[m\].
pub(crate) fn mesh_body(mesh: &Mesh, parts: u32, spacing: f32) -> Result<Placed, HullError> {
    if parts <= 1 {
        return convex_hull(&mesh.vertices).map(|hull| (hull.shape, hull.offset));
    }
    let parameters = VHACDParameters {
        concavity: CONCAVITY,
        resolution: RESOLUTION,
        max_convex_hulls: parts,
        plane_downsampling: 1,
        convex_hull_downsampling: 1,
        ..VHACDParameters::default()
    };
    let taken_apart = VHACD::decompose(&parameters, &mesh.vertices, &mesh.triangles, true);
    let hulls = taken_apart.compute_exact_convex_hulls(&mesh.vertices, &mesh.triangles);
    // A part without volume separates nothing.
    let hulls: Vec<_> = hulls.iter().filter_map(|(points, _)| convex_hull(points).ok()).collect();
    if hulls.is_empty() {
        return Err(HullError::Flat);
    }
    Ok(compound(hulls, (mesh.vertices.clone(), mesh.triangles.clone()), spacing))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::Shape;
    use glam::Vec3;

    /// A trough: a box with an open hollow.
    fn trough() -> Mesh {
        let mut vertices = Vec::new();
        let mut triangles: Vec<[u32; 3]> = vec![[0, 1, 2], [0, 2, 3], [12, 14, 13], [12, 15, 14]];
        for (half, y) in [(0.04, 0.0), (0.04, 0.06), (0.03, 0.06), (0.03, 0.01)] {
            for (x, z) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                vertices.push(Vec3::new(x * half, y, z * half));
            }
        }
        for ring in 0..3 {
            for side in 0..4 {
                let (a, b) = (4 * ring + side, 4 * ring + (side + 1) % 4);
                triangles.extend([[a, a + 4, b + 4], [a, b + 4, b]]);
            }
        }
        Mesh::new(&vertices, &triangles).unwrap()
    }

    /// How far points of the trough are from the shape at most, and how deep it reaches into the hollow \[m\].
    fn errors(parts: u32) -> (f32, f32) {
        let (shape, centre) = mesh_body(&trough(), parts, 0.005).unwrap();
        let distance = |point: Vec3| match &shape {
            Shape::Compound(compound) => {
                compound.parts.iter().map(|part| part.distance(point - centre)).fold(f32::MAX, f32::min)
            }
            Shape::Hull { planes, .. } => {
                planes.iter().map(|(n, offset)| n.dot(point - centre) - offset).fold(f32::MIN, f32::max)
            }
            other => panic!("{other:?}"),
        };
        let (mut gap, mut filled) = (0.0_f32, 0.0_f32);
        for step in 0..100_000 {
            let unit = |factor: f32| (step as f32 * factor).fract();
            let (x, y, z) = (unit(0.618_034), unit(0.414_214), unit(0.732_051));
            let point = Vec3::new(0.08 * x - 0.04, 0.06 * y, 0.08 * z - 0.04);
            if point.x.abs() < 0.03 && point.z.abs() < 0.03 && point.y > 0.01 {
                filled = filled.max(-distance(point));
            } else {
                gap = gap.max(distance(point));
            }
        }
        (gap, filled)
    }

    #[test]
    fn parts_of_a_hollow_mesh_leave_no_gap_and_its_hollow_free() {
        let (gap, filled) = errors(32);
        assert!(gap < 1e-6 && filled < 0.0025, "{gap} m, {filled} m");
        // Negative control: the hull fills the hollow.
        let (gap, filled) = errors(1);
        assert!(gap < 1e-6 && filled > 0.02, "{gap} m, {filled} m");
    }
}
