//! Tests of the kernel table: every kernel against its oracle, its declaration, and physics.

mod audit;
mod compare;
mod descent;
mod divergence;
mod drag;
#[cfg(feature = "gpu")]
pub(crate) mod gpu;
mod imports;
mod lattice;
mod levels;
mod momentum;
mod oracles;
mod periodic;
pub(crate) mod scene;
mod strain;
mod viscosity;
mod wetting;
