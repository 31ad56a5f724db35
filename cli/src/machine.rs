//! What a command runs on.

use sorb::{Offload, Options, SimdLevel};

/// Threads, SIMD level and backend.
#[derive(Debug, clap::Args)]
pub(crate) struct Machine {
    /// Number of threads, 1 to 1024, by default one per core; results do not depend on it
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// SIMD level: auto, fallback, sse4.2, avx2, avx512 or neon; results do not depend on it
    #[arg(long, value_name = "LEVEL", default_value = "auto", value_parser = simd, hide_possible_values = true)]
    simd: Simd,
    /// Where to run: cpu, gpu, auto (a GPU for large scenes), from:KERNEL (that kernel and all after it on the GPU), or
    /// each:NAME=PLACE,.. where a name is a kernel, a family or all, and a place is cpu or gpu
    #[arg(long, value_name = "BACKEND", default_value = "cpu")]
    backend: Offload,
    /// Measures the time of every kernel on the GPU, which makes its steps a little longer
    #[cfg(feature = "gpu")]
    #[arg(long)]
    gpu_times: bool,
}

impl Machine {
    /// Options of a world.
    pub(crate) fn options(&self) -> Options {
        Options {
            threads: self.threads,
            simd: self.simd.0,
            offload: self.backend.clone(),
            #[cfg(feature = "gpu")]
            gpu_times: self.gpu_times,
            ..Options::default()
        }
    }
}

/// A level, or none for the best one of the machine.
#[derive(Clone, Copy, Debug)]
struct Simd(Option<SimdLevel>);

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
