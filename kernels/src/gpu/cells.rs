//! Cells over points, as shaders have them.

use glam::Vec3;

use super::groups::GROUP_THREADS;
use crate::{
    grid::cells::Domain,
    layout::{constants, layout},
};

constants! {
    /// Cells of a page, which a group adds up.
    pub(super) const PAGE_CELLS: u32 = 4096;
    /// Pages up to which each adds up those before it.
    pub(super) const ONE_GROUP_PAGES: u32 = GROUP_THREADS;
}

layout! {
    /// Cells over points.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub(super) struct Grid {
        origin: [f32; 3],
        /// One over the edge of a cell.
        inverse_edge: f32,
        /// Cells along every axis, powers of two where the axis wraps.
        size: [u32; 3],
        /// All cells.
        cells: u32,
        /// Axes that wrap.
        wrap: [bool; 3],
        /// Points.
        rows: u32,
    }
}

/// Cells per point up to which a dense grid is worth its prefix sums.
const CELLS_PER_POINT: u64 = 16;
/// Fewest cells of an axis that wraps.
const SMALLEST_TORUS: u32 = 64;

impl Grid {
    /// Cells of half the radius. They are a dense grid over a box. Without a box, or where it has more cells than `most` or than the points
    /// are worth, they are a torus.
    pub(super) fn new(domain: Domain, radius: f32, points: usize, maximum: u64) -> Self {
        let edge = 0.5 * radius;
        let maximum = maximum.min(CELLS_PER_POINT * points as u64).max(u64::from(SMALLEST_TORUS).pow(3));
        let (origin, extent) = match domain {
            Domain::Bounded { minimum, maximum } => (minimum, (maximum - minimum).max(Vec3::ZERO)),
            Domain::Unbounded => (Vec3::ZERO, Vec3::INFINITY),
        };
        let mut size = [0, 1, 2].map(|axis| ((extent[axis] / edge).floor() + 1.0).min(1.0e6) as u32);
        let mut wrap = [false; 3];
        let cells = |size: [u32; 3]| size.iter().map(|size| u64::from(*size)).product::<u64>();
        while cells(size) > maximum {
            let longest = (0..3).max_by_key(|axis| size[*axis]).unwrap_or(0);
            if size[longest] <= SMALLEST_TORUS {
                break;
            }
            wrap[longest] = true;
            // The next smaller power of two.
            size[longest] = (size[longest] - 1).checked_ilog2().map_or(1, |power| 1 << power);
        }
        let (origin, inverse_edge) = (origin.to_array(), 1.0 / edge);
        Self { origin, inverse_edge, size, cells: cells(size) as u32, wrap, rows: points as u32 }
    }

    /// Numbers in a line, for prefix sums over them.
    pub(super) fn line(numbers: usize) -> Self {
        let count = numbers as u32;
        Self {
            origin: [0.0; 3],
            inverse_edge: 1.0,
            size: [count, 1, 1],
            cells: count,
            wrap: [false; 3],
            rows: count,
        }
    }

    /// Pages of cells; the last cell is followed by one more start.
    pub(super) fn pages(&self) -> u64 {
        u64::from(self.cells / PAGE_CELLS + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_is_dense_and_everything_else_a_torus() {
        let domain = Domain::Bounded { minimum: Vec3::ZERO, maximum: Vec3::new(1.0, 0.5, 0.25) };
        let dense = Grid::new(domain, 0.05, 100_000, 1 << 26);
        assert_eq!((dense.size, dense.wrap), ([40, 20, 10].map(|size| size + 1), [false; 3]));
        for torus in [
            Grid::new(Domain::Unbounded, 0.05, 1_000_000, 1 << 26),
            Grid::new(Domain::Unbounded, 0.05, 0, 1),
            Grid::new(domain, 0.001, 100_000, 1 << 20),
        ] {
            assert!(torus.wrap.contains(&true), "{torus:?}");
            for axis in (0..3).filter(|axis| torus.wrap[*axis]) {
                assert!(torus.size[axis].is_power_of_two() && torus.size[axis] >= 64, "{torus:?}");
            }
        }
    }
}
