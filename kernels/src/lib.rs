//! How a phase of sorb computes: columns, kernel table, CPU bodies and oracles.
//!
//! One file per kernel. A kernel's name is its path: `sph::density` is `sph/density.rs`. It declares what it
//! reads and writes, and has a body for the CPU that is generic over the SIMD level and runs on fixed chunks of
//! rows; its oracle, a brute-force loop in f64, is in `oracle` (tests and feature `oracles`). Kernels know no scene, and no other kernel.

pub mod asleep;
pub mod body;
pub mod columns;
pub mod couple;
pub mod cpu;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod grid;
pub mod kernel;
mod lanes;
pub mod need;
#[cfg(any(test, feature = "oracles"))]
pub mod oracle;
pub mod params;
pub mod pbd;
pub mod periodic;
pub mod reduce;
pub mod smoothing;
pub mod sph;
mod sweep;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
mod vector;

pub use lanes::{LANES, SimdLevel};
