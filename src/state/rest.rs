//! The state beside columns and engine.

use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};

use crate::{
    clock::Clock,
    command::Commands,
    world::{World, sleep},
};

/// Numbers that decide the future, and the forces that a host may look at.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Rest {
    pub(super) clock: Clock,
    /// Length of the last step \[s\].
    pub(super) step: f32,
    pub(super) gravity: Vec3,
    /// Smallest of the constant bounds of the step \[s\], and the number of the bound.
    pub(super) constant: (f32, u8),
    pub(super) sleep: sleep::Saved,
    pub(super) commands: Commands,
    /// Impulses of the fluid on the bodies \[N s\], and the time of them \[s\].
    pub(super) fluid_forces: (Vec<DVec3>, f64),
}

impl Rest {
    pub(super) fn of(world: &World) -> Self {
        let (constant, bound) = world.steps.constant();
        Self {
            clock: world.clock,
            step: world.params.step,
            gravity: world.params.gravity,
            constant: (constant, bound as u8),
            sleep: world.sleep.saved(),
            commands: world.commands.clone(),
            fluid_forces: world.loads.saved(),
        }
    }

    /// What is impossible in a world of these bodies, if anything is.
    #[cfg(feature = "serde")]
    pub(super) fn defect(&self, world: &World) -> Option<String> {
        let Self { clock, step, gravity, constant, commands, fluid_forces, .. } = self;
        let bodies = world.bodies().len();
        let fits = |length: usize| length == 0 || length == bodies;
        let are_finite = commands.forces.iter().flatten().all(|vector| vector.is_finite());
        if !(clock.time.is_finite() && clock.time >= 0.0) {
            return Some(format!("time = {} s", clock.time));
        }
        if !(*step > 0.0 && step.is_finite() && constant.0 > 0.0 && constant.0.is_finite()) {
            return Some(format!("steps of {step} and {} s", constant.0));
        }
        if usize::from(constant.1) >= crate::Bound::ALL.len() {
            return Some(format!("a bound of number {}", constant.1));
        }
        if !(gravity.is_finite() && are_finite) {
            return Some("a force that is not finite".to_owned());
        }
        if !(fits(commands.forces.len()) && fits(commands.targets.len()) && fits(fluid_forces.0.len())) {
            return Some(format!("forces on other bodies than {bodies}"));
        }
        if commands.targets.iter().flatten().any(|target| !target.is_valid()) {
            return Some("a target that no body can reach".to_owned());
        }
        commands
            .pending
            .iter()
            .find_map(|command| world.check_later(command).err().map(|error| error.to_string()))
    }
}
