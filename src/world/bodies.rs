//! Bodies that come, go and change their kind while a world runs.
//!
//! A body has a number, which is its row and its number in the engine. What is removed leaves a body behind that nothing can meet, until
//! another one takes its number. Rows and numbers of all others stay, and so do the nodes that they hold.

use glam::{Quat, Vec3};
use sorb_kernels::{body::Body, reduce::Wrenches, rounding::Rounding};

use super::{StepError, World, WorldError, fastest_body, sleep, slots::Slots};
use crate::{
    command::Command,
    handle::BodyHandle,
    rigid::{BodyKind, BodySetup, LightBodies, RigidError},
    scene::{self, Rotation, Scene},
    setup::{TOUCH, body_setup, cutter, engine, params},
};

impl Slots<BodyKind> {
    /// The kind of a body; none for a stale handle.
    pub(crate) fn kind(&self, body: BodyHandle) -> Option<BodyKind> {
        self.of(body.index(), body.generation())
    }

    fn follow(&mut self, command: &Command) {
        match command {
            Command::AddBody { body, description } => {
                self.take(body.index(), body.generation(), description.kind);
            }
            Command::RemoveBody { body } => self.free(body.index(), body.generation()),
            Command::BodyKind { body, kind } => self.change(body.index(), *kind),
            _ => {}
        }
    }
}

impl World {
    /// The bodies that are there, in the order of their numbers.
    pub fn body_handles(&self) -> impl Iterator<Item = BodyHandle> {
        let all = (0..self.scene.bodies.len()).map(|index| self.handle_of(index));
        all.filter(|body| !self.scene.bodies[body.index()].is_removed())
    }

    /// A body; none for a stale handle.
    #[must_use]
    pub fn body(&self, body: BodyHandle) -> Option<&Body> {
        self.slots().kind(body)?;
        self.bodies().get(body.index())
    }

    /// The handle of the next body that a command adds, after those that wait.
    #[must_use]
    pub fn next_body(&self) -> BodyHandle {
        let (index, generation) = self.slots_after_commands().next();
        BodyHandle::new(index, generation)
    }

    /// The handle of the body with a number.
    pub(crate) fn handle_of(&self, index: usize) -> BodyHandle {
        let generations = self.origin.as_ref().map_or(&[][..], |origin| &origin.generations);
        BodyHandle::new(index as u32, generations.get(index).copied().unwrap_or(0))
    }

    /// The numbers of bodies.
    pub(crate) fn slots(&self) -> Slots<BodyKind> {
        let slot = |(index, body): (usize, &scene::Body)| {
            let kind = (!body.is_removed()).then_some(body.kind);
            (self.handle_of(index).generation(), kind)
        };
        Slots::new(self.scene.bodies.iter().enumerate().map(slot))
    }

    /// The same after the commands that wait.
    pub(crate) fn slots_after_commands(&self) -> Slots<BodyKind> {
        let mut slots = self.slots();
        self.commands.pending.iter().for_each(|command| slots.follow(command));
        slots
    }

    /// The scene with a body in place of the one with a number, or after the last.
    pub(crate) fn scene_with(&self, index: usize, body: scene::Body) -> Scene {
        let mut scene = Scene::clone(&self.scene);
        match scene.bodies.get_mut(index) {
            Some(own) => *own = body,
            None => scene.bodies.push(body),
        }
        scene
    }

    /// A body as it is now, of another kind: at its present pose, without motions, and with its velocity if it is dynamic now.
    pub(crate) fn described(&self, index: usize, kind: BodyKind) -> Result<scene::Body, WorldError> {
        let old = &self.scene.bodies[index];
        let spacing = self.scene.fluid.as_ref().map_or(0.0, |fluid| fluid.spacing);
        let state = self.engine.state(index);
        let rotation = rotation_of(state.rotation);
        // Of a body whose frame is at the origin: where its centre of mass is in that frame.
        let at_origin = scene::Body { position: Vec3::ZERO, rotation, ..old.clone() };
        let centre = body_setup(&at_origin, spacing)?.state.position;
        let velocity = |own: Vec3| if kind == BodyKind::Dynamic { own } else { Vec3::ZERO };
        Ok(scene::Body {
            kind,
            position: state.position - centre,
            rotation,
            linear_velocity: velocity(state.linear_velocity),
            angular_velocity: velocity(state.angular_velocity),
            motions: Vec::new(),
            ..old.clone()
        })
    }

    /// Why there is no room for a body; none if there is.
    pub(crate) fn body_refusal(&self, description: &scene::Body) -> Option<String> {
        let spacing = self.scene.fluid.as_ref().map_or(0.0, |fluid| fluid.spacing);
        let setup = match body_setup(description, spacing) {
            Ok(setup) => setup,
            Err(error) => return Some(error.to_string()),
        };
        let body = cutter(description, &setup);
        let is_in = |row: &[f32; 4], depth: f32| body.distance(Vec3::new(row[0], row[1], row[2])) < -depth;
        let wet = self.particle_positions().iter().filter(|row| is_in(row, 0.0)).count();
        if wet > 0 {
            return Some(format!("{wet} particles are there; remove them first"));
        }
        let nodes = self.node_positions().iter().zip(&self.lattice.node_sponge);
        let edge = |sponge: u32| self.params.sponges[sponge as usize].edge;
        let mut inside = nodes.filter(|(row, sponge)| is_in(row, TOUCH * edge(**sponge)));
        if body.touches_nodes
            && let Some((_, sponge)) = inside.next()
        {
            return Some(format!(
                "sponge number {sponge} is there, `{}`",
                self.scene.sponges[*sponge as usize].name
            ));
        }
        self.is_claimed(sleep::box_of(&body))
            .then(|| "a command that waits brings something there; take a step first".to_owned())
    }

    /// Adds a body with the handle that was promised.
    pub(super) fn add_body(&mut self, body: BodyHandle, description: &scene::Body) -> Result<(), StepError> {
        // Only a state that was made up has another one.
        if self.slots().next() != (body.index() as u32, body.generation()) {
            return Ok(());
        }
        self.put_body(body.index(), description.clone())?;
        if description.grip {
            self.hold_what_is_inside(body.index(), None);
        }
        Ok(())
    }

    /// Removes a body; what it held is let go.
    pub(super) fn remove_body(&mut self, body: BodyHandle) -> Result<(), StepError> {
        let grips = self.stores.host.nodes.grip.iter().take(self.stores.host.rows.nodes);
        let held = grips.enumerate().filter(|(_, own)| **own as usize == body.index());
        let rows: Vec<usize> = held.map(|(row, _)| row).collect();
        self.let_go(&rows);
        self.put_body(body.index(), scene::Body::removed(body.index()))?;
        if let Some(origin) = &mut self.origin {
            let generations = &mut origin.generations;
            generations.resize(generations.len().max(body.index() + 1), 0);
            generations[body.index()] = body.generation().saturating_add(1);
        }
        Ok(())
    }

    /// Changes the kind of a body.
    pub(super) fn change_kind(&mut self, body: BodyHandle, kind: BodyKind) -> Result<(), StepError> {
        let fail = |error: WorldError| StepError::Scene(error.to_string());
        let description = self.described(body.index(), kind).map_err(fail)?;
        self.put_body(body.index(), description)
    }

    /// Puts a body in place of the one with a number, or after the last.
    fn put_body(&mut self, index: usize, body: scene::Body) -> Result<(), StepError> {
        let fail = |error: WorldError| StepError::Scene(error.to_string());
        let spacing = self.scene.fluid.as_ref().map_or(0.0, |fluid| fluid.spacing);
        let setup = body_setup(&body, spacing).map_err(fail)?;
        self.keep_cutters();
        let scene = self.scene_with(index, body);
        self.change_scene(scene);
        self.put_in_engine(index, &setup).map_err(|error| StepError::Rigid(error.to_string()))?;
        self.put_row(index, &setup);
        let gravity = self.params.gravity;
        let asleep = std::mem::take(&mut self.params.asleep);
        self.params =
            sorb_kernels::params::Params { step: self.params.step, gravity, asleep, ..params(&self.scene) };
        self.light = LightBodies::new(&self.scene);
        self.light.set_gravity(gravity);
        self.loads.begin_frame();
        let count = self.scene.bodies.len();
        self.commands.forget_body(index, count);
        self.steps_anew().map_err(fail)?;
        if self.scene.time.sleep_after > 0.0 {
            // Parts are others: everything wakes, and rest is detected anew.
            self.sleep = self.sleep.anew(&self.scene, &self.params, &self.commands.targets);
        } else {
            let mut sleep = sleep::Sleep::new(&self.scene, &self.params);
            (sleep.carried, self.sleep.carried) = (std::mem::take(&mut self.sleep.carried), Vec::new());
            self.sleep = sleep;
        }
        self.apply_sleep();
        Ok(())
    }

    /// Gives the engine a body. An engine without dynamic bodies is replaced by one that has them. An engine without any bodies is replaced
    /// by one of the present time.
    fn put_in_engine(&mut self, index: usize, setup: &BodySetup) -> Result<(), RigidError> {
        let is_dynamic = setup.kind == BodyKind::Dynamic;
        let has_dynamics = self.origin.as_ref().is_some_and(|origin| origin.has_dynamics);
        let is_first = self.stores.host.rows.bodies == 0;
        if self.has_own_engine || has_dynamics || !(is_dynamic || is_first) {
            return self.engine.set_body(index, setup);
        }
        let fail = |error: WorldError| RigidError::Engine { message: error.to_string() };
        let setups = crate::setup::body_setups(&self.scene).map_err(fail)?;
        let mut new = engine(&self.scene, &setups, is_dynamic).map_err(fail)?;
        new.wait(self.clock.time);
        new.set_gravity(self.params.gravity)?;
        let targets = self.commands.targets.iter().enumerate();
        for (body, target) in targets.filter_map(|(body, target)| target.map(|target| (body, target))) {
            if body != index {
                new.set_target(body, target)?;
            }
        }
        self.engine = new;
        if let Some(origin) = &mut self.origin {
            origin.has_dynamics = is_dynamic;
        }
        Ok(())
    }

    /// The row of a body.
    fn put_row(&mut self, index: usize, setup: &BodySetup) {
        let own = &self.scene.bodies[index];
        let spacing = self.scene.fluid.as_ref().map_or(0.0, |fluid| fluid.spacing);
        let body = Body {
            shape: setup.shape.clone(),
            kind: setup.kind,
            state: self.engine.state(index),
            friction: own.friction,
            touches_nodes: !own.grip,
            no_slip: own.no_slip,
            rounding: Rounding::new(&setup.shape, spacing),
            inverse_mass: self.engine.inverse_mass(index),
            inverse_inertia: self.engine.inverse_inertia(index),
        };
        let store = &mut self.stores.host.bodies;
        match store.states.0.get_mut(index) {
            Some(row) => *row = body,
            None => store.states.0.push(body),
        }
        let rows = &mut self.stores.host.rows;
        rows.bodies = self.stores.host.bodies.states.0.len();
        let store = &mut self.stores.host.bodies;
        (store.fluid_wrenches, store.node_wrenches) = (Wrenches::default(), Wrenches::default());
        self.clock.body_speed = fastest_body(&store.states.0);
    }

    /// Keeps the bodies that the sponges of the scene were cut by: those of later scenes are others.
    pub(super) fn keep_cutters(&mut self) {
        let bodies = if self.scene.sponges.is_empty() { Vec::new() } else { self.scene.bodies.clone() };
        let origin = self.origin_mut();
        if origin.cut_by.is_none() {
            origin.cut_by = Some(bodies);
        }
    }

    /// Gives a body the nodes that are in it; or those of one sponge that nothing holds yet.
    pub(super) fn hold_what_is_inside(&mut self, index: usize, of: Option<u32>) {
        let body = &self.stores.host.bodies.states.0[index];
        let is_in = |row: &[f32; 4]| body.distance(Vec3::new(row[0], row[1], row[2])) <= 0.0;
        let nodes = self.stores.host.nodes.position.iter().take(self.stores.host.rows.nodes).enumerate();
        let own = &self.stores.host.nodes;
        let is_meant = |row: usize| of.is_none_or(|of| own.grip[row] == u32::MAX && own.sponge[row] == of);
        let rows = nodes.filter(|(row, place)| is_in(place) && is_meant(*row)).map(|(row, _)| row as u32);
        let rows: Vec<u32> = rows.collect();
        self.grip(index as u32, &crate::command::Nodes::Rows(rows));
    }
}

/// A rotation as scenes have it.
fn rotation_of(rotation: Quat) -> Rotation {
    let rotation = rotation.as_dquat().normalize();
    let axis = glam::DVec3::new(rotation.x, rotation.y, rotation.z);
    let sine = axis.length();
    if sine == 0.0 {
        return Rotation::default();
    }
    let degrees = (2.0 * libm::atan2(sine, rotation.w)).to_degrees();
    Rotation::new((axis / sine).as_vec3(), degrees as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotations_come_back() {
        for turn in [Quat::IDENTITY, Quat::from_rotation_x(1.0), Quat::from_xyzw(0.5, -0.5, 0.5, -0.5)] {
            let back = rotation_of(turn).quaternion();
            assert!(back.dot(turn).abs() > 1.0 - 1e-6, "{turn} {back}");
        }
        // The control: another one.
        assert!(
            rotation_of(Quat::from_rotation_x(1.0)).quaternion().dot(Quat::from_rotation_y(1.0)).abs() < 0.99
        );
    }
}
