//! Signed distances of shapes in f64.

use glam::{DMat3, DQuat, DVec3};

use crate::body::{Body, Shape};

/// Rotation from the body's frame to the world.
pub(super) fn rotation(body: &Body) -> DMat3 {
    DMat3::from_quat(DQuat::from_array(body.state.rotation.to_array().map(f64::from)))
}

/// Velocity of the body's material at a world point.
pub(super) fn velocity(body: &Body, point: DVec3) -> DVec3 {
    let arm = point - body.state.position.as_dvec3();
    body.state.linear_velocity.as_dvec3() + body.state.angular_velocity.as_dvec3().cross(arm)
}

/// Signed distance from the surface and outward normal at a world point.
pub(super) fn distance(body: &Body, point: DVec3) -> (f64, DVec3) {
    let rotation = rotation(body);
    let (distance, normal) =
        local(&body.shape, rotation.transpose() * (point - body.state.position.as_dvec3()));
    (distance, rotation * normal)
}

pub(super) fn local(shape: &Shape, point: DVec3) -> (f64, DVec3) {
    match shape {
        Shape::Plane => (point.y, DVec3::Y),
        Shape::Sphere { radius } => ball(point, f64::from(*radius)),
        Shape::Capsule { half_height, radius } => {
            let half = f64::from(*half_height);
            ball(point - DVec3::Y * point.y.clamp(-half, half), f64::from(*radius))
        }
        Shape::Cuboid { half_extents } => cuboid(point, half_extents.as_dvec3()),
        Shape::Compound(compound) => {
            let parts = compound.parts.iter().map(|part| local(&part.hull, point - part.centre.as_dvec3()));
            parts.fold((f64::MAX, DVec3::Y), |best, part| if part.0 < best.0 { part } else { best })
        }
        Shape::Hull { planes, .. } => {
            let faces = planes.iter().map(|(normal, offset)| {
                let normal = normal.as_dvec3();
                (normal.dot(point) - f64::from(*offset), normal)
            });
            faces.fold((f64::MIN, DVec3::Y), |best, face| if face.0 > best.0 { face } else { best })
        }
    }
}

fn ball(arm: DVec3, radius: f64) -> (f64, DVec3) {
    let length = arm.length();
    let normal = if length > 1.0e-12 { arm / length } else { DVec3::Y };
    (length - radius, normal)
}

fn cuboid(point: DVec3, half_extents: DVec3) -> (f64, DVec3) {
    let nearest = point.clamp(-half_extents, half_extents);
    if nearest != point {
        let away = point - nearest;
        return (away.length(), away.normalize());
    }
    let mut best = (f64::MIN, DVec3::Y);
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        let place = point.dot(axis);
        let depth = place.abs() - half_extents.dot(axis);
        if depth > best.0 {
            best = (depth, if place < 0.0 { -axis } else { axis });
        }
    }
    best
}
