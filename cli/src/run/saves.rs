//! States that a run leaves on its way.

use std::{
    fs::{self, File},
    io::{BufReader, BufWriter, Write},
    path::{Path, PathBuf},
};

use sorb::{Save, World};

use super::folder::Folder;
use crate::error::CliError;

/// Writes the state at intervals.
#[derive(Debug)]
pub(super) struct Saves {
    path: PathBuf,
    /// Simulated time from save to save \[s\].
    every: f64,
    /// Time of the next one \[s\].
    next: f64,
}

impl Saves {
    pub(super) fn new(folder: &Folder, world: &World, every: f64) -> Self {
        Self { path: folder.save(), every, next: world.clock().time + every }
    }

    /// Writes the state after a frame, if it is due. A run that is killed meanwhile leaves the former one.
    ///
    /// # Errors
    /// The file cannot be written, or the world cannot be saved.
    pub(super) fn frame(&mut self, world: &World) -> Result<(), CliError> {
        // Times of frames are sums.
        if world.clock().time < self.next - 1e-6 {
            return Ok(());
        }
        while self.next - 1e-6 <= world.clock().time {
            self.next += self.every;
        }
        write_save(world, &self.path)
    }
}

/// Writes a state beside its file first, and puts it in its place when it is complete.
fn write_save(world: &World, path: &Path) -> Result<(), CliError> {
    let beside = path.with_extension("sorb.new");
    let file = File::create(&beside).map_err(CliError::write(&beside))?;
    let mut out = BufWriter::new(file);
    world.to_save().and_then(|save| save.write_compressed(&mut out)).map_err(CliError::state(&beside))?;
    out.flush().map_err(CliError::write(&beside))?;
    fs::rename(&beside, path).map_err(CliError::write(path))
}

/// Reads a save.
///
/// # Errors
/// The file cannot be read, or is no save.
pub(crate) fn read_save(path: &Path) -> Result<Save, CliError> {
    let file = File::open(path).map_err(CliError::read(path))?;
    Save::read(BufReader::new(file)).map_err(CliError::state(path))
}
