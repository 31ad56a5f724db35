//! The numbers of a scene as sliders, with the units, ranges, defaults and descriptions of its schema.

use std::sync::LazyLock;

use serde_json::Value as Json;
use sorb::{
    SpongeHandle, World,
    scene::{self, Limit, Material, limits},
};

/// Keys without sliders: what only pictures read, lists of times, and counts of cells, which go with the place of a sponge.
const LEFT_OUT: [&str; 6] = ["camera.", "motions[]", "gravity_path", ".rotation", ".mesh.", ".cells"];

static SCHEMA: LazyLock<Json> = LazyLock::new(|| serde_json::from_str(&scene::schema()).unwrap_or_default());

/// A number, or three.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Real(f32),
    /// A number without a fraction.
    Whole(u32),
    /// Three numbers.
    Vector([f32; 3]),
}

impl Value {
    fn new(value: &Json, whole: bool) -> Option<Self> {
        match value {
            Json::Number(_) if whole => Some(Self::Whole(u32::try_from(value.as_u64()?).ok()?)),
            Json::Number(number) => Some(Self::Real(number.as_f64()? as f32)),
            Json::Array(all) => {
                let all: Vec<f32> = all.iter().filter_map(|own| own.as_f64().map(|own| own as f32)).collect();
                Some(Self::Vector(<[f32; 3]>::try_from(all).ok()?))
            }
            _ => None,
        }
    }

    /// As a scene file has it.
    #[must_use]
    pub fn text(&self) -> String {
        match self {
            Self::Real(value) => format!("{value:?}"),
            Self::Whole(value) => value.to_string(),
            Self::Vector(value) => format!("{value:?}"),
        }
    }

    /// As JSON.
    #[must_use]
    pub fn json(&self) -> Json {
        match self {
            Self::Real(value) => Json::from(f64::from(*value)),
            Self::Whole(value) => Json::from(*value),
            Self::Vector(value) => value.iter().map(|own| Json::from(f64::from(*own))).collect(),
        }
    }
}

impl Value {
    /// A material with this value of a field; none for a field that it does not have.
    #[must_use]
    pub fn in_material(&self, material: &Material, field: &str) -> Option<Material> {
        let mut table = serde_json::to_value(material).ok()?;
        *table.get_mut(field)? = self.json();
        serde_json::from_value(table).ok()
    }
}

/// A number of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its key, as in [`Scene::set`](scene::Scene::set).
    pub key: String,
    /// What it belongs to: `time`, `fluid`, the name of a sponge or a body.
    pub group: String,
    /// Last part of the key.
    pub field: &'static str,
    /// Range and unit.
    pub limit: &'static Limit,
    /// Its value.
    pub value: Value,
    /// That of a scene which does not have it.
    pub default: Option<Value>,
    /// What it is.
    pub text: String,
    /// The sponge whose material it belongs to: such parameters, and gravity, act at once.
    pub sponge: Option<SpongeHandle>,
}

impl Parameter {
    /// Whether a change acts at once; others act at the next reset.
    #[must_use]
    pub fn acts_at_once(&self) -> bool {
        self.sponge.is_some() || self.key == "gravity"
    }
}

/// The numbers of the scene of a world, in the order of the documentation.
#[must_use]
pub fn parameters(world: &World) -> Vec<Parameter> {
    let Ok(scene) = serde_json::to_value(world.scene()) else { return Vec::new() };
    let mut all = Vec::new();
    for limit in limits().filter(|limit| !LEFT_OUT.iter().any(|own| limit.key.contains(own))) {
        let Some(described) = described(limit.key) else { continue };
        let whole = described.get("type").is_some_and(|kind| kind == "integer");
        let text = described.get("description").and_then(Json::as_str).unwrap_or_default();
        for (key, group, value) in places(&scene, limit.key) {
            let Some(value) = Value::new(value, whole) else { continue };
            let sponge = sponge_of(world, &key, limit.field());
            let default = described.get("default").and_then(|value| Value::new(value, whole));
            let text = text.split("\n\n").next().unwrap_or_default().replace('\n', " ");
            all.push(Parameter { key, group, field: limit.field(), limit, value, default, text, sponge });
        }
    }
    all
}

/// The sponge whose material has a key.
fn sponge_of(world: &World, key: &str, field: &str) -> Option<SpongeHandle> {
    let index: u32 = key.strip_prefix("sponges[")?.split(']').next()?.parse().ok()?;
    let handle = SpongeHandle::from(index);
    let material = serde_json::to_value(world.material(handle)?).ok()?;
    let is_own = material.get(field).is_some() && key.matches('.').count() == 1;
    is_own.then_some(handle)
}

/// Values of a key with `[]` for "every element", with their keys and what they belong to.
fn places<'a>(scene: &'a Json, key: &str) -> Vec<(String, String, &'a Json)> {
    let mut found = vec![(String::new(), "scene".to_owned(), scene)];
    for part in key.split('.') {
        let name = part.trim_end_matches("[]");
        let mut next = Vec::new();
        for (key, group, table) in found {
            let Some(value) = table.get(name) else { continue };
            let key = if key.is_empty() { name.to_owned() } else { format!("{key}.{name}") };
            let group =
                if group == "scene" && !key.contains('.') && value.is_object() { key.clone() } else { group };
            if !part.ends_with("[]") {
                next.push((key, group, value));
                continue;
            }
            for (index, element) in value.as_array().into_iter().flatten().enumerate() {
                let key = format!("{key}[{index}]");
                let own =
                    element.get("name").and_then(Json::as_str).map_or_else(|| key.clone(), str::to_owned);
                next.push((key, own, element));
            }
        }
        found = next;
    }
    found
}

/// What the schema says of a key.
fn described(key: &str) -> Option<&'static Json> {
    let mut nodes = vec![&*SCHEMA];
    for part in key.split('.') {
        let name = part.trim_end_matches("[]");
        let mut next = Vec::new();
        for table in nodes.into_iter().flat_map(tables) {
            let Some(node) = table.get("properties").and_then(|all| all.get(name)) else { continue };
            next.extend(if part.ends_with("[]") { node.get("items") } else { Some(node) });
        }
        nodes = next;
    }
    nodes.into_iter().next()
}

/// A node, and all that it stands for by references and alternatives.
fn tables(node: &'static Json) -> Vec<&'static Json> {
    let mut found = vec![node];
    if let Some(reference) = node.get("$ref").and_then(Json::as_str) {
        found.extend(SCHEMA.pointer(reference.trim_start_matches('#')).into_iter().flat_map(tables));
    }
    for alternatives in ["anyOf", "oneOf"] {
        let all = node.get(alternatives).and_then(Json::as_array);
        found.extend(all.into_iter().flatten().flat_map(tables));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use sorb::scene::preset;

    fn of(name: &str) -> Vec<Parameter> {
        let scene = preset(name).unwrap_or_else(|error| panic!("{error}"));
        let world = World::new(&scene).unwrap_or_else(|error| panic!("{error}"));
        parameters(&world)
    }

    #[test]
    fn sliders_have_what_the_schema_says() {
        let all = of("ball_drop");
        let find = |key: &str| all.iter().find(|own| own.key == key).unwrap_or_else(|| panic!("{key}"));
        let permeability = find("sponges[0].permeability");
        assert_eq!((permeability.value, permeability.limit.unit), (Value::Real(5e-9), "m^2"));
        assert!(permeability.acts_at_once() && permeability.group == "sponge");
        assert!(permeability.default.is_some() && permeability.text.contains("m^2"), "{permeability:?}");
        let gravity = find("gravity");
        assert!(matches!(gravity.value, Value::Vector(_)) && gravity.acts_at_once());
        // What makes the lattice, and what belongs to the water, acts at the next reset.
        for key in ["sponges[0].edge", "fluid.viscosity", "time.frame_rate", "bodies[0].shape.radius"] {
            assert!(!find(key).acts_at_once(), "{key}");
        }
        assert!(matches!(find("sponges[0].iterations").value, Value::Whole(_)));
        assert!(all.iter().all(|own| !own.text.is_empty()), "{all:?}");
        assert!(of("empty").iter().all(|own| own.sponge.is_none()));
    }

    #[test]
    fn what_a_slider_says_is_a_change_of_the_scene() {
        for scene in scene::presets() {
            let own = preset(scene.name).unwrap_or_else(|error| panic!("{error}"));
            let texts: Vec<String> =
                of(scene.name).iter().map(|own| format!("{}={}", own.key, own.value.text())).collect();
            let changed = own.with_overrides(texts.iter().map(String::as_str));
            let changed = changed.unwrap_or_else(|error| panic!("{}: {error}", scene.name));
            assert_eq!(changed, own, "{}", scene.name);
        }
    }
}
