//! Bodies that come, go and change while the engine runs.
//!
//! The sets of rapier3d are built anew from all bodies as they are. Handles are then those of an engine that was built with these bodies,
//! and a restored engine has the same. Impulses of contacts begin anew.

use glam::Vec3;
use rapier3d::prelude::{CoefficientCombineRule, ColliderBuilder, SharedShape};

use super::super::{BodyKind, BodySetup, BodyState, RigidError};
use super::{RapierEngine, build::check_container, pose};

impl RapierEngine {
    /// Puts a body in place of one, or after the last.
    pub(super) fn replace(&mut self, index: usize, body: &BodySetup) -> Result<(), RigidError> {
        if let Some(container) = self.container {
            check_container(container, std::slice::from_ref(body))?;
        }
        let mut setups = self.setups.to_vec();
        for (own, setup) in setups.iter_mut().enumerate() {
            if self.kinds[own] == BodyKind::Dynamic {
                setup.state = self.moving_state(own);
            }
        }
        match setups.get_mut(index) {
            Some(setup) => setup.clone_from(body),
            None => setups.push(body.clone()),
        }
        let mut new = Self::build(self.gravity, self.container, &setups)?;
        (new.time, new.parameters.dt) = (self.time, self.parameters.dt);
        for own in 0..new.kinds.len() {
            if own != index
                && let Some(script) = self.scripts.get(own)
            {
                new.scripts[own].clone_from(script);
            }
            if let Some(script) = &new.scripts[own] {
                let state = script.state(self.time);
                new.states[own] = state;
                new.bodies[new.handles[own]].set_position(pose(&state), true);
            }
        }
        *self = new;
        Ok(())
    }

    /// The state of a body with the velocity that it continues with, if it is held.
    fn moving_state(&self, index: usize) -> BodyState {
        let mut state = self.states[index];
        if let Some(velocities) = self.held[index] {
            [state.linear_velocity, state.angular_velocity] = velocities;
        }
        state
    }

    /// Walls around all bodies.
    pub(super) fn add_walls(&mut self, (low, high): (Vec3, Vec3)) {
        for (index, axis) in Vec3::AXES.into_iter().enumerate() {
            for (bound, normal) in [(low[index], axis), (high[index], -axis)] {
                // An open side.
                if !bound.is_finite() {
                    continue;
                }
                // The product with a coefficient of one is the body's own coefficient.
                let wall = ColliderBuilder::new(SharedShape::halfspace(normal))
                    .translation(axis * bound)
                    .friction(1.0)
                    .restitution(1.0)
                    .friction_combine_rule(CoefficientCombineRule::Multiply)
                    .restitution_combine_rule(CoefficientCombineRule::Multiply);
                self.colliders.insert(wall);
            }
        }
    }
}
