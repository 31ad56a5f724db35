//! Reads any bytes as a save and as a recording, with the checksum that they need. The result is an error, or a state that is the
//! same after writing and reading it again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sorb::{Options, Recording, Save};

/// Bytes before header and body.
const FRAME: usize = 24;

/// Puts the checksum where it belongs; without it every change would be found at once.
fn with_checksum(bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    if bytes.len() > FRAME {
        let checksum = xxhash_rust::xxh3::xxh3_64(&bytes[FRAME..]);
        bytes[16..FRAME].copy_from_slice(&checksum.to_le_bytes());
    }
    bytes
}

fuzz_target!(|bytes: &[u8]| {
    let bytes = &with_checksum(bytes)[..];
    if let Ok(save) = Save::read(bytes) {
        let options = Options { threads: Some(1), ..Options::default() };
        if let Ok(world) = save.world(&options) {
            let again = world.to_save().map(|again| again.first_difference(&save));
            assert!(again.is_ok_and(|difference| difference.is_none()));
        }
    }
    if let Ok(recording) = Recording::read(bytes) {
        let mut again = Vec::new();
        assert!(recording.write(&mut again).is_ok());
        assert_eq!(Recording::read(&again[..]).map(|again| again.ticks()).ok(), Some(recording.ticks()));
    }
});
