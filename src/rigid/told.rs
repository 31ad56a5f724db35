//! The engine of a [`Coupler`](crate::Coupler): it keeps what the host says of its bodies.

use std::any::Any;

use glam::Mat3;
use serde::{Deserialize, Serialize};

use super::{
    BodyKind, BodySetup, BodyState, MassProperties, RigidEngine, RigidError, Wrench, check_state,
    saved::{append, read},
    setup::{check_step, checked_state},
};

/// A body of a host.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HostBody {
    /// Pose of its centre of mass, and velocity.
    pub state: BodyState,
    /// Inverse of its mass \[1/kg\]; 0 for a body that forces do not move.
    pub inverse_mass: f32,
    /// Inverse of its inertia about the centre of mass, in the world's frame \[1/(kg m^2)\]; zero for such a body.
    pub inverse_inertia: Mat3,
}

/// Bodies as a host has told them last.
#[derive(Clone, Debug)]
pub(crate) struct ToldEngine {
    names: Vec<String>,
    kinds: Vec<BodyKind>,
    pub(crate) bodies: Vec<HostBody>,
    /// What the last step gave them.
    pub(crate) wrenches: Vec<Wrench>,
}

/// A body as it is saved.
#[derive(Debug, Serialize, Deserialize)]
struct Saved {
    position: glam::Vec3,
    rotation: glam::Quat,
    velocities: [glam::Vec3; 2],
    inverse_mass: f32,
    inverse_inertia: Mat3,
}

impl ToldEngine {
    /// The bodies at time zero, with the masses of their shapes.
    pub(crate) fn new(setups: &[BodySetup]) -> Result<Self, RigidError> {
        let body = |setup: &BodySetup| {
            let state = checked_state(setup)?;
            let mass = MassProperties::new(&setup.shape, setup.density);
            let mass = mass.filter(|_| setup.kind == BodyKind::Dynamic);
            let turned = Mat3::from_quat(state.rotation);
            let inertia =
                |own: &MassProperties| turned * own.inertia.inverse().as_mat3() * turned.transpose();
            Ok(HostBody {
                state,
                inverse_mass: mass.as_ref().map_or(0.0, |own| 1.0 / own.mass as f32),
                inverse_inertia: mass.as_ref().map_or(Mat3::ZERO, inertia),
            })
        };
        Ok(Self {
            names: setups.iter().map(|setup| setup.name.clone()).collect(),
            kinds: setups.iter().map(|setup| setup.kind).collect(),
            bodies: setups.iter().map(body).collect::<Result<_, RigidError>>()?,
            wrenches: vec![Wrench::default(); setups.len()],
        })
    }

    /// Refuses what no body can be.
    pub(crate) fn check(&self) -> Result<(), RigidError> {
        for (index, (body, kind)) in self.bodies.iter().zip(&self.kinds).enumerate() {
            check_state(index, &body.state)?;
            let (mass, is_dynamic) = (body.inverse_mass, *kind == BodyKind::Dynamic);
            let is_mass = mass.is_finite() && mass >= 0.0 && (is_dynamic || mass == 0.0);
            if !(is_mass && body.inverse_inertia.is_finite()) {
                let range = if is_dynamic { "finite and at least 0" } else { "0" };
                let name = &self.names[index];
                let message = format!("body `{name}`: inverse mass = {mass} 1/kg is out of range: {range}");
                return Err(RigidError::Engine { message });
            }
        }
        Ok(())
    }
}

impl RigidEngine for ToldEngine {
    fn body_count(&self) -> usize {
        self.kinds.len()
    }

    fn kind(&self, index: usize) -> BodyKind {
        self.kinds[index]
    }

    fn state(&self, index: usize) -> BodyState {
        self.bodies[index].state
    }

    fn inverse_mass(&self, index: usize) -> f32 {
        self.bodies[index].inverse_mass
    }

    fn inverse_inertia(&self, index: usize) -> Mat3 {
        self.bodies[index].inverse_inertia
    }

    fn step(&mut self, dt: f32, wrenches: &[Wrench]) -> Result<(), RigidError> {
        check_step(dt, wrenches, &self.names)?;
        self.wrenches.copy_from_slice(wrenches);
        Ok(())
    }

    fn wait(&mut self, _time: f64) {}

    fn hold(&mut self, _index: usize, _is_held: bool) {}

    fn boxed_clone(&self) -> Box<dyn RigidEngine> {
        Box::new(self.clone())
    }

    fn as_any(&self) -> Option<&dyn Any> {
        Some(self)
    }

    fn as_any_mut(&mut self) -> Option<&mut dyn Any> {
        Some(self)
    }

    fn copy_from(&mut self, other: &dyn RigidEngine) -> bool {
        let Some(other) = other.as_any().and_then(|other| other.downcast_ref::<Self>()) else { return false };
        self.clone_from(other);
        true
    }

    fn save(&self, out: &mut Vec<u8>) -> Result<(), RigidError> {
        let saved = |body: &HostBody| {
            let BodyState { position, rotation, linear_velocity, angular_velocity } = body.state;
            let (inverse_mass, inverse_inertia) = (body.inverse_mass, body.inverse_inertia);
            let velocities = [linear_velocity, angular_velocity];
            Saved { position, rotation, velocities, inverse_mass, inverse_inertia }
        };
        append(&self.bodies.iter().map(saved).collect::<Vec<_>>(), out)
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<(), RigidError> {
        let saved: Vec<Saved> = read(bytes)?;
        if saved.len() != self.kinds.len() {
            let reason = format!("{} bodies, and there are {}", saved.len(), self.kinds.len());
            return Err(RigidError::Saved { reason });
        }
        let body = |saved: Saved| {
            let Saved { position, rotation, velocities, inverse_mass, inverse_inertia } = saved;
            let [linear_velocity, angular_velocity] = velocities;
            let state = BodyState { position, rotation, linear_velocity, angular_velocity };
            HostBody { state, inverse_mass, inverse_inertia }
        };
        let new = Self { bodies: saved.into_iter().map(body).collect(), ..self.clone() };
        new.check()?;
        *self = new;
        Ok(())
    }

    fn set_gravity(&mut self, _gravity: glam::Vec3) -> Result<(), RigidError> {
        // The host asks the world for it.
        Ok(())
    }
}
