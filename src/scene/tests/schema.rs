use std::fs;
use std::path::Path;

use serde_json::Value;

use super::super::number::{number_text, with_unit};
use super::super::schema::SCHEMA;
use super::super::*;

/// Calls `each` with every description and node of the schema's properties.
fn properties(node: &'static Value, each: &mut dyn FnMut(&str, &'static Value)) {
    if let Some(members) = node.get("properties").and_then(Value::as_object) {
        for (name, property) in members {
            each(name, property);
        }
    }
    match node {
        Value::Object(map) => map.values().for_each(|inner| properties(inner, each)),
        Value::Array(items) => items.iter().for_each(|inner| properties(inner, each)),
        _ => {}
    }
}

/// The number inside vectors.
fn innermost(mut node: &'static Value) -> &'static Value {
    while let Some(items) = node.get("items") {
        node = items;
    }
    node
}

#[expect(clippy::cast_possible_truncation, reason = "every number of a scene is an f32")]
fn single(number: &Value) -> f32 {
    number.as_f64().expect("a number") as f32
}

fn is_number(node: &Value) -> bool {
    let numeric = |kind: &Value| kind == "number" || kind == "integer";
    node.get("type")
        .is_some_and(|kind| numeric(kind) || kind.as_array().is_some_and(|all| all.iter().any(numeric)))
}

#[test]
fn every_number_has_its_range_and_every_range_its_number() {
    let mut numbers = 0;
    properties(&SCHEMA, &mut |name, property| {
        let node = innermost(property);
        if is_number(node) && name != "version" {
            numbers += 1;
            assert!(node.get("minimum").is_some() && node.get("maximum").is_some(), "{name}: {node}");
            let minimum = single(&node["minimum"]);
            let maximum = single(&node["maximum"]);
            let listed = |limit: &Limit| {
                limit.field() == name
                    && (limit.minimum, limit.maximum) == (minimum, maximum)
                    && node["x-unit"] == limit.unit
            };
            assert!(limits().any(listed), "{name} has a range that is not in the table");
        }
    });
    // `radius`, `start`, `end` and `ease` are each in three variants.
    assert_eq!(numbers, limits().count() + 8);
}

#[test]
fn the_docs_state_the_range_of_the_table() {
    properties(&SCHEMA, &mut |name, property| {
        let node = innermost(property);
        if is_number(node) && name != "version" {
            let ends = [&node["minimum"], &node["maximum"]].map(|end| number_text(single(end)));
            let unit = node["x-unit"].as_str().expect("a unit");
            let range = format!("Range {}", with_unit(&format!("{} to {}", ends[0], ends[1]), unit));
            let description = property["description"].as_str().unwrap_or_default().replace('\n', " ");
            let stated = ['.', ';'].iter().any(|end| description.contains(&format!("{range}{end}")));
            assert!(stated, "{name}: `{range}` is not in `{description}`");
        }
    });
}

#[test]
fn the_docs_state_the_default() {
    let mut checked = 0;
    properties(&SCHEMA, &mut |name, property| {
        let Some(default) = property.get("default").filter(|_| is_number(property)) else {
            return;
        };
        if default.is_number() && name != "version" {
            checked += 1;
            let stated = format!("default {}", number_text(single(default)));
            let description = property["description"].as_str().unwrap_or_default().replace('\n', " ");
            assert!(description.contains(&stated), "{name}: `{stated}` is not in `{description}`");
        }
    });
    assert!(checked > 30, "{checked}");
}

#[test]
fn the_published_schema_is_current() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/schema.json");
    if std::env::var_os("SORB_BLESS").is_some() {
        fs::write(&file, schema()).expect("writable folder");
    }
    let published: Value =
        serde_json::from_str(&fs::read_to_string(&file).expect("published")).expect("valid JSON");
    // As values: the order of keys is a build option of serde_json that any crate of a build may switch on.
    assert_eq!(published, *SCHEMA, "run the tests with SORB_BLESS=1 and commit scenes/schema.json");
}
