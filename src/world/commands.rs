//! Commands of a host, applied at the beginning of a step.

use glam::{DVec3, Quat, Vec3};
use sorb_kernels::{
    body::{Body, Wrench},
    columns::{Columns, lane},
};

use super::{StepError, World, fastest_body, sleep::Kind};
use crate::{
    command::{Command, CommandError, Nodes},
    handle::{BodyHandle, FlowHandle, SpongeHandle},
    rigid::{RigidError, Target},
    water::FlowKind,
};

impl World {
    /// Checks a command, and keeps it for the beginning of the next step; commands are carried out in the order in which they
    /// were pushed. They wake what they act on.
    ///
    /// ```
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// use sorb::{Command, World, glam::Vec3, scene::Scene};
    ///
    /// let mut world = World::new(&Scene::new("space"))?;
    /// world.push(Command::Gravity { gravity: Vec3::new(0.0, -1.62, 0.0) })?;
    /// let error = world.push(Command::Gravity { gravity: Vec3::splat(1e6) });
    /// assert!(error.is_err_and(|error| error.to_string().contains("out of range -100 to 100 m/s^2")));
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// A value is out of range, or there is no such body or node; nothing has changed.
    pub fn push(&mut self, command: Command) -> Result<(), CommandError> {
        self.check_command(&command)?;
        self.commands.pending.push(command);
        Ok(())
    }

    /// Whether commands that change the water wait for the next step.
    pub(crate) fn has_water_commands(&self) -> bool {
        self.commands.pending.iter().any(changes_water)
    }

    /// Flows that commands begin which wait for the next step.
    pub(crate) fn pending_flows(&self) -> u32 {
        let begins = |command: &&Command| matches!(command, Command::Emit { .. } | Command::Drain { .. });
        self.commands.pending.iter().filter(begins).count() as u32
    }

    /// Whether an emitter or a drain of a number has not ended, nor will before the next step.
    pub(crate) fn has_flow(&self, number: FlowHandle) -> bool {
        let mut is_there = self.water.flows.iter().any(|flow| flow.number == number.number());
        for command in &self.commands.pending {
            match command {
                Command::Emit { number: own, .. } | Command::Drain { number: own, .. } => {
                    is_there |= *own == number;
                }
                Command::EndFlow { number: own } => is_there &= *own != number,
                _ => {}
            }
        }
        is_there
    }

    /// Carries out what was pushed.
    pub(super) fn carry_out(&mut self) -> Result<(), StepError> {
        if self.commands.pending.is_empty() {
            return Ok(());
        }
        // A device that cannot be read is lost, which the step reports.
        if self.commands.pending.iter().any(changes_columns) && !self.stores.move_to_host() {
            return Ok(());
        }
        let pending = std::mem::take(&mut self.commands.pending);
        for command in &pending {
            self.carry_out_one(command)?;
        }
        self.clock.body_speed = fastest_body(&self.stores.host.bodies.states.0);
        Ok(())
    }

    fn carry_out_one(&mut self, command: &Command) -> Result<(), StepError> {
        // Only a state that was made up has stale handles.
        if body_of(command).is_some_and(|body| self.slots().kind(body).is_none())
            || sponge_of(command).is_some_and(|sponge| !self.has_sponge(sponge))
        {
            return Ok(());
        }
        match command {
            Command::Force { body, force, torque } => {
                let count = self.bodies().len();
                self.commands.forces.resize(count, [Vec3::ZERO; 2]);
                self.commands.forces[body.index()] = [*force, *torque];
                self.wake_kinds(|kind| kind == Kind::Body(body.index()));
            }
            Command::Impulse { body, impulse, angular_impulse } => {
                let index = body.index();
                self.wake_kinds(|kind| kind == Kind::Body(index));
                let state = self.engine.state(index);
                let linear = state.linear_velocity + *impulse * self.engine.inverse_mass(index);
                let angular = state.angular_velocity + self.engine.inverse_inertia(index) * *angular_impulse;
                self.set_velocity(index, linear, angular).map_err(rigid)?;
            }
            Command::Velocity { body, linear_velocity, angular_velocity } => {
                let index = body.index();
                self.wake_kinds(|kind| kind == Kind::Body(index));
                self.set_velocity(index, *linear_velocity, *angular_velocity).map_err(rigid)?;
            }
            Command::Pose { body, position, rotation, duration } => {
                let index = body.index();
                let target = self.target(index, (*position, *rotation), *duration);
                self.engine.set_target(index, target).map_err(rigid)?;
                let count = self.bodies().len();
                self.commands.targets.resize(count, None);
                self.commands.targets[index] = Some(target);
                self.sleep.follow(index, &target);
                self.take_over_body(index);
                self.wake_kinds(|_| false);
            }
            Command::Gravity { gravity } => {
                self.begin_gravity(*gravity).map_err(rigid)?;
                self.wake_kinds(|_| true);
            }
            Command::GravityPath { path } => self.begin_gravity_path(path),
            Command::Container { motions } => self.begin_motions(motions),
            Command::Grip { body, nodes } => self.grip(body.index() as u32, nodes),
            Command::Release { nodes } => self.release(nodes),
            Command::PlaceSponge { sponge, position, rotation, velocity } => {
                self.place_sponge(sponge.index(), (*position, *rotation), *velocity);
            }
            Command::AddBody { body, description } => self.add_body(*body, description)?,
            Command::RemoveBody { body } => self.remove_body(*body)?,
            Command::BodyKind { body, kind } => self.change_kind(*body, *kind)?,
            Command::AddSponge { sponge, description } => self.add_sponge(*sponge, description)?,
            Command::RemoveSponge { sponge } => self.remove_sponge(*sponge)?,
            Command::Material { sponge, material } => self.set_material(sponge.index(), material)?,
            Command::Pour { region, velocity } => self.pour(region, *velocity)?,
            Command::Remove { region } => self.remove_water(region)?,
            Command::Emit { number, emitter } => self.begin_flow(*number, FlowKind::Emitter(*emitter)),
            Command::Drain { number, drain } => self.begin_flow(*number, FlowKind::Drain(*drain)),
            Command::EndFlow { number } => self.water.flows.retain(|flow| flow.number != number.number()),
        }
        Ok(())
    }

    /// The way of a body from where it is to a pose, in some time \[s\].
    pub(crate) fn target(&self, index: usize, (position, rotation): (Vec3, Quat), duration: f32) -> Target {
        let (state, start) = (self.engine.state(index), self.clock.time);
        Target {
            from: state.position,
            from_rotation: state.rotation,
            position,
            rotation: rotation.as_dquat().normalize().as_quat(),
            start,
            end: start + f64::from(duration),
        }
    }

    fn set_velocity(&mut self, index: usize, linear: Vec3, angular: Vec3) -> Result<(), RigidError> {
        self.engine.set_velocity(index, linear, angular)?;
        self.take_over_body(index);
        Ok(())
    }

    fn take_over_body(&mut self, index: usize) {
        self.stores.host.bodies.states.0[index].state = self.engine.state(index);
    }

    /// Sets the gravity of everything.
    pub(crate) fn set_gravity(&mut self, gravity: Vec3) -> Result<(), RigidError> {
        self.engine.set_gravity(gravity)?;
        self.light.set_gravity(gravity);
        self.params.gravity = gravity;
        Ok(())
    }

    pub(super) fn grip(&mut self, body: u32, nodes: &Nodes) {
        let columns = &mut self.stores.host;
        let state = columns.bodies.states.0[body as usize].state;
        let rows = rows_of(columns, nodes);
        let inverse = state.rotation.conjugate();
        for row in &rows {
            let [x, y, z, _] = columns.nodes.position[*row];
            let offset = inverse * (Vec3::new(x, y, z) - state.position);
            columns.nodes.grip[*row] = body;
            columns.nodes.grip_offset[*row] = [offset.x, offset.y, offset.z, 0.0];
            columns.nodes.position[*row][lane::nodes::position::INVERSE_MASS] = 0.0;
        }
        self.wake_sponges(&rows, true);
    }

    fn release(&mut self, nodes: &Nodes) {
        let columns = &self.stores.host;
        let mut rows = rows_of(columns, nodes);
        rows.retain(|row| columns.nodes.grip[*row] != u32::MAX);
        self.let_go(&rows);
        self.wake_sponges(&rows, false);
    }

    /// Nodes that nothing holds any more.
    pub(super) fn let_go(&mut self, rows: &[usize]) {
        let nodes = &mut self.stores.host.nodes;
        for row in rows {
            let density = self.scene.sponges[nodes.sponge[*row] as usize].density;
            nodes.grip[*row] = u32::MAX;
            nodes.grip_offset[*row] = [0.0; 4];
            nodes.position[*row][lane::nodes::position::INVERSE_MASS] = 1.0 / (density * nodes.volume[*row]);
        }
    }

    /// Wakes the sponges of some nodes, which bodies may move from afar if they hold them.
    fn wake_sponges(&mut self, rows: &[usize], is_held: bool) {
        let mut sponges: Vec<usize> =
            rows.iter().map(|row| self.stores.host.nodes.sponge[*row] as usize).collect();
        sponges.sort_unstable();
        sponges.dedup();
        if is_held {
            self.sleep.keep_awake(&sponges);
        }
        self.wake_kinds(|kind| matches!(kind, Kind::Sponge(own) if sponges.contains(&own)));
    }
}

fn rigid(error: RigidError) -> StepError {
    StepError::Rigid(error.to_string())
}

/// The body that a command acts on, which must be there.
fn body_of(command: &Command) -> Option<BodyHandle> {
    match command {
        Command::Force { body, .. }
        | Command::Impulse { body, .. }
        | Command::Velocity { body, .. }
        | Command::Pose { body, .. }
        | Command::Grip { body, .. }
        | Command::RemoveBody { body }
        | Command::BodyKind { body, .. } => Some(*body),
        _ => None,
    }
}

/// The sponge that a command acts on, which must be there.
fn sponge_of(command: &Command) -> Option<SpongeHandle> {
    match command {
        Command::PlaceSponge { sponge, .. }
        | Command::Material { sponge, .. }
        | Command::RemoveSponge { sponge } => Some(*sponge),
        _ => None,
    }
}

/// Whether a command changes what a device has a copy of.
fn changes_columns(command: &Command) -> bool {
    changes_water(command)
        || matches!(
            command,
            Command::Gravity { .. }
                | Command::Grip { .. }
                | Command::Release { .. }
                | Command::PlaceSponge { .. }
                | Command::AddSponge { .. }
                | Command::RemoveSponge { .. }
                | Command::Material { .. }
                | Command::AddBody { .. }
                | Command::RemoveBody { .. }
                | Command::BodyKind { .. }
        )
}

/// Whether water comes or goes by a command.
fn changes_water(command: &Command) -> bool {
    matches!(command, Command::Pour { .. } | Command::Remove { .. } | Command::AddSponge { .. })
}

/// Rows of nodes, in order.
pub(super) fn rows_of(columns: &Columns, nodes: &Nodes) -> Vec<usize> {
    match nodes {
        // Only in a state that was made up others have more.
        Nodes::Rows(rows) => {
            rows.iter().map(|row| *row as usize).filter(|row| *row < columns.rows.nodes).collect()
        }
        Nodes::Sphere { centre, radius } => {
            let rows = columns.nodes.position.iter().take(columns.rows.nodes).enumerate();
            let is_inside = |row: &[f32; 4]| {
                centre.distance_squared(Vec3::new(row[0], row[1], row[2])) <= radius * radius
            };
            rows.filter(|(_, row)| is_inside(row)).map(|(row, _)| row).collect()
        }
    }
}

/// Adds the forces of commands in a step \[s\] to the wrenches on bodies.
pub(crate) fn add_forces(forces: &[[Vec3; 2]], bodies: &[Body], wrenches: &mut [Wrench], step: f32) {
    debug_assert!(forces.is_empty() || forces.len() == bodies.len());
    for (wrench, [force, torque]) in wrenches.iter_mut().zip(forces) {
        let whole = |vector: &Vec3| -> DVec3 { vector.as_dvec3() * f64::from(step) };
        wrench.impulse += whole(force);
        wrench.angular_impulse += whole(torque);
    }
}
