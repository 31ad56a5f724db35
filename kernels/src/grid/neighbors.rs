//! Neighbour lists: for every query point, the target points within a radius.
//!
//! Lists are interleaved by groups of eight queries, so that a pass over neighbours has one particle per lane
//! and adds up each particle's list in order: the width of the machine's vectors cannot change the sum. Shorter
//! lists of a group are filled up with a padding row, which adds exact zeros.

use std::ops::Range;

use super::cells::Cells;
use crate::{
    columns::{ColumnData, FAR},
    cpu::{CHUNK, Cpu, PerChunk},
    lanes::{self, LANES, Simd, prelude::*, u32x8, with_lanes},
    vector::{self, dot, minus},
};

const GROUPS: usize = CHUNK / LANES;

/// Neighbour lists of all queries, in chunks of [`CHUNK`] queries.
#[derive(Clone, Debug, Default)]
pub struct Neighbors {
    chunks: Vec<ChunkLists>,
    /// Coordinates of the targets, one array per axis: candidates are read in order, and many times.
    planes: [Vec<f32>; 3],
}

/// Lists of the queries of one chunk.
#[derive(Clone, Debug)]
pub(crate) struct ChunkLists {
    /// Where the entries of a group begin.
    start: [u32; GROUPS + 1],
    /// The k-th neighbours of eight queries.
    entries: Vec<[u32; LANES]>,
}

impl Default for ChunkLists {
    fn default() -> Self {
        Self { start: [0; GROUPS + 1], entries: Vec::new() }
    }
}

impl ChunkLists {
    /// The list entries of the group of eight queries that begins at `row` of the chunk.
    #[inline(always)]
    pub(crate) fn group(&self, row: usize) -> &[[u32; LANES]] {
        &self.entries[self.range(row)]
    }

    /// Where the entries of that group are, among those of the chunk.
    #[inline(always)]
    pub(crate) fn range(&self, row: usize) -> Range<usize> {
        let group = row / LANES;
        self.start[group] as usize..self.start[group + 1] as usize
    }
}

impl Neighbors {
    /// The lists of the chunk that begins at query `first`.
    #[inline(always)]
    pub(crate) fn chunk(&self, first: usize) -> &ChunkLists {
        &self.chunks[first / CHUNK]
    }

    /// The neighbours of one query, in list order, without padding.
    pub fn of(&self, query: usize, targets: usize) -> impl Iterator<Item = u32> + '_ {
        let lists = self.chunk(query).group(query % CHUNK);
        lists.iter().map(move |entry| entry[query % LANES]).filter(move |row| (*row as usize) < targets)
    }

    /// Number of list entries, padding included.
    #[must_use]
    pub fn entries(&self) -> usize {
        self.chunks.iter().map(|chunk| chunk.entries.len() * LANES).sum()
    }

    /// Lists given one by one, with entries in order; `padding` fills up a group.
    #[cfg(any(test, feature = "oracles", feature = "gpu"))]
    pub(crate) fn from_lists(lists: &[Vec<u32>], padding: u32) -> Self {
        let mut chunks = Vec::new();
        for queries in lists.chunks(CHUNK) {
            let mut chunk = ChunkLists::default();
            for (group, queries) in queries.chunks(LANES).enumerate() {
                let length = queries.iter().map(Vec::len).max().unwrap_or(0);
                let entry = |k: usize, lane: usize| queries.get(lane).and_then(|list| list.get(k)).copied();
                chunk.entries.extend(
                    (0..length).map(|k| std::array::from_fn(|lane| entry(k, lane).unwrap_or(padding))),
                );
                chunk.start[group + 1..].fill(chunk.entries.len() as u32);
            }
            chunks.push(chunk);
        }
        Self { chunks, ..Self::default() }
    }

    /// Builds the lists of `queries` (padded rows, of which the first `count` are in use) over `targets` (padded
    /// rows in the order of `cells`).
    pub(crate) fn build(
        &mut self,
        cpu: &Cpu,
        (queries, count): (&[[f32; 4]], usize),
        (targets, target_count): (&[[f32; 4]], usize),
        cells: &Cells,
        radius: f32,
    ) {
        let Self { chunks, planes } = self;
        chunks.resize_with(queries.len().div_ceil(CHUNK), ChunkLists::default);
        planes.iter_mut().for_each(|plane| plane.resize(targets.len(), FAR));
        let [x, y, z] = planes;
        cpu.for_chunks((&mut x[..], &mut y[..], &mut z[..]), |first, (x, y, z)| {
            for (row, target) in targets[first..].iter().take(x.len()).enumerate() {
                (x[row], y[row], z[row]) = (target[0], target[1], target[2]);
            }
        });
        let planes = [&x[..], &y[..], &z[..]];
        cpu.for_chunks(PerChunk(chunks), |first, lists| {
            let end = queries.len().min(first + CHUNK);
            let task = Task { planes, padding: target_count as u32, cells, radius };
            let used = count.saturating_sub(first).min(end - first);
            with_lanes!(cpu, simd => task.chunk(simd, &queries[first..end], used, &mut lists.0[0]));
        });
    }
}

/// One value for every entry of neighbour lists, so that passes that repeat need not compute it again.
#[derive(Clone, Debug, Default)]
pub struct ListValues(pub(crate) Vec<Vec<[f32; LANES]>>);

impl ListValues {
    /// Makes room for the values of `lists`, one vector per chunk.
    pub(crate) fn match_lists(&mut self, lists: &Neighbors) -> PerChunk<'_, Vec<[f32; LANES]>> {
        self.0.resize_with(lists.chunks.len(), Vec::new);
        for (values, lists) in self.0.iter_mut().zip(&lists.chunks) {
            values.resize(lists.entries.len(), [0.0; LANES]);
        }
        PerChunk(&mut self.0)
    }

    /// The values of the chunk that begins at query `first`.
    #[inline(always)]
    pub(crate) fn chunk(&self, first: usize) -> &[[f32; LANES]] {
        &self.0[first / CHUNK]
    }
}

impl ColumnData for ListValues {
    fn visit_words(&self, _rows: usize, visit: &mut dyn FnMut(u32)) {
        self.0.iter().flatten().flatten().for_each(|value| visit(value.to_bits()));
    }
    fn poison(&mut self) {
        self.0.iter_mut().for_each(|chunk| chunk.fill([f32::NAN; LANES]));
    }
}

impl ColumnData for Neighbors {
    fn visit_words(&self, _rows: usize, visit: &mut dyn FnMut(u32)) {
        for chunk in &self.chunks {
            chunk.start.iter().for_each(|start| visit(*start));
            chunk.entries.iter().flatten().for_each(|row| visit(*row));
        }
    }
    fn poison(&mut self) {
        self.chunks.iter_mut().for_each(|chunk| chunk.entries.fill([u32::MAX; LANES]));
    }
}

/// What all groups of a build share.
struct Task<'a> {
    planes: [&'a [f32]; 3],
    padding: u32,
    cells: &'a Cells,
    radius: f32,
}

/// Targets near a few queries, and the lists of eight queries.
#[derive(Default)]
struct Candidates {
    x: Vec<f32>,
    y: Vec<f32>,
    z: Vec<f32>,
    row: Vec<u32>,
    count: usize,
    spans: Vec<[u32; 2]>,
    lists: [Vec<u32>; LANES],
    lengths: [usize; LANES],
}

impl Candidates {
    /// Makes room for eight more candidates.
    #[inline(always)]
    fn reserve(&mut self) {
        if self.count + LANES > self.x.len() {
            let length = (self.count + LANES).max(256) * 2;
            self.x.resize(length, FAR);
            self.y.resize(length, FAR);
            self.z.resize(length, FAR);
            self.row.resize(length, 0);
        }
    }
}

impl Task<'_> {
    #[inline(always)]
    fn chunk<S: Simd>(&self, simd: S, queries: &[[f32; 4]], used: usize, lists: &mut ChunkLists) {
        let mut candidates = Candidates::default();
        lists.entries.clear();
        lists.start.fill(0);
        for (group, queries) in queries.chunks_exact(LANES).enumerate() {
            let used = used.saturating_sub(group * LANES).min(LANES);
            self.group(simd, &queries[..used], &mut candidates);
            self.interleave(&mut candidates, &mut lists.entries);
            lists.start[group + 1] = lists.entries.len() as u32;
        }
        let groups = queries.len() / LANES;
        lists.start[groups + 1..].fill(lists.entries.len() as u32);
    }

    /// Lists of up to eight queries. Consecutive queries may lie far apart, where a row of cells ends: they are
    /// cut into runs that fit a small box.
    #[inline(always)]
    fn group<S: Simd>(&self, simd: S, queries: &[[f32; 4]], candidates: &mut Candidates) {
        candidates.lengths = [0; LANES];
        let mut first = 0;
        while first < queries.len() {
            let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
            let mut end = first;
            while end < queries.len() {
                let grown_low = [0, 1, 2].map(|axis| low[axis].min(queries[end][axis]));
                let grown_high = [0, 1, 2].map(|axis| high[axis].max(queries[end][axis]));
                let fits = (0..3).all(|axis| grown_high[axis] - grown_low[axis] <= 1.5 * self.radius);
                if end > first && !fits {
                    break;
                }
                (low, high) = (grown_low, grown_high);
                end += 1;
            }
            self.collect(simd, low, high, candidates);
            self.test(simd, queries, first..end, candidates);
            first = end;
        }
    }

    /// Collects the targets whose distance from the box is less than the radius.
    #[inline(always)]
    fn collect<S: Simd>(&self, simd: S, low: [f32; 3], high: [f32; 3], candidates: &mut Candidates) {
        let radius = self.radius;
        let splat = |value| lanes::splat(simd, value);
        let (lows, highs) = (vector::splat(simd, low), vector::splat(simd, high));
        let (zero, square) = (splat(0.0), splat(radius * radius));
        let lane_index = u32x8::from_fn(simd, |lane| lane as u32);
        let last = self.planes[0].len() - LANES;
        candidates.count = 0;
        self.cells.spans(low.map(|x| x - radius), high.map(|x| x + radius), &mut candidates.spans);
        for span in 0..candidates.spans.len() {
            let [begin, end] = candidates.spans[span];
            for row in (begin..end).step_by(LANES) {
                // Near the end of the array the last eight rows are loaded; those before `row` were seen already.
                let loaded = (row as usize).min(last);
                let x = lanes::load(simd, self.planes[0], loaded);
                let y = lanes::load(simd, self.planes[1], loaded);
                let z = lanes::load(simd, self.planes[2], loaded);
                let rows = lane_index + loaded as u32;
                let dx = (lows[0] - x).max(x - highs[0]).max(zero);
                let dy = (lows[1] - y).max(y - highs[1]).max(zero);
                let dz = (lows[2] - z).max(z - highs[2]).max(zero);
                let mut near = (dx * dx + dy * dy + dz * dz).simd_lt(square);
                if row + 8 > end || loaded < row as usize {
                    near &= rows.simd_ge(u32x8::splat(simd, row)) & rows.simd_lt(u32x8::splat(simd, end));
                }
                let hits = near.to_bitmask().count_ones() as usize;
                if hits == 0 {
                    continue;
                }
                candidates.reserve();
                let at = candidates.count..candidates.count + LANES;
                simd.compress_f32x8(x, near).store_slice(&mut candidates.x[at.clone()]);
                simd.compress_f32x8(y, near).store_slice(&mut candidates.y[at.clone()]);
                simd.compress_f32x8(z, near).store_slice(&mut candidates.z[at.clone()]);
                simd.compress_u32x8(rows, near).store_slice(&mut candidates.row[at]);
                candidates.count += hits;
            }
        }
        candidates.reserve();
        candidates.x[candidates.count..candidates.count + LANES].fill(FAR);
    }

    /// Appends to the lists of `range` the candidates within the radius.
    #[inline(always)]
    fn test<S: Simd>(&self, simd: S, queries: &[[f32; 4]], range: Range<usize>, candidates: &mut Candidates) {
        let square = lanes::splat(simd, self.radius * self.radius);
        let Candidates { x, y, z, row, count, lists, lengths, .. } = candidates;
        let room = *count + LANES;
        for list in &mut lists[range.clone()] {
            if list.len() < room {
                list.resize(room, 0);
            }
        }
        // Two queries at a time share the loads of the candidates.
        for lane in range.clone().step_by(2) {
            let other = (lane + 1).min(range.end - 1);
            let query = |lane: usize| {
                let [x, y, z, _] = queries[lane];
                vector::splat(simd, [x, y, z])
            };
            let (a, b) = (query(lane), query(other));
            let (left, right) = lists.split_at_mut(lane + 1);
            let mut unused = Vec::new();
            let list_a = &mut left[lane];
            let list_b = if other > lane { &mut right[0] } else { &mut unused };
            list_b.resize(list_b.len().max(room), 0);
            let (mut length_a, mut length_b) = (0, 0);
            for at in (0..*count).step_by(LANES) {
                let (xs, ys, zs) =
                    (lanes::load(simd, x, at), lanes::load(simd, y, at), lanes::load(simd, z, at));
                let rows = u32x8::from_slice(simd, &row[at..at + LANES]);
                let to_a = minus([xs, ys, zs], a);
                let to_b = minus([xs, ys, zs], b);
                let (near_a, near_b) = (dot(to_a, to_a).simd_lt(square), dot(to_b, to_b).simd_lt(square));
                simd.compress_u32x8(rows, near_a).store_slice(&mut list_a[length_a..length_a + LANES]);
                simd.compress_u32x8(rows, near_b).store_slice(&mut list_b[length_b..length_b + LANES]);
                length_a += near_a.to_bitmask().count_ones() as usize;
                length_b += near_b.to_bitmask().count_ones() as usize;
            }
            lengths[lane] = length_a;
            if other > lane {
                lengths[other] = length_b;
            }
        }
    }

    /// Appends the lists of eight queries, one entry for all k-th neighbours.
    #[inline(always)]
    fn interleave(&self, candidates: &mut Candidates, entries: &mut Vec<[u32; LANES]>) {
        let length = candidates.lengths.into_iter().max().unwrap_or(0);
        for list in &mut candidates.lists {
            if list.len() < length {
                list.resize(length, 0);
            }
        }
        let lists: [&[u32]; LANES] = std::array::from_fn(|lane| &candidates.lists[lane][..length]);
        let first = entries.len();
        entries.extend((0..length).map(|k| std::array::from_fn(|lane| lists[lane][k])));
        let entries = &mut entries[first..];
        for (lane, &own) in candidates.lengths.iter().enumerate() {
            entries[own..].iter_mut().for_each(|entry| entry[lane] = self.padding);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        columns::{FAR_ROW, padded},
        grid::cells::Domain,
        lanes::SimdLevel,
        testing::random_points,
    };
    use glam::Vec3;

    fn build(points: &[[f32; 4]], radius: f32, domain: Domain, cpu: &Cpu) -> (Vec<[f32; 4]>, Neighbors) {
        let mut cells = Cells::default();
        cells.build(cpu, points, radius, domain);
        let mut sorted: Vec<[f32; 4]> = cells.order.iter().map(|row| points[*row as usize]).collect();
        sorted.resize(padded(points.len()), FAR_ROW);
        let mut lists = Neighbors::default();
        cpu.enter(|| lists.build(cpu, (&sorted, points.len()), (&sorted, points.len()), &cells, radius));
        (sorted, lists)
    }

    fn brute_force(sorted: &[[f32; 4]], count: usize, query: usize, radius: f32) -> Vec<u32> {
        let near = |row: &u32| {
            let d: [f32; 3] = std::array::from_fn(|axis| sorted[*row as usize][axis] - sorted[query][axis]);
            d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < radius * radius
        };
        (0..count as u32).filter(near).collect()
    }

    #[test]
    fn lists_equal_brute_force_on_every_level_and_scheme() {
        let bounded = Domain::Bounded { minimum: Vec3::splat(-1.0), maximum: Vec3::splat(1.0) };
        for count in [0, 1, 7, 8, 9, 1500] {
            let points = random_points(count, 1.0, 11);
            for domain in [bounded, Domain::Unbounded] {
                for level in SimdLevel::ALL.into_iter().filter(|level| level.is_supported()) {
                    let cpu = Cpu::with_threads(level, 2).expect("supported");
                    let (sorted, lists) = build(&points, 0.21, domain, &cpu);
                    for query in 0..count {
                        let mut found: Vec<u32> = lists.of(query, count).collect();
                        found.sort_unstable();
                        assert_eq!(found, brute_force(&sorted, count, query, 0.21), "{level} {query}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_radius_that_is_a_little_too_small_is_noticed() {
        let points = random_points(1500, 1.0, 11);
        let cpu = Cpu::serial(SimdLevel::best()).expect("supported");
        let (sorted, lists) = build(&points, 0.20, Domain::Unbounded, &cpu);
        let differ = (0..1500)
            .any(|query| lists.of(query, 1500).count() != brute_force(&sorted, 1500, query, 0.21).len());
        assert!(differ);
    }
}
