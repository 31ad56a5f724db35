//! Rigid bodies: the engines that move them, and the one interface through which fluid and sponge push them.
//!
//! A [`RigidEngine`] takes one [`Wrench`] per body and advances the bodies by one step. [`ScriptedEngine`] supports fixed
//! and kinematic bodies only and needs no physics engine. With the feature `rigid`, `RapierEngine` adds dynamic bodies,
//! moved by rapier3d. A host with its own engine implements the trait, and builds its world by
//! [`World::with_engine`](crate::World::with_engine).
//!
//! The same inputs give the same bits on every run. Bodies are inserted in the order given, and nothing sleeps by itself.
//! Scripted poses are closed forms of the time, with trigonometry that does not depend on the platform.

#[cfg(feature = "rigid")]
mod compound;
mod error;
mod foreign;
#[cfg(feature = "rigid")]
mod hull;
mod light;
mod mass;
mod mechanics;
#[cfg(feature = "rigid")]
mod parts;
#[cfg(feature = "rigid")]
mod rapier;
mod saved;
mod script;
mod scripted;
mod setup;
mod target;
#[cfg(test)]
mod tests;
mod told;

// The interface shared with the kernels and the scene. The files of this folder import these types from here.
pub use sorb_kernels::body::{Body, BodyKind, BodyState, Compound, ConvexPart, Shape, Wrench};

use crate::scene::Motion;

pub use crate::setup::body_setups;
#[cfg(feature = "rigid")]
pub(crate) use compound::cup;
pub use error::RigidError;
pub(crate) use foreign::{check_engine, check_state};
#[cfg(feature = "rigid")]
pub use hull::{ConvexHull, HullError, MAX_HULL_VERTICES, convex_hull};
pub(crate) use light::LightBodies;
pub use mass::MassProperties;
pub use mechanics::Mechanics;
#[cfg(feature = "rigid")]
pub(crate) use parts::mesh_body;
#[cfg(feature = "rigid")]
pub use rapier::{RapierEngine, shape_of};
/// The version whose shapes [`shape_of`] takes.
#[cfg(feature = "rigid")]
pub use rapier3d;
pub(crate) use script::{Moved, Script, moved};
pub use scripted::ScriptedEngine;
pub use setup::BodySetup;
pub use target::Target;
pub use told::HostBody;
pub(crate) use told::ToldEngine;

use glam::{Mat3, Vec3};
use std::{any::Any, fmt};

/// Interface between the simulator and the engine that moves the rigid bodies.
///
/// Bodies are numbered from zero in the order in which they were given; the numbers never change.
/// [`BodyState`] is at the centre of mass, in the world's frame, in SI units.
///
/// The per-body methods may panic if `index` is not less than [`body_count`](Self::body_count).
pub trait RigidEngine: fmt::Debug + Send + Sync {
    /// Number of bodies.
    fn body_count(&self) -> usize;

    /// What moves the body.
    fn kind(&self, index: usize) -> BodyKind;

    /// Pose and velocity now.
    ///
    /// The velocity of a kinematic body is that from now on, hence zero once its motion is over.
    fn state(&self, index: usize) -> BodyState;

    /// Inverse of the mass \[1/kg\]; zero for fixed and kinematic bodies.
    fn inverse_mass(&self, index: usize) -> f32;

    /// Inverse of the inertia about the centre of mass, in the world's frame \[1/(kg m²)\]; zero for fixed and
    /// kinematic bodies.
    fn inverse_inertia(&self, index: usize) -> Mat3;

    /// Applies one wrench per body at once, then advances all bodies by `dt` \[s\], which may differ from step
    /// to step.
    ///
    /// Wrenches on fixed and kinematic bodies have no effect.
    ///
    /// # Errors
    /// `dt` that is not finite and above zero, a wrong number of wrenches, or a wrench that is not finite:
    /// nothing has moved then. A state that is not finite after the step: the run cannot continue.
    fn step(&mut self, dt: f32, wrenches: &[Wrench]) -> Result<(), RigidError>;

    /// Lets time pass \[s\] in which nothing moves: bodies keep their places and velocities, and scripts continue after it.
    fn wait(&mut self, time: f64);

    /// Holds a dynamic body in place, at rest, whatever acts on it, or releases it with its former velocity. Mass and
    /// inertia are unchanged. No moving body is near a held one. No effect on fixed and kinematic bodies.
    fn hold(&mut self, index: usize, is_held: bool);

    /// Copies the engine with all of its state: the copy continues with the same bits.
    fn boxed_clone(&self) -> Box<dyn RigidEngine>;

    /// The engine itself, for [`copy_from`](Self::copy_from) of its own kind; the default is none.
    fn as_any(&self) -> Option<&dyn Any> {
        None
    }

    /// The engine itself, writable; the default is none.
    fn as_any_mut(&mut self) -> Option<&mut dyn Any> {
        None
    }

    /// Takes over the state of another engine of the same bodies, in the same memory; false if it cannot, and nothing has
    /// changed. The default cannot.
    fn copy_from(&mut self, other: &dyn RigidEngine) -> bool {
        let _ = other;
        false
    }

    /// Appends everything that decides the future and does not follow from the bodies that the engine was built from. An engine
    /// of the same bodies that [`restore`](Self::restore)s it continues with the same bits, and saves the same bytes after
    /// every step.
    ///
    /// # Errors
    /// The default: [`RigidError::Unsupported`].
    fn save(&self, out: &mut Vec<u8>) -> Result<(), RigidError> {
        let _ = out;
        Err(RigidError::Unsupported { what: "saves" })
    }

    /// Takes over what [`save`](Self::save) appended in an engine of the same bodies.
    ///
    /// # Errors
    /// Bytes that no engine of these bodies has saved; the engine is unchanged. The default: [`RigidError::Unsupported`].
    fn restore(&mut self, bytes: &[u8]) -> Result<(), RigidError> {
        let _ = bytes;
        Err(RigidError::Unsupported { what: "restores" })
    }

    /// Gives a dynamic body a velocity \[m/s\] and an angular velocity \[rad/s\].
    ///
    /// # Errors
    /// The default: [`RigidError::Unsupported`].
    fn set_velocity(&mut self, index: usize, linear: Vec3, angular: Vec3) -> Result<(), RigidError> {
        let _ = (index, linear, angular);
        Err(RigidError::Unsupported { what: "velocities from outside" })
    }

    /// Gives a kinematic body a pose to go to, in place of its script.
    ///
    /// # Errors
    /// The default: [`RigidError::Unsupported`].
    fn set_target(&mut self, index: usize, target: Target) -> Result<(), RigidError> {
        let _ = (index, target);
        Err(RigidError::Unsupported { what: "poses from outside" })
    }

    /// Puts another body in place of one, or after the last where `index` is the number of bodies. Motions have absolute times.
    ///
    /// # Errors
    /// A body that the engine could not have been built with; it is unchanged. The default: [`RigidError::Unsupported`].
    fn set_body(&mut self, index: usize, body: &BodySetup) -> Result<(), RigidError> {
        let _ = (index, body);
        Err(RigidError::Unsupported { what: "bodies that come and go" })
    }

    /// Pairs of bodies that touched in the last step, and bodies that touched a wall of the container (none). The default knows of none.
    fn contacts(&self) -> Vec<(usize, Option<usize>)> {
        Vec::new()
    }

    /// Sets the acceleration of gravity \[m/s^2\].
    ///
    /// # Errors
    /// The default: [`RigidError::Unsupported`].
    fn set_gravity(&mut self, gravity: Vec3) -> Result<(), RigidError> {
        let _ = gravity;
        Err(RigidError::Unsupported { what: "another gravity" })
    }
}

impl Clone for Box<dyn RigidEngine> {
    fn clone(&self) -> Self {
        (**self).boxed_clone()
    }
}
