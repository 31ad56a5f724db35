//! Copies of the engine, how it is shown, and what touches in it.

use std::{fmt, sync::Arc};

use rapier3d::prelude::PhysicsPipeline;

use super::RapierEngine;

impl Clone for RapierEngine {
    fn clone(&self) -> Self {
        Self {
            gravity: self.gravity,
            container: self.container,
            setups: Arc::clone(&self.setups),
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
        // Bodies may have come and gone since.
        self.names.clone_from(&other.names);
        self.kinds.clone_from(&other.kinds);
        self.handles.clone_from(&other.handles);
        self.scripts.clone_from(&other.scripts);
        self.setups = Arc::clone(&other.setups);
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

impl fmt::Debug for RapierEngine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RapierEngine")
            .field("gravity", &self.gravity)
            .field("time", &self.time)
            .field("names", &self.names)
            .field("kinds", &self.kinds)
            .field("states", &self.states)
            .finish_non_exhaustive()
    }
}

impl RapierEngine {
    /// Pairs of bodies that touch, and bodies that touch a wall.
    pub(super) fn touching(&self) -> Vec<(usize, Option<usize>)> {
        let body_of = |collider| {
            let parent = self.colliders.get(collider)?.parent()?;
            self.handles.iter().position(|handle| *handle == parent)
        };
        let pairs = self.narrow_phase.contact_pairs().filter(|pair| pair.has_any_active_contact());
        let pair = pairs.filter_map(|pair| match (body_of(pair.collider1), body_of(pair.collider2)) {
            (Some(first), second) => Some((first, second)),
            (None, Some(second)) => Some((second, None)),
            (None, None) => None,
        });
        pair.collect()
    }
}
