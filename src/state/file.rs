//! The frame of files: what they are, a checksum, a header and a body.
//!
//! ```text
//! bytes  content
//! 8      kind of file
//! 4      version of its format
//! 4      bytes of the header
//! 8      xxh3 of header and body
//! ..     header (postcard)
//! ..     body
//! ```

use std::io::{ErrorKind, Read, Write};

use serde::{Serialize, de::DeserializeOwned};
use xxhash_rust::xxh3::Xxh3;

use super::{error::StateError, take::invalid};

/// A kind of file.
#[derive(Debug)]
pub(crate) struct Kind {
    pub(crate) name: &'static str,
    pub(crate) magic: [u8; 8],
    pub(crate) version: u32,
}

/// Most bytes that lz4 makes of one.
const LARGEST_RATIO: u64 = 255;

fn checksum(header: &[u8], body: &[u8]) -> u64 {
    let mut hasher = Xxh3::new();
    hasher.update(header);
    hasher.update(body);
    hasher.digest()
}

/// Writes a file.
pub(crate) fn write(
    kind: &Kind,
    header: &impl Serialize,
    body: &[u8],
    mut out: impl Write,
) -> Result<(), StateError> {
    let header = postcard::to_stdvec(header).map_err(|error| invalid("header", error.to_string()))?;
    let length = u32::try_from(header.len()).map_err(|_| invalid("header", "it is longer than 4 GiB"))?;
    out.write_all(&kind.magic)?;
    out.write_all(&kind.version.to_le_bytes())?;
    out.write_all(&length.to_le_bytes())?;
    out.write_all(&checksum(&header, body).to_le_bytes())?;
    out.write_all(&header)?;
    out.write_all(body)?;
    Ok(())
}

/// Reads a file: its header and its body, of as many bytes as the header says.
pub(crate) fn read<H: DeserializeOwned>(
    kind: &Kind,
    mut from: impl Read,
    stored: impl Fn(&H) -> u64,
) -> Result<(H, Vec<u8>), StateError> {
    let magic: [u8; 8] = exact(&mut from, "the kind of file")?;
    if magic != kind.magic {
        let found = String::from_utf8_lossy(&magic).into_owned();
        return Err(StateError::Kind { kind: kind.name, found });
    }
    let found = u32::from_le_bytes(exact(&mut from, "the version")?);
    if found != kind.version {
        return Err(StateError::Version { kind: kind.name, found, supported: kind.version });
    }
    let length = u32::from_le_bytes(exact(&mut from, "the length of the header")?);
    let expected = u64::from_le_bytes(exact(&mut from, "the checksum")?);
    let text = bytes(&mut from, u64::from(length), "the header")?;
    // An altered header may say anything of the body.
    let header: H = postcard::from_bytes(&text).map_err(|error| invalid("header", error.to_string()))?;
    let body = bytes(&mut from, stored(&header), "the body")?;
    let found = checksum(&text, &body);
    if found != expected {
        return Err(StateError::Altered { expected, found });
    }
    Ok((header, body))
}

fn exact<const COUNT: usize>(from: &mut impl Read, what: &'static str) -> Result<[u8; COUNT], StateError> {
    let mut found = [0; COUNT];
    match from.read_exact(&mut found) {
        Ok(()) => Ok(found),
        Err(error) if error.kind() == ErrorKind::UnexpectedEof => {
            Err(StateError::Truncated { what, needed: COUNT as u64, found: 0 })
        }
        Err(error) => Err(error.into()),
    }
}

/// Bytes of a length that the input claims: the memory grows with what is really there.
fn bytes(from: &mut impl Read, needed: u64, what: &'static str) -> Result<Vec<u8>, StateError> {
    let mut all = Vec::new();
    let found = from.take(needed).read_to_end(&mut all)? as u64;
    if found < needed { Err(StateError::Truncated { what, needed, found }) } else { Ok(all) }
}

/// Packs bytes with lz4.
pub(crate) fn compress(bytes: &[u8]) -> Vec<u8> {
    lz4_flex::block::compress(bytes)
}

/// Unpacks what was packed to `size` bytes.
pub(crate) fn decompress(stored: &[u8], size: u64) -> Result<Vec<u8>, StateError> {
    let largest = LARGEST_RATIO * stored.len() as u64;
    if size > largest {
        return Err(invalid("body", format!("{size} bytes cannot come from {} of lz4", stored.len())));
    }
    let mut all = vec![0; size as usize];
    match lz4_flex::block::decompress_into(stored, &mut all) {
        Ok(written) if written as u64 == size => Ok(all),
        Ok(written) => Err(invalid("body", format!("{written} bytes instead of {size}"))),
        Err(error) => Err(invalid("body", error.to_string())),
    }
}
