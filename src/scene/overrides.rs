//! Changes of single keys, as given on a command line: `fluid.spacing=0.004`.

use toml::{Table, Value};

use super::error::nearest;
use super::{Scene, SceneError, key};

impl Scene {
    /// Changes one key: `time.duration=5`, `sponges[0].permeability=1e-10`, `sponges.0.edge=0.008`,
    /// `sponges.NAME.porosity=0.8`, `fluid.blocks[0].maximum=[0.1, 0.2, 0.1]`.
    ///
    /// The value is TOML, and a bare word is text. Absent keys, such as `fluid.sound_speed`, are added. Replace a table to
    /// change its `kind`: `domain={kind="open"}`.
    ///
    /// # Errors
    /// [`SceneError::Override`] for a text without `=`, an element that is not there or a value that is not TOML.
    /// [`SceneError::Invalid`] for an unknown key or a value that makes the scene invalid. The scene is then unchanged.
    pub fn set(&mut self, text: &str) -> Result<(), SceneError> {
        *self = self.with_overrides([text])?;
        Ok(())
    }

    /// The scene with several keys changed in order, as [`Scene::set`] does; only the result must be valid.
    ///
    /// # Errors
    /// As [`Scene::set`].
    pub fn with_overrides<'a>(&self, texts: impl IntoIterator<Item = &'a str>) -> Result<Self, SceneError> {
        let mut value =
            Value::try_from(self).map_err(|error| SceneError::Write { message: error.to_string() })?;
        for text in texts {
            assign(&mut value, text)
                .map_err(|message| SceneError::Override { text: text.to_owned(), message })?;
        }
        Self::from_value(value, &format!("scene {} with overrides", self.name))
    }
}

fn assign(root: &mut Value, text: &str) -> Result<(), String> {
    let (path, value) = text.split_once('=').ok_or("expected KEY=VALUE")?;
    let parts = key::parts(path).ok_or("expected a key such as `sponges[0].permeability`")?;
    let value = parse(value.trim())?;
    let mut place = root;
    let mut so_far = String::new();
    for part in &parts {
        place = match place {
            Value::Array(elements) => {
                let index = index_of(elements, part, &so_far)?;
                so_far = key::element(&so_far, index);
                &mut elements[index]
            }
            Value::Table(members) => {
                so_far = key::member(&so_far, part);
                members.entry(part.as_str()).or_insert_with(|| Value::Table(Table::new()))
            }
            _ => return Err(format!("`{so_far}` is a single value and has no `{part}`")),
        };
    }
    *place = value;
    Ok(())
}

/// Element of an array by number or by name.
fn index_of(elements: &[Value], part: &str, array: &str) -> Result<usize, String> {
    let count = elements.len();
    if let Ok(index) = part.parse::<usize>() {
        return if index < count {
            Ok(index)
        } else {
            Err(format!("`{array}` has {count} elements, numbered from 0"))
        };
    }
    let names: Vec<&str> =
        elements.iter().map(|e| e.get("name").and_then(Value::as_str).unwrap_or("")).collect();
    names.iter().position(|name| *name == part).ok_or_else(|| {
        let hint = nearest(part, names.iter().copied()).map(|name| format!("; did you mean `{name}`?"));
        format!("`{array}` has no element named `{part}`{}", hint.unwrap_or_default())
    })
}

fn parse(text: &str) -> Result<Value, String> {
    // A second line would add a second key.
    let parsed = toml::from_str::<Table>(&format!("value = {text}")).map(|mut table| {
        let only = table.len() == 1;
        table.remove("value").filter(|_| only)
    });
    match parsed {
        Ok(Some(value)) => Ok(value),
        _ if !text.is_empty() && text.chars().all(|c| c.is_ascii_alphanumeric() || "_- ".contains(c)) => {
            Ok(Value::String(text.to_owned()))
        }
        Ok(None) => Err("expected one value".to_owned()),
        Err(error) => Err(format!("the value is not TOML: {}", error.message().trim())),
    }
}
