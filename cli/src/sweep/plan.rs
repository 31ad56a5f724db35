//! Plans of sweeps: TOML files.

use std::{fmt, fs, path::Path};

use serde::{
    Deserialize, Deserializer,
    de::{MapAccess, SeqAccess, Visitor},
};
use sorb::Measures;
use toml::{Spanned, Value};

use crate::error::CliError;

/// Most runs of a plan.
const MAX_RUNS: usize = 1_000_000;

/// A plan as it is in its file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Plan {
    /// Name of a scene, or path of its file, from the folder of the plan.
    pub(super) scene: String,
    /// Quality of all runs.
    pub(super) quality: Option<String>,
    /// Resolution of all runs.
    pub(super) resolution: Option<f64>,
    /// Changes of all runs, as `--set` takes them.
    #[serde(default)]
    pub(super) set: Vec<String>,
    /// Length of a run.
    pub(super) frames: Option<u32>,
    /// Length of a run \[s\], up to whole frames.
    pub(super) seconds: Option<f64>,
    /// Names of measures; all numbers by default.
    pub(super) measures: Option<Vec<String>>,
    /// Keys and their values.
    pub(super) grid: Grid,
}

/// Keys in the order of the file, and the values of each.
#[derive(Debug)]
pub(super) struct Grid(pub(super) Vec<(String, Vec<Value>)>);

impl Plan {
    /// Reads a plan.
    ///
    /// # Errors
    /// The file cannot be read, or is no plan: the text names file, key and value.
    pub(super) fn read(path: &Path) -> Result<Self, CliError> {
        let text = fs::read_to_string(path).map_err(CliError::read(path))?;
        let wrong = |message: String| CliError::Usage(format!("{}: {message}", path.display()));
        let plan: Self = toml::from_str(&text).map_err(|error| wrong(error.to_string()))?;
        plan.check().map_err(wrong)?;
        Ok(plan)
    }

    fn check(&self) -> Result<(), String> {
        match (self.frames, self.seconds) {
            (Some(_), Some(_)) => return Err("give `frames` or `seconds`, not both".to_owned()),
            (_, Some(seconds)) if !(0.0..=1e5).contains(&seconds) => {
                return Err(format!("`seconds` = {seconds} is out of range 0 to 100000 s"));
            }
            _ => {}
        }
        for (number, (key, values)) in self.grid.0.iter().enumerate() {
            if values.is_empty() {
                return Err(format!("`grid.{key}` has no values"));
            }
            if self.grid.0[..number].iter().any(|(other, _)| other == key) {
                return Err(format!("`grid.{key}` is there twice"));
            }
        }
        let runs = self.grid.0.iter().try_fold(1_usize, |runs, (_, values)| runs.checked_mul(values.len()));
        if runs.is_none_or(|runs| runs > MAX_RUNS) {
            return Err(format!("`grid` has more than {MAX_RUNS} combinations"));
        }
        let known = Measures::default().named();
        let unknown = self.measures.iter().flatten().find(|name| known.iter().all(|(own, _)| own != name));
        unknown.map_or(Ok(()), |name| {
            let known = known.map(|(name, _)| name).join(", ");
            Err(format!("`measures`: there is no {name:?}; measures: {known}"))
        })
    }

    /// Names of the measures of a run, one a number.
    pub(super) fn columns(&self) -> Vec<String> {
        self.numbers(&Measures::default()).into_iter().map(|(name, _)| name).collect()
    }

    /// The measures of a run. A vector becomes three numbers, `NAME_x`, `NAME_y` and `NAME_z`; without a list of names there are none.
    pub(super) fn numbers(&self, measures: &Measures) -> Vec<(String, f64)> {
        let named = measures.named();
        let Some(names) = &self.measures else {
            let numbers = named.into_iter().filter(|(_, values)| values.len() == 1);
            return numbers.map(|(name, values)| (name.to_owned(), values[0])).collect();
        };
        let of_name = |name: &String| named.iter().find(|(own, _)| own == name);
        let columns = names.iter().filter_map(of_name).flat_map(|(name, values)| {
            let ends: &[&str] = if values.len() == 1 { &[""] } else { &["_x", "_y", "_z"] };
            ends.iter().zip(values).map(move |(end, value)| (format!("{name}{end}"), *value))
        });
        columns.collect()
    }
}

/// What stands at a key of the grid: values, or keys below it, with their places in the file.
enum Entry {
    Values(Vec<Value>),
    Below(Vec<(Spanned<String>, Self)>),
}

impl Entry {
    /// Adds what is below a key.
    fn flatten(self, (place, key): (usize, String), found: &mut Vec<(usize, String, Vec<Value>)>) {
        match self {
            Self::Values(values) => found.push((place, key, values)),
            Self::Below(entries) => {
                for (name, entry) in entries {
                    let own = if key.is_empty() {
                        name.get_ref().clone()
                    } else {
                        format!("{key}.{}", name.get_ref())
                    };
                    entry.flatten((name.span().start, own), found);
                }
            }
        }
    }
}

struct Entries;

impl<'de> Visitor<'de> for Entries {
    type Value = Entry;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a list of values, such as [0.5, 0.7]")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Entry, A::Error> {
        let mut values = Vec::new();
        while let Some(value) = list.next_element()? {
            values.push(value);
        }
        Ok(Entry::Values(values))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Entry, A::Error> {
        let mut entries = Vec::new();
        while let Some(entry) = map.next_entry()? {
            entries.push(entry);
        }
        Ok(Entry::Below(entries))
    }
}

impl<'de> Deserialize<'de> for Entry {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_any(Entries)
    }
}

impl<'de> Deserialize<'de> for Grid {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let mut found = Vec::new();
        from.deserialize_map(Entries)?.flatten((0, String::new()), &mut found);
        // Readers of TOML sort by name; the first key of the file varies slowest.
        found.sort_by_key(|(place, ..)| *place);
        Ok(Self(found.into_iter().map(|(_, key, values)| (key, values)).collect()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(text: &str) -> Result<Plan, String> {
        let plan: Plan = toml::from_str(text).map_err(|error| error.to_string())?;
        plan.check()?;
        Ok(plan)
    }

    #[test]
    fn keys_of_a_grid_have_the_order_of_the_file() {
        let text = "scene = \"dry\"\n[grid]\nresolution = [1]\nsponges.b.edge = [1]\n\"fluid.spacing\" = [2, 3]\n\
                    sponges.a.edge = [4]\ndomain = [{ kind = \"open\" }]\n";
        let keys: Vec<String> = plan(text).unwrap().grid.0.into_iter().map(|(key, _)| key).collect();
        assert_eq!(keys, ["resolution", "sponges.b.edge", "fluid.spacing", "sponges.a.edge", "domain"]);
    }

    #[test]
    fn wrong_plans_are_errors_that_name_the_key() {
        for (text, message) in [
            ("", "missing field `scene`"),
            ("scene = \"dry\"", "missing field `grid`"),
            ("scene = \"dry\"\ngrids = {}", "unknown field `grids`"),
            ("scene = \"dry\"\ngrid = { resolution = 2 }", "expected a list of values"),
            ("scene = \"dry\"\ngrid = { resolution = [] }", "`grid.resolution` has no values"),
            ("scene = \"dry\"\ngrid = { \"a.b\" = [1], a.b = [2] }", "`grid.a.b` is there twice"),
            ("scene = \"dry\"\nseconds = -1\ngrid = {}", "`seconds` = -1 is out of range"),
            ("scene = \"dry\"\nseconds = nan\ngrid = {}", "`seconds` = NaN is out of range"),
            ("scene = \"dry\"\nseconds = 1\nframes = 1\ngrid = {}", "not both"),
            (
                "scene = \"dry\"\nmeasures = [\"mass\"]\ngrid = {}",
                "there is no \"mass\"; measures: time, water_mass",
            ),
        ] {
            let found = plan(text).expect_err(text);
            assert!(found.contains(message), "{text}: {found}");
        }
        let list: String = "0, ".repeat(1001);
        let text = format!("scene = \"dry\"\n[grid]\na = [{list}]\nb = [{list}]\n");
        assert!(plan(&text).unwrap_err().contains("more than 1000000"));
    }

    #[test]
    fn vectors_become_three_numbers() {
        let text = "scene = \"dry\"\nmeasures = [\"sponge_centre\", \"saturation\"]\ngrid = {}";
        let own = plan(text).unwrap();
        assert_eq!(own.columns(), ["sponge_centre_x", "sponge_centre_y", "sponge_centre_z", "saturation"]);
        assert!(plan("scene = \"dry\"\ngrid = {}").unwrap().columns().contains(&"elastic_energy".to_owned()));
    }
}
