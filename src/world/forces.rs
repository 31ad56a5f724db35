//! What pushes bodies, by its source, as a mean over the steps of a frame.

use glam::{DMat3, DVec3, Mat3, Vec3};
use sorb_kernels::body::{BodyState, Wrench};

use crate::rigid::RigidEngine;

/// Force and torque about the centre of mass of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    /// Force \[N\].
    pub force: DVec3,
    /// Torque \[N m\].
    pub torque: DVec3,
}

/// What acts on a body beside its weight, by its source: means over the steps of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct BodyLoads {
    /// By the fluid.
    pub fluid: Load,
    /// By sponges: contact, friction, and nodes that it grips.
    pub sponges: Load,
    /// By forces of [`Command::Force`](crate::Command::Force); impulses are no forces.
    pub host: Load,
    /// By other bodies and the walls of the container: what the engine changed the momentum by beside all others. Zero for bodies that are
    /// not dynamic, whose engine does not say.
    pub contact: Load,
}

/// Sources, in the order of the sums.
const SOURCES: usize = 4;

/// Impulse \[N s\] and angular impulse \[N m s\].
type Sum = [DVec3; 2];

/// Sums of a body but for the impulse of the fluid, as they are saved: its angular impulse, and those of the other sources.
pub(crate) type SavedLoads = Vec<(DVec3, [Sum; SOURCES - 1])>;

/// Sums over the steps of the present frame, and the means over those of the last one that had any.
#[derive(Clone, Debug, Default)]
pub(crate) struct Loads {
    sums: Vec<[Sum; SOURCES]>,
    time: f64,
}

impl Loads {
    /// Forgets the steps so far, before those of a frame.
    pub(crate) fn begin_frame(&mut self) {
        self.sums.clear();
        self.time = 0.0;
    }

    /// Adds a step \[s\]: what the bodies were given by the fluid, by nodes of sponges, by the host and by the engine.
    pub(crate) fn add(&mut self, given: impl ExactSizeIterator<Item = [Wrench; SOURCES]>, step: f32) {
        self.sums.resize(given.len(), [[DVec3::ZERO; 2]; SOURCES]);
        for (sums, given) in self.sums.iter_mut().zip(given) {
            for (sum, own) in sums.iter_mut().zip(given) {
                sum[0] += own.impulse;
                sum[1] += own.angular_impulse;
            }
        }
        self.time += f64::from(step);
    }

    /// Impulses of the fluid, and the time of all sums.
    pub(crate) fn saved(&self) -> (Vec<DVec3>, f64) {
        (self.sums.iter().map(|sums| sums[0][0]).collect(), self.time)
    }

    /// The other sums.
    pub(crate) fn saved_others(&self) -> SavedLoads {
        self.sums.iter().map(|[fluid, a, b, c]| (fluid[1], [*a, *b, *c])).collect()
    }

    /// Takes over what was saved. Where the others are missing they are zero.
    #[cfg(feature = "serde")]
    pub(crate) fn take(&mut self, (impulses, time): (Vec<DVec3>, f64), others: &SavedLoads) {
        let sums = |(index, impulse): (usize, DVec3)| {
            let (spin, [a, b, c]) = others.get(index).copied().unwrap_or_default();
            [[impulse, spin], a, b, c]
        };
        self.sums = impulses.into_iter().enumerate().map(sums).collect();
        self.time = time;
    }

    /// Takes over other sums in the same memory.
    pub(crate) fn copy(&mut self, from: &Self) {
        self.sums.clone_from(&from.sums);
        self.time = from.time;
    }

    /// Mean loads on every body; empty before the first step.
    pub(crate) fn means(&self) -> Vec<BodyLoads> {
        let load = |[impulse, spin]: Sum| Load { force: impulse / self.time, torque: spin / self.time };
        let means = |sums: &[Sum; SOURCES]| {
            let [fluid, sponges, host, contact] = sums.map(load);
            BodyLoads { fluid, sponges, host, contact }
        };
        self.sums.iter().map(means).collect()
    }
}

/// Momentum of a dynamic body before a step, which tells what its engine adds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Momentum(Option<Sum>);

impl Momentum {
    /// Of a body of an engine; of none that forces do not move.
    pub(crate) fn of(engine: &dyn RigidEngine, index: usize, inverse_mass: f32) -> Self {
        let BodyState { linear_velocity, angular_velocity, .. } = engine.state(index);
        let momentum = || {
            let spin = inertia(engine.inverse_inertia(index)) * angular_velocity.as_dvec3();
            [linear_velocity.as_dvec3() / f64::from(inverse_mass), spin]
        };
        Self((inverse_mass > 0.0).then(momentum))
    }

    /// What has changed it beside its weight and what was given.
    pub(crate) fn beside(self, after: Self, weight: Vec3, given: &Wrench) -> Wrench {
        let (Some(before), Some(after)) = (self.0, after.0) else { return Wrench::default() };
        Wrench {
            impulse: after[0] - before[0] - weight.as_dvec3() - given.impulse,
            angular_impulse: after[1] - before[1] - given.angular_impulse,
        }
    }
}

/// Zero for a body that does not turn.
pub(super) fn inertia(inverse: Mat3) -> DMat3 {
    inverse.as_dmat3().try_inverse().unwrap_or(DMat3::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_is_over_time_and_begins_anew_with_a_frame() {
        let given = |impulse: f64| {
            let wrench = |impulse: DVec3| Wrench { impulse, angular_impulse: DVec3::Z * impulse.y };
            [[wrench(DVec3::Y * impulse), wrench(DVec3::X), wrench(DVec3::ZERO), wrench(DVec3::Z)]]
                .into_iter()
        };
        let mut loads = Loads::default();
        assert!(loads.means().is_empty());
        loads.add(given(2.0), 0.5);
        loads.add(given(4.0), 1.5);
        let found = loads.means()[0];
        assert_eq!(found.fluid, Load { force: DVec3::Y * 3.0, torque: DVec3::Z * 3.0 });
        assert_eq!(
            (found.sponges.force, found.host.force, found.contact.force),
            (DVec3::X, DVec3::ZERO, DVec3::Z)
        );
        // The control: without a new frame the first steps would still be there.
        loads.begin_frame();
        loads.add(given(4.0), 0.5);
        assert_eq!(loads.means()[0].fluid.force, DVec3::Y * 8.0);
    }
}
