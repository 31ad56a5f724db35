//! Cells over points: the rows in each part of space.
//!
//! Two schemes with one interface. A *bounded* domain gets a dense grid: rows of cells along x, and inside a
//! row narrow bins, found by counting. An *unbounded* domain gets the scheme of Winchenbach and Kolb [WK20,
//! section 3; the paper, section 3.1]: Morton keys, a sort, a list of the occupied cells, and a hash table of
//! that list, made by a second sort. Coordinates may be negative and far away (2^20 cells from the origin).

mod dense;
mod hashed;

use glam::Vec3;

use self::{dense::Dense, hashed::Hashed};
use crate::{column::ColumnData, cpu::Cpu};

/// The part of space that points lie in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Domain {
    /// A known box \[m\].
    Bounded {
        /// Corner with the smallest coordinates.
        minimum: Vec3,
        /// Corner with the largest coordinates.
        maximum: Vec3,
    },
    /// All of space.
    Unbounded,
}

/// Cells over points.
#[derive(Clone, Debug, Default)]
pub struct Cells {
    /// Source rows in the order of the cells.
    pub(crate) order: Vec<u32>,
    /// Temporary rows and identities of the sort; kept so that a step allocates nothing.
    pub(crate) spare: (Vec<[f32; 4]>, Vec<u32>),
    scheme: Scheme,
    dense: Dense,
    hashed: Hashed,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Scheme {
    #[default]
    Dense,
    Hashed,
}

impl Cells {
    /// Sorts points into cells of edge `support`; `self.order` then holds the order of the rows.
    pub(crate) fn build(&mut self, cpu: &Cpu, points: &[[f32; 4]], support: f32, domain: Domain) {
        self.scheme = match domain {
            Domain::Bounded { minimum, maximum }
                if self.dense.fit(points.len(), support, minimum, maximum) =>
            {
                Scheme::Dense
            }
            _ => Scheme::Hashed,
        };
        match self.scheme {
            Scheme::Dense => self.dense.build(cpu, points, &mut self.order),
            Scheme::Hashed => self.hashed.build(cpu, points, support, &mut self.order),
        }
    }

    /// Replaces `spans` by the runs of sorted rows that may lie in the box. Runs do not overlap, and their order is
    /// a function of the box and the points alone.
    pub(crate) fn spans(&self, low: [f32; 3], high: [f32; 3], spans: &mut Vec<[u32; 2]>) {
        spans.clear();
        match self.scheme {
            Scheme::Dense => self.dense.spans(low, high, spans),
            Scheme::Hashed => self.hashed.spans(low, high, spans),
        }
    }
}

impl ColumnData for Cells {
    fn visit_words(&self, _rows: usize, visit: &mut dyn FnMut(u32)) {
        self.order.iter().for_each(|row| visit(*row));
        match self.scheme {
            Scheme::Dense => self.dense.row_start.iter().for_each(|start| visit(*start)),
            Scheme::Hashed => self.hashed.table.iter().for_each(|entry| visit(entry[0])),
        }
    }
    fn poison(&mut self) {
        self.order.fill(u32::MAX);
        self.dense.row_start.iter_mut().enumerate().for_each(|(row, start)| *start = row as u32 * 3);
        self.dense.bin_start.fill(u32::MAX);
        self.hashed.table.fill([0, 1]);
        self.hashed.cells.fill([u32::MAX - 1, u32::MAX]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{lanes::SimdLevel, testing::random_points};

    fn rows_in_box(cells: &Cells, points: &[[f32; 4]], low: [f32; 3], high: [f32; 3]) -> Vec<u32> {
        let (mut found, mut spans) = (Vec::new(), Vec::new());
        cells.spans(low, high, &mut spans);
        for [begin, end] in spans {
            found.extend_from_slice(&cells.order[begin as usize..end as usize]);
        }
        found.sort_unstable();
        let all = found.len();
        found.dedup();
        assert_eq!(found.len(), all, "spans overlap");
        found
            .retain(|row| (0..3).all(|axis| (low[axis]..=high[axis]).contains(&points[*row as usize][axis])));
        found
    }

    #[test]
    fn both_schemes_find_every_point_of_a_box() {
        let cpu = Cpu::with_threads(SimdLevel::Fallback, 3).expect("the fallback is always there");
        let bounded = Domain::Bounded { minimum: Vec3::splat(-1.0), maximum: Vec3::splat(1.0) };
        for count in [0, 1, 8, 5000] {
            let points = random_points(count, 1.0, 7);
            for domain in [bounded, Domain::Unbounded] {
                let mut cells = Cells::default();
                cpu.enter(|| cells.build(&cpu, &points, 0.1, domain));
                let mut order = cells.order.clone();
                order.sort_unstable();
                assert!(order.iter().enumerate().all(|(row, point)| row == *point as usize));
                for centre in [[0.0_f32; 3], [-0.9, 0.3, 0.99], [0.5, -1.0, 0.2]] {
                    let (low, high) = (centre.map(|x| x - 0.17), centre.map(|x| x + 0.13));
                    let expected: Vec<u32> = (0..count as u32)
                        .filter(|row| {
                            (0..3).all(|axis| (low[axis]..=high[axis]).contains(&points[*row as usize][axis]))
                        })
                        .collect();
                    assert_eq!(rows_in_box(&cells, &points, low, high), expected);
                }
            }
        }
    }

    #[test]
    fn far_away_and_negative_points_are_found_in_an_unbounded_domain() {
        let cpu = Cpu::serial(SimdLevel::Fallback).expect("the fallback is always there");
        let points = [[-5000.0, 3.0, 7000.5, 0.0], [-5000.01, 3.0, 7000.5, 0.0], [1e9, 0.0, -1e9, 0.0]];
        let mut cells = Cells::default();
        cells.build(&cpu, &points, 0.01, Domain::Unbounded);
        let found = rows_in_box(&cells, &points, [-5000.1, 2.9, 7000.0], [-4999.9, 3.1, 7001.0]);
        assert_eq!(found, [0, 1]);
        assert!(rows_in_box(&cells, &points, [5000.0 - 0.1, 2.9, 7000.0], [5000.1, 3.1, 7001.0]).is_empty());
    }

    #[test]
    fn a_grid_that_would_be_too_large_is_hashed() {
        let cpu = Cpu::serial(SimdLevel::Fallback).expect("the fallback is always there");
        let huge = Domain::Bounded { minimum: Vec3::splat(-1e6), maximum: Vec3::splat(1e6) };
        let mut cells = Cells::default();
        cells.build(&cpu, &random_points(100, 1.0, 3), 0.01, huge);
        assert_eq!(cells.scheme, Scheme::Hashed);
    }
}
