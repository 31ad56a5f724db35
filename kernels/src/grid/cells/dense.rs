//! A bounded domain: rows of cells along x, and inside a row narrow bins, found by counting.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use glam::Vec3;

use crate::cpu::Cpu;

/// Bins of a row per support radius.
const BINS: f32 = 4.0;
/// Rows of a chunk of the counting sort.
const COUNT_CHUNK: usize = 4096;
/// Largest number of bins of a dense grid, and of row counters over all chunks.
const BIN_LIMIT: u64 = 1 << 26;

/// Rows of cells along x with narrow bins inside, over a box.
#[derive(Debug, Default)]
pub(super) struct Dense {
    origin: [f32; 3],
    /// One over the size of a bin in x and of a cell in y and z.
    scale: [f32; 3],
    /// Bins in x, cells in y and z.
    size: [usize; 3],
    /// (row, bin) of every point.
    place: Vec<[u32; 2]>,
    /// Points of a row, per chunk of points; then the first slot of that row for the chunk.
    counts: Vec<u32>,
    by_row: Vec<AtomicU32>,
    pub(super) row_start: Vec<u32>,
    /// `size[0] + 1` starts per row; not set for empty rows.
    pub(super) bin_start: Vec<u32>,
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
    pub(super) fn fit(&mut self, points: usize, support: f32, minimum: Vec3, maximum: Vec3) -> bool {
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
        // A cast saturates: points outside are in the outermost cell, NaN in the first.
        (((value - self.origin[axis]) * self.scale[axis]) as usize).min(self.size[axis] - 1)
    }

    pub(super) fn build(&mut self, cpu: &Cpu, points: &[[f32; 4]], order: &mut Vec<u32>) {
        let rows = self.size[1] * self.size[2];
        self.count_rows(cpu, points, rows);
        self.scatter_rows(cpu, points.len(), rows);
        order.resize(points.len(), 0);
        let mut bin_start = std::mem::take(&mut self.bin_start);
        bin_start.resize(rows * (self.size[0] + 1), 0);
        self.sort_rows(cpu, cpu.threads(), 0..rows, &mut bin_start, order);
        self.bin_start = bin_start;
    }

    /// Places of the points, and number of points per row in every chunk.
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
                // Every slot is written once; the atomics only tell the compiler that threads do not collide.
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

    pub(super) fn spans(&self, low: [f32; 3], high: [f32; 3], spans: &mut Vec<[u32; 2]>) {
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
