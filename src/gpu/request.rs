//! Access of a host to a device: the device, its buffers, and a state that is requested now and taken later without waiting.

use std::sync::Arc;

use sorb_kernels::{
    body::Body,
    columns::Columns,
    gpu::{Gpu, GpuError, Pending, Resident, wgpu::Buffer},
};

use super::Device;
use crate::{Clock, World};

/// The state of a world at the time of a request, on its way to the host.
#[derive(Debug)]
pub struct StateRequest {
    clock: Clock,
    columns: Columns,
    pending: Option<Pending>,
}

impl World {
    /// Buffers of the positions and velocities of the particles on the GPU after the last step: rows of four floats like
    /// those of [`Self::particle_positions`]. For a renderer on the same device, which must not write them. None for a world
    /// on the CPU, and before the first step.
    ///
    /// Once water came or went they may be other buffers, and longer: the first [`Self::particle_count`] rows count.
    #[must_use]
    pub fn particle_buffers(&self) -> Option<(&Buffer, &Buffer)> {
        self.resident().map(Resident::particle_buffers)
    }

    /// The columns on the device, if there are any yet.
    pub(crate) fn resident(&self) -> Option<&Resident> {
        self.stores.device.as_ref().and_then(Device::resident)
    }

    /// The GPU that the world runs on; none for a world on the CPU.
    #[must_use]
    pub fn gpu(&self) -> Option<&Arc<Gpu>> {
        self.stores.device.as_ref().map(Device::gpu)
    }

    /// Requests the present state without waiting. The world can take steps meanwhile, and the state is taken when it has
    /// arrived, for example for a picture a frame later. A world on the CPU has it at once.
    ///
    /// The answer has what a [`State`] has views of.
    ///
    /// # Errors
    /// The device was lost, or there is no memory to copy to.
    pub fn request_state(&self) -> Result<StateRequest, GpuError> {
        let host = &self.stores.host;
        let device = self.stores.device.as_ref().filter(|device| !device.is_host_current());
        let (columns, pending) = match device {
            Some(device) => {
                let mut columns = Columns { rows: host.rows, ..Columns::default() };
                columns.bodies.states = host.bodies.states.clone();
                (columns, device.request_columns()?)
            }
            None => (self.columns().clone(), None),
        };
        Ok(StateRequest { clock: self.clock, columns, pending })
    }
}

impl StateRequest {
    /// Whether [`Self::take`] has nothing to wait for.
    #[must_use]
    pub fn is_ready(&mut self) -> bool {
        self.pending.as_mut().is_none_or(Pending::is_ready)
    }

    /// The clock of the state.
    #[must_use]
    pub fn clock(&self) -> &Clock {
        &self.clock
    }

    /// The state; waits until it has arrived.
    ///
    /// # Errors
    /// The device was lost.
    pub fn take(self) -> Result<State, GpuError> {
        let Self { mut columns, pending, .. } = self;
        if let Some(pending) = pending {
            pending.take(&mut columns)?;
        }
        Ok(State(columns))
    }
}

/// The state of a world at some time, with the views of a [`World`] by row.
#[derive(Clone, Debug)]
pub struct State(Columns);

impl State {
    pub(crate) fn columns(&self) -> &Columns {
        &self.0
    }

    /// Shapes, poses and velocities of the bodies, in the order of the scene.
    #[must_use]
    pub fn bodies(&self) -> &[Body] {
        &self.0.bodies.states.0
    }
}
