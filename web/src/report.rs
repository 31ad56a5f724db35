//! What a world tells the page, as JSON.

use serde_json::{Value, json};
use sorb::{SpongeHandle, World, rigid::Shape, scene::Domain};

use crate::page::{Failure, Page};

/// What does not change from step to step.
pub(crate) fn describe(world: &World) -> Result<Vec<u8>, Failure> {
    let scene = world.scene();
    let camera = scene.viewpoint();
    let materials = (0..scene.sponges.len() as u32).map(|index| world.material(SpongeHandle::from(index)));
    let bodies = world.bodies().iter().zip(&scene.bodies).map(|(body, own)| {
        json!({
            "name": own.name,
            "kind": format!("{:?}", body.kind).to_lowercase(),
            "shape": shape(&body.shape),
            "look": own.look,
            "colour": own.colour.map(|colour| colour.to_array()),
            "removed": own.is_removed(),
        })
    });
    let container = match scene.domain {
        Domain::Box { minimum, maximum, .. } => json!([minimum.to_array(), maximum.to_array()]),
        Domain::Open => Value::Null,
    };
    Ok(serde_json::to_vec(&json!({
        "name": scene.name,
        "title": scene.title,
        "duration": scene.time.duration,
        "frame_rate": scene.time.frame_rate,
        "spacing": scene.fluid.as_ref().map(|fluid| fluid.spacing),
        "container": container,
        "camera": {
            "eye": camera.eye.to_array(),
            "target": camera.target.to_array(),
            "field_of_view_degrees": camera.field_of_view_degrees,
        },
        "bodies": bodies.collect::<Vec<_>>(),
        "materials": materials.collect::<Vec<_>>(),
        "viscosity": scene.fluid.as_ref().map(|fluid| fluid.viscosity),
        "gravity": world.gravity().to_array(),
        "nodes": world.node_positions().len(),
        "simd": world.cpu().simd().name(),
    }))?)
}

fn shape(shape: &Shape) -> Value {
    match shape {
        Shape::Plane => json!({ "kind": "plane" }),
        Shape::Sphere { radius } => json!({ "kind": "sphere", "radius": radius }),
        Shape::Cuboid { half_extents } => {
            json!({ "kind": "cuboid", "half_extents": half_extents.to_array() })
        }
        Shape::Capsule { half_height, radius } => {
            json!({ "kind": "capsule", "half_height": half_height, "radius": radius })
        }
        Shape::Hull { vertices, triangles, .. } => mesh(vertices, triangles),
        Shape::Compound(compound) => mesh(&compound.vertices, &compound.triangles),
    }
}

fn mesh(vertices: &[sorb::glam::Vec3], triangles: &[[u32; 3]]) -> Value {
    let vertices: Vec<[f32; 3]> = vertices.iter().map(|vertex| vertex.to_array()).collect();
    json!({ "kind": "mesh", "vertices": vertices, "triangles": triangles })
}

/// The clock, the counts and the digest.
pub(crate) fn status(page: &Page) -> Result<Vec<u8>, Failure> {
    let world = page.world()?;
    let (clock, ledger) = (world.clock(), world.ledger());
    let (is_recorded, playing) = page.recording();
    Ok(serde_json::to_vec(&json!({
        "time": clock.time,
        "steps": clock.steps,
        "frames": clock.frames,
        "particles": ledger.present,
        "absorbed": ledger.absorbed,
        "particle_mass": ledger.particle_mass,
        "bodies": world.bodies().len(),
        "next_body": world.next_body(),
        "next_flow": world.next_flow(),
        "gravity": world.gravity().to_array(),
        "recorded": is_recorded,
        "playing": playing,
        "digest": format!("{:016x}", world.digest()),
    }))?)
}
