//! Saves: states as files.

use std::{
    fmt,
    io::{Read, Write},
    ops::Range,
};

use sorb_kernels::{column::Element, columns::Column};
use xxhash_rust::xxh3::xxh3_64;

use super::{
    body::{REST, WATER, saved_columns},
    error::StateError,
    file::{self, Kind},
    filter::{self, row_bytes},
    header::{Header, LIBRARY, scene_of},
    rest::Rest,
    take::{Parts, invalid, origin_in},
};
use crate::{
    Options, World,
    scene::{Estimate, Scene},
    world::digest_of,
};

/// Files of saves.
const KIND: Kind = Kind { name: "save", magic: *b"sorbsave", version: 1 };

/// A state in a form that can be written, compared and restored.
#[derive(Clone, Debug)]
pub struct Save {
    header: Header,
    body: Vec<u8>,
    /// Bytes of every section.
    ranges: Vec<Range<usize>>,
}

impl World {
    /// Writes the state with its scene. A world that is [restored](Self::restore) from it continues with the same bits: with
    /// any threads, at any SIMD level, in another process. On a GPU the state is read back. It continues with the same bits
    /// on the same device, and on others within the bounds of parity.
    ///
    /// ```
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// use sorb::{Options, World, scene::Scene};
    ///
    /// let mut world = World::new(&Scene::new("space"))?;
    /// world.step()?;
    /// let mut bytes = Vec::new();
    /// world.save(&mut bytes)?;
    /// let restored = World::restore(&bytes[..], &Options::default())?;
    /// assert_eq!(restored.digest(), world.digest());
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// The output cannot be written, the world has failed, or its rigid-body engine cannot be saved.
    pub fn save(&self, out: impl Write) -> Result<(), StateError> {
        self.to_save()?.write(out)
    }

    /// The state in memory, as [`Self::save`] writes it.
    ///
    /// # Errors
    /// The world has failed, or its rigid-body engine cannot be saved.
    pub fn to_save(&self) -> Result<Save, StateError> {
        if let Some(error) = &self.failed {
            return Err(StateError::Failed(error.clone()));
        }
        let mut body = Vec::new();
        let (sections, engine) = self.write_state(&mut body);
        if !self.bodies().is_empty() {
            engine?;
        }
        let identity = self.identity()?;
        let clock = self.clock();
        let header = Header {
            library: LIBRARY.to_owned(),
            scene: identity.scene.clone(),
            parameters: identity.parameters,
            digest: super::digest_of(sections.iter().copied(), &body),
            clock: (clock.time, clock.steps, clock.frames),
            sections: sections.into_iter().map(|(name, bytes)| (name.to_owned(), bytes)).collect(),
            is_compressed: false,
            stored: body.len() as u64,
        };
        Save::new(header, body)
    }

    /// Builds the world of a save, in the state that it was saved in.
    ///
    /// # Errors
    /// The input is no save, truncated, altered, of another version of the format, or impossible, or the machine lacks what
    /// the options ask for. No input makes it panic, or allocate more than its size justifies.
    pub fn restore(from: impl Read, options: &Options) -> Result<Self, StateError> {
        Save::read(from)?.world(options)
    }

    /// Returns to the state of a save of the same scene, without building anything anew, unless commands have changed the scene before or
    /// after it.
    ///
    /// # Errors
    /// The save is of another scene, or impossible; the world is unchanged.
    pub fn resume(&mut self, save: &Save) -> Result<(), StateError> {
        let identity = self.identity()?;
        if identity.scene != save.header.scene && save.scene()? != *self.scene() {
            let scene = save.scene()?;
            let origin = origin_in(&save.parts())?;
            let first = origin.as_ref().map_or_else(|| digest_of(&scene), |origin| origin.first);
            if first != self.first_scene() {
                let (expected, found) = (self.scene().name.clone(), scene.name);
                return Err(StateError::Scene { expected, found });
            }
            // Commands have made another one of the same scene.
            let mut world = self.of_scene(&scene, origin)?;
            world.check_parameters(save.header.parameters, &save.header.library)?;
            world.take_state(&save.parts())?;
            *self = world;
            return Ok(());
        }
        self.check_parameters(save.header.parameters, &save.header.library)?;
        self.take_state(&save.parts())
    }
}

impl Save {
    fn new(header: Header, body: Vec<u8>) -> Result<Self, StateError> {
        let mut end = 0_usize;
        let mut ranges = Vec::new();
        for (name, bytes) in &header.sections {
            let after = usize::try_from(*bytes).ok().and_then(|bytes| end.checked_add(bytes));
            let after = after.filter(|after| *after <= body.len());
            let after =
                after.ok_or_else(|| invalid(name, format!("{bytes} bytes are more than there are")))?;
            ranges.push(end..after);
            end = after;
        }
        if end != body.len() {
            return Err(invalid("sections", format!("{end} bytes of {}", body.len())));
        }
        Ok(Self { header, body, ranges })
    }

    /// Reads a save.
    ///
    /// # Errors
    /// The input cannot be read, is no save, truncated, altered, or of another version of the format.
    pub fn read(from: impl Read) -> Result<Self, StateError> {
        let (mut header, stored): (Header, _) = file::read(&KIND, from, |header: &Header| header.stored)?;
        let body = if header.is_compressed {
            let size = header.sections.iter().fold(0_u64, |sum, (_, bytes)| sum.saturating_add(*bytes));
            let mut body = file::decompress(&stored, size)?;
            let mut rest = &mut body[..];
            for (name, bytes) in &header.sections {
                // All sections together are as long as the body.
                let (own, after) = rest.split_at_mut((*bytes as usize).min(rest.len()));
                row_bytes(name).into_iter().for_each(|row| filter::undo(own, row));
                rest = after;
            }
            body
        } else {
            stored
        };
        (header.is_compressed, header.stored) = (false, body.len() as u64);
        Self::new(header, body)
    }

    /// Writes the save.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn write(&self, out: impl Write) -> Result<(), StateError> {
        file::write(&KIND, &self.header, &self.body, out)
    }

    /// Writes the save, compressed with lz4.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn write_compressed(&self, out: impl Write) -> Result<(), StateError> {
        let mut ordered = Vec::with_capacity(self.body.len());
        for (name, bytes) in self.parts().0 {
            match row_bytes(name) {
                Some(row) => filter::apply(bytes, row, &mut ordered),
                None => ordered.extend_from_slice(bytes),
            }
        }
        let packed = file::compress(&ordered);
        let header = Header { is_compressed: true, stored: packed.len() as u64, ..self.header.clone() };
        file::write(&KIND, &header, &packed, out)
    }

    /// The world of the save, in its state.
    ///
    /// # Errors
    /// As [`World::restore`], but for reading.
    pub fn world(&self, options: &Options) -> Result<World, StateError> {
        let scene = self.scene()?;
        // A few bytes of scene could ask for gigabytes.
        let Estimate { particles, nodes, .. } = scene.estimate();
        let (has_water, mut is_dry) = (!self.parts().of(WATER).is_empty(), false);
        let rows = |column: Column| self.parts().of(column.name()).len() as u64 / 16;
        for (column, estimate) in [(Column::FluidPosition, particles), (Column::NodePosition, nodes)] {
            // Commands may have removed most of the water: it is not made at all.
            is_dry |= column == Column::FluidPosition && estimate > rows(column) && has_water;
            if estimate > 4 * rows(column) + 10_000 && !(is_dry && column == Column::FluidPosition) {
                let reason = format!("{} rows, and the scene has about {estimate}", rows(column));
                return Err(invalid(column.name(), reason));
            }
        }
        let origin = origin_in(&self.parts())?;
        let world = World::for_state(&scene, options, origin, is_dry);
        let mut world = world.map_err(|error| StateError::World(Box::new(error)))?;
        world.resume(self)?;
        Ok(world)
    }

    /// The scene.
    ///
    /// # Errors
    /// The text of the scene in the file is no valid scene.
    pub fn scene(&self) -> Result<Scene, StateError> {
        scene_of(&self.header.scene)
    }

    /// Digest of the state, as [`World::digest`].
    #[must_use]
    pub fn digest(&self) -> u64 {
        self.header.digest
    }

    /// Simulated time \[s\].
    #[must_use]
    pub fn time(&self) -> f64 {
        self.header.clock.0
    }

    /// Steps taken.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.header.clock.1
    }

    /// Frames completed.
    #[must_use]
    pub fn frames(&self) -> u64 {
        self.header.clock.2
    }

    /// Version of the library that wrote it.
    #[must_use]
    pub fn library(&self) -> &str {
        &self.header.library
    }

    /// Name and bytes of every section, in order.
    pub fn sections(&self) -> impl Iterator<Item = (&str, usize)> {
        self.header.sections.iter().zip(&self.ranges).map(|((name, _), range)| (name.as_str(), range.len()))
    }

    fn parts(&self) -> Parts<'_> {
        let sections = self.header.sections.iter().zip(&self.ranges);
        Parts(sections.map(|((name, _), range)| (name.as_str(), &self.body[range.clone()])).collect())
    }

    /// The first difference from another save of the same scene, in the order of the sections; none for equal states.
    #[must_use]
    pub fn first_difference(&self, other: &Self) -> Option<Difference> {
        let (own, others) = (self.parts(), other.parts());
        let names = own.0.iter().chain(others.0.iter().filter(|(name, _)| own.of(name).is_empty()));
        let different = names.map(|(name, _)| *name).find(|name| own.of(name) != others.of(name))?;
        Some(Difference::of(different, own.of(different), others.of(different)))
    }
}

/// The first place where two states differ.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Difference {
    /// Name of the column, or of another part of the state.
    pub column: String,
    /// The row of the column; none for other parts.
    pub row: Option<usize>,
    /// The quantity in the row, where a row has several: x, y, z or a name.
    pub lane: String,
    /// The value in the first state.
    pub first: String,
    /// The value in the second state.
    pub second: String,
}

impl fmt::Display for Difference {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { column, row, lane, first, second } = self;
        let row = row.map(|row| format!(" row {row}")).unwrap_or_default();
        let lane = if lane.is_empty() { String::new() } else { format!(" {lane}") };
        write!(out, "{column}{row}{lane}: {first} and {second}")
    }
}

/// Quantities of a body, in the order of its words.
const BODY: [&str; 13] = [
    "position.x",
    "position.y",
    "position.z",
    "rotation.x",
    "rotation.y",
    "rotation.z",
    "rotation.w",
    "linear_velocity.x",
    "linear_velocity.y",
    "linear_velocity.z",
    "angular_velocity.x",
    "angular_velocity.y",
    "angular_velocity.z",
];

impl Difference {
    fn of(name: &str, first: &[u8], second: &[u8]) -> Self {
        let column = saved_columns().find(|column| column.name() == name);
        if first.len() != second.len() || name == REST {
            return Self::of_text(name, first, second);
        }
        let words = |bytes: &[u8]| -> Vec<u32> {
            bytes.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect()
        };
        let (a, b) = (words(first), words(second));
        let word = a.iter().zip(&b).position(|(a, b)| a != b);
        let Some(word) = word else { return Self::of_text(name, first, second) };
        let (width, is_float) = match column.map(Column::element) {
            Some(Element::Rows(_)) => (4, true),
            Some(Element::Values(_)) => (1, true),
            Some(Element::Words(_)) => (1, false),
            Some(Element::Other) => (BODY.len(), true),
            None if name.starts_with("sleep.") => (3, true),
            None => return Self::of_text(name, first, second),
        };
        let value =
            |word: u32| if is_float { format!("{:?}", f32::from_bits(word)) } else { word.to_string() };
        let lane = lane_name(column, width, word % width);
        let (column, row) = (name.to_owned(), Some(word / width));
        Self { column, row, lane, first: value(a[word]), second: value(b[word]) }
    }

    /// Of a part that is no column, as text.
    fn of_text(name: &str, first: &[u8], second: &[u8]) -> Self {
        let text = |bytes: &[u8]| match (name, postcard::from_bytes::<Rest>(bytes)) {
            (REST, Ok(rest)) => format!("{rest:#?}"),
            _ => format!("{} bytes with digest {:016x}", bytes.len(), xxh3_64(bytes)),
        };
        let (a, b) = (text(first), text(second));
        let lines = a.lines().zip(b.lines()).find(|(a, b)| a != b);
        let (first, second) = lines.map_or((a.as_str(), b.as_str()), |(a, b)| (a.trim(), b.trim()));
        let (first, second) = (first.to_owned(), second.to_owned());
        Self { column: name.to_owned(), row: None, lane: String::new(), first, second }
    }
}

/// Name of a word of a row.
fn lane_name(column: Option<Column>, width: usize, index: usize) -> String {
    let named = match column.map(Column::element) {
        Some(Element::Rows(lanes)) => lanes.iter().find(|lane| lane.index == index && !lane.name.is_empty()),
        Some(Element::Other) => return BODY[index].to_owned(),
        _ => None,
    };
    match named {
        Some(lane) => lane.name.to_lowercase(),
        None if width == 1 => String::new(),
        None => ["x", "y", "z", "w"][index].to_owned(),
    }
}
