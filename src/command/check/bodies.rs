//! Checks of commands to bodies, and of what an engine of a host lacks.

use glam::Vec3;

use super::Check;
use crate::{
    command::{Command, Nodes},
    handle::BodyHandle,
    rigid::{BodyKind, BodySetup, BodyState, Shape},
    scene::{Body, Problem, REMOVED},
};

impl Check<'_> {
    /// A body that is there, of a kind, once the commands that wait are carried out.
    pub(super) fn body(&mut self, key: &str, body: BodyHandle, kind: Option<BodyKind>) {
        if !self.knows_flows {
            return;
        }
        let slots = self.world.slots_after_commands();
        let rule = match (slots.kind(body), kind) {
            (None, _) => {
                let count = slots.count();
                format!("no such body; there are {count}, numbered from 0, and one that was removed is gone")
            }
            (Some(found), Some(kind)) if found != kind => {
                format!("the body is {found:?}, and must be {kind:?}").to_lowercase()
            }
            _ => return,
        };
        self.rule(key, body.to_string(), rule);
    }

    /// A body that the scene could have, with the next handle, where nothing is.
    pub(super) fn add_body(&mut self, body: BodyHandle, description: &Body) {
        let world = self.world;
        if self.knows_flows {
            let next = world.next_body();
            if body != next {
                let rule = format!("no handle is used twice; the next one is {next}");
                self.rule("add_body.body", body.to_string(), rule);
                return;
            }
        }
        if description.is_removed() || description.name.starts_with(REMOVED) {
            let rule = format!("names of bodies that were removed begin with `{REMOVED}`");
            self.rule("add_body.description.name", format!("{:?}", description.name), rule);
        }
        self.described(body.index(), description, "add_body.description.");
        if !self.problems.is_empty() || !self.knows_flows {
            return;
        }
        if let Some(rule) = world.body_refusal(description) {
            self.rule("add_body.description.position", description.position.to_string(), rule);
        }
    }

    /// Nodes that a body can hold.
    pub(super) fn load(&mut self, body: BodyHandle, nodes: &Nodes) {
        if !self.problems.is_empty() || !self.knows_flows {
            return;
        }
        if let Some(rule) = self.world.grip_refusal(body, nodes) {
            self.rule("grip.nodes", format!("{nodes:?}"), rule);
        }
    }

    /// A kind that a body can have.
    pub(super) fn body_kind(&mut self, body: BodyHandle, kind: BodyKind) {
        let is_there = self.world.slots().kind(body).is_some();
        if !self.problems.is_empty() || !is_there {
            return;
        }
        if let Some(rule) = self.world.kind_refusal(body, kind) {
            self.rule("body_kind.kind", format!("{kind:?}"), rule);
            return;
        }
        match self.world.described(body.index(), kind) {
            Ok(description) => self.described(body.index(), &description, "body_kind."),
            Err(error) => self.rule("body_kind.kind", format!("{kind:?}"), error.to_string()),
        }
    }

    /// Problems of a body with a number, as those of a scene with it.
    fn described(&mut self, index: usize, body: &Body, table: &str) {
        let world = self.world;
        let index = index.min(world.scene().bodies.len());
        let own = format!("bodies[{index}].");
        let named = |problem: Problem| {
            let key = problem.key.strip_prefix(&own).map(|key| format!("{table}{key}"));
            Problem { key: key.unwrap_or(problem.key), ..problem }
        };
        let problems = world.scene_with(index, body.clone()).problems();
        self.problems.extend(problems.into_iter().map(named));
    }

    /// A body that every engine can have.
    fn probe(&self) -> BodySetup {
        let state = BodyState {
            position: Vec3::ZERO,
            rotation: glam::Quat::IDENTITY,
            linear_velocity: Vec3::ZERO,
            angular_velocity: Vec3::ZERO,
        };
        BodySetup {
            name: "probe".to_owned(),
            shape: Shape::Sphere { radius: 0.01 },
            kind: BodyKind::Fixed,
            density: 1000.0,
            state,
            friction: 0.0,
            restitution: 0.0,
            motions: Vec::new(),
        }
    }

    /// What an engine of a host refuses: tried on a copy, because a step must not fail by it later.
    pub(super) fn engine(&mut self, command: &Command) {
        let mut engine = self.world.engine.boxed_clone();
        let (key, value, tried) = match command {
            Command::Impulse { body, .. } => {
                ("impulse.body", *body, engine.set_velocity(body.index(), Vec3::ZERO, Vec3::ZERO))
            }
            Command::Velocity { body, linear_velocity, angular_velocity } => {
                let tried = engine.set_velocity(body.index(), *linear_velocity, *angular_velocity);
                ("velocity.body", *body, tried)
            }
            Command::Pose { body, position, rotation, duration } => {
                let target = self.world.target(body.index(), (*position, *rotation), *duration);
                ("pose.body", *body, engine.set_target(body.index(), target))
            }
            Command::AddBody { body, .. } => {
                let body = *body;
                ("add_body.body", body, engine.set_body(body.index(), &self.probe()))
            }
            Command::RemoveBody { body } => {
                let body = *body;
                ("remove_body.body", body, engine.set_body(body.index(), &self.probe()))
            }
            Command::BodyKind { body, .. } => {
                let body = *body;
                ("body_kind.body", body, engine.set_body(body.index(), &self.probe()))
            }
            Command::GravityPath { path } => {
                if let Err(error) = engine.set_gravity(self.world.params.gravity) {
                    self.rule("gravity_path.path", format!("({} keys)", path.len()), error.to_string());
                }
                return;
            }
            Command::Container { motions } => {
                if let Err(error) = engine.set_gravity(self.world.params.gravity) {
                    self.rule("container.motions", format!("({} motions)", motions.len()), error.to_string());
                }
                return;
            }
            Command::Gravity { gravity } => {
                if let Err(error) = engine.set_gravity(*gravity) {
                    self.rule("gravity.gravity", gravity.to_string(), error.to_string());
                }
                return;
            }
            _ => return,
        };
        if let Err(error) = tried {
            self.rule(key, value.to_string(), error.to_string());
        }
    }
}
