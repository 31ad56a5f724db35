//! What an engine of a host must be right about.

use super::{BodyKind, BodySetup, BodyState, RigidEngine, RigidError};

/// How far the squared length of a rotation may be from one.
const UNIT_TOLERANCE: f32 = 1e-3;

fn fail(message: String) -> RigidError {
    RigidError::Engine { message }
}

/// Refuses an engine that is not one of these bodies.
pub(crate) fn check_engine(engine: &dyn RigidEngine, bodies: &[BodySetup]) -> Result<(), RigidError> {
    let (found, expected) = (engine.body_count(), bodies.len());
    if found != expected {
        return Err(fail(format!("it has {found} bodies, and the scene has {expected}")));
    }
    for (index, body) in bodies.iter().enumerate() {
        let (name, kind) = (&body.name, engine.kind(index));
        if kind != body.kind {
            let expected = body.kind;
            return Err(fail(format!("body `{name}` is {kind:?} in it, and {expected:?} in the scene")));
        }
        check_state(index, &engine.state(index))?;
        let (mass, inertia) = (engine.inverse_mass(index), engine.inverse_inertia(index));
        let is_dynamic = kind == BodyKind::Dynamic;
        if !(mass.is_finite() && if is_dynamic { mass > 0.0 } else { mass == 0.0 }) {
            let range = if is_dynamic { "finite and above 0" } else { "0" };
            return Err(fail(format!("body `{name}`: inverse mass = {mass} 1/kg is out of range: {range}")));
        }
        if !inertia.is_finite() {
            return Err(fail(format!("body `{name}`: inverse inertia = {inertia} is not finite")));
        }
    }
    Ok(())
}

/// Refuses a state that no body can have.
pub(crate) fn check_state(index: usize, state: &BodyState) -> Result<(), RigidError> {
    let BodyState { position, rotation, linear_velocity, angular_velocity } = state;
    let vectors = [
        ("position", position),
        ("linear velocity", linear_velocity),
        ("angular velocity", angular_velocity),
    ];
    if let Some((what, value)) = vectors.into_iter().find(|(_, value)| !value.is_finite()) {
        return Err(fail(format!("body number {index}: {what} = {value} is not finite")));
    }
    // A length that is not a number fails the comparison as well.
    let is_unit = (rotation.length_squared() - 1.0).abs() <= UNIT_TOLERANCE;
    if !is_unit {
        return Err(fail(format!("body number {index}: rotation = {rotation} is not of unit length")));
    }
    Ok(())
}
