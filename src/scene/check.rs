//! Compares a parsed file with the schema, so that every mistake is reported by its key before serde reads the value.

use serde_json::Value as Json;
use toml::{Table, Value};

use super::error::{Defect, Problem, nearest};
use super::key;
use super::schema::SCHEMA;

/// All unknown keys, missing keys, wrong types and unknown choices of a file.
pub(super) fn check(file: &Value) -> Vec<Problem> {
    let mut problems = Vec::new();
    node(&SCHEMA, file, "", &mut problems);
    problems
}

/// A value as a file would write it, shortened.
pub(super) fn value_text(value: &Value) -> String {
    let text = value.to_string().replace('\n', " ");
    match text.char_indices().nth(60) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text,
    }
}

/// Follows references, and skips the `null` of optional keys.
fn resolve(mut schema: &'static Json) -> &'static Json {
    loop {
        let target = match (schema.get("$ref").and_then(Json::as_str), schema.get("anyOf")) {
            (Some(reference), _) => SCHEMA.pointer(reference.trim_start_matches('#')),
            (None, Some(Json::Array(choices))) => {
                choices.iter().find(|choice| choice.get("type").is_none_or(|kind| kind != "null"))
            }
            _ => None,
        };
        match target {
            Some(target) => schema = target,
            None => return schema,
        }
    }
}

fn node(schema: &'static Json, value: &Value, path: &str, problems: &mut Vec<Problem>) {
    let schema = resolve(schema);
    if let Some(variants) = schema.get("oneOf").and_then(Json::as_array) {
        choice(variants, value, path, problems);
        return;
    }
    let kind = match schema.get("type") {
        Some(Json::Array(kinds)) => kinds.iter().filter_map(Json::as_str).find(|kind| *kind != "null"),
        kind => kind.and_then(Json::as_str),
    };
    match (kind.unwrap_or_default(), value) {
        ("object", Value::Table(members)) => table(schema, members, path, problems),
        ("array", Value::Array(elements)) => array(schema, elements, value, path, problems),
        ("integer", Value::Integer(number)) if u32::try_from(*number).is_ok() => {}
        ("number", Value::Float(_) | Value::Integer(_))
        | ("string", Value::String(_))
        | ("boolean", Value::Boolean(_)) => {}
        _ => problems.push(wrong_type(path, value, expected(schema, kind.unwrap_or("value")))),
    }
}

fn table(schema: &'static Json, members: &Table, path: &str, problems: &mut Vec<Problem>) {
    let properties = schema.get("properties").and_then(Json::as_object);
    for (name, value) in members {
        let path = key::member(path, name);
        match properties.and_then(|properties| properties.get(name)) {
            Some(property) => node(property, value, &path, problems),
            None => {
                let known: Vec<String> = properties.into_iter().flat_map(|p| p.keys().cloned()).collect();
                let nearest = nearest(name, known.iter().map(String::as_str));
                let defect = Defect::UnknownKey { nearest, known };
                problems.push(Problem::new(path, value_text(value), defect));
            }
        }
    }
    let required = schema.get("required").and_then(Json::as_array).into_iter().flatten();
    for name in required.filter_map(Json::as_str).filter(|name| !members.contains_key(*name)) {
        problems.push(Problem::missing(key::member(path, name)));
    }
}

fn array(schema: &'static Json, elements: &[Value], value: &Value, path: &str, problems: &mut Vec<Problem>) {
    let count = |bound: &str| schema.get(bound).and_then(Json::as_u64);
    let length = elements.len() as u64;
    if count("minItems").is_some_and(|minimum| length < minimum)
        || count("maxItems").is_some_and(|maximum| length > maximum)
    {
        problems.push(wrong_type(path, value, expected(schema, "array")));
        return;
    }
    let Some(items) = schema.get("items") else { return };
    for (index, element) in elements.iter().enumerate() {
        node(items, element, &key::element(path, index), problems);
    }
}

/// One of several words, or one of several tables that differ in the word at `kind`.
fn choice(variants: &'static [Json], value: &Value, path: &str, problems: &mut Vec<Problem>) {
    let tag = |variant: &'static Json| variant.pointer("/properties/kind/const").and_then(Json::as_str);
    let word = |variant: &'static Json| variant.get("const").and_then(Json::as_str);
    let known: Vec<&str> = variants.iter().filter_map(|v| word(v).or_else(|| tag(v))).collect();
    let tagged = variants.iter().any(|variant| tag(variant).is_some());
    let (text, text_path) = match value {
        Value::String(text) if !tagged => (text, path.to_owned()),
        Value::Table(members) if tagged => match members.get("kind") {
            Some(Value::String(text)) => (text, key::member(path, "kind")),
            Some(other) => {
                let expected = format!("one of {}", known.join(", "));
                problems.push(wrong_type(&key::member(path, "kind"), other, expected));
                return;
            }
            None => {
                problems.push(Problem::missing(key::member(path, "kind")));
                return;
            }
        },
        _ => {
            let form = if tagged { "a table with a `kind` of " } else { "one of " };
            problems.push(wrong_type(path, value, format!("{form}{}", known.join(", "))));
            return;
        }
    };
    match (known.iter().position(|known| known == text), value) {
        (Some(index), Value::Table(members)) => table(&variants[index], members, path, problems),
        (Some(_), _) => {}
        (None, _) => {
            let nearest = nearest(text, known.iter().copied());
            let known = known.into_iter().map(str::to_owned).collect();
            problems.push(Problem::new(
                text_path,
                format!("{text:?}"),
                Defect::UnknownChoice { nearest, known },
            ));
        }
    }
}

fn wrong_type(path: &str, value: &Value, expected: String) -> Problem {
    let found = match value {
        Value::String(_) => "text",
        Value::Integer(_) => "a whole number",
        Value::Float(_) => "a number with decimals",
        Value::Boolean(_) => "true or false",
        Value::Datetime(_) => "a date",
        Value::Array(_) => "an array",
        Value::Table(_) => "a table",
    };
    Problem::new(path, value_text(value), Defect::WrongType { expected, found })
}

/// What a node of the schema expects, in words.
fn expected(schema: &'static Json, kind: &str) -> String {
    let bound = |name: &str| schema.get(name).map(Json::to_string);
    match (kind, bound("minimum"), bound("maximum")) {
        ("integer", Some(minimum), Some(maximum)) => format!("a whole number from {minimum} to {maximum}"),
        ("integer", ..) => "a whole number".to_owned(),
        ("number", ..) => "a number".to_owned(),
        ("string", ..) => "text in quotes".to_owned(),
        ("boolean", ..) => "true or false".to_owned(),
        ("object", ..) => "a table".to_owned(),
        ("array", ..) => match bound("minItems") {
            Some(count) => {
                let kind = schema.get("items").and_then(|items| items.get("type")).and_then(Json::as_str);
                let is_flag = kind == Some("boolean");
                format!("an array of {count}{}", if is_flag { ", each true or false" } else { " numbers" })
            }
            None => "an array".to_owned(),
        },
        _ => "something else".to_owned(),
    }
}
