//! The surface of the water as a mesh, by the crate `splashsurf_lib`. No digest depends on it.

use sorb::World;
use splashsurf_lib::{Parameters, nalgebra::Vector3, reconstruct_surface};

use crate::error::CliError;

/// Reach of the kernel and edge of the cells, over half a spacing.
const SUPPORT: f32 = 4.0;
const CELL: f32 = 0.5;

/// Corners and triangles of a surface.
pub(super) type Surface = (Vec<[f32; 3]>, Vec<[u32; 3]>);

/// The surface of all water, that in sponges included; empty without water.
///
/// # Errors
/// It cannot be made, for example of particles that are too far from each other.
pub(super) fn surface(world: &World) -> Result<Surface, CliError> {
    let rows = world.particle_positions();
    let Some(fluid) = world.scene().fluid.as_ref().filter(|_| !rows.is_empty()) else {
        return Ok(Surface::default());
    };
    let positions: Vec<Vector3<f32>> = rows.iter().map(|[x, y, z, _]| Vector3::new(*x, *y, *z)).collect();
    let half = 0.5 * fluid.spacing;
    let parameters = Parameters::new(half, SUPPORT * half, CELL * half);
    let found = reconstruct_surface::<i64, f32>(&positions, &parameters)
        .map_err(|error| CliError::Surface(error.to_string()))?;
    let vertices = found.mesh.vertices.iter().map(|vertex| [vertex.x, vertex.y, vertex.z]).collect();
    let triangles = found.mesh.triangles.iter().map(|corners| corners.map(|corner| corner as u32)).collect();
    Ok((vertices, triangles))
}
