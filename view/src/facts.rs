//! What the simulation thread tells the window, and what is left of it at the end.

use std::{collections::BTreeMap, fmt};

use sorb::{StepError, glam::Vec3};

use crate::{orbit::Orbit, parameters::Parameter, session::Advance};

/// What the simulation thread tells the window.
#[derive(Clone, Debug, Default)]
pub struct Facts {
    /// Name of the scene; empty until it is built.
    pub name: String,
    /// Its title.
    pub title: String,
    /// The camera of the scene.
    pub camera: Option<Orbit>,
    /// Simulated time \[s\].
    pub time: f64,
    /// Frames so far, and steps.
    pub frames: u64,
    /// Steps so far.
    pub steps: u64,
    /// Frames a simulated second.
    pub frame_rate: f32,
    /// What the last frame took.
    pub last: Option<Advance>,
    /// Simulated over real time in the last second; none unless it runs.
    pub ratio: Option<f64>,
    /// Whether it runs.
    pub runs: bool,
    /// The present frame of a recording that plays, and its last one.
    pub played: Option<(u64, u64)>,
    /// Particles of water, and those in sponges.
    pub particles: (u64, u64),
    /// Real time of a simulated frame \[ms\], and of its phases, the longest first.
    pub frame_ms: f64,
    /// Phases that ran, by the time that they took in a frame \[ms\].
    pub phases: Vec<(&'static str, f64)>,
    /// Phases that do not run, and why.
    pub skipped: Vec<(&'static str, &'static str)>,
    /// Names of the sponges.
    pub sponges: Vec<String>,
    /// Saturation of every sponge \[1\] at times \[s\].
    pub saturations: Vec<(f64, Vec<f32>)>,
    /// Sliders.
    pub parameters: Vec<Parameter>,
    /// How often the sliders were made anew.
    pub epoch: u64,
    /// Whether changes of the scene wait for a reset.
    pub waits: bool,
    /// What the hand holds: number of the question, place and name.
    pub held: Option<(u64, Option<(Vec3, String)>)>,
    /// What was refused last.
    pub note: Option<String>,
    /// Why the world goes no further.
    pub failure: Option<String>,
    /// Threads, SIMD level and backend.
    pub machine: String,
    /// Whether all frames that were asked for are done.
    pub is_done: bool,
}

/// What a window did.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Name of the scene.
    pub name: String,
    /// Frames since the last reset.
    pub frames: u64,
    /// Simulated time \[s\].
    pub time: f64,
    /// Digest of the state.
    pub digest: u64,
    /// Commands that the world took, by their names.
    pub commands: BTreeMap<&'static str, u64>,
    /// Pictures that were shown.
    pub pictures: u64,
    /// Why the world went no further.
    pub failure: Option<StepError>,
}

impl fmt::Display for Report {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, frames, time, digest, commands, pictures, .. } = self;
        let told: Vec<String> = commands.iter().map(|(name, count)| format!("{count} {name}")).collect();
        let told = if told.is_empty() { "none".to_owned() } else { told.join(", ") };
        write!(
            out,
            "{name}: {frames} frames, {time:.3} s, {pictures} pictures, commands: {told}, digest {digest:016x}"
        )
    }
}
