//! Cells over points: which rows lie in which part of space.
//!
//! Two schemes with one interface. A *bounded* domain gets a dense grid: rows of cells along x, and inside a
//! row narrow bins, found by counting. An *unbounded* domain gets the scheme of Winchenbach and Kolb [WK20,
//! section 3; the paper, section 3.1]: Morton keys, a sort, a list of the occupied cells, and a hash table of
//! that list, made by a second sort. Coordinates may be negative and far away (2^20 cells from the origin).

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use glam::Vec3;

use super::{scan, sort::Sort};
use crate::{columns::ColumnData, cpu::Cpu};

/// Bins of a row per support radius.
const BINS: f32 = 4.0;
/// Rows of a chunk of the counting sort.
const COUNT_CHUNK: usize = 4096;
/// Most bins that a dense grid may have, and most row counters over all chunks.
const BIN_LIMIT: u64 = 1 << 26;
/// Cells on either side of the origin of an unbounded domain.
const CELL_LIMIT: f32 = (1 << 20) as f32;

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
    /// Rows and identities on their way to the new order; kept so that a step allocates nothing.
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

    /// Replaces `spans` by the runs of sorted rows that may lie in the box; runs do not overlap, and their order is
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

/// Rows of cells along x with narrow bins inside, over a box.
#[derive(Debug, Default)]
struct Dense {
    origin: [f32; 3],
    /// One over the size of a bin in x and of a cell in y and z.
    scale: [f32; 3],
    /// Bins in x, cells in y and z.
    size: [usize; 3],
    /// (row, bin) of every point.
    place: Vec<[u32; 2]>,
    /// Points of a row, per chunk of points; then where the chunk's points of that row begin.
    counts: Vec<u32>,
    by_row: Vec<AtomicU32>,
    row_start: Vec<u32>,
    /// `size[0] + 1` starts per row; not set for empty rows.
    bin_start: Vec<u32>,
}

impl Clone for Dense {
    fn clone(&self) -> Self {
        Self {
            place: Vec::new(),
            counts: Vec::new(),
            by_row: Vec::new(),
            row_start: self.row_start.clone(),
            bin_start: self.bin_start.clone(),
            ..*self
        }
    }
}

impl Dense {
    /// Sets the size; false if the grid would be too large.
    fn fit(&mut self, points: usize, support: f32, minimum: Vec3, maximum: Vec3) -> bool {
        let extent = (maximum - minimum).max(Vec3::ZERO).to_array();
        let cell = [support / BINS, support, support];
        let mut size = [0; 3];
        for axis in 0..3 {
            let cells = (extent[axis] / cell[axis]).floor() + 1.0;
            if !cells.is_finite() || cells > BIN_LIMIT as f32 {
                return false;
            }
            size[axis] = cells as usize;
        }
        let rows = size[1] as u64 * size[2] as u64;
        let chunks = points.div_ceil(COUNT_CHUNK) as u64;
        if rows * size[0] as u64 > BIN_LIMIT || rows * chunks > BIN_LIMIT {
            return false;
        }
        self.origin = minimum.to_array();
        self.scale = cell.map(|cell| 1.0 / cell);
        self.size = size;
        true
    }

    fn coordinate(&self, axis: usize, value: f32) -> usize {
        // A cast saturates: whatever lies outside is kept in the outermost cell, NaN in the first.
        (((value - self.origin[axis]) * self.scale[axis]) as usize).min(self.size[axis] - 1)
    }

    fn build(&mut self, cpu: &Cpu, points: &[[f32; 4]], order: &mut Vec<u32>) {
        let rows = self.size[1] * self.size[2];
        self.count_rows(cpu, points, rows);
        self.scatter_rows(cpu, points.len(), rows);
        order.resize(points.len(), 0);
        let mut bin_start = std::mem::take(&mut self.bin_start);
        bin_start.resize(rows * (self.size[0] + 1), 0);
        self.sort_rows(cpu, cpu.threads(), 0..rows, &mut bin_start, order);
        self.bin_start = bin_start;
    }

    /// Places of the points, and how many points of a row every chunk has.
    fn count_rows(&mut self, cpu: &Cpu, points: &[[f32; 4]], rows: usize) {
        let chunks = points.len().div_ceil(COUNT_CHUNK);
        let mut place = std::mem::take(&mut self.place);
        let mut counts = std::mem::take(&mut self.counts);
        place.resize(points.len(), [0; 2]);
        counts.clear();
        counts.resize(rows * chunks, 0);
        let this = &*self;
        cpu.for_chunks_of(COUNT_CHUNK, &mut place[..], |first, place| {
            for (place, point) in place.iter_mut().zip(&points[first..]) {
                let (y, z) = (this.coordinate(1, point[1]), this.coordinate(2, point[2]));
                *place = [(z * this.size[1] + y) as u32, this.coordinate(0, point[0]) as u32];
            }
        });
        cpu.for_chunks_of(rows.max(1), &mut counts[..], |first, counts| {
            let begin = first / rows.max(1) * COUNT_CHUNK;
            let end = place.len().min(begin + COUNT_CHUNK);
            place[begin..end].iter().for_each(|place| counts[place[0] as usize] += 1);
        });
        (self.place, self.counts) = (place, counts);
    }

    /// Points ordered by row, stable.
    fn scatter_rows(&mut self, cpu: &Cpu, points: usize, rows: usize) {
        self.row_start.resize(rows + 1, 0);
        let mut sum = 0;
        for row in 0..rows {
            self.row_start[row] = sum;
            for counts in self.counts.chunks_exact_mut(rows) {
                let next = sum + counts[row];
                counts[row] = sum;
                sum = next;
            }
        }
        self.row_start[rows] = sum;
        self.by_row.resize_with(points, AtomicU32::default);
        let (place, by_row) = (&self.place, &self.by_row);
        cpu.for_chunks_of(rows.max(1), &mut self.counts[..], |first, offsets| {
            let begin = first / rows.max(1) * COUNT_CHUNK;
            let end = place.len().min(begin + COUNT_CHUNK);
            for (point, place) in place[begin..end].iter().enumerate() {
                let offset = &mut offsets[place[0] as usize];
                // Every slot is written once; atomics only tell the compiler that threads do not collide.
                by_row[*offset as usize].store((begin + point) as u32, Relaxed);
                *offset += 1;
            }
        });
    }

    /// Sorts the points of every row by bin, rows in parallel.
    fn sort_rows(
        &self,
        cpu: &Cpu,
        parts: usize,
        rows: std::ops::Range<usize>,
        bin_start: &mut [u32],
        order: &mut [u32],
    ) {
        if parts <= 1 || rows.len() <= 1 {
            return self.sort_rows_serial(rows, bin_start, order);
        }
        let first = self.row_start[rows.start];
        let points = self.row_start[rows.end] - first;
        let target = first + (u64::from(points) * (parts as u64 / 2) / parts as u64) as u32;
        let middle =
            rows.start + self.row_start[rows.start..rows.end].partition_point(|start| *start < target);
        let (left_bins, right_bins) = bin_start.split_at_mut((middle - rows.start) * (self.size[0] + 1));
        let (left_order, right_order) = order.split_at_mut((self.row_start[middle] - first) as usize);
        cpu.join(
            || self.sort_rows(cpu, parts / 2, rows.start..middle, left_bins, left_order),
            || self.sort_rows(cpu, parts - parts / 2, middle..rows.end, right_bins, right_order),
        );
    }

    fn sort_rows_serial(&self, rows: std::ops::Range<usize>, bin_start: &mut [u32], order: &mut [u32]) {
        let width = self.size[0] + 1;
        let first = self.row_start[rows.start];
        for row in rows.clone() {
            let (begin, end) = (self.row_start[row], self.row_start[row + 1]);
            if begin == end {
                continue;
            }
            let points = &self.by_row[begin as usize..end as usize];
            let starts = &mut bin_start[(row - rows.start) * width..][..width];
            starts.fill(0);
            for point in points {
                starts[self.place[point.load(Relaxed) as usize][1] as usize] += 1;
            }
            let mut sum = begin;
            for start in starts.iter_mut() {
                sum += *start;
                *start = sum;
            }
            // From the back, so that starts end up where their bins begin and the order is kept.
            for point in points.iter().rev() {
                let point = point.load(Relaxed);
                let start = &mut starts[self.place[point as usize][1] as usize];
                *start -= 1;
                order[(*start - first) as usize] = point;
            }
        }
    }

    fn spans(&self, low: [f32; 3], high: [f32; 3], spans: &mut Vec<[u32; 2]>) {
        let from = [0, 1, 2].map(|axis| self.coordinate(axis, low[axis]));
        let to = [0, 1, 2].map(|axis| self.coordinate(axis, high[axis]));
        for z in from[2]..=to[2] {
            for y in from[1]..=to[1] {
                let row = z * self.size[1] + y;
                if self.row_start[row] == self.row_start[row + 1] {
                    continue;
                }
                let starts = &self.bin_start[row * (self.size[0] + 1)..][..=self.size[0]];
                let (begin, end) = (starts[from[0]], starts[to[0] + 1]);
                if begin < end {
                    spans.push([begin, end]);
                }
            }
        }
    }
}

/// The scheme of Winchenbach and Kolb for an unbounded domain.
#[derive(Clone, Debug, Default)]
struct Hashed {
    scale: f32,
    keys: Vec<u64>,
    /// Morton keys in the order of the cells of the list.
    cell_keys: Vec<u64>,
    /// Occupied cells, ordered by hash: first and last row.
    cells: Vec<[u32; 2]>,
    /// First and last cell of every hash.
    table: Vec<[u32; 2]>,
    flags: Vec<u32>,
    page_sums: Vec<u32>,
    hashes: Vec<u64>,
    cell_order: Vec<u32>,
    sort: Sort,
}

impl Hashed {
    fn build(&mut self, cpu: &Cpu, points: &[[f32; 4]], support: f32, order: &mut Vec<u32>) {
        self.scale = 1.0 / support;
        let scale = self.scale;
        self.keys.resize(points.len(), 0);
        cpu.for_chunks(&mut self.keys[..], |first, keys| {
            for (key, point) in keys.iter_mut().zip(&points[first..]) {
                *key = morton([0, 1, 2].map(|axis| cell(point[axis], scale)));
            }
        });
        self.sort.stable_by_key(cpu, &self.keys, order);
        self.list_cells(cpu, order);
        self.hash_cells(cpu);
    }

    /// Occupied cells in the order of their Morton keys: a flag where the key changes, compacted by prefix sums.
    fn list_cells(&mut self, cpu: &Cpu, order: &[u32]) {
        let keys = &self.keys;
        let begins = |row: usize| row == 0 || keys[order[row] as usize] != keys[order[row - 1] as usize];
        self.flags.resize(order.len(), 0);
        cpu.for_chunks(&mut self.flags[..], |first, flags| {
            flags.iter_mut().enumerate().for_each(|(row, flag)| *flag = u32::from(begins(first + row)));
        });
        let count = scan::exclusive(cpu, &mut self.flags, &mut self.page_sums) as usize;
        self.cell_keys.clear();
        self.cell_keys.resize(count, 0);
        self.cells.clear();
        self.cells.resize(count, [0; 2]);
        for row in (0..order.len()).filter(|row| begins(*row)) {
            let cell = self.flags[row] as usize;
            self.cell_keys[cell] = keys[order[row] as usize];
            self.cells[cell][0] = row as u32;
            if cell > 0 {
                self.cells[cell - 1][1] = row as u32;
            }
        }
        if let Some(last) = self.cells.last_mut() {
            last[1] = order.len() as u32;
        }
    }

    /// Sorts the cells by hash, and notes where every hash begins.
    fn hash_cells(&mut self, cpu: &Cpu) {
        let size = (self.keys.len() as u64 + 1).next_power_of_two();
        self.hashes.clear();
        self.hashes.extend(self.cell_keys.iter().map(|key| hash(*key) % size));
        self.sort.stable_by_key(cpu, &self.hashes, &mut self.cell_order);
        self.cells = self.cell_order.iter().map(|cell| self.cells[*cell as usize]).collect();
        self.cell_keys = self.cell_order.iter().map(|cell| self.cell_keys[*cell as usize]).collect();
        self.table.clear();
        self.table.resize(size as usize, [0; 2]);
        for (row, cell) in self.cell_order.iter().enumerate() {
            let entry = &mut self.table[self.hashes[*cell as usize] as usize];
            if entry[1] == 0 {
                entry[0] = row as u32;
            }
            entry[1] = row as u32 + 1;
        }
    }

    fn spans(&self, low: [f32; 3], high: [f32; 3], spans: &mut Vec<[u32; 2]>) {
        if self.table.is_empty() {
            return;
        }
        let from = [0, 1, 2].map(|axis| cell(low[axis], self.scale));
        let to = [0, 1, 2].map(|axis| cell(high[axis], self.scale));
        for z in from[2]..=to[2] {
            for y in from[1]..=to[1] {
                for x in from[0]..=to[0] {
                    let key = morton([x, y, z]);
                    let [first, last] = self.table[(hash(key) % self.table.len() as u64) as usize];
                    for row in first..last {
                        // Different cells may share a hash: a run of a few cells, told apart by their keys.
                        if self.cell_keys[row as usize] == key {
                            spans.push(self.cells[row as usize]);
                        }
                    }
                }
            }
        }
    }
}

/// Cell of a coordinate, counted from 2^20 cells below the origin.
fn cell(value: f32, scale: f32) -> u32 {
    ((value * scale).floor().clamp(-CELL_LIMIT, CELL_LIMIT - 1.0) + CELL_LIMIT) as u32
}

/// Interleaves 21 bits of every coordinate.
fn morton(cell: [u32; 3]) -> u64 {
    let spread = |value: u32| {
        let mut bits = u64::from(value) & 0x1f_ffff;
        bits = (bits | bits << 32) & 0x001f_0000_0000_ffff;
        bits = (bits | bits << 16) & 0x001f_0000_ff00_00ff;
        bits = (bits | bits << 8) & 0x100f_00f0_0f00_f00f;
        bits = (bits | bits << 4) & 0x10c3_0c30_c30c_30c3;
        (bits | bits << 2) & 0x1249_2492_4924_9249
    };
    spread(cell[0]) | spread(cell[1]) << 1 | spread(cell[2]) << 2
}

/// Multiplicative mix: the upper bits of the product depend on all bits of the key.
fn hash(key: u64) -> u64 {
    key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 24
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
