//! Recordings in memory and as files.

use std::{
    fmt,
    io::{Read, Write},
};

use serde::{Deserialize, Serialize};

use crate::{
    Command, StateError,
    scene::Scene,
    state::{self, Kind, Save},
};

/// Files of recordings.
const KIND: Kind = Kind { name: "recording", magic: *b"sorbrecd", version: 2 };

/// What a host did to a world: its scene, its commands, a digest after every frame or step, and key frames.
#[derive(Clone, Default)]
pub struct Recording {
    pub(super) header: Header,
    /// Digest after every tick.
    pub(super) digests: Vec<u64>,
    /// Key frames, each with the number of ticks before it, as files.
    pub(super) keys: Vec<(u64, Vec<u8>)>,
}

/// What is not large.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Header {
    pub(super) library: String,
    /// The scene as JSON.
    pub(super) scene: String,
    /// Digest of the parameters that the library derived from it.
    pub(super) parameters: u64,
    /// Digest of the first state.
    pub(super) start: u64,
    /// Whether it was recorded on a GPU, whose bits only the same device gives again.
    pub(super) is_on_gpu: bool,
    /// Ranges of ticks that were single steps, the others being frames: first and end.
    pub(super) steps: Vec<(u64, u64)>,
    /// Commands, with the number of ticks and of steps before them.
    pub(super) commands: Vec<(u64, u64, Command)>,
    /// Number of ticks.
    pub(super) ticks: u64,
    /// Key frames: ticks before each, and its bytes.
    pub(super) keys: Vec<(u64, u64)>,
}

impl Header {
    fn body_bytes(&self) -> u64 {
        let keys = self.keys.iter().fold(0_u64, |sum, (_, bytes)| sum.saturating_add(*bytes));
        self.ticks.saturating_mul(8).saturating_add(keys)
    }
}

impl Recording {
    /// Reads a recording.
    ///
    /// # Errors
    /// The input cannot be read, is no recording, truncated, altered, or of another version of the format.
    pub fn read(from: impl Read) -> Result<Self, StateError> {
        let (header, body): (Header, Vec<u8>) = state::read(&KIND, from, Header::body_bytes)?;
        let (digests, mut rest) = body.split_at((8 * header.ticks as usize).min(body.len()));
        let digests = digests.as_chunks::<8>().0.iter().map(|digest| u64::from_le_bytes(*digest)).collect();
        let mut keys = Vec::new();
        let mut before = None;
        for (tick, bytes) in &header.keys {
            if *tick > header.ticks || before.is_some_and(|before| before >= *tick) {
                return Err(state::invalid(
                    "key frames",
                    format!("one after {tick} of {} frames", header.ticks),
                ));
            }
            before = Some(*tick);
            let (own, after) = rest.split_at((*bytes as usize).min(rest.len()));
            keys.push((*tick, own.to_vec()));
            rest = after;
        }
        Ok(Self { header, digests, keys })
    }

    /// Writes the recording.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn write(&self, out: impl Write) -> Result<(), StateError> {
        let keys = self.keys.iter().map(|(tick, bytes)| (*tick, bytes.len() as u64)).collect();
        let header = Header { ticks: self.digests.len() as u64, keys, ..self.header.clone() };
        let mut body: Vec<u8> = self.digests.iter().flat_map(|digest| digest.to_le_bytes()).collect();
        self.keys.iter().for_each(|(_, bytes)| body.extend_from_slice(bytes));
        state::write(&KIND, &header, &body, out)
    }

    /// The scene.
    ///
    /// # Errors
    /// The text of the scene is no valid scene.
    pub fn scene(&self) -> Result<Scene, StateError> {
        state::scene_of(&self.header.scene)
    }

    /// Number of ticks: frames, and single steps.
    #[must_use]
    pub fn ticks(&self) -> u64 {
        self.digests.len() as u64
    }

    /// Commands, with the number of ticks before them.
    pub fn commands(&self) -> impl Iterator<Item = (u64, &Command)> {
        self.header.commands.iter().map(|(tick, _, command)| (*tick, command))
    }

    /// Key frames, by the number of ticks before them.
    pub fn key_frames(&self) -> impl Iterator<Item = u64> {
        self.keys.iter().map(|(tick, _)| *tick)
    }

    /// Whether it was recorded on a GPU: only the same device gives the same digests.
    #[must_use]
    pub fn is_on_gpu(&self) -> bool {
        self.header.is_on_gpu
    }

    /// The save of the last key frame before or at a tick; none if there is none.
    pub(super) fn key_before(&self, tick: u64) -> Option<Result<(u64, Save), StateError>> {
        let (at, bytes) = self.keys.iter().rev().find(|(at, _)| *at <= tick)?;
        Some(Save::read(&bytes[..]).map(|save| (*at, save)))
    }

    /// The save of the first key frame at a tick or after it; none if there is none.
    pub(super) fn key_after(&self, tick: u64) -> Option<Result<(u64, Save), StateError>> {
        let (at, bytes) = self.keys.iter().find(|(at, _)| *at >= tick)?;
        Some(Save::read(&bytes[..]).map(|save| (*at, save)))
    }

    /// Whether a tick is a single step.
    pub(super) fn is_step(&self, tick: u64) -> bool {
        self.header.steps.iter().any(|(first, end)| (*first..*end).contains(&tick))
    }
}

impl fmt::Debug for Recording {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let keys: Vec<u64> = self.key_frames().collect();
        let mut debug = out.debug_struct("Recording");
        debug
            .field("ticks", &self.ticks())
            .field("commands", &self.header.commands)
            .field("key_frames", &keys);
        debug.finish_non_exhaustive()
    }
}
