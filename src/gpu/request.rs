//! A state that is asked for now and taken later, so that the host need not wait for the device.

use sorb_kernels::{
    columns::{Columns, RowCounts},
    gpu::{GpuError, Pending},
};

use crate::{Clock, World};

/// The state of a world when it was asked for, on its way to the host.
#[derive(Debug)]
pub struct StateRequest {
    clock: Clock,
    columns: Columns,
    pending: Option<Pending>,
}

impl World {
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
