//! Bodies and walls as rapier3d takes them.

use super::super::hull::check_hull;
use super::super::mass::principal_moments;
use super::super::{BodyKind, BodySetup, HullError, MassProperties, RigidError, Shape};
use glam::Vec3;
use rapier3d::parry::mass_properties::MassProperties as RapierMass;
use rapier3d::prelude::{FrictionModel, IntegrationParameters, Pose, Real, SharedShape, SpringCoefficients};

/// Speed limit that rapier3d would apply silently; a body that fast is reported as diverged instead.
const NO_SPEED_LIMIT: Real = Real::MAX;

/// Fastest push out of a penetration \[m/s\], rapier3d's default at the scale of a metre.
const PUSH_OUT: Real = 3.0;

/// Stiffness of contacts \[Hz\]: a resting body sags by g / (2 pi f)², here 17 µm (default: 276 µm).
const CONTACT_FREQUENCY: Real = 120.0;

/// Damping ratio of contacts, the default: a push out of a penetration never bounces.
const CONTACT_DAMPING: Real = 10.0;

pub(super) fn parameters(bodies: &[BodySetup]) -> IntegrationParameters {
    let dynamic = bodies.iter().filter(|body| body.kind == BodyKind::Dynamic);
    let thinnest = dynamic.map(|body| thickness(&body.shape)).fold(1.0, f32::min);
    let softness = SpringCoefficients::new(CONTACT_FREQUENCY, CONTACT_DAMPING);
    let length_unit = thinnest.max(1e-3);
    IntegrationParameters {
        length_unit,
        contact_softness: softness,
        static_contact_softness: softness,
        normalized_max_corrective_velocity: PUSH_OUT / length_unit,
        normalized_max_linear_velocity: NO_SPEED_LIMIT,
        contact_recycling: false,
        friction_model: FrictionModel::Coulomb,
        ..IntegrationParameters::default()
    }
}

/// Approximate smallest extent \[m\].
fn thickness(shape: &Shape) -> f32 {
    match shape {
        Shape::Plane => f32::INFINITY,
        Shape::Sphere { radius } | Shape::Capsule { radius, .. } => 2.0 * radius,
        Shape::Cuboid { half_extents } => 2.0 * half_extents.min_element(),
        Shape::Hull { planes, .. } => {
            planes.iter().map(|&(_, offset)| 2.0 * offset).fold(f32::INFINITY, f32::min)
        }
        Shape::Compound(compound) => {
            compound.parts.iter().map(|part| thickness(&part.hull)).fold(f32::INFINITY, f32::min)
        }
    }
}

pub(super) fn check_container((low, high): (Vec3, Vec3), bodies: &[BodySetup]) -> Result<(), RigidError> {
    let container = format!("{low} to {high}");
    // A bound that is not a number fails this comparison.
    if !low.cmplt(high).all() {
        return Err(RigidError::Container { value: container });
    }
    for body in bodies.iter().filter(|body| body.kind == BodyKind::Dynamic) {
        let position = body.state.position;
        if position.is_finite() && !(position.cmpge(low) & position.cmple(high)).all() {
            let (body, value) = (body.name.clone(), position.to_string());
            return Err(RigidError::OutsideContainer { body, value, container });
        }
    }
    Ok(())
}

pub(super) fn collision_shape(body: &BodySetup, shape: &Shape) -> Result<SharedShape, RigidError> {
    let shape = match shape {
        Shape::Plane => SharedShape::halfspace(Vec3::Y),
        Shape::Sphere { radius } => SharedShape::ball(*radius),
        Shape::Cuboid { half_extents } => SharedShape::cuboid(half_extents.x, half_extents.y, half_extents.z),
        Shape::Capsule { half_height, radius } => SharedShape::capsule_y(*half_height, *radius),
        Shape::Hull { planes, vertices, triangles } => {
            let refused = |source| RigidError::Hull { body: body.name.clone(), source };
            check_hull(planes, vertices, triangles).map_err(refused)?;
            SharedShape::convex_mesh(vertices.clone(), triangles)
                .ok_or(HullError::NotClosed)
                .map_err(refused)?
        }
        Shape::Compound(compound) => {
            let parts = compound
                .parts
                .iter()
                .map(|part| Ok((Pose::from_translation(part.centre), collision_shape(body, &part.hull)?)));
            SharedShape::compound(parts.collect::<Result<_, RigidError>>()?)
        }
    };
    Ok(shape)
}

/// Mass properties with the centre of mass exactly at the origin of the body's frame.
pub(super) fn rapier_mass(body: &BodySetup) -> Result<RapierMass, RigidError> {
    if body.kind != BodyKind::Dynamic {
        return Ok(RapierMass::default());
    }
    let Some(solid) = MassProperties::new(&body.shape, body.density) else {
        return Ok(RapierMass::default());
    };
    let (moments, frame) = principal_moments(solid.inertia);
    // rapier3d calculates in f32.
    let rounded = moments.extend(solid.mass).as_vec4();
    if !(rounded.is_finite() && rounded.recip().is_finite()) {
        let value = format!("{} kg, moments {moments} kg m²", solid.mass);
        return Err(body.bad_value("mass", value, "mass and inertia within the range of f32"));
    }
    let (mass, moments) = (rounded.w, rounded.truncate());
    Ok(RapierMass::with_principal_inertia_frame(Vec3::ZERO, mass, moments, frame.as_quat()))
}
