//! Arguments of `sorb run`.

use std::path::PathBuf;

use sorb::{
    Offload, SimdLevel,
    render::Style,
    scene::{Scene, Time},
};

use crate::choice::Choice;

/// Arguments of `sorb run`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(super) choice: Choice,
    /// Number of frames to simulate; by default as many as fill the scene's `time.duration`
    #[arg(long, value_name = "N", conflicts_with = "time")]
    frames: Option<u32>,
    /// Time to simulate in s, rounded to whole frames
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    time: Option<f64>,
    /// Number of threads, 1 to 1024, by default one per core; results do not depend on it
    #[arg(long, value_name = "N")]
    pub(super) threads: Option<usize>,
    /// SIMD level: auto, fallback, sse2, sse4.2, avx2, avx512 or neon; results do not depend on it
    #[arg(long, value_name = "LEVEL", default_value = "auto", value_parser = simd, hide_possible_values = true)]
    pub(super) simd: Simd,
    /// Where to run: cpu, gpu, auto (a GPU for large scenes), from:KERNEL (that kernel and all after it on the GPU), or
    /// each:NAME=PLACE,.. where a name is a kernel, a family or all, and a place is cpu or gpu
    #[arg(long, value_name = "BACKEND", default_value = "cpu")]
    pub(super) backend: Offload,
    /// Measures the time of every kernel on the GPU, which makes its steps a little longer
    #[cfg(feature = "gpu")]
    #[arg(long)]
    pub(super) gpu_times: bool,
    /// Folder for the results, by default out/SCENE; an earlier run in it is replaced
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Draws PNG frames and an animated PNG (APNG, which web browsers play)
    #[arg(long)]
    pub(super) pictures: bool,
    /// Pictures per simulated second, at most; the animation plays at the speed of the simulated world
    #[arg(long, value_name = "RATE", default_value_t = 30.0, value_parser = picture_rate)]
    pub(super) picture_rate: f32,
    /// Size of the pictures in pixels, each side 16 to 8192
    #[arg(long, value_name = "WxH", default_value = "640x360", value_parser = size)]
    pub(super) size: Size,
    /// Style of the water
    #[arg(long, value_name = "STYLE", default_value = "spheres")]
    pub(super) style: StyleName,
    /// Prints the summary as a JSON object to standard output, and nothing else
    #[arg(long)]
    pub(super) json: bool,
    /// Prints neither progress nor a final report
    #[arg(long)]
    pub(super) quiet: bool,
}

/// A level, or none for the best one of the machine.
#[derive(Clone, Copy, Debug)]
pub(super) struct Simd(pub(super) Option<SimdLevel>);

/// Width and height in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Size(pub(super) u32, pub(super) u32);

/// Name of a style of the water.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub(super) enum StyleName {
    /// Every particle is a droplet
    Spheres,
    /// The water is one transparent surface
    Surface,
}

impl Arguments {
    /// Number of frames to simulate.
    pub(super) fn frames(&self, scene: &Scene) -> u32 {
        let Time { frame_rate, duration, .. } = scene.time;
        self.frames.unwrap_or_else(|| {
            let seconds = self.time.unwrap_or_else(|| f64::from(duration));
            (seconds * f64::from(frame_rate)).round() as u32
        })
    }

    /// The out folder.
    pub(super) fn folder(&self, scene: &Scene) -> PathBuf {
        self.out.clone().unwrap_or_else(|| PathBuf::from("out").join(&scene.name))
    }
}

impl From<StyleName> for Style {
    fn from(name: StyleName) -> Self {
        match name {
            StyleName::Spheres => Self::Spheres,
            StyleName::Surface => Self::Surface,
        }
    }
}

/// Refuses unknown names and levels that the machine lacks.
fn simd(name: &str) -> Result<Simd, String> {
    if name == "auto" {
        return Ok(Simd(None));
    }
    let names = |levels: &mut dyn Iterator<Item = SimdLevel>| {
        levels.map(SimdLevel::name).collect::<Vec<_>>().join(", ")
    };
    let level = SimdLevel::from_name(name)
        .ok_or_else(|| format!("no such level; levels: auto, {}", names(&mut SimdLevel::ALL.into_iter())))?;
    if level.is_supported() {
        Ok(Simd(Some(level)))
    } else {
        let supported = names(&mut SimdLevel::ALL.into_iter().filter(|level| level.is_supported()));
        Err(format!("not supported by this machine; supported: {supported}"))
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    ranged(text, 0.0, 1e5).ok_or_else(|| "expected a number from 0 to 100000 s".to_owned())
}

fn picture_rate(text: &str) -> Result<f32, String> {
    let rate = ranged(text, 0.1, 1e3);
    rate.map(|rate| rate as f32).ok_or_else(|| "expected a number from 0.1 to 1000 1/s".to_owned())
}

/// A number in a range; `nan` is in no range.
fn ranged(text: &str, minimum: f64, maximum: f64) -> Option<f64> {
    let number: f64 = text.parse().ok()?;
    (minimum..=maximum).contains(&number).then_some(number)
}

fn size(text: &str) -> Result<Size, String> {
    let side = |text: &str| text.parse().ok().filter(|side| (16..=8192).contains(side));
    text.split_once('x')
        .and_then(|(width, height)| Some(Size(side(width)?, side(height)?)))
        .ok_or_else(|| "expected WIDTHxHEIGHT such as 640x360, each 16 to 8192".to_owned())
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
