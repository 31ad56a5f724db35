//! Wall-clock time for measurements.

#[cfg(not(all(target_arch = "wasm32", target_os = "unknown")))]
use std::time::Instant;

/// Time since a start. A WebAssembly module has no clock: there it is 0, and the host measures.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stopwatch(#[cfg(not(all(target_arch = "wasm32", target_os = "unknown")))] Instant);

impl Stopwatch {
    pub(crate) fn start() -> Self {
        Self(
            #[cfg(not(all(target_arch = "wasm32", target_os = "unknown")))]
            Instant::now(),
        )
    }

    /// Seconds since the start.
    pub(crate) fn seconds(self) -> f64 {
        #[cfg(not(all(target_arch = "wasm32", target_os = "unknown")))]
        return self.0.elapsed().as_secs_f64();
        #[cfg(all(target_arch = "wasm32", target_os = "unknown"))]
        0.0
    }
}
