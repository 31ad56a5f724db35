//! The progress bar.

use std::{
    io::{self, IsTerminal},
    time::Duration,
};

use indicatif::{ProgressBar, ProgressStyle};
use sorb::{FrameReport, scene::Scene};

const TEMPLATE: &str = "{prefix} {bar:30} {percent:>3} %  {msg}  {eta} left";

/// A bar on standard error with the simulated time, the speed and the bound of the step; none where standard error is no
/// terminal.
#[derive(Debug)]
pub(super) struct Progress {
    bar: ProgressBar,
    duration: f64,
}

impl Progress {
    pub(super) fn new(scene: &Scene, frames: u32, quiet: bool) -> Self {
        let bar = if quiet || !io::stderr().is_terminal() {
            ProgressBar::hidden()
        } else {
            ProgressBar::new(frames.into())
        };
        let style = ProgressStyle::with_template(TEMPLATE).unwrap_or_else(|_| ProgressStyle::default_bar());
        bar.set_style(style.progress_chars("=> "));
        bar.set_prefix(scene.name.clone());
        Self { bar, duration: f64::from(frames) / f64::from(scene.time.frame_rate) }
    }

    /// Shows the state after a frame.
    pub(super) fn frame(&self, report: &FrameReport, wall: Duration) {
        let speed = f64::from(report.steps) / wall.as_secs_f64().max(1e-9);
        self.bar.set_message(format!(
            "{:.2} of {:.2} s  {speed:.0} steps/s, limited by {}",
            report.time,
            self.duration,
            report.bound.name()
        ));
        self.bar.inc(1);
    }

    /// Removes the bar.
    pub(super) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
