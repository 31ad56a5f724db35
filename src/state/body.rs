//! A world as sections of bytes.

use sorb_kernels::columns::Column;

use super::{rest::Rest, section::append_column};
use crate::{rigid::RigidError, world::World};

/// Names of the sections that are no columns.
pub(super) const SLEEP: [&str; 2] = ["sleep.particles", "sleep.nodes"];
pub(super) const ENGINE: &str = "engine";
pub(super) const ENGINE_OF_HOST: &str = "engine of the host";
pub(super) const LOADS: &str = "loads";
pub(super) const REST: &str = "rest";
pub(super) const WATER: &str = "water";
pub(super) const SCENE: &str = "scene";
pub(super) const CONTAINER: &str = "container";

/// Name and bytes of every section, in order.
pub(super) type Sections = Vec<(&'static str, u64)>;

/// The columns of a state, in order.
pub(crate) fn saved_columns() -> impl Iterator<Item = Column> {
    Column::ALL.iter().copied().filter(|column| column.life().is_saved())
}

impl World {
    /// Appends all sections. The result is that of the engine, whose section is empty if it cannot be saved.
    pub(super) fn write_state(&self, out: &mut Vec<u8>) -> (Sections, Result<(), RigidError>) {
        let columns = self.columns();
        let mut sections = Sections::new();
        let rows = columns.rows;
        out.reserve(64 * rows.fluid + 160 * rows.nodes + 4096);
        let mut start = out.len();
        let mut end = |name: &'static str, out: &Vec<u8>| {
            if out.len() > start {
                sections.push((name, (out.len() - start) as u64));
            }
            start = out.len();
        };
        for column in saved_columns() {
            append_column(columns, column, out);
            end(column.name(), out);
        }
        for (name, places) in SLEEP.into_iter().zip(self.sleep.places_before()) {
            for place in places {
                place.to_array().into_iter().for_each(|value| out.extend_from_slice(&value.to_le_bytes()));
            }
            end(name, out);
        }
        if self.water.is_changed() {
            let all = std::mem::take(out);
            // Numbers alone cannot fail.
            *out = postcard::to_extend(&self.water, all).unwrap_or_default();
            end(WATER, out);
        }
        if let Some(origin) = &self.origin {
            let all = std::mem::take(out);
            *out = postcard::to_extend(origin, all).unwrap_or_default();
            end(SCENE, out);
        }
        if let Some(frame) = &self.frame {
            let all = std::mem::take(out);
            // As for the water: the text of motions has numbers that are finite.
            *out = postcard::to_extend(frame, all).unwrap_or_default();
            end(CONTAINER, out);
        }
        let length = out.len();
        let engine = self.engine.save(out);
        if engine.is_err() {
            out.truncate(length);
        }
        end(if self.has_own_engine { ENGINE_OF_HOST } else { ENGINE }, out);
        let loads = self.loads.saved_others();
        if !loads.is_empty() {
            let all = std::mem::take(out);
            // As for the rest.
            *out = postcard::to_extend(&loads, all).unwrap_or_default();
            end(LOADS, out);
        }
        let all = std::mem::take(out);
        // Neither lists without a length nor maps are in there, which is all that could fail.
        *out = postcard::to_extend(&Rest::of(self), all).unwrap_or_default();
        end(REST, out);
        (sections, engine)
    }
}
