//! The rules for rigid bodies.

use glam::{DVec3, Vec3};

use super::error::Problem;
use super::number::{number_text, vector_text};
use super::validate::inside;
use super::{Body, BodyKind, Scene, ShapeKind};

/// Adds the problems of a body whose numbers are in their ranges.
pub(super) fn body_rules(body: &Body, table: &str, scene: &Scene, problems: &mut Vec<Problem>) {
    let mut broken = |field: &str, value: String, rule: &str| {
        problems.push(Problem::rule(format!("{table}.{field}"), value, rule));
    };
    let dynamic = body.kind == BodyKind::Dynamic;
    if dynamic && body.shape == ShapeKind::Plane {
        broken(
            "shape.kind",
            "\"plane\"".to_owned(),
            "a plane has no mass: its `kind` must be fixed or kinematic",
        );
    }
    if dynamic && body.grip {
        broken("grip", "true".to_owned(), "only a fixed or kinematic body can hold a sponge");
    }
    if body.grip && scene.sponges.is_empty() {
        broken("grip", "true".to_owned(), "the scene has no sponge to hold");
    }
    if body.kind != BodyKind::Kinematic && !body.motions.is_empty() {
        let count = format!("({} motions)", body.motions.len());
        broken("motions", count, "only a body of `kind` kinematic follows motions");
    }
    for (field, velocity) in
        [("linear_velocity", body.linear_velocity), ("angular_velocity", body.angular_velocity)]
    {
        if !dynamic && velocity != Vec3::ZERO {
            let rule = "only a dynamic body starts with a velocity; use `motions` for a kinematic one";
            broken(field, vector_text(velocity), rule);
        }
    }
    if body.rotation.axis.length_squared() < 1e-12 {
        broken("rotation.axis", vector_text(body.rotation.axis), "must not be zero");
    }
    if let ShapeKind::Hull { vertices } = &body.shape {
        if vertices.len() < 4 {
            broken("shape.vertices", format!("({} points)", vertices.len()), "a hull has at least 4 points");
        } else if flat(vertices) {
            broken("shape.vertices", format!("({} points)", vertices.len()), "all points lie in one plane");
        }
    }
    if let ShapeKind::Cup { height, thickness, .. } = body.shape
        && height <= thickness
    {
        let rule = format!("must be above `shape.thickness` = {}", number_text(thickness));
        broken("shape.height", number_text(height), &rule);
    }
    for (index, motion) in body.motions.iter().enumerate() {
        motion.rules(&format!("{table}.motions[{index}]"), problems);
    }
    if let ShapeKind::Mesh { mesh, .. } = &body.shape {
        mesh.rules(&format!("{table}.shape.mesh"), problems);
    }
    if dynamic {
        inside(&format!("{table}.position"), body.position, body.position, 0.0, scene, problems);
    }
}

/// Whether points span almost no volume: less than a millionth of the cube of their extent.
fn flat(points: &[Vec3]) -> bool {
    let origin = points[0].as_dvec3();
    let arms = || points.iter().map(|point| point.as_dvec3() - origin);
    // The farthest point, the point farthest from that line, the point farthest from that plane.
    let farthest = |size: &dyn Fn(DVec3) -> f64| {
        arms().fold(DVec3::ZERO, |best, arm| if size(arm) > size(best) { arm } else { best })
    };
    let first = farthest(&|arm| arm.length_squared());
    let second = farthest(&|arm| first.cross(arm).length_squared());
    let normal = first.cross(second);
    let third = farthest(&|arm| normal.dot(arm).abs());
    normal.dot(third).abs() <= 1e-6 * first.length().powi(3)
}
