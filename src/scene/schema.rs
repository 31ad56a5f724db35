//! The JSON schema: generated from the types, completed from the table of ranges.

use std::sync::LazyLock;

use serde_json::{Map, Value};

use super::{Limit, Scene, VERSION, limits};

/// Keys that a file must contain although the type has a default for them.
const REQUIRED: &[(&str, &[&str])] = &[
    ("", &["version"]),
    ("fluid.blocks[]", &["minimum", "maximum"]),
    ("sponges[]", &["name"]),
    ("bodies[]", &["name", "shape"]),
];

/// The schema as a value. Files are checked against it before they become a [`Scene`].
pub(super) static SCHEMA: LazyLock<Value> = LazyLock::new(build);

/// JSON schema of scene files, indented, with a line feed at the end.
///
/// Each number has its `minimum`, `maximum` and, as `x-unit`, its SI unit. It holds for TOML files as well. Editors use it
/// to complete and check both.
#[must_use]
pub fn schema() -> String {
    format!("{:#}\n", *SCHEMA)
}

fn build() -> Value {
    let mut schema = schemars::schema_for!(Scene).to_value();
    for (table, keys) in REQUIRED {
        for pointer in tables(&schema, &places(&schema, table)) {
            if let Some(Value::Object(node)) = schema.pointer_mut(&pointer) {
                node.insert("required".to_owned(), keys.iter().copied().map(Value::from).collect());
            }
        }
    }
    for limit in limits() {
        for pointer in places(&schema, limit.key) {
            if let Some(node) = schema.pointer_mut(&pointer) {
                bound(node, limit);
            }
        }
    }
    if let Some(Value::Object(version)) = schema.pointer_mut("/properties/version") {
        version.insert("minimum".to_owned(), VERSION.into());
        version.insert("maximum".to_owned(), VERSION.into());
    }
    tidy(&mut schema);
    schema
}

/// Follows references and alternatives from a node to all table nodes that it can stand for, as JSON pointers.
fn tables(schema: &Value, pointers: &[String]) -> Vec<String> {
    let mut found = Vec::new();
    for pointer in pointers {
        let Some(node) = schema.pointer(pointer) else {
            continue;
        };
        if let Some(reference) = node.get("$ref").and_then(Value::as_str) {
            found.extend(tables(schema, &[reference.trim_start_matches('#').to_owned()]));
        }
        for alternatives in ["anyOf", "oneOf"] {
            let count = node.get(alternatives).and_then(Value::as_array).map_or(0, Vec::len);
            let inner: Vec<String> = (0..count).map(|i| format!("{pointer}/{alternatives}/{i}")).collect();
            found.extend(tables(schema, &inner));
        }
        if node.get("properties").is_some() {
            found.push(pointer.clone());
        }
    }
    found
}

/// JSON pointers of the nodes that describe a key with `[]` for "every element".
fn places(schema: &Value, key: &str) -> Vec<String> {
    let mut pointers = vec![String::new()];
    for part in key.split('.').filter(|part| !part.is_empty()) {
        let name = part.trim_end_matches("[]");
        let items = if part.ends_with("[]") { "/items" } else { "" };
        pointers = tables(schema, &pointers)
            .into_iter()
            .map(|table| format!("{table}/properties/{name}{items}"))
            .filter(|pointer| schema.pointer(pointer).is_some())
            .collect();
    }
    pointers
}

/// Writes a range into a number, or into the numbers of a vector.
fn bound(node: &mut Value, limit: &Limit) {
    if let Some(items) = node.get_mut("items") {
        bound(items, limit);
        return;
    }
    let whole = node.get("type").is_some_and(|kind| kind == "integer");
    let Value::Object(node) = node else { return };
    for (key, value) in [("minimum", limit.minimum), ("maximum", limit.maximum)] {
        node.insert(key.to_owned(), decimal(value, whole));
    }
    node.insert("x-unit".to_owned(), limit.unit.into());
}

/// The number that the decimal digits of an f32 represent, not the f64 next to its binary value.
fn decimal(value: f32, whole: bool) -> Value {
    let text = value.to_string();
    if whole && let Ok(integer) = text.parse::<i64>() {
        return integer.into();
    }
    text.parse::<f64>().map_or(Value::Null, Value::from)
}

/// Gives decimals their short form and removes what only Rust uses.
fn tidy(node: &mut Value) {
    match node {
        Value::Object(map) => tidy_table(map),
        Value::Array(items) => items.iter_mut().for_each(tidy),
        Value::Number(number) if number.is_f64() => {
            #[expect(clippy::cast_possible_truncation, reason = "every number of a scene is an f32")]
            let single = number.as_f64().unwrap_or(0.0) as f32;
            *node = decimal(single, false);
        }
        _ => {}
    }
}

fn tidy_table(map: &mut Map<String, Value>) {
    let rust_format = |format: &Value| ["float", "uint32"].iter().any(|name| format == name);
    if map.get("format").is_some_and(rust_format) {
        map.remove("format");
    }
    map.values_mut().for_each(tidy);
}
