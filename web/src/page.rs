//! What a page holds: a world, a recording that is being made or played, input and answer.

use std::error::Error;

use serde::Deserialize;
use serde_json::json;
use sorb::{
    Command, Options, Recorder, SimdLevel, World,
    scene::{self, Scene},
};

use crate::{columns, replay::Playing, report};

/// Why something was refused.
pub(crate) type Failure = Box<dyn Error>;

/// A world, and who steps it.
enum Stage {
    /// The page; a recorder takes all that it does.
    Live(Box<World>, Option<Box<Recorder>>),
    /// A recording.
    Played(Box<Playing>),
}

/// What the page holds.
#[derive(Default)]
pub(crate) struct Page {
    stage: Option<Stage>,
    pub(crate) input: Vec<u8>,
    pub(crate) answer: Vec<u8>,
    /// A column that the world does not have as such.
    made: Vec<f32>,
}

/// Which scene, and what is changed of it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Load {
    scene: String,
    resolution: Option<f32>,
    #[serde(default)]
    set: Vec<String>,
    simd: Option<String>,
}

impl Page {
    /// The world.
    pub(crate) fn world(&self) -> Result<&World, Failure> {
        match &self.stage {
            Some(Stage::Live(world, _)) => Ok(world),
            Some(Stage::Played(playing)) => Ok(playing.world()),
            None => Err("no scene is loaded".into()),
        }
    }

    /// Whether it is being recorded, and the frame and number of frames of a recording that plays.
    pub(crate) fn recording(&self) -> (bool, Option<(u64, u64)>) {
        match &self.stage {
            Some(Stage::Live(_, recorder)) => (recorder.is_some(), None),
            Some(Stage::Played(playing)) => (false, Some(playing.frames())),
            None => (false, None),
        }
    }

    pub(crate) fn load(&mut self) -> Result<Vec<u8>, Failure> {
        let load: Load =
            serde_json::from_slice(&self.input).map_err(|error| format!("what to load: {error}"))?;
        let mut scene = match load.scene.contains('\n') {
            true => Scene::from_toml(&load.scene, "scene")?,
            false => scene::preset(&load.scene)?,
        };
        if let Some(resolution) = load.resolution.filter(|resolution| *resolution != 1.0) {
            scene = scene.scaled(resolution)?;
        }
        load.set.iter().try_for_each(|change| scene.set(change))?;
        let level = |name: &str| SimdLevel::from_name(name).ok_or_else(|| format!("no SIMD level `{name}`"));
        let simd = load.simd.as_deref().map(level).transpose()?;
        let world = World::with_options(&scene, &Options { simd, ..Options::default() })?;
        self.stage = Some(Stage::Live(Box::new(world), None));
        report::describe(self.world()?)
    }

    pub(crate) fn step(&mut self) -> Result<Vec<u8>, Failure> {
        match &mut self.stage {
            Some(Stage::Live(world, Some(recorder))) => recorder.step(world).map(drop)?,
            Some(Stage::Live(world, None)) => world.step().map(drop)?,
            Some(Stage::Played(_)) => return Err("a recording plays: it has frames, not steps".into()),
            None => return Err("no scene is loaded".into()),
        }
        Ok(Vec::new())
    }

    pub(crate) fn frame(&mut self) -> Result<Vec<u8>, Failure> {
        match &mut self.stage {
            Some(Stage::Live(world, Some(recorder))) => recorder.advance_frame(world).map(drop)?,
            Some(Stage::Live(world, None)) => world.advance_frame().map(drop)?,
            Some(Stage::Played(playing)) => playing.advance()?,
            None => return Err("no scene is loaded".into()),
        }
        Ok(Vec::new())
    }

    pub(crate) fn command(&mut self) -> Result<Vec<u8>, Failure> {
        let command: Command =
            serde_json::from_slice(&self.input).map_err(|error| format!("command: {error}"))?;
        match &mut self.stage {
            Some(Stage::Live(world, Some(recorder))) => recorder.push(world, command)?,
            Some(Stage::Live(world, None)) => world.push(command)?,
            Some(Stage::Played(_)) => return Err("a recording plays: reset it to act on the scene".into()),
            None => return Err("no scene is loaded".into()),
        }
        Ok(Vec::new())
    }

    pub(crate) fn restore(&mut self) -> Result<Vec<u8>, Failure> {
        let world = World::restore(&self.input[..], &Options::default())?;
        self.stage = Some(Stage::Live(Box::new(world), None));
        report::describe(self.world()?)
    }

    pub(crate) fn record(&mut self, every: u32) -> Result<Vec<u8>, Failure> {
        let begun = Recorder::new(self.world()?, (every > 0).then_some(every))?;
        match &mut self.stage {
            Some(Stage::Live(_, recorder)) => *recorder = Some(Box::new(begun)),
            _ => return Err("a recording plays: reset it to record another one".into()),
        }
        Ok(Vec::new())
    }

    pub(crate) fn end_recording(&mut self) -> Result<Vec<u8>, Failure> {
        let Some(Stage::Live(_, recorder)) = &mut self.stage else {
            return Err("nothing is being recorded".into());
        };
        let recorder = recorder.take().ok_or("nothing is being recorded")?;
        if let Some(error) = recorder.lost_key_frame() {
            return Err(format!("a key frame is missing: {error}").into());
        }
        let mut bytes = Vec::new();
        recorder.into_recording().write(&mut bytes)?;
        Ok(bytes)
    }

    pub(crate) fn play(&mut self) -> Result<Vec<u8>, Failure> {
        self.stage = Some(Stage::Played(Box::new(Playing::new(&self.input)?)));
        report::describe(self.world()?)
    }

    /// The bytes of a column; none without a world.
    pub(crate) fn column(&mut self, number: u32) -> &[u8] {
        let mut made = std::mem::take(&mut self.made);
        if let Ok(world) = self.world() {
            columns::make(world, number, &mut made);
        }
        self.made = made;
        self.world().map_or(&[], |world| columns::bytes(world, number, &self.made))
    }
}

/// The scenes of the library.
pub(crate) fn presets() -> Result<Vec<u8>, Failure> {
    let preset =
        |preset: &scene::Preset| json!({ "name": preset.name, "title": preset.title, "text": preset.text });
    let all: Vec<_> = scene::presets().iter().map(preset).collect();
    Ok(serde_json::to_vec(&all)?)
}

/// The schema of scenes.
pub(crate) fn schema() -> Result<Vec<u8>, Failure> {
    Ok(scene::schema().into_bytes())
}

/// The state as a file.
pub(crate) fn save(world: &World) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    world.save(&mut bytes)?;
    Ok(bytes)
}
