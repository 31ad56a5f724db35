//! Worlds on a GPU need the feature `gpu`. Without it these types have no values, so that no other code asks for the
//! feature.

use std::fmt;

use glam::Vec3;
use sorb_kernels::{asleep::Asleep, columns::Columns, cpu::Cpu, params::Params};

use crate::{
    Measures,
    clock::Steps,
    query::{Probe, Ray},
    schedule::Awake,
    world::{FrameReport, StepError, StepReport, World, WorldError},
};

/// A GPU; there is none without the feature `gpu`.
#[derive(Debug)]
pub enum Gpu {}

/// Why something could not be done on a GPU; nothing is tried without the feature `gpu`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum GpuError {}

impl fmt::Display for GpuError {
    fn fmt(&self, _: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {}
    }
}

impl std::error::Error for GpuError {}

/// What runs the kernels of a world on a device.
#[derive(Debug)]
pub(crate) enum Device {}

impl Device {
    pub(crate) fn without_data(&self) -> Self {
        match *self {}
    }

    pub(crate) fn move_to_host(&mut self, _: &mut Columns) -> bool {
        match *self {}
    }

    pub(crate) fn discard_state(&mut self) {
        match *self {}
    }

    pub(crate) fn has_all(&self) -> bool {
        match *self {}
    }

    pub(crate) fn view<'a>(&'a self, _: &'a Columns) -> &'a Columns {
        match *self {}
    }

    pub(crate) fn set_asleep(&mut self, _: Awake, _: &Asleep, _: &Steps, _: bool) {
        match *self {}
    }

    pub(crate) fn set_gravity(&mut self, _: Vec3) {
        match *self {}
    }

    pub(crate) fn take_velocities(&mut self, _: &mut Columns) -> Result<(), GpuError> {
        match *self {}
    }

    pub(crate) fn step_with(&mut self, _: &Cpu, _: &mut Columns, _: &Params) -> Result<(), GpuError> {
        match *self {}
    }

    pub(crate) fn add_sums(&self, _: &World, _: &mut Measures) -> bool {
        match *self {}
    }
}

impl World {
    pub(crate) fn probe_on_device(&self, _: &[Vec3]) -> Option<Vec<Probe>> {
        None
    }

    pub(crate) fn water_on_device(&self, _: &[Ray]) -> Option<Vec<Option<(f32, Vec3)>>> {
        None
    }

    pub(crate) fn levels_on_device(&self, _: &[Vec3]) -> Option<Vec<Option<f32>>> {
        None
    }

    /// The same for other contents.
    ///
    /// # Errors
    /// As [`Self::place`].
    pub(crate) fn place_again(&mut self) -> Result<(), WorldError> {
        self.place()
    }

    /// Places the step as the options say: on the CPU.
    ///
    /// # Errors
    /// A GPU is asked for.
    pub(crate) fn place(&mut self) -> Result<(), WorldError> {
        if self.options.offload.wants_gpu() {
            return Err(WorldError::NeedsGpu(self.options.offload.clone()));
        }
        Ok(())
    }

    pub(crate) fn step_on_device(&mut self) -> Option<Result<StepReport, StepError>> {
        None
    }

    pub(crate) fn frame_on_device(&mut self) -> Option<Result<FrameReport, StepError>> {
        None
    }
}
