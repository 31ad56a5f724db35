//! What the fluid pushes bodies with, as a mean over the steps of a frame.

use glam::DVec3;
use sorb_kernels::body::Wrench;

/// Sums over the steps of the present frame, and the means over those of the last one that had any.
#[derive(Clone, Debug, Default)]
pub(crate) struct FluidForces {
    impulses: Vec<DVec3>,
    time: f64,
}

impl FluidForces {
    /// Forgets the steps so far, before those of a frame.
    pub(crate) fn begin_frame(&mut self) {
        self.impulses.clear();
        self.time = 0.0;
    }

    /// Adds what the bodies were given in a step \[s\]: by the fluid, and by nodes of sponges.
    pub(crate) fn add(&mut self, given: &[(Wrench, Wrench)], step: f32) {
        self.impulses.resize(given.len(), DVec3::ZERO);
        for (sum, (by_fluid, _)) in self.impulses.iter_mut().zip(given) {
            *sum += by_fluid.impulse;
        }
        self.time += f64::from(step);
    }

    /// What is saved: the sums, and their time.
    pub(crate) fn saved(&self) -> (Vec<DVec3>, f64) {
        (self.impulses.clone(), self.time)
    }

    /// Takes over what was saved.
    #[cfg(feature = "serde")]
    pub(crate) fn take(&mut self, (impulses, time): (Vec<DVec3>, f64)) {
        (self.impulses, self.time) = (impulses, time);
    }

    /// Takes over other sums in the same memory.
    pub(crate) fn copy(&mut self, from: &Self) {
        self.impulses.clone_from(&from.impulses);
        self.time = from.time;
    }

    /// Mean force on every body \[N\]; empty before the first step.
    pub(crate) fn means(&self) -> Vec<DVec3> {
        self.impulses.iter().map(|impulse| *impulse / self.time).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_is_over_time_and_begins_anew_with_a_frame() {
        let given = |impulse: f64| {
            let by_fluid = Wrench { impulse: DVec3::Y * impulse, angular_impulse: DVec3::ZERO };
            let by_nodes = Wrench { impulse: DVec3::X, angular_impulse: DVec3::ZERO };
            [(by_fluid, by_nodes)]
        };
        let mut forces = FluidForces::default();
        assert!(forces.means().is_empty());
        forces.add(&given(2.0), 0.5);
        forces.add(&given(4.0), 1.5);
        assert_eq!(forces.means(), [DVec3::Y * 3.0]);
        // The control: without a new frame the first steps would still be there.
        forces.begin_frame();
        forces.add(&given(4.0), 0.5);
        assert_eq!(forces.means(), [DVec3::Y * 8.0]);
    }
}
