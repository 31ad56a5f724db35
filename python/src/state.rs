//! Snapshots, recordings and files of pictures.

use pyo3::prelude::*;
use sorb::{Player, Recording, ReplayError, render::Image};

use crate::{
    error::{OrRaise, exception},
    scene::options,
};

/// A state in memory, to roll back to.
#[pyclass]
#[derive(Debug, Default)]
pub(crate) struct Snapshot(pub(crate) sorb::Snapshot);

#[pymethods]
impl Snapshot {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// Simulated time of the state; none while it is empty.
    fn time(&self) -> Option<f64> {
        self.0.clock().map(|clock| clock.time)
    }
}

/// Plays a recording to its end, and compares every frame; the number of frames.
#[pyfunction]
pub(crate) fn verify(
    py: Python<'_>,
    recording: &[u8],
    threads: Option<usize>,
    simd: Option<&str>,
    backend: &str,
) -> PyResult<u64> {
    let options = options(threads, simd, backend)?;
    let recording = Recording::read(recording).or_raise()?;
    let raise = |error: ReplayError| exception("ReplayError", &error.to_string(), Vec::new());
    let mut player = py.detach(|| Player::new(&recording, &options)).map_err(raise)?;
    while py.detach(|| player.advance()).map_err(raise)? {
        py.check_signals()?;
    }
    Ok(player.frame())
}

/// Writes pixels as a PNG file.
#[pyfunction]
pub(crate) fn write_png(path: std::path::PathBuf, width: u32, height: u32, pixels: Vec<u8>) -> PyResult<()> {
    let image = Image { width, height, pixels };
    image.write_png(&path).map_err(|error| exception("Error", &error.to_string(), Vec::new()))
}
