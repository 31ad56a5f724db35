//! Copies of the engine.

use rapier3d::prelude::PhysicsPipeline;

use super::RapierEngine;

impl Clone for RapierEngine {
    fn clone(&self) -> Self {
        Self {
            gravity: self.gravity,
            names: self.names.clone(),
            kinds: self.kinds.clone(),
            handles: self.handles.clone(),
            scripts: self.scripts.clone(),
            states: self.states.clone(),
            held: self.held.clone(),
            time: self.time,
            parameters: self.parameters,
            islands: self.islands.clone(),
            broad_phase: self.broad_phase.clone(),
            narrow_phase: self.narrow_phase.clone(),
            bodies: self.bodies.clone(),
            colliders: self.colliders.clone(),
            continuous: self.continuous.clone(),
            // Working memory: rapier3d leaves it out of its own snapshots as well.
            pipeline: PhysicsPipeline::new(),
        }
    }
}

impl RapierEngine {
    /// Takes over the state of another engine of as many bodies.
    pub(super) fn take_over(&mut self, other: &Self) {
        (self.gravity, self.time, self.parameters) = (other.gravity, other.time, other.parameters);
        self.states.copy_from_slice(&other.states);
        self.held.copy_from_slice(&other.held);
        for (own, other) in self.scripts.iter_mut().flatten().zip(other.scripts.iter().flatten()) {
            own.target = other.target;
        }
        // rapier3d has no copy in place.
        self.islands = other.islands.clone();
        self.broad_phase = other.broad_phase.clone();
        self.narrow_phase = other.narrow_phase.clone();
        self.bodies = other.bodies.clone();
        self.colliders = other.colliders.clone();
        self.continuous = other.continuous.clone();
        // Its working memory refers to the sets as they were.
        self.pipeline = PhysicsPipeline::new();
    }
}
