//! What a host sees of a device: the device itself, its buffers, and a state that is asked for now and taken later, so that the host need
//! not wait.

use std::sync::Arc;

use sorb_kernels::{
    columns::{Columns, RowCounts},
    gpu::{Gpu, GpuError, Pending, Resident},
};

use super::Device;
use crate::{Clock, World};

/// The state of a world when it was asked for, on its way to the host.
#[derive(Debug)]
pub struct StateRequest {
    clock: Clock,
    columns: Columns,
    pending: Option<Pending>,
}

impl World {
    /// The columns on the GPU, for a renderer that draws from the same buffers; none for a world on the CPU, and before
    /// the first step.
    #[must_use]
    pub fn resident(&self) -> Option<&Resident> {
        self.stores.device.as_ref().and_then(Device::resident)
    }

    /// The GPU that the world runs on; none for a world on the CPU.
    #[must_use]
    pub fn gpu(&self) -> Option<&Arc<Gpu>> {
        self.stores.device.as_ref().map(Device::gpu)
    }

    /// Asks for the present state, and does not wait for it: the world can take steps meanwhile, and the state is taken
    /// when it has arrived, for a picture say, a frame later. A world on the CPU has it at once.
    ///
    /// The answer has the columns that measures and pictures look at (positions, velocities, identities, density,
    /// interior, saturation), those that the options observe, and the bodies. Other columns are empty.
    ///
    /// # Errors
    /// The device was lost, or there is no memory to copy to.
    pub fn request_state(&self) -> Result<StateRequest, GpuError> {
        let host = &self.stores.host;
        let device = self.stores.device.as_ref().filter(|device| !device.is_looked_at());
        let (columns, pending) = match device {
            Some(device) => {
                let mut columns = Columns { rows: host.rows, ..Columns::default() };
                columns.bodies.states = host.bodies.states.clone();
                (columns, device.ask()?)
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

    /// Rows of the state.
    #[must_use]
    pub fn rows(&self) -> RowCounts {
        self.columns.rows
    }

    /// The columns; waits for them if they have not arrived.
    ///
    /// # Errors
    /// The device was lost.
    pub fn take(self) -> Result<Columns, GpuError> {
        let Self { mut columns, pending, .. } = self;
        if let Some(pending) = pending {
            pending.take(&mut columns)?;
        }
        Ok(columns)
    }
}
