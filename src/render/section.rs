//! The surface of sponges that a plane cuts in halves.

use crate::World;
use glam::Vec3;

/// The plane through the middle of some places, across the axis that the eye is nearest to. The result is a point (m) and the normal
/// towards the eye.
pub(super) fn plane(places: &[[f32; 4]], eye: Vec3) -> (Vec3, Vec3) {
    let places = places.iter().map(|&[x, y, z, _]| Vec3::new(x, y, z)).filter(|place| place.is_finite());
    let (sum, count) = places.fold((Vec3::ZERO, 0.0_f32), |(sum, count), place| (sum + place, count + 1.0));
    let middle = sum / count.max(1.0);
    let towards = eye - middle;
    let normal = if towards.x.abs() > towards.z.abs() {
        Vec3::X * towards.x.signum()
    } else {
        Vec3::Z * towards.z.signum()
    };
    (middle, normal)
}

/// Outer triangles of the tetrahedra behind a plane, wound counter-clockwise seen from outside.
pub(super) fn behind(world: &World, nodes: &[[f32; 4]], (point, normal): (Vec3, Vec3)) -> Vec<[u32; 3]> {
    let place = |node: u32| nodes.get(node as usize).map_or(Vec3::ZERO, |&[x, y, z, _]| Vec3::new(x, y, z));
    let mut faces: Vec<([u32; 3], [u32; 3])> = Vec::new();
    for tet in &world.lattice().tets {
        let middle = tet.iter().map(|node| place(*node)).sum::<Vec3>() * 0.25;
        if (middle - point).dot(normal) > 0.0 {
            continue;
        }
        for opposite in 0..4 {
            let mut face =
                [0, 1, 2, 3].into_iter().filter(|corner| *corner != opposite).map(|corner| tet[corner]);
            let (Some(a), Some(mut b), Some(mut c)) = (face.next(), face.next(), face.next()) else {
                continue;
            };
            let outward = (place(b) - place(a)).cross(place(c) - place(a));
            if outward.dot(place(tet[opposite]) - place(a)) > 0.0 {
                (b, c) = (c, b);
            }
            let mut key = [a, b, c];
            key.sort_unstable();
            faces.push((key, [a, b, c]));
        }
    }
    // A face of two tetrahedra is inside.
    faces.sort_by_key(|(key, _)| *key);
    let groups = faces.chunk_by(|a, b| a.0 == b.0);
    groups.filter(|group| group.len() == 1).map(|group| group[0].1).collect()
}
