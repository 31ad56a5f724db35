//! Neighbour search.

pub mod cells;
pub mod fluid_neighbors;
pub mod neighbors;
pub(crate) mod scan;
mod search;
pub(crate) mod sort;
pub mod sort_fluid;
