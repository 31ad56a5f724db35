//! Parts of a sweep: files with a row a line, which are written as the runs end.

use std::{
    collections::BTreeMap,
    fs::{self, File, TryLockError},
    io::Write,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};

use super::jobs::Row;
use crate::error::CliError;

/// The first line of a part.
#[derive(Debug, Deserialize, Serialize)]
struct Head {
    /// What the sweep computes.
    sweep: String,
}

/// Rows of one part, and the length of its whole lines \[bytes\].
#[derive(Debug, Default)]
struct Read {
    rows: Vec<Row>,
    whole: usize,
}

/// The file of a shard while it is written.
#[derive(Debug)]
pub(super) struct Part {
    path: PathBuf,
    file: File,
}

impl Part {
    /// Opens or begins the file of a shard. A line that an end by force has cut off is removed.
    ///
    /// # Errors
    /// The file cannot be read or written, is of another sweep, or another process writes it.
    pub(super) fn open(folder: &Path, [shard, shards]: [usize; 2], identity: &str) -> Result<Self, CliError> {
        fs::create_dir_all(folder).map_err(CliError::write(folder))?;
        let path = folder.join(format!("part_{shard}_of_{shards}.jsonl"));
        let mut open = File::options();
        let file = open.create(true).append(true).open(&path).map_err(CliError::write(&path))?;
        // Some network file systems have no locks: two processes of one shard are then up to the caller.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(CliError::Usage(format!("{}: another process runs this shard", path.display())));
        }
        let mut part = Self { path, file };
        let read = read(&part.path, identity)?;
        part.file.set_len(read.whole as u64).map_err(CliError::write(&part.path))?;
        if read.whole == 0 {
            part.line(&Head { sweep: identity.to_owned() })?;
        }
        Ok(part)
    }

    /// Writes a row, which reaches the file at once.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(super) fn add(&mut self, row: &Row) -> Result<(), CliError> {
        self.line(row)
    }

    fn line(&mut self, value: &impl Serialize) -> Result<(), CliError> {
        let mut line = serde_json::to_string(value)?;
        line.push('\n');
        self.file.write_all(line.as_bytes()).map_err(CliError::write(&self.path))
    }
}

/// The rows of all parts in a folder by run, each once. A run that failed gives way to one that did not.
///
/// # Errors
/// A part cannot be read or is of another sweep, or two rows of one run have other digests.
pub(super) fn rows(folder: &Path, identity: &str) -> Result<BTreeMap<usize, Row>, CliError> {
    let mut rows: BTreeMap<usize, Row> = BTreeMap::new();
    for path in paths(folder)? {
        for row in read(&path, identity)?.rows {
            match rows.get(&row.run) {
                Some(earlier) if earlier.error.is_empty() && row.error.is_empty() => {
                    if earlier.digest != row.digest {
                        let (file, run) = (path.display(), row.run);
                        let digests = [&earlier.digest, &row.digest].map(String::as_str).join(" and ");
                        let message = format!("{file}: run {run} has two results, of the digests {digests}");
                        return Err(CliError::CheckFailed(message));
                    }
                }
                Some(earlier) if earlier.error.is_empty() => {}
                _ => {
                    rows.insert(row.run, row);
                }
            }
        }
    }
    Ok(rows)
}

/// Files of parts, in the order of their names.
fn paths(folder: &Path) -> Result<Vec<PathBuf>, CliError> {
    let is_part = |path: &PathBuf| {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        name.starts_with("part_") && name.ends_with(".jsonl")
    };
    let entries = fs::read_dir(folder).map_err(CliError::read(folder))?;
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).filter(is_part).collect();
    paths.sort();
    Ok(paths)
}

/// The whole lines of a part. The last one is without an end if the process was ended, or writes it now.
fn read(path: &Path, identity: &str) -> Result<Read, CliError> {
    let bytes = fs::read(path).map_err(CliError::read(path))?;
    let wrong = |message: &str| CliError::Usage(format!("{}: {message}", path.display()));
    let mut found = Read::default();
    for (number, line) in bytes.split_inclusive(|byte| *byte == b'\n').enumerate() {
        if !line.ends_with(b"\n") {
            break;
        }
        if number == 0 {
            let head: Head = serde_json::from_slice(line).map_err(|_| wrong("is no part of a sweep"))?;
            if head.sweep != identity {
                return Err(wrong("is of another plan: remove it, or choose another folder with --out"));
            }
        } else {
            let row = serde_json::from_slice(line);
            found.rows.push(row.map_err(|error| wrong(&format!("line {}: {error}", number + 1)))?);
        }
        found.whole += line.len();
    }
    Ok(found)
}
