//! Ranges of the numbers of a sponge.

use glam::DVec3;

use super::error::LatticeError;
use super::lattice::LatticeSponge;

/// Smallest edge of a lattice \[m\].
pub const MIN_EDGE: f32 = 1.0e-6;

/// Largest edge of a lattice \[m\].
pub const MAX_EDGE: f32 = 1.0e3;

/// Largest number of cells of the blocks of all sponges together (512^3); the set-up takes about ten bytes a cell.
pub const MAX_CELLS: u64 = 1 << 27;

// A block of N cells has at most 9 N sites, 12 N tets and 24 N faces. All rows then fit into 32 bits, with one value left
// for unused sites.
const _: () = assert!(24 * MAX_CELLS < u32::MAX as u64);

/// Checks all sponges before anything is allocated for them.
pub(super) fn check(sponges: &[LatticeSponge<'_>]) -> Result<(), LatticeError> {
    let mut total: u64 = 0;
    for (sponge, &LatticeSponge { edge, cells, origin, .. }) in sponges.iter().enumerate() {
        if !(MIN_EDGE..=MAX_EDGE).contains(&edge) {
            return Err(LatticeError::Edge { sponge, value: edge });
        }
        if cells.contains(&0) {
            return Err(LatticeError::NoCells { sponge, value: cells });
        }
        let product = cells.iter().fold(1_u64, |product, &n| product.saturating_mul(u64::from(n)));
        total = total.saturating_add(product);
        if total > MAX_CELLS {
            return Err(LatticeError::TooManyCells { sponge, value: cells, total });
        }
        if !origin.is_finite() {
            return Err(LatticeError::Origin { sponge, value: origin });
        }
        let size = DVec3::from_array(cells.map(f64::from)) * f64::from(edge);
        let low = origin.as_dvec3();
        let reach = low.abs().max((low + size).abs()).max_element();
        // A coordinate may be off by half a unit in the last place. This keeps the strain at rest near one per cent.
        let limit = f64::from(edge) / (64.0 * f64::from(f32::EPSILON));
        if reach > limit {
            return Err(LatticeError::Reach { sponge, reach, edge, limit });
        }
    }
    Ok(())
}
