//! The inside of a mesh as a mask.

use glam::Vec3;
use rapier3d::parry::{
    query::PointQuery,
    shape::{TriMesh, TriMeshFlags},
};

use super::skin::mesh_scale;
use crate::mesh::Mesh;

/// Keeps the tets whose centroids are inside a mesh, which fills a block of some size \[m\] as far as its proportions let it. The
/// pseudo-normal of the nearest face, edge or corner decides what is inside.
pub(crate) fn solid(mesh: Mesh, size: Vec3) -> impl Fn(Vec3) -> bool {
    let (low, high) = mesh.bounds();
    let scale = mesh_scale(&mesh, size);
    let (block, middle) = (size, 0.5 * (low + high));
    let surface = TriMesh::with_flags(mesh.vertices, mesh.triangles, TriMeshFlags::ORIENTED).ok();
    move |centroid| {
        let point = middle + (centroid - 0.5) * block / scale;
        surface.as_ref().is_some_and(|surface| surface.contains_local_point(point))
    }
}
