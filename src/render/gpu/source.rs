//! Where the particles of a picture are: uploaded, or in the buffers of a world.

use std::sync::Arc;

use sorb_kernels::{
    columns::{Column, Columns},
    gpu::{Gpu, GpuError, wgpu::Buffer},
};

use super::buffers::Buffers;
use crate::{
    World,
    render::{Picture, View, world::Seen},
};

/// The particles of a picture, under the names of the passes.
#[derive(Debug)]
pub(super) struct Source {
    pub(super) count: u32,
    pub(super) has_interior: bool,
    pub(super) has_velocities: bool,
    pub(super) has_pressures: bool,
}

impl Source {
    /// Uploads the particles of a picture.
    pub(super) fn of_picture(buffers: &mut Buffers, picture: &Picture<'_>) -> Result<Self, GpuError> {
        let count = picture.particles.len();
        // Buffers of a world may be under these names.
        for name in ["positions", "velocities", "interior", "pressures"] {
            buffers.restore(name);
        }
        buffers.write("positions", bytemuck::cast_slice(picture.particles))?;
        buffers.write("velocities", bytemuck::cast_slice(picture.velocities))?;
        buffers.write("interior", bytemuck::cast_slice(picture.interior))?;
        buffers.write("pressures", bytemuck::cast_slice(picture.pressures))?;
        // Columns of a world are padded.
        let is_whole = |length: usize| count > 0 && length >= count;
        Ok(Self {
            count: count as u32,
            has_interior: is_whole(picture.interior.len()),
            has_velocities: is_whole(picture.velocities.len()),
            has_pressures: is_whole(picture.pressures.len()),
        })
    }

    /// Takes the buffers of a world on the same device.
    pub(super) fn of_world(buffers: &mut Buffers, world: &World) -> Result<Self, GpuError> {
        let refused = || GpuError::Refused { reason: "the world has no buffers".to_owned() };
        let (positions, velocities) = world.particle_buffers().ok_or_else(refused)?;
        let interior = world.resident().and_then(|resident| resident.interior_buffer());
        buffers.lend("positions", positions);
        buffers.lend("velocities", velocities);
        interior.into_iter().for_each(|interior: &Buffer| buffers.lend("interior", interior));
        buffers.restore("pressures");
        buffers.reserve("pressures", 0)?;
        Ok(Self {
            count: world.particle_count() as u32,
            has_interior: interior.is_some(),
            has_velocities: true,
            has_pressures: false,
        })
    }
}

/// What the host has to know of a world whose particles stay on the device: its nodes.
#[derive(Debug)]
pub(super) struct Resident {
    columns: Columns,
    nodes: usize,
}

impl Resident {
    pub(super) fn seen(&self) -> Seen<'_> {
        let nodes = &self.columns.nodes;
        Seen {
            particles: &[],
            velocities: &[],
            interior: &[],
            nodes: &nodes.position[..self.nodes.min(nodes.position.len())],
            saturations: &nodes.saturation[..self.nodes.min(nodes.saturation.len())],
        }
    }
}

/// The nodes of a world that is on this device; none if the view needs particles on the host.
///
/// Pressures are computed on the host, and a section without sponges goes through the middle of the particles.
pub(super) fn resident(world: &World, gpu: &Arc<Gpu>, view: View) -> Result<Option<Resident>, GpuError> {
    let Some(resident) = world.resident().filter(|resident| Arc::ptr_eq(resident.gpu(), gpu)) else {
        return Ok(None);
    };
    let nodes = world.lattice().position.len();
    if view == View::Pressure || (view == View::Cutaway && nodes == 0) {
        return Ok(None);
    }
    let mut columns = Columns { rows: world.stores.host.rows, ..Columns::default() };
    if nodes > 0 {
        resident.download(&mut columns, &[Column::NodePosition, Column::NodeSaturation])?;
    }
    Ok(Some(Resident { columns, nodes }))
}
