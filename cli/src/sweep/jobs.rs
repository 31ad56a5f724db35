//! The runs of a plan.

use std::{path::Path, time::Instant};

use serde::{Deserialize, Serialize};
use sorb::{
    Options, World,
    scene::{Quality, Scene},
};
use toml::Value;
use xxhash_rust::xxh3::Xxh3;

use super::plan::Plan;
use crate::{choice, error::CliError};

/// One run.
#[derive(Clone, Debug)]
pub(super) struct Job {
    /// Its number, from 0.
    pub(super) number: usize,
    /// Its value of every key of the grid.
    pub(super) settings: Vec<Value>,
}

/// What a run leaves: a row of the table.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub(super) struct Row {
    pub(super) run: usize,
    /// Shortest digits that give the same number back: as numbers, a reader of JSON may change the last bit.
    pub(super) measures: Vec<String>,
    /// 16 hexadecimal digits; empty if the run failed.
    pub(super) digest: String,
    pub(super) wall_seconds: f64,
    /// What went wrong; empty if nothing did.
    pub(super) error: String,
}

/// All combinations; the last key varies fastest.
pub(super) fn jobs(plan: &Plan) -> Vec<Job> {
    let mut combinations: Vec<Vec<Value>> = vec![Vec::new()];
    for (_, values) in &plan.grid.0 {
        let with = |start: &Vec<Value>| -> Vec<Vec<Value>> {
            values.iter().map(|value| [start.as_slice(), std::slice::from_ref(value)].concat()).collect()
        };
        combinations = combinations.iter().flat_map(with).collect();
    }
    combinations.into_iter().enumerate().map(|(number, settings)| Job { number, settings }).collect()
}

/// A plan with the scene that it names.
#[derive(Debug)]
pub(super) struct Sweep<'a> {
    path: &'a Path,
    plan: &'a Plan,
    base: Scene,
}

impl<'a> Sweep<'a> {
    /// # Errors
    /// The scene is not there, or wrong.
    pub(super) fn new(path: &'a Path, plan: &'a Plan) -> Result<Self, CliError> {
        // As written in the plan, or beside it.
        let beside = path.parent().map(|folder| folder.join(&plan.scene)).filter(|file| file.is_file());
        let name = beside.and_then(|file| file.to_str().map(str::to_owned));
        let base = choice::named(name.as_ref().unwrap_or(&plan.scene))?;
        Ok(Self { path, plan, base })
    }

    /// The scene of a run: quality, then changes, then resolution, as `sorb run` has them.
    ///
    /// # Errors
    /// A setting is wrong: the text names the file of the plan, the run and its settings.
    pub(super) fn scene(&self, job: &Job) -> Result<Scene, CliError> {
        self.changed(job).map_err(|message| {
            let settings = self.plan.grid.0.iter().zip(&job.settings);
            let settings: Vec<String> =
                settings.map(|((key, _), value)| format!("{key} = {value}")).collect();
            let (path, number) = (self.path.display(), job.number);
            CliError::Usage(format!("{path}: run {number} ({}): {message}", settings.join(", ")))
        })
    }

    fn changed(&self, job: &Job) -> Result<Scene, String> {
        let mut quality = self.plan.quality.clone();
        let mut resolution = self.plan.resolution.unwrap_or(1.0);
        let mut changes = self.plan.set.clone();
        for ((key, _), value) in self.plan.grid.0.iter().zip(&job.settings) {
            match (key.as_str(), value) {
                ("quality", Value::String(name)) => quality = Some(name.clone()),
                ("resolution", Value::Float(factor)) => resolution = *factor,
                ("resolution", Value::Integer(factor)) => resolution = *factor as f64,
                ("quality" | "resolution", other) => {
                    return Err(format!("`{key}` = {other} is a {}", other.type_str()));
                }
                _ => changes.push(format!("{key}={value}")),
            }
        }
        let mut scene = self.base.clone();
        if let Some(name) = quality {
            let quality: Quality = name.parse().map_err(|message| format!("`quality`: {message}"))?;
            scene = scene.with_quality(quality).map_err(|error| error.to_string())?;
        }
        if !changes.is_empty() {
            let changes = changes.iter().map(String::as_str);
            scene = scene.with_overrides(changes).map_err(|error| error.to_string())?;
        }
        scene.scaled(resolution as f32).map_err(|error| error.to_string())
    }

    /// A digest of what the sweep computes: of all scenes, their lengths and the measures. Every mistake in a setting is found here.
    ///
    /// # Errors
    /// As [`Self::scene`].
    pub(super) fn identity(&self, jobs: &[Job]) -> Result<String, CliError> {
        let mut hasher = Xxh3::new();
        for job in jobs {
            let scene = self.scene(job)?;
            hasher.update(scene.to_json()?.as_bytes());
            hasher.update(&self.frames(&scene).to_le_bytes());
        }
        for name in self.plan.grid.0.iter().map(|(key, _)| key).chain(&self.plan.columns()) {
            hasher.update(name.as_bytes());
            hasher.update(&[0]);
        }
        Ok(format!("{:016x}", hasher.digest()))
    }

    /// Frames of a run; the last one ends at the time of the plan or after it.
    fn frames(&self, scene: &Scene) -> u32 {
        self.plan.frames.unwrap_or_else(|| {
            let seconds = self.plan.seconds.unwrap_or_else(|| f64::from(scene.time.duration));
            // Rates and durations have 24 bits: 6000 frames may be 6000.0004.
            (seconds * f64::from(scene.time.frame_rate) - 1e-3).ceil().max(0.0) as u32
        })
    }

    /// Runs. What goes wrong is part of the row.
    pub(super) fn run(&self, job: &Job, options: &Options) -> Row {
        let start = Instant::now();
        let found = self.simulate(job, options);
        let wall_seconds = (start.elapsed().as_secs_f64() * 1e3).round() / 1e3;
        let row = Row {
            run: job.number,
            measures: Vec::new(),
            digest: String::new(),
            wall_seconds,
            error: String::new(),
        };
        match found {
            Ok((measures, digest)) => Row { measures, digest: format!("{digest:016x}"), ..row },
            Err(error) => Row { error: error.to_string(), ..row },
        }
    }

    fn simulate(&self, job: &Job, options: &Options) -> Result<(Vec<String>, u64), CliError> {
        let scene = self.scene(job)?;
        let mut world = World::with_options(&scene, options)?;
        for _ in 0..self.frames(&scene) {
            world.advance_frame().map_err(CliError::Step)?;
        }
        let numbers = self.plan.numbers(&world.measures());
        let measures = numbers.into_iter().map(|(_, value)| format!("{value:?}"));
        Ok((measures.collect(), world.digest()))
    }
}
