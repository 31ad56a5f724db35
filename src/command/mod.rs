//! Commands: what a host changes while a world runs, as data.
//!
//! [`World::push`](crate::World::push) checks a command and keeps it; the next step begins with all that were pushed, in their
//! order. The same commands before the same steps give the same bits. Recordings hold commands with their step.

mod check;
mod region;

use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

use crate::{
    handle::{BodyHandle, FlowHandle, SpongeHandle},
    rigid::{BodyKind, Target},
    scene::{Body, Drain, Emitter, GravityKey, KindKey, Material, Motion, Problem, Sponge},
};

pub use region::Region;

/// A change of a running world. Bodies and sponges have handles; those of the scene have its numbers, from 0. Other kinds may be added.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum Command {
    /// A force and a torque on a dynamic body, in all steps from the next one on. Another one replaces them, zeros end them.
    Force {
        /// The body.
        body: BodyHandle,
        /// Force at its centre of mass. Range -1e6 to 1e6 N.
        force: Vec3,
        /// Torque. Range -1e6 to 1e6 N m.
        torque: Vec3,
    },
    /// An impulse on a dynamic body, at once.
    Impulse {
        /// The body.
        body: BodyHandle,
        /// Impulse at its centre of mass. Range -1e6 to 1e6 N s.
        impulse: Vec3,
        /// Angular impulse. Range -1e6 to 1e6 N m s.
        angular_impulse: Vec3,
    },
    /// The velocity of a dynamic body, at once.
    Velocity {
        /// The body.
        body: BodyHandle,
        /// Velocity of its centre of mass. Range -100 to 100 m/s.
        linear_velocity: Vec3,
        /// Angular velocity. Range -1000 to 1000 rad/s.
        angular_velocity: Vec3,
    },
    /// A pose that a kinematic body goes to, at constant velocity and rate, in place of its motions.
    Pose {
        /// The body.
        body: BodyHandle,
        /// Position of its centre. Range -1000 to 1000 m.
        position: Vec3,
        /// Rotation from its frame to the world, of unit length.
        rotation: Quat,
        /// Time to get there. Range 0.000001 to 100000 s.
        duration: f32,
    },
    /// The acceleration of gravity.
    Gravity {
        /// Range -100 to 100 m/s^2.
        gravity: Vec3,
    },
    /// Gravity over time from now on: from what it is in straight lines from key to key, and as the last one after it.
    GravityPath {
        /// Times from now on, each after the one before it. At least one.
        path: Vec<GravityKey>,
    },
    /// Further motions of the container, after those that it has, in the frame in which it is at rest at time zero. What `ease` must
    /// be, and what is felt of it, is with [`Container`](crate::scene::Container).
    Container {
        /// Motions that begin now or later. At least one.
        #[serde(with = "crate::text")]
        motions: Vec<Motion>,
    },
    /// Nodes of sponges that a body holds from now on, where they are in its frame, which may move.
    Grip {
        /// The body, of any kind.
        body: BodyHandle,
        /// The nodes.
        nodes: Nodes,
    },
    /// Water in a region, at once, as particles on a lattice of `fluid.spacing`. Some places are left out and counted
    /// ([`Ledger::left_out`](crate::Ledger)): those outside of the container or less than a quarter of a spacing from its walls. So are
    /// those in bodies, in sponges and less than 0.8 spacings from other water. A region without any room is an error. For water that falls
    /// from above the blocks of the scene, or is faster than they are, set [`Fluid::sound_speed`](crate::scene::Fluid::sound_speed).
    Pour {
        /// Where. At most 50 million particles in all.
        region: Region,
        /// Its velocity. Range -100 to 100 m/s.
        velocity: Vec3,
    },
    /// All water in a region is taken away, at once: particles whose centres are in it, those in sponges included. A region without any is
    /// an error.
    Remove {
        /// Where.
        region: Region,
    },
    /// Begins a stream of water.
    Emit {
        /// Its number, which is that of [`World::next_flow`](crate::World::next_flow).
        number: FlowHandle,
        /// The stream. It begins at once if `start` is past.
        emitter: Emitter,
    },
    /// Opens a drain.
    Drain {
        /// Its number, which is that of [`World::next_flow`](crate::World::next_flow).
        number: FlowHandle,
        /// The drain. It opens at once if `start` is past.
        drain: Drain,
    },
    /// Ends an emitter or a drain.
    EndFlow {
        /// Its number. One that has ended, by itself as well, is an error.
        number: FlowHandle,
    },
    /// A sponge in its shape at rest at another place, at once, with the water in its pores. Nodes that bodies hold are let go. A place
    /// outside of the container, in a body or in a sponge is an error. So is one in water if the sponge brings water along.
    PlaceSponge {
        /// The sponge.
        sponge: SpongeHandle,
        /// Where the middle of its block goes. Range -1000 to 1000 m.
        position: Vec3,
        /// Rotation of its block, of unit length; the identity is as in the scene.
        rotation: Quat,
        /// Velocity of all of it. Range -100 to 100 m/s.
        velocity: Vec3,
    },
    /// Another sponge, with the water in its pores. Bodies that grip hold the nodes that are in them. A place in a body or in a sponge is
    /// an error, and one in water if the sponge brings water along. Rows of nodes change.
    AddSponge {
        /// Its handle, which is that of [`World::next_sponge`](crate::World::next_sponge).
        sponge: SpongeHandle,
        /// What it is, of the ranges and rules of scenes. A mesh needs vertices: a file is not read.
        #[serde(with = "crate::text")]
        description: Box<Sponge>,
    },
    /// A sponge goes; the water in it stays where it is. Rows of nodes change.
    RemoveSponge {
        /// The sponge.
        sponge: SpongeHandle,
    },
    /// Another material of a sponge, from the next step on.
    Material {
        /// The sponge.
        sponge: SpongeHandle,
        /// The material, of the ranges and rules of scenes; [`World::material`](crate::World::material) has the present one.
        material: Material,
    },
    /// Another body. One that grips holds the nodes that are in it. A place in a sponge or in water is an error.
    AddBody {
        /// Its handle, which is that of [`World::next_body`](crate::World::next_body).
        body: BodyHandle,
        /// What it is, of the ranges and rules of scenes. Motions have absolute times.
        #[serde(with = "crate::text")]
        description: Box<Body>,
    },
    /// A body goes; what it held is let go.
    RemoveBody {
        /// The body.
        body: BodyHandle,
    },
    /// Another kind of a body, where it is now. A dynamic one begins with its velocity, others have no motions: they rest until a `Pose`.
    BodyKind {
        /// The body.
        body: BodyHandle,
        /// Its kind.
        #[serde(with = "KindKey")]
        kind: BodyKind,
    },
    /// Nodes that nothing holds any more, whatever held them.
    Release {
        /// The nodes; those that nothing holds are left out.
        nodes: Nodes,
    },
}

/// Nodes of sponges.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum Nodes {
    /// Those in a ball at the beginning of the step.
    Sphere {
        /// Its centre. Range -1000 to 1000 m.
        centre: Vec3,
        /// Its radius. Range 0.0001 to 100 m.
        radius: f32,
    },
    /// These rows of [`World::node_positions`](crate::World::node_positions).
    Rows(Vec<u32>),
}

/// Why a command was refused; nothing has changed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("command: {}", .problems.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
#[non_exhaustive]
pub struct CommandError {
    /// What is wrong, with the key, the value and the range, as for keys of scenes. At least one.
    pub problems: Vec<Problem>,
}

/// What commands have set, and those that wait for the next step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Commands {
    pub(crate) pending: Vec<Command>,
    /// Force \[N\] and torque \[N m\] on every body; empty before the first.
    pub(crate) forces: Vec<[Vec3; 2]>,
    /// Where kinematic bodies go; empty before the first.
    pub(crate) targets: Vec<Option<Target>>,
}

impl Commands {
    /// Forgets what was set for a body, of so many.
    pub(crate) fn forget_body(&mut self, index: usize, count: usize) {
        if !self.forces.is_empty() {
            self.forces.resize(count, [Vec3::ZERO; 2]);
            self.forces[index] = [Vec3::ZERO; 2];
        }
        if !self.targets.is_empty() {
            self.targets.resize(count, None);
            self.targets[index] = None;
        }
    }

    /// Takes over other commands in the same memory.
    pub(crate) fn copy(&mut self, from: &Self) {
        self.pending.clone_from(&from.pending);
        self.forces.clone_from(&from.forces);
        self.targets.clone_from(&from.targets);
    }
}
