//! Set-up of sponges: tetragonal disphenoids on a body-centred cubic lattice.
//!
//! A block of `[nx, ny, nz]` cubic cells of edge `a` has two sublattices. Sublattice A is on the cell corners, `A(i,j,k)` with
//! `0 <= i <= nx`. Sublattice B is on the cell centres, `B(i,j,k)` with `0 <= i < nx`. Every tet has one long edge A-A and one long edge
//! B-B, both of length `a` and perpendicular to each other. All tets are therefore congruent, with volume `a^3/12`. A block keeps the tets
//! that lie wholly inside it. Every boundary square is then a pit, a pyramid of depth `a/2` without a tet. The tets fill `1 - 1/n` of the
//! box with `n^3` cells. The tets around a pit stand for it ([`Lattice::tet_weight`]) and its corners have its mass
//! ([`Lattice::node_volume`]). A block then has the weight, stiffness and pore volume of its box. [`SpongeSummary::rest_volume`] is the
//! sum.
//!
//! [`Lattice::new`] packs any number of sponges into one set of rows in an order that the sweeps rely on:
//!
//! - nodes by vertex colour (A even, A odd, B even, B odd; parity of `i + j + k`), then sponge, then `k`, `j`, `i`;
//! - tets by colour (`class * 2 + parity` of their cell), then sponge, then `k`, `j`, `i` of their cell.
//!
//! A class has constant offsets from its cell to its four nodes. In one colour each slot therefore always holds the same vertex colour
//! ([`SLOT_VERTEX_COLOR`]). The node indices of each slot strictly increase from tet to tet. Any range of tets of one colour touches four
//! node ranges, one in each vertex colour. No other tet of that colour touches these nodes. [`chunks`] cuts such ranges.

mod chunk;
mod class;
mod error;
mod grid;
mod lattice;
mod limits;
mod locate;
mod mask;
mod pieces;
mod pits;
mod skin;
#[cfg(feature = "rigid")]
mod solid;
mod surface;
#[cfg(test)]
mod tests;

pub use crate::scene::Axis;
pub use chunk::{TetChunk, chunks};
pub use class::{
    CLASS_FRAME, CLASS_OFFSET, COLORS, SLOT_VERTEX_COLOR, TET_CLASS_COUNT, VERTEX_COLOR_SLOT, VERTEX_COLORS,
};
pub use error::LatticeError;
pub use lattice::{Lattice, LatticeSponge, SpongeSummary};
pub use limits::{MAX_CELLS, MAX_EDGE, MIN_EDGE};
pub(crate) use locate::{Located, TetGrid};
pub use mask::{block, cylinder, ellipsoid};
pub use pieces::{Pieces, pieces};
pub use skin::Skin;
#[cfg(feature = "rigid")]
pub(crate) use solid::solid;
