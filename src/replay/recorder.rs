//! Records what a host does.

use super::{Recording, recording::Header};
use crate::{Command, CommandError, FrameReport, Options, StateError, StepError, StepReport, World};

/// Records a world: the host steps it, and pushes commands, through the recorder.
///
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// use sorb::{Command, Options, Player, Recorder, World, glam::Vec3, scene::Scene};
///
/// let mut world = World::new(&Scene::new("space"))?;
/// let mut recorder = Recorder::new(&world, Some(60))?;
/// recorder.push(&mut world, Command::Gravity { gravity: Vec3::ZERO })?;
/// recorder.advance_frame(&mut world)?;
/// let recording = recorder.into_recording();
/// let mut player = Player::new(&recording, &Options::default())?;
/// while player.advance()? {}
/// assert_eq!(player.world().digest(), world.digest());
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Recorder {
    recording: Recording,
    every: Option<u64>,
    memory: Vec<u8>,
    /// Why a key frame is missing.
    lost: Option<StateError>,
}

impl Recorder {
    /// Begins with the present state. `every` is the number of frames from a key frame to the next, at least 1. Without it
    /// there is none, and who seeks plays from the start.
    ///
    /// # Errors
    /// The world has failed, or its rigid-body engine cannot be saved.
    pub fn new(world: &World, every: Option<u32>) -> Result<Self, StateError> {
        let start = world.try_digest()?;
        let identity = world.identity()?;
        let header = Header {
            library: env!("CARGO_PKG_VERSION").to_owned(),
            scene: identity.scene.clone(),
            parameters: identity.parameters,
            start,
            is_on_gpu: world.plan().placement().is_some_and(|placement| !placement.on_gpu.is_empty()),
            ..Header::default()
        };
        let recording = Recording { header, ..Recording::default() };
        let every = every.map(|every| u64::from(every.max(1)));
        let mut recorder = Self { recording, every, memory: Vec::new(), lost: None };
        // What the scene does not say by itself is the first key frame.
        let is_new = world.clock().steps == 0 && world.clock().frames == 0;
        let same = |fresh: World| fresh.digest() == start;
        let options = Options { threads: Some(1), ..Options::default() };
        if !(is_new && World::with_options(world.scene(), &options).is_ok_and(same)) {
            recorder.key_frame(world)?;
        }
        Ok(recorder)
    }

    /// Pushes a command to the world, and records it.
    ///
    /// # Errors
    /// As [`World::push`]; nothing is recorded.
    pub fn push(&mut self, world: &mut World, command: Command) -> Result<(), CommandError> {
        world.push(command.clone())?;
        self.recording.header.commands.push((self.recording.ticks(), world.clock().steps, command));
        Ok(())
    }

    /// Takes a frame of the world, and records it.
    ///
    /// # Errors
    /// As [`World::advance_frame`]; the frame is not recorded.
    pub fn advance_frame(&mut self, world: &mut World) -> Result<FrameReport, StepError> {
        let report = world.advance_frame()?;
        self.tick(world);
        Ok(report)
    }

    /// Takes a step of the world, and records it.
    ///
    /// # Errors
    /// As [`World::step`]; the step is not recorded.
    pub fn step(&mut self, world: &mut World) -> Result<StepReport, StepError> {
        let report = world.step()?;
        let tick = self.recording.ticks();
        match self.recording.header.steps.last_mut() {
            Some((_, end)) if *end == tick => *end += 1,
            _ => self.recording.header.steps.push((tick, tick + 1)),
        }
        self.tick(world);
        Ok(report)
    }

    /// The recording so far.
    #[must_use]
    pub fn recording(&self) -> &Recording {
        &self.recording
    }

    /// The recording.
    #[must_use]
    pub fn into_recording(self) -> Recording {
        self.recording
    }

    /// Why a key frame is missing; none if none is.
    #[must_use]
    pub fn lost_key_frame(&self) -> Option<&StateError> {
        self.lost.as_ref()
    }

    fn tick(&mut self, world: &World) {
        let (digest, _) = world.digest_with(&mut self.memory);
        self.recording.digests.push(digest);
        let is_due = self.every.is_some_and(|every| self.recording.ticks().is_multiple_of(every));
        if is_due && let Err(error) = self.key_frame(world) {
            self.lost = Some(error);
        }
    }

    fn key_frame(&mut self, world: &World) -> Result<(), StateError> {
        let mut bytes = Vec::new();
        world.to_save()?.write_compressed(&mut bytes)?;
        self.recording.keys.push((self.recording.ticks(), bytes));
        Ok(())
    }
}
