//! Questions of the page.

use serde::Deserialize;
use serde_json::{Value, json};
use sorb::{Hit, Ray, Surface, Targets, World, glam::Vec3};

use crate::page::Failure;

/// Length of a ray \[m\]: beyond every scene that fits on a page.
const LENGTH: f32 = 100.0;

/// A ray of the page.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Question {
    origin: [f32; 3],
    direction: [f32; 3],
    #[serde(default)]
    water: bool,
}

/// What a ray meets first.
pub(crate) fn cast(world: &World, input: &[u8]) -> Result<Vec<u8>, Failure> {
    let question: Question = serde_json::from_slice(input).map_err(|error| format!("ray: {error}"))?;
    let [origin, direction] = [question.origin, question.direction].map(Vec3::from_array);
    let targets = if question.water { Targets::ALL } else { Targets::SOLID };
    let hits = world.cast_rays(&[Ray { origin, direction, length: LENGTH }], targets)?;
    let told = hits.first().copied().flatten().map_or(Value::Null, |hit| told(world, &hit));
    Ok(serde_json::to_vec(&told)?)
}

fn told(world: &World, hit: &Hit) -> Value {
    let (kind, number) = match hit.surface {
        Surface::Body(number) => ("body", number),
        Surface::Sponge(number) => ("sponge", number),
        _ => ("water", 0),
    };
    let body = (kind == "body").then(|| world.body_handles().find(|body| body.index() == number)).flatten();
    json!({
        "kind": kind,
        "number": number,
        "handle": body,
        "distance": hit.distance,
        "point": hit.point.to_array(),
        "normal": hit.normal.to_array(),
    })
}
