//! Arguments of `sorb run`.

use std::path::PathBuf;

use sorb::{
    render::View,
    scene::{Scene, SceneError, Time},
};

use crate::{choice::Changes, export::Format, machine::Machine};

/// Arguments of `sorb run`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Name of a scene that comes with the program (see `sorb scenes`), or path of a .toml or .json file
    #[arg(required_unless_present = "from")]
    scene: Option<String>,
    #[command(flatten)]
    pub(super) changes: Changes,
    /// Continues the run that left this save, with its scene: results and tables are as if nothing had interrupted it
    #[arg(long, value_name = "SAVE", conflicts_with_all = ["scene", "quality", "set", "resolution"])]
    pub(super) from: Option<PathBuf>,
    /// Writes the state to the folder of the results whenever this time has passed in the scene, in s: `state.sorb`
    #[arg(long, value_name = "SECONDS", value_parser = interval)]
    pub(super) save_every: Option<f64>,
    #[command(flatten)]
    length: Length,
    #[command(flatten)]
    pub(super) machine: Machine,
    /// Folder for the results, by default out/SCENE; an earlier run in it is replaced
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    pub(super) drawing: Drawing,
    /// Writes frames for other programs to the folder `export` of the results, in these formats, separated by commas
    #[arg(long, value_name = "FORMATS", value_delimiter = ',')]
    pub(super) export: Vec<Format>,
    /// With --export: frames from an exported one to the next, at least 1
    #[arg(long, value_name = "N", default_value_t = 1, requires = "export", value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) export_every: u32,
    /// Prints the summary as a JSON object to standard output, and nothing else
    #[arg(long)]
    pub(super) json: bool,
    /// Prints neither progress nor a final report
    #[arg(long)]
    pub(super) quiet: bool,
}

/// Width and height in pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Size(pub(crate) u32, pub(crate) u32);

/// Name of a view.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub(crate) enum ViewName {
    /// Rays from the eye: refraction, reflection, absorption and soft shadows
    Realistic,
    /// Surfaces by the depth of the particles, in about half of the time
    Fast,
    /// Particles of the water
    Particles,
    /// Nodes of the sponges
    Nodes,
    /// Surfaces of water and sponges that let light through
    Superimposed,
    /// Saturation of the sponges, as a colour map
    Saturation,
    /// Pressure of the particles, as a colour map
    Pressure,
    /// Speed of the particles, as a colour map
    Speed,
    /// A section through the sponges, with the water in them
    Cutaway,
}

/// Length of a run.
#[derive(Debug, clap::Args)]
pub(crate) struct Length {
    /// Number of frames to simulate; by default as many as fill the scene's `time.duration`
    #[arg(long, value_name = "N", conflicts_with = "time")]
    frames: Option<u32>,
    /// Time to simulate in s, rounded to whole frames
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    time: Option<f64>,
}

/// Which pictures are drawn.
#[derive(Debug, clap::Args)]
pub(crate) struct Drawing {
    /// Draws PNG frames and a film (MP4)
    #[arg(long)]
    pub(crate) pictures: bool,
    /// With --pictures: an animated PNG as well, which web browsers play
    #[arg(long, requires = "pictures")]
    pub(crate) animation: bool,
    /// Pictures per simulated second, at most; the film plays at the speed of the simulated world
    #[arg(long, value_name = "RATE", default_value_t = 30.0, value_parser = picture_rate)]
    pub(crate) picture_rate: f32,
    #[command(flatten)]
    pub(crate) picture: Picture,
}

/// What pictures look like.
#[derive(Debug, clap::Args)]
pub(crate) struct Picture {
    /// Size of the pictures in pixels, each side 16 to 8192 (of films 3840)
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = size)]
    pub(crate) size: Size,
    /// What the pictures show
    #[arg(long, value_name = "VIEW", default_value = "realistic")]
    pub(crate) view: ViewName,
    /// Follows small motions slowly, so that what is at rest does not flicker; a picture then depends on those before it
    #[arg(long)]
    pub(crate) steady: bool,
}

impl Length {
    /// Number of frames to simulate.
    pub(crate) fn frames(&self, scene: &Scene) -> u32 {
        let Time { frame_rate, duration, .. } = scene.time;
        self.frames.unwrap_or_else(|| {
            let seconds = self.time.unwrap_or_else(|| f64::from(duration));
            (seconds * f64::from(frame_rate)).round() as u32
        })
    }
}

impl Arguments {
    /// The scene of the arguments; none for one that continues a run.
    pub(super) fn load(&self) -> Result<Option<Scene>, SceneError> {
        self.scene.as_ref().map(|name| self.changes.load(name)).transpose()
    }

    /// Number of frames to simulate after those that are done: by default the rest of the scene's `time.duration`.
    pub(super) fn frames(&self, scene: &Scene, done: u32) -> u32 {
        let frames = self.length.frames(scene);
        let is_given = self.length.frames.is_some() || self.length.time.is_some();
        if is_given { frames } else { frames.saturating_sub(done) }
    }

    /// The out folder.
    pub(super) fn folder(&self, scene: &Scene) -> PathBuf {
        self.out.clone().unwrap_or_else(|| PathBuf::from("out").join(&scene.name))
    }
}

impl From<ViewName> for View {
    fn from(name: ViewName) -> Self {
        match name {
            ViewName::Realistic => Self::Realistic,
            ViewName::Fast => Self::Fast,
            ViewName::Particles => Self::Particles,
            ViewName::Nodes => Self::Nodes,
            ViewName::Superimposed => Self::Superimposed,
            ViewName::Saturation => Self::Saturation,
            ViewName::Pressure => Self::Pressure,
            ViewName::Speed => Self::Speed,
            ViewName::Cutaway => Self::Cutaway,
        }
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    ranged(text, 0.0, 1e5).ok_or_else(|| "expected a number from 0 to 100000 s".to_owned())
}

fn interval(text: &str) -> Result<f64, String> {
    ranged(text, 1e-3, 1e5).ok_or_else(|| "expected a number from 0.001 to 100000 s".to_owned())
}

fn picture_rate(text: &str) -> Result<f32, String> {
    number(text, 0.1, 1e3, "1/s")
}

/// A number in a range, in a unit.
///
/// # Errors
/// The text is no number, or it is out of the range.
pub(crate) fn number(text: &str, minimum: f64, maximum: f64, unit: &str) -> Result<f32, String> {
    let number = ranged(text, minimum, maximum).map(|number| number as f32);
    number
        .ok_or_else(|| format!("expected a number from {minimum} to {maximum} {unit}").trim_end().to_owned())
}

/// A number in a range; `nan` is in no range.
fn ranged(text: &str, minimum: f64, maximum: f64) -> Option<f64> {
    let number: f64 = text.parse().ok()?;
    (minimum..=maximum).contains(&number).then_some(number)
}

pub(crate) fn size(text: &str) -> Result<Size, String> {
    let side = |text: &str| text.parse().ok().filter(|side| (16..=8192).contains(side));
    text.split_once('x')
        .and_then(|(width, height)| Some(Size(side(width)?, side(height)?)))
        .ok_or_else(|| "expected WIDTHxHEIGHT such as 1280x720, each 16 to 8192".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_rates_have_ranges() {
        assert!(size("640x360").is_ok());
        for bad in ["640", "640x", "0x360", "640x9000", "-640x360", "640X360", "1e3x20"] {
            assert!(size(bad).is_err(), "{bad}");
        }
        assert!(picture_rate("30").is_ok() && seconds("0").is_ok());
        for bad in ["nan", "inf", "-1", "", "1e9"] {
            assert!(picture_rate(bad).is_err() && seconds(bad).is_err(), "{bad}");
        }
    }
}
