//! A turn of the container, on the device.

use super::{
    error::GpuError,
    resident::Resident,
    twins::{Names, TURN_NODES, TURN_PARTICLES},
};
use crate::turn::Turn;

/// Particles between steps, in the order that `grid::sort_fluid` left or where `sph::advect` put them back.
const SORTED: Names = &[("positions", "fluid_position"), ("velocities", "fluid_velocity")];

impl Resident {
    /// Does to the velocities of particles and nodes what a turn of the container does in the next step, as [`Turn::apply`]. Once for
    /// every step, between two of them.
    ///
    /// # Errors
    /// The device was lost.
    pub fn turn(&mut self, turn: &Turn) -> Result<(), GpuError> {
        let uniform = self.uniform("turn", turn)?;
        let particles = if self.sorted { TURN_PARTICLES.on(SORTED) } else { TURN_PARTICLES };
        let jobs = [self.jobs("frame", &particles), self.jobs("frame", &TURN_NODES)].concat();
        let dispatches = self.bind_all(&jobs, &[("turn", &uniform)])?;
        self.submit(&[&dispatches], false, None)
    }
}
