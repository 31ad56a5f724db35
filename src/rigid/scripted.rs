use super::saved::{append, check_targets, read};
use super::script::Script;
use super::setup::{check_step, checked_state};
use super::{BodyKind, BodySetup, BodyState, RigidEngine, RigidError, Target, Wrench};
use glam::{Mat3, Vec3};
use std::any::Any;

/// Fixed and kinematic bodies only; needs no physics engine.
#[derive(Clone, Debug)]
pub struct ScriptedEngine {
    names: Vec<String>,
    kinds: Vec<BodyKind>,
    scripts: Vec<Script>,
    states: Vec<BodyState>,
    time: f64,
}

impl ScriptedEngine {
    /// Builds the bodies, in the order given, at time zero.
    ///
    /// # Errors
    /// A dynamic body, a value out of its range, or a key that does not fit the kind of the body.
    pub fn new(bodies: &[BodySetup]) -> Result<Self, RigidError> {
        let mut scripts = Vec::with_capacity(bodies.len());
        for body in bodies {
            if body.kind == BodyKind::Dynamic {
                return Err(RigidError::DynamicUnsupported { body: body.name.clone() });
            }
            scripts.push(Script::new(checked_state(body)?, &body.motions));
        }
        Ok(Self {
            names: bodies.iter().map(|body| body.name.clone()).collect(),
            kinds: bodies.iter().map(|body| body.kind).collect(),
            states: scripts.iter().map(|script| script.state(0.0)).collect(),
            scripts,
            time: 0.0,
        })
    }

    /// Time since the start \[s\].
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }
}

impl RigidEngine for ScriptedEngine {
    fn body_count(&self) -> usize {
        self.kinds.len()
    }

    fn kind(&self, index: usize) -> BodyKind {
        self.kinds[index]
    }

    fn state(&self, index: usize) -> BodyState {
        self.states[index]
    }

    fn inverse_mass(&self, _index: usize) -> f32 {
        0.0
    }

    fn inverse_inertia(&self, _index: usize) -> Mat3 {
        Mat3::ZERO
    }

    fn step(&mut self, dt: f32, wrenches: &[Wrench]) -> Result<(), RigidError> {
        check_step(dt, wrenches, &self.names)?;
        self.time += f64::from(dt);
        for (state, script) in self.states.iter_mut().zip(&self.scripts) {
            *state = script.state(self.time);
        }
        Ok(())
    }

    fn wait(&mut self, time: f64) {
        self.time += time;
    }

    fn hold(&mut self, _index: usize, _is_held: bool) {}

    fn as_any(&self) -> Option<&dyn Any> {
        Some(self)
    }

    fn copy_from(&mut self, other: &dyn RigidEngine) -> bool {
        let Some(other) = other.as_any().and_then(|other| other.downcast_ref::<Self>()) else { return false };
        if other.states.len() != self.states.len() {
            return false;
        }
        self.time = other.time;
        self.states.copy_from_slice(&other.states);
        // Bodies may have come and gone since.
        self.names.clone_from(&other.names);
        self.kinds.clone_from(&other.kinds);
        self.scripts.clone_from(&other.scripts);
        true
    }

    fn save(&self, out: &mut Vec<u8>) -> Result<(), RigidError> {
        let targets: Vec<_> = self.scripts.iter().map(|script| script.target).collect();
        append(&(self.time, targets), out)
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<(), RigidError> {
        let (time, targets): (f64, Vec<Option<Target>>) = read(bytes)?;
        check_targets(time, &targets, &self.kinds)?;
        self.time = time;
        for ((state, script), target) in self.states.iter_mut().zip(&mut self.scripts).zip(targets) {
            script.target = target;
            *state = script.state(time);
        }
        Ok(())
    }

    fn set_target(&mut self, index: usize, target: Target) -> Result<(), RigidError> {
        self.scripts[index].target = Some(target);
        self.states[index] = self.scripts[index].state(self.time);
        Ok(())
    }

    fn set_body(&mut self, index: usize, body: &BodySetup) -> Result<(), RigidError> {
        if body.kind == BodyKind::Dynamic {
            return Err(RigidError::DynamicUnsupported { body: body.name.clone() });
        }
        let script = Script::new(checked_state(body)?, &body.motions);
        let state = script.state(self.time);
        if index == self.kinds.len() {
            self.names.push(body.name.clone());
            self.kinds.push(body.kind);
            self.scripts.push(script);
            self.states.push(state);
        } else {
            (self.names[index], self.kinds[index]) = (body.name.clone(), body.kind);
            (self.scripts[index], self.states[index]) = (script, state);
        }
        Ok(())
    }

    fn set_gravity(&mut self, _gravity: Vec3) -> Result<(), RigidError> {
        Ok(())
    }

    fn boxed_clone(&self) -> Box<dyn RigidEngine> {
        Box::new(self.clone())
    }
}
