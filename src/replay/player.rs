//! Plays recordings, and compares every frame.

use std::fmt;

use super::Recording;
use crate::{CommandError, Difference, Options, Save, SimdLevel, StateError, StepError, World};

/// Plays a recording.
#[derive(Debug)]
pub struct Player<'a> {
    recording: &'a Recording,
    options: Options,
    /// A world of the host that plays in place of one that is built from the scene.
    own: Option<World>,
    world: World,
    /// Ticks that were played.
    tick: u64,
    memory: Vec<u8>,
}

/// The first frame that differs from its recording.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Mismatch {
    /// The frame, counted from 1; 0 is the first state.
    pub frame: u64,
    /// Digest in the recording.
    pub recorded: u64,
    /// Digest of this run.
    pub found: u64,
    /// What differs first, and in which frame. It is this one where the recorded state can be computed from the key frame before it,
    /// else that of the next key frame. The first value is the recorded one.
    pub difference: Option<(u64, Difference)>,
}

impl fmt::Display for Mismatch {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { frame, recorded, found, difference } = self;
        write!(out, "frame {frame} has digest {found:016x} instead of {recorded:016x}")?;
        match difference {
            Some((at, difference)) if at == frame => write!(out, "; {difference}, the first as recorded"),
            Some((at, difference)) => write!(out, "; in key frame {at}: {difference}, the first as recorded"),
            None => write!(out, "; no key frame says what differs"),
        }
    }
}

/// Why a recording could not be played.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReplayError {
    /// The recording, or a key frame in it, is not usable.
    #[error(transparent)]
    State(#[from] StateError),
    /// A recorded command is refused.
    #[error("frame {frame}: {error}")]
    Command {
        /// Frames before it.
        frame: u64,
        /// Why.
        error: CommandError,
    },
    /// The world failed.
    #[error("frame {frame}: {error}")]
    Step {
        /// Frames before it.
        frame: u64,
        /// Why.
        error: StepError,
    },
    /// A frame is not as it was recorded.
    #[error("{0}")]
    Mismatch(Box<Mismatch>),
    /// There is no such frame.
    #[error("frame {frame} is out of range 0 to {last}")]
    NoFrame {
        /// The frame.
        frame: u64,
        /// The last one.
        last: u64,
    },
}

impl<'a> Player<'a> {
    /// Builds the world of a recording in its first state. Threads and SIMD level may differ from those of the recording.
    ///
    /// # Errors
    /// The scene cannot be built, or its first state is another one than that of the recording.
    pub fn new(recording: &'a Recording, options: &Options) -> Result<Self, ReplayError> {
        Self::begin(recording, options, None)
    }

    /// The same in a world of the host, of the scene of the recording: for one whose bodies an engine of the host moves
    /// ([`World::with_engine`]). What that world has done so far does not matter if the recording begins with a key frame, else it is new.
    ///
    /// # Errors
    /// The world is of another scene, or its first state is another one than that of the recording.
    pub fn in_world(recording: &'a Recording, world: World) -> Result<Self, ReplayError> {
        let (own, found) = (world.identity()?.scene.clone(), &recording.header.scene);
        if own != *found && *world.scene() != recording.scene()? {
            let (expected, found) = (world.scene().name.clone(), recording.scene()?.name);
            return Err(StateError::Scene { expected, found }.into());
        }
        let options = Options::default();
        Self::begin(recording, &options, Some(world))
    }

    fn begin(recording: &'a Recording, options: &Options, own: Option<World>) -> Result<Self, ReplayError> {
        let world = Self::first(recording, options, own.as_ref())?;
        let player = Self { recording, options: options.clone(), own, world, tick: 0, memory: Vec::new() };
        let (recorded, found) = (recording.header.start, player.world.digest());
        // On another device the first state is the same: nothing was computed yet.
        if recorded != found {
            return Err(mismatch(Mismatch { frame: 0, recorded, found, difference: None }));
        }
        Ok(player)
    }

    fn first(recording: &Recording, options: &Options, own: Option<&World>) -> Result<World, ReplayError> {
        if let Some(key) = recording.key_before(0) {
            return Ok(world_of(&key?.1, options, own)?);
        }
        let world = match own {
            Some(own) => own.clone(),
            None => World::with_options(&recording.scene()?, options)
                .map_err(|error| StateError::World(Box::new(error)))?,
        };
        world.check_parameters(recording.header.parameters, &recording.header.library)?;
        Ok(world)
    }

    /// The world in the present frame.
    #[must_use]
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The world in the present frame, writable: what a host changes is found by the comparison of the next frame.
    pub fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }

    /// Number of frames, or single steps, so far.
    #[must_use]
    pub fn frame(&self) -> u64 {
        self.tick
    }

    /// Plays a frame, and compares it; false at the end.
    ///
    /// # Errors
    /// The world failed, or the frame is not as it was recorded: the error says what differs first. The player goes on after
    /// that if it is asked to.
    pub fn advance(&mut self) -> Result<bool, ReplayError> {
        if !self.play()? {
            return Ok(false);
        }
        let recorded = self.recorded();
        let (found, _) = self.world.digest_with(&mut self.memory);
        if recorded != found {
            let difference = self.difference(recorded)?;
            return Err(mismatch(Mismatch { frame: self.tick, recorded, found, difference }));
        }
        Ok(true)
    }

    /// Plays a frame without a comparison; false at the end.
    ///
    /// # Errors
    /// The world failed, or refuses a command.
    pub fn play(&mut self) -> Result<bool, ReplayError> {
        let (frame, recording) = (self.tick, self.recording);
        if frame >= recording.ticks() {
            return Ok(false);
        }
        let due = recording.header.commands.iter().filter(|(tick, ..)| *tick == frame);
        for (_, _, command) in due {
            self.world.push(command.clone()).map_err(|error| ReplayError::Command { frame, error })?;
        }
        let result = if recording.is_step(frame) {
            self.world.step().map(|_| ())
        } else {
            self.world.advance_frame().map(|_| ())
        };
        result.map_err(|error| ReplayError::Step { frame, error })?;
        self.tick += 1;
        Ok(true)
    }

    /// Goes to a frame, from the nearest key frame before it where that is nearer than the present one.
    ///
    /// # Errors
    /// There is no such frame, a key frame is not usable, or the world failed.
    pub fn seek(&mut self, frame: u64) -> Result<(), ReplayError> {
        let last = self.recording.ticks();
        if frame > last {
            return Err(ReplayError::NoFrame { frame, last });
        }
        let is_behind = frame < self.tick;
        match self.recording.key_before(frame).transpose()? {
            Some((at, save)) if is_behind || at > self.tick => {
                self.world.resume(&save)?;
                self.tick = at;
            }
            None if is_behind => {
                self.world = Self::first(self.recording, &self.options, self.own.as_ref())?;
                self.tick = 0;
            }
            _ => {}
        }
        while self.tick < frame {
            self.play()?;
        }
        Ok(())
    }

    /// Digest of the present frame in the recording.
    fn recorded(&self) -> u64 {
        let before = self.tick.checked_sub(1).and_then(|tick| self.recording.digests.get(tick as usize));
        before.copied().unwrap_or(self.recording.header.start)
    }

    /// What differs first from the recording.
    fn difference(&mut self, recorded: u64) -> Result<Option<(u64, Difference)>, ReplayError> {
        let found = self.world.to_save()?;
        // What was recorded follows from the key frame before, unless this machine computes something else.
        if let Some(expected) = self.recomputed(recorded) {
            return Ok(expected.first_difference(&found).map(|difference| (self.tick, difference)));
        }
        let Some((at, key)) = self.recording.key_after(self.tick).transpose()? else { return Ok(None) };
        let (options, own, world) = (self.options.clone(), self.own.clone(), self.world.clone());
        let mut later = Player { options, own, world, memory: Vec::new(), ..*self };
        while later.tick < at {
            later.play()?;
        }
        let found = later.world.to_save()?;
        Ok(key.first_difference(&found).map(|difference| (at, difference)))
    }

    /// The present frame as it was recorded, computed from the key frame before on one thread at the lowest SIMD level. None if that gives
    /// another digest.
    fn recomputed(&self, recorded: u64) -> Option<Save> {
        let options =
            Options { threads: Some(1), simd: SimdLevel::supported().next(), ..self.options.clone() };
        let from = self.tick.checked_sub(1)?;
        let (tick, world) = match self.recording.key_before(from) {
            Some(key) => key.ok().and_then(|(at, save)| {
                let world = world_of(&save, &options, self.own.as_ref()).ok()?;
                Some((at, world))
            })?,
            None => (0, Self::first(self.recording, &options, self.own.as_ref()).ok()?),
        };
        let (recording, own) = (self.recording, self.own.clone());
        let mut again = Player { recording, options, own, world, tick, memory: Vec::new() };
        while again.tick < self.tick {
            again.play().ok()?;
        }
        (again.world.digest() == recorded).then(|| again.world.to_save().ok()).flatten()
    }
}

/// The world of a key frame, in a copy of that of a host if there is one.
fn world_of(save: &Save, options: &Options, own: Option<&World>) -> Result<World, StateError> {
    let Some(own) = own else { return save.world(options) };
    let mut world = own.clone();
    world.resume(save)?;
    Ok(world)
}

fn mismatch(mismatch: Mismatch) -> ReplayError {
    ReplayError::Mismatch(Box::new(mismatch))
}
