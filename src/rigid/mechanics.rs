use super::{BodyState, RigidEngine};
use glam::{DMat3, DVec3, Vec3};

/// Momenta and energies of one body, in `f64` for balances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mechanics {
    /// Linear momentum \[kg m/s\].
    pub linear_momentum: DVec3,
    /// Angular momentum about the origin of the world \[kg m²/s\].
    pub angular_momentum: DVec3,
    /// Kinetic energy of translation and rotation \[J\].
    pub kinetic_energy: f64,
    /// Potential energy in the gravity, zero at the origin of the world \[J\].
    pub potential_energy: f64,
}

impl Mechanics {
    /// From mass \[kg\], inertia about the centre of mass in the world's frame \[kg m²\], state and gravity
    /// \[m/s²\].
    #[must_use]
    pub fn new(mass: f64, world_inertia: DMat3, state: &BodyState, gravity: Vec3) -> Self {
        let position = state.position.as_dvec3();
        let velocity = state.linear_velocity.as_dvec3();
        let spin = state.angular_velocity.as_dvec3();
        let linear_momentum = velocity * mass;
        let own_momentum = world_inertia * spin;
        Self {
            linear_momentum,
            angular_momentum: position.cross(linear_momentum) + own_momentum,
            kinetic_energy: 0.5 * (linear_momentum.dot(velocity) + own_momentum.dot(spin)),
            potential_energy: -mass * gravity.as_dvec3().dot(position),
        }
    }

    /// Mechanics of body number `index` of an engine; `None` if its mass is infinite (fixed and kinematic bodies).
    ///
    /// May panic like [`RigidEngine::state`] if there is no such body.
    #[must_use]
    pub fn of(engine: &dyn RigidEngine, index: usize, gravity: Vec3) -> Option<Self> {
        let inverse_mass = f64::from(engine.inverse_mass(index));
        if inverse_mass <= 0.0 {
            return None;
        }
        let inertia = engine.inverse_inertia(index).as_dmat3().try_inverse().unwrap_or(DMat3::ZERO);
        Some(Self::new(1.0 / inverse_mass, inertia, &engine.state(index), gravity))
    }
}
