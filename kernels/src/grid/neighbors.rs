//! Neighbour lists: for every query point, the target points within a radius.
//!
//! Lists are interleaved by groups of eight queries. A pass over neighbours then has one particle per lane and sums each
//! particle's list in order. The vector width therefore cannot change the sum. A padding row, which adds exact zeros, fills
//! up the shorter lists of a group.

use std::ops::Range;

use super::{cells::Cells, search::Search};
use crate::{
    column::{ColumnData, FAR},
    cpu::{CHUNK, Cpu, PerChunk},
    lanes::{LANES, with_lanes},
    periodic::Periodic,
};

/// Groups of a chunk.
pub(super) const GROUPS: usize = CHUNK / LANES;

/// Neighbour lists of all queries, in chunks of [`CHUNK`] queries.
#[derive(Clone, Debug, Default)]
pub struct Neighbors {
    pub(super) chunks: Vec<ChunkLists>,
    /// Coordinates of the targets, one array per axis: candidates are read in order, many times.
    planes: [Vec<f32>; 3],
}

/// Lists of the queries of one chunk.
#[derive(Clone, Debug)]
pub(crate) struct ChunkLists {
    /// First entry of each group.
    pub(super) start: [u32; GROUPS + 1],
    /// The k-th neighbours of eight queries.
    pub(super) entries: Vec<[u32; LANES]>,
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

    /// Range of the entries of that group, within the chunk.
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

    /// Whether there is a list for a query.
    #[cfg(test)]
    pub(crate) fn has(&self, query: usize) -> bool {
        query / CHUNK < self.chunks.len()
    }

    /// Number of list entries, padding included.
    #[must_use]
    pub fn entries(&self) -> usize {
        self.chunks.iter().map(|chunk| chunk.entries.len() * LANES).sum()
    }

    /// Lists from single lists with entries in order; `padding` fills up a group.
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

    /// Makes the list of every query with a function that may keep working memory from one query to the next; `padding`
    /// fills up a group.
    pub(crate) fn fill<M: Default>(
        &mut self,
        cpu: &Cpu,
        queries: usize,
        padding: u32,
        list: impl Fn(&mut M, usize, &mut Vec<u32>) + Sync,
    ) {
        self.chunks.resize_with(queries.div_ceil(CHUNK), ChunkLists::default);
        cpu.for_chunks_with(
            PerChunk(&mut self.chunks),
            |memory: &mut (M, [Vec<u32>; LANES]), first, lists| {
                let ChunkLists { start, entries } = &mut lists.0[0];
                let (memory, lists) = memory;
                entries.clear();
                for (group, start) in start.iter_mut().enumerate() {
                    *start = entries.len() as u32;
                    let rows = first + group * LANES..queries.min(first + CHUNK);
                    if group == GROUPS || rows.is_empty() {
                        continue;
                    }
                    lists.iter_mut().for_each(Vec::clear);
                    rows.zip(lists.iter_mut()).for_each(|(query, own)| list(memory, query, own));
                    let length = lists.iter().map(Vec::len).max().unwrap_or(0);
                    let entry = |k: usize, lane: usize| lists[lane].get(k).copied().unwrap_or(padding);
                    entries.extend((0..length).map(|k| std::array::from_fn(|lane| entry(k, lane))));
                }
            },
        );
    }

    /// Builds the lists of `queries` over `targets` and their periodic images. Both are padded rows: of `queries` the first `count` are in
    /// use, and `targets` are in the order of `cells`.
    pub(crate) fn build(
        &mut self,
        cpu: &Cpu,
        (queries, count): (&[[f32; 4]], usize),
        (targets, target_count): (&[[f32; 4]], usize),
        cells: &Cells,
        (radius, periodic): (f32, Option<&Periodic>),
    ) {
        let Self { chunks, planes } = self;
        chunks.resize_with(queries.len().div_ceil(CHUNK), ChunkLists::default);
        if queries.is_empty() {
            return;
        }
        fill_planes(cpu, targets, planes);
        let [x, y, z] = planes;
        let search = Search { planes: [x, y, z], padding: target_count as u32, cells, radius, periodic };
        cpu.for_chunks_with(PerChunk(chunks), |memory, first, lists| {
            let end = queries.len().min(first + CHUNK);
            let used = count.saturating_sub(first).min(end - first);
            let ChunkLists { start, entries } = &mut lists.0[0];
            with_lanes!(cpu, simd => search.chunk(simd, &queries[first..end], used, memory, start, entries));
        });
    }
}

/// Coordinates of the targets, one array per axis, with eight spare rows behind the last.
fn fill_planes(cpu: &Cpu, targets: &[[f32; 4]], planes: &mut [Vec<f32>; 3]) {
    planes.iter_mut().for_each(|plane| plane.resize(targets.len() + LANES, FAR));
    let [x, y, z] = planes.each_mut().map(|plane| &mut plane[..targets.len()]);
    cpu.for_chunks((x, y, z), |first, (x, y, z)| {
        for (row, target) in targets[first..].iter().take(x.len()).enumerate() {
            (x[row], y[row], z[row]) = (target[0], target[1], target[2]);
        }
    });
}

/// One value for every entry of neighbour lists, so that repeated passes need not compute it again.
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

    /// A value for every entry of `lists`, from its query and its target; 0 for padding.
    #[cfg(any(test, feature = "oracles", feature = "gpu"))]
    pub(crate) fn fill(&mut self, lists: &Neighbors, value: impl Fn(usize, usize) -> f32) {
        self.match_lists(lists);
        for (chunk, (values, lists)) in self.0.iter_mut().zip(&lists.chunks).enumerate() {
            for group in 0..GROUPS {
                for at in lists.range(group * LANES) {
                    let query = chunk * CHUNK + group * LANES;
                    for (lane, (own, target)) in values[at].iter_mut().zip(lists.entries[at]).enumerate() {
                        *own = value(query + lane, target as usize);
                    }
                }
            }
        }
    }

    /// The value of the k-th neighbour of a query.
    #[cfg(test)]
    pub(crate) fn of(&self, lists: &Neighbors, query: usize, place: usize) -> f32 {
        let range = lists.chunk(query).range(query % CHUNK);
        self.chunk(query)[range][place][query % LANES]
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        column::{FAR_ROW, padded},
        grid::cells::Domain,
        lanes::SimdLevel,
        testing::random_points,
    };
    use glam::Vec3;

    fn build(
        points: &[[f32; 4]],
        (radius, periodic): (f32, Option<&Periodic>),
        domain: Domain,
        cpu: &Cpu,
    ) -> (Vec<[f32; 4]>, Neighbors) {
        let mut cells = Cells::default();
        cells.build(cpu, points, radius, domain);
        let mut sorted: Vec<[f32; 4]> = cells.order.iter().map(|row| points[*row as usize]).collect();
        sorted.resize(padded(points.len()), FAR_ROW);
        let mut lists = Neighbors::default();
        cpu.enter(|| {
            lists.build(cpu, (&sorted, points.len()), (&sorted, points.len()), &cells, (radius, periodic))
        });
        (sorted, lists)
    }

    fn brute_force(
        sorted: &[[f32; 4]],
        count: usize,
        query: usize,
        (radius, periodic): (f32, Option<&Periodic>),
    ) -> Vec<u32> {
        let periods = periodic.map_or(Vec3::ZERO, |periodic| periodic.periods());
        let near = |row: &u32, shift: Vec3| {
            let [x, y, z, _] = sorted[*row as usize];
            let [from_x, from_y, from_z, _] = sorted[query];
            let apart = Vec3::new(x, y, z) + shift - Vec3::new(from_x, from_y, from_z);
            apart.length_squared() < radius * radius
        };
        let place = |image: i32| [image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1].map(|at| at as f32);
        // Along axes without a period the same shift occurs more than once.
        let any = |row: &u32| (0..27).any(|image| near(row, Vec3::from_array(place(image)) * periods));
        (0..count as u32).filter(any).collect()
    }

    #[test]
    fn lists_equal_brute_force_on_every_level_and_scheme() {
        let bounded = Domain::Bounded { minimum: Vec3::splat(-1.0), maximum: Vec3::splat(1.0) };
        for count in [0, 1, 7, 8, 9, 1500] {
            let points = random_points(count, 1.0, 11);
            for domain in [bounded, Domain::Unbounded] {
                assert_brute_force(&points, (0.21, None), domain);
            }
        }
    }

    fn assert_brute_force(points: &[[f32; 4]], reach: (f32, Option<&Periodic>), domain: Domain) {
        let count = points.len();
        for level in SimdLevel::supported() {
            let cpu = Cpu::with_threads(level, 2).expect("supported");
            let (sorted, lists) = build(points, reach, domain, &cpu);
            for query in 0..count {
                let mut found: Vec<u32> = lists.of(query, count).collect();
                found.sort_unstable();
                // A particle that is in a list twice would occur twice.
                assert_eq!(found, brute_force(&sorted, count, query, reach), "{level} {query} {reach:?}");
            }
        }
    }

    #[test]
    fn lists_across_the_sides_of_a_box_that_repeats_equal_brute_force() {
        let (low, high) = (Vec3::splat(-1.0), Vec3::splat(1.0));
        let bounded = Domain::Bounded { minimum: low, maximum: high };
        let mut points = random_points(700, 1.0, 11);
        // At the very edge.
        points.extend([[-1.0, -1.0, -1.0, 0.0], [1.0, 1.0, 1.0, 0.0], [-1.0, 0.3, 1.0, 0.0]]);
        for axes in [[true, false, false], [false, true, true], [true, false, true], [true; 3]] {
            let periodic = Periodic::new(low, high, axes);
            for domain in [bounded, Domain::Unbounded] {
                // A radius far below the box, and one of nearly half of it.
                for radius in [0.21, 0.99] {
                    assert_brute_force(&points, (radius, periodic.as_ref()), domain);
                }
            }
        }
    }

    #[test]
    fn a_side_that_nobody_looks_across_is_noticed() {
        let points = random_points(700, 1.0, 11);
        let (low, high) = (Vec3::splat(-1.0), Vec3::splat(1.0));
        let [all, two] = [[true; 3], [true, true, false]].map(|axes| Periodic::new(low, high, axes));
        let cpu = Cpu::serial(SimdLevel::best()).expect("supported");
        let (sorted, lists) = build(&points, (0.21, two.as_ref()), Domain::Unbounded, &cpu);
        let expected = |query| brute_force(&sorted, 700, query, (0.21, all.as_ref())).len();
        assert!((0..700).any(|query| lists.of(query, 700).count() != expected(query)));
    }

    #[test]
    fn a_radius_that_is_a_little_too_small_is_noticed() {
        let points = random_points(1500, 1.0, 11);
        let cpu = Cpu::serial(SimdLevel::best()).expect("supported");
        let (sorted, lists) = build(&points, (0.20, None), Domain::Unbounded, &cpu);
        let differ = (0..1500).any(|query| {
            lists.of(query, 1500).count() != brute_force(&sorted, 1500, query, (0.21, None)).len()
        });
        assert!(differ);
    }
}
