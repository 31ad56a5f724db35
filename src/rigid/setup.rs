use super::{BodyKind, BodyState, Motion, RigidError, Shape, Wrench};
use glam::Vec3;
use std::fmt;

const FINITE: &str = "finite numbers";
const ABOVE_ZERO: &str = "finite and above 0";
const NOT_BELOW_ZERO: &str = "finite and at least 0";

/// How far the squared length of a quaternion may be from one.
const UNIT_TOLERANCE: f32 = 1e-3;

/// Initial description of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct BodySetup {
    /// Name, used in errors.
    pub name: String,
    /// Geometry, with the centre of mass at the origin of the body's frame.
    pub shape: Shape,
    /// What moves it.
    pub kind: BodyKind,
    /// Density \[kg/m³\]; above 0 for dynamic bodies, without effect for the others.
    pub density: f32,
    /// Pose and velocity at time zero. Only dynamic bodies may have a velocity here: a kinematic body takes
    /// it from its motions.
    pub state: BodyState,
    /// Coefficient of friction, at least 0. A contact of two bodies takes the mean, and a contact with a wall of the
    /// container that of the body alone.
    pub friction: f32,
    /// Coefficient of restitution, 0 to 1, combined in the same way.
    pub restitution: f32,
    /// Motions of a kinematic body; empty for the others. Each motion acts on the result of those before it in the list.
    pub motions: Vec<Motion>,
}

impl BodySetup {
    pub(super) fn bad_value(
        &self,
        key: impl Into<String>,
        value: impl fmt::Display,
        range: &'static str,
    ) -> RigidError {
        RigidError::Value { body: self.name.clone(), key: key.into(), value: value.to_string(), range }
    }

    fn bad_kind(&self, key: &'static str, reason: &'static str) -> RigidError {
        RigidError::Kind { body: self.name.clone(), key, kind: self.kind, reason }
    }

    fn number(
        &self,
        key: impl Into<String>,
        value: f32,
        good: bool,
        range: &'static str,
    ) -> Result<(), RigidError> {
        if good { Ok(()) } else { Err(self.bad_value(key, value, range)) }
    }

    fn finite(&self, key: impl Into<String>, value: Vec3) -> Result<(), RigidError> {
        if value.is_finite() { Ok(()) } else { Err(self.bad_value(key, value, FINITE)) }
    }
}

/// Checks a body and returns its state with a rotation of unit length.
pub(super) fn checked_state(body: &BodySetup) -> Result<BodyState, RigidError> {
    let dynamic = body.kind == BodyKind::Dynamic;
    check_shape(body, &body.shape)?;
    let density = body.density;
    body.number("density", density, density.is_finite() && density >= 0.0, NOT_BELOW_ZERO)?;
    body.number("density", density, !dynamic || density > 0.0, ABOVE_ZERO)?;
    let friction = body.friction;
    body.number("friction", friction, friction.is_finite() && friction >= 0.0, NOT_BELOW_ZERO)?;
    body.number("restitution", body.restitution, (0.0..=1.0).contains(&body.restitution), "0 to 1")?;
    let state = body.state;
    body.finite("position", state.position)?;
    body.finite("linear_velocity", state.linear_velocity)?;
    body.finite("angular_velocity", state.angular_velocity)?;
    // A length that is not a number fails the comparison as well.
    let unit = (state.rotation.length_squared() - 1.0).abs() <= UNIT_TOLERANCE;
    if !unit {
        return Err(body.bad_value("rotation", state.rotation, "a quaternion of unit length"));
    }
    if !dynamic && state.linear_velocity != Vec3::ZERO {
        return Err(body.bad_kind("linear_velocity", "only a dynamic body starts with a velocity"));
    }
    if !dynamic && state.angular_velocity != Vec3::ZERO {
        return Err(body.bad_kind("angular_velocity", "only a dynamic body starts with a velocity"));
    }
    if body.kind != BodyKind::Kinematic && !body.motions.is_empty() {
        return Err(body.bad_kind("motions", "only a kinematic body has motions"));
    }
    for (index, motion) in body.motions.iter().enumerate() {
        check_motion(body, index, motion)?;
    }
    Ok(BodyState { rotation: state.rotation.as_dquat().normalize().as_quat(), ..state })
}

fn check_shape(body: &BodySetup, shape: &Shape) -> Result<(), RigidError> {
    let length =
        |key: &str, value: f32| body.number(key, value, value.is_finite() && value > 0.0, ABOVE_ZERO);
    match shape {
        Shape::Plane if body.kind == BodyKind::Dynamic => {
            Err(body.bad_kind("shape", "a plane has no finite mass"))
        }
        Shape::Plane => Ok(()),
        Shape::Sphere { radius } => length("shape.radius", *radius),
        Shape::Cuboid { half_extents } => {
            length("shape.half_extents.x", half_extents.x)?;
            length("shape.half_extents.y", half_extents.y)?;
            length("shape.half_extents.z", half_extents.z)
        }
        Shape::Capsule { half_height, radius } => {
            length("shape.half_height", *half_height)?;
            length("shape.radius", *radius)
        }
        Shape::Compound(compound) => {
            body.number(
                "shape.parts",
                compound.parts.len() as f32,
                !compound.parts.is_empty(),
                "at least 1",
            )?;
            compound.parts.iter().try_for_each(|part| {
                body.finite("shape.parts.centre", part.centre)?;
                check_shape(body, &part.hull)
            })
        }
        Shape::Hull { planes, vertices, triangles } => {
            for (index, vertex) in vertices.iter().enumerate() {
                body.finite(format!("shape.vertices[{index}]"), *vertex)?;
            }
            for (index, (normal, offset)) in planes.iter().enumerate() {
                let good = (normal.length_squared() - 1.0).abs() <= UNIT_TOLERANCE && offset.is_finite();
                if !good {
                    let key = format!("shape.planes[{index}]");
                    let value = format!("({normal}, {offset})");
                    return Err(body.bad_value(key, value, "a unit normal and a finite offset"));
                }
            }
            let corners = vertices.len();
            for (index, triangle) in triangles.iter().enumerate() {
                if triangle.iter().any(|&corner| corner as usize >= corners) {
                    let key = format!("shape.triangles[{index}]");
                    let value = format!("{triangle:?}");
                    return Err(body.bad_value(key, value, "numbers of existing vertices"));
                }
            }
            Ok(())
        }
    }
}

fn check_motion(body: &BodySetup, index: usize, motion: &Motion) -> Result<(), RigidError> {
    let key = |name: &str| format!("motions[{index}].{name}");
    match *motion {
        Motion::Linear { velocity, .. } => body.finite(key("velocity"), velocity)?,
        Motion::Shake { amplitude, frequency, .. } => {
            body.finite(key("amplitude"), amplitude)?;
            body.number(key("frequency"), frequency, frequency.is_finite() && frequency > 0.0, ABOVE_ZERO)?;
        }
        Motion::Turn { axis, pivot, rate, .. } => {
            body.finite(key("axis"), axis)?;
            if axis == Vec3::ZERO {
                return Err(body.bad_value(key("axis"), axis, "any length but zero"));
            }
            body.finite(key("pivot"), pivot)?;
            body.number(key("rate"), rate, rate.is_finite(), FINITE)?;
        }
    }
    let ((start, end), ease) = (motion.interval(), motion.ease());
    body.number(key("start"), start, start.is_finite() && start >= 0.0, NOT_BELOW_ZERO)?;
    // An infinite end is allowed: the motion never stops.
    body.number(key("end"), end, end >= start, "at least `start`")?;
    let fits = ease.is_finite() && ease >= 0.0 && 2.0 * ease <= end - start;
    body.number(key("ease"), ease, fits || ease == 0.0, "0 to half of the motion")
}

/// Checks the arguments of a step, before anything moves.
pub(super) fn check_step(dt: f32, wrenches: &[Wrench], names: &[String]) -> Result<(), RigidError> {
    if !(dt.is_finite() && dt > 0.0) {
        return Err(RigidError::TimeStep { dt });
    }
    if wrenches.len() != names.len() {
        return Err(RigidError::WrenchCount { expected: names.len(), found: wrenches.len() });
    }
    for (index, (wrench, name)) in wrenches.iter().zip(names).enumerate() {
        let parts = [("impulse", wrench.impulse), ("angular_impulse", wrench.angular_impulse)];
        for (quantity, value) in parts {
            // The engines calculate in f32, where a finite f64 may overflow.
            if !value.as_vec3().is_finite() {
                let value = value.to_string();
                return Err(RigidError::Wrench { body: name.clone(), index, quantity, value });
            }
        }
    }
    Ok(())
}
