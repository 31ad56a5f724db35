//! Errors in a list of sponges.

use glam::Vec3;

use super::limits::{MAX_CELLS, MAX_EDGE, MIN_EDGE};

/// Why a list of sponges could not be turned into a lattice; `sponge` is the index in that list.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LatticeError {
    /// The edge is not a number or outside its range.
    #[error("sponges[{sponge}]: edge = {value} m is outside [{MIN_EDGE}, {MAX_EDGE}] m")]
    Edge {
        /// Index of the sponge.
        sponge: usize,
        /// The edge as given \[m\].
        value: f32,
    },
    /// A number of cells is zero.
    #[error("sponges[{sponge}]: cells = {value:?}: each must be at least 1")]
    NoCells {
        /// Index of the sponge.
        sponge: usize,
        /// The numbers of cells as given.
        value: [u32; 3],
    },
    /// The blocks of all sponges together have too many cells.
    #[error(
        "sponges[{sponge}]: cells = {value:?} brings all sponges to {total} cells; at most {MAX_CELLS} are allowed"
    )]
    TooManyCells {
        /// Index of the first sponge that does not fit.
        sponge: usize,
        /// The numbers of cells as given.
        value: [u32; 3],
        /// Cells of all sponges up to this one.
        total: u64,
    },
    /// A coordinate of the origin is infinite or not a number.
    #[error("sponges[{sponge}]: origin = {value} m must be finite")]
    Origin {
        /// Index of the sponge.
        sponge: usize,
        /// The origin as given \[m\].
        value: Vec3,
    },
    /// The block lies so far out that rounding in single precision would distort its tets.
    #[error(
        "sponges[{sponge}]: origin: the block reaches {reach} m from the world's origin, where single precision \
         cannot resolve edge = {edge} m; the reach must be at most {limit} m"
    )]
    Reach {
        /// Index of the sponge.
        sponge: usize,
        /// Largest coordinate of the block \[m\].
        reach: f64,
        /// The edge as given \[m\].
        edge: f32,
        /// Largest reach for this edge \[m\].
        limit: f64,
    },
    /// No tet is left, because the block is too small, or the mask or bodies leave nothing.
    #[error(
        "sponges[{sponge}]: shape and bodies leave none of the {candidates} tets of cells = {cells:?} (a block of one \
         cell has none)"
    )]
    Empty {
        /// Index of the sponge.
        sponge: usize,
        /// The numbers of cells as given.
        cells: [u32; 3],
        /// Tets wholly inside the block, before the mask.
        candidates: u32,
    },
}
