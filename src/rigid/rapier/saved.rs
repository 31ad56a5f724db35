//! The state of rapier3d as bytes.
//!
//! Everything that its own snapshots hold: bodies, colliders, contacts with their impulses, islands and the broad phase with
//! its layout. Working memory is left out, as in those ([`PhysicsPipeline`], the cached targets of the swept test).

use glam::{Quat, Vec3};
use rapier3d::prelude::{
    BroadPhaseBvh, CCDSolver, ColliderSet, IslandManager, NarrowPhase, PhysicsPipeline, Real, RigidBodySet,
};
use serde::{Deserialize, Serialize};

use super::super::saved::{append, check_targets, read};
use super::super::{BodyKind, BodyState, RigidError, Target};
use super::RapierEngine;

/// What the engine has beside the sets of rapier3d.
#[derive(Debug, Serialize, Deserialize)]
struct Own {
    gravity: Vec3,
    time: f64,
    /// Length of the last rapier3d step \[s\].
    dt: Real,
    targets: Vec<Option<Target>>,
    held: Vec<Option<[Vec3; 2]>>,
    states: Vec<(Vec3, Quat, Vec3, Vec3)>,
}

/// The sets of rapier3d.
type Sets = (RigidBodySet, ColliderSet, IslandManager, BroadPhaseBvh, NarrowPhase);

impl RapierEngine {
    pub(super) fn append_to(&self, out: &mut Vec<u8>) -> Result<(), RigidError> {
        let state = |state: &BodyState| {
            (state.position, state.rotation, state.linear_velocity, state.angular_velocity)
        };
        let own = Own {
            gravity: self.gravity,
            time: self.time,
            dt: self.parameters.dt,
            targets: self.scripts.iter().map(|script| script.as_ref().and_then(|own| own.target)).collect(),
            held: self.held.clone(),
            states: self.states.iter().map(state).collect(),
        };
        let sets = (&self.bodies, &self.colliders, &self.islands, &self.broad_phase, &self.narrow_phase);
        append(&(own, sets), out)
    }

    pub(super) fn read_from(&mut self, bytes: &[u8]) -> Result<(), RigidError> {
        let (own, sets): (Own, Sets) = read(bytes)?;
        self.check(&own, &sets)?;
        let Own { gravity, time, dt, targets, held, states } = own;
        (self.gravity, self.time, self.parameters.dt, self.held) = (gravity, time, dt, held);
        for (script, target) in self.scripts.iter_mut().zip(targets) {
            if let Some(script) = script {
                script.target = target;
            }
        }
        for (own, saved) in self.states.iter_mut().zip(states) {
            let (position, rotation, linear_velocity, angular_velocity) = saved;
            *own = BodyState { position, rotation, linear_velocity, angular_velocity };
        }
        (self.bodies, self.colliders, self.islands, self.broad_phase, self.narrow_phase) = sets;
        self.continuous = CCDSolver::new();
        self.pipeline = PhysicsPipeline::new();
        Ok(())
    }

    /// Refuses bytes of an engine of other bodies.
    fn check(&self, own: &Own, (bodies, colliders, ..): &Sets) -> Result<(), RigidError> {
        let fail = |reason: String| Err(RigidError::Saved { reason });
        check_targets(own.time, &own.targets, &self.kinds)?;
        let count = self.kinds.len();
        if own.held.len() != count || own.states.len() != count || bodies.len() != count {
            return fail(format!("{} bodies, and there are {count}", bodies.len()));
        }
        if colliders.len() != self.colliders.len() {
            return fail(format!("{} shapes, and there are {}", colliders.len(), self.colliders.len()));
        }
        for (index, (handle, kind)) in self.handles.iter().zip(&self.kinds).enumerate() {
            let is_held = own.held[index].is_some();
            let found = bodies.get(*handle).map(|body| (body.is_dynamic(), body.is_kinematic()));
            let expected = match kind {
                BodyKind::Dynamic => (!is_held, is_held),
                BodyKind::Kinematic => (false, true),
                BodyKind::Fixed => (false, false),
            };
            if found != Some(expected) || is_held && *kind != BodyKind::Dynamic {
                return fail(format!("body number {index} is no {kind:?} body"));
            }
        }
        if !(own.gravity.is_finite() && own.dt.is_finite() && own.dt > 0.0) {
            return fail(format!("gravity = {} m/s^2, step = {} s", own.gravity, own.dt));
        }
        Ok(())
    }
}
