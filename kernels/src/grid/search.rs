//! The search for neighbour lists: candidates around eight queries, then distance tests.

use std::ops::Range;

use super::{cells::Cells, neighbors::GROUPS};
use crate::{
    column::FAR,
    lanes::{self, LANES, Simd, prelude::*, u32x8},
    periodic::Periodic,
    vector::{self, dot, minus},
};

/// Common data of all groups of a search.
pub(super) struct Search<'a> {
    /// Coordinates of the targets, with at least eight spare rows behind the last.
    pub(super) planes: [&'a [f32]; 3],
    /// The row that fills up lists.
    pub(super) padding: u32,
    pub(super) cells: &'a Cells,
    pub(super) radius: f32,
    pub(super) periodic: Option<&'a Periodic>,
}

/// Working memory of a search.
#[derive(Default)]
pub(super) struct Memory {
    candidates: Candidates,
    lists: GroupLists,
    /// Lists of the previous group, whose stores have reached the cache when they are read again.
    before: GroupLists,
}

/// Targets near a few queries.
#[derive(Default)]
struct Candidates {
    x: Vec<f32>,
    y: Vec<f32>,
    z: Vec<f32>,
    row: Vec<u32>,
    count: usize,
    spans: Vec<[u32; 2]>,
    shifts: Vec<[f32; 3]>,
}

impl Candidates {
    /// Reserves room for all rows of the spans, and for eight more that a store may touch.
    fn reserve(&mut self) {
        let mut room = self.count + LANES;
        for [begin, end] in &self.spans {
            room += (end - begin) as usize;
        }
        if room > self.x.len() {
            let room = room.max(512) * 2;
            self.x.resize(room, FAR);
            self.y.resize(room, FAR);
            self.z.resize(room, FAR);
            self.row.resize(room, 0);
        }
    }
}

/// The lists of eight queries, one by one.
#[derive(Default)]
struct GroupLists {
    lists: [Vec<u32>; LANES],
    lengths: [usize; LANES],
}

impl GroupLists {
    /// Appends the lists to `entries`, one entry for all k-th neighbours; `padding` fills up shorter lists.
    #[inline(always)]
    fn interleave<S: Simd>(&mut self, simd: S, padding: u32, entries: &mut Vec<[u32; LANES]>) {
        let length = self.lengths.into_iter().max().unwrap_or(0);
        let blocks = length.div_ceil(LANES);
        let padding = u32x8::splat(simd, padding);
        for (list, &own) in self.lists.iter_mut().zip(&self.lengths) {
            if list.len() < (blocks + 1) * LANES {
                list.resize((blocks + 1) * LANES, 0);
            }
            for at in (own..blocks * LANES).step_by(LANES) {
                padding.store_slice(&mut list[at..at + LANES]);
            }
        }
        let [a, b, c, d, e, f, g, h] = self.lists.each_ref().map(|list| list.as_chunks::<LANES>().0);
        for block in 0..blocks {
            let rows =
                [&a[block], &b[block], &c[block], &d[block], &e[block], &f[block], &g[block], &h[block]];
            let columns = lanes::transpose_rows(simd, rows);
            entries.extend_from_slice(&columns[..LANES.min(length - block * LANES)]);
        }
    }
}

impl Search<'_> {
    /// Lists of the groups of one chunk, of whose queries the first `used` are in use.
    #[inline(always)]
    pub(super) fn chunk<S: Simd>(
        &self,
        simd: S,
        queries: &[[f32; 4]],
        used: usize,
        memory: &mut Memory,
        start: &mut [u32; GROUPS + 1],
        entries: &mut Vec<[u32; LANES]>,
    ) {
        let Memory { candidates, lists, before } = memory;
        entries.clear();
        let groups = queries.len() / LANES;
        for group in 0..=groups {
            if group < groups {
                let rows = group * LANES..(group + 1) * LANES;
                let used = used.saturating_sub(rows.start).min(LANES);
                self.group(simd, &queries[rows][..used], candidates, lists);
            }
            if group > 0 {
                start[group - 1] = entries.len() as u32;
                before.interleave(simd, self.padding, entries);
            }
            std::mem::swap(lists, before);
        }
        start[groups..].fill(entries.len() as u32);
    }

    /// Lists of up to eight queries. Consecutive queries may lie far apart at the end of a row of cells: they are divided
    /// into runs within a small box.
    #[inline(always)]
    fn group<S: Simd>(
        &self,
        simd: S,
        queries: &[[f32; 4]],
        candidates: &mut Candidates,
        lists: &mut GroupLists,
    ) {
        lists.lengths = [0; LANES];
        let mut first = 0;
        while first < queries.len() {
            // Rows without a place have no neighbours.
            if queries[first][0] >= FAR {
                first += 1;
                continue;
            }
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
            candidates.count = 0;
            self.collect::<S, false>(simd, low, high, [0.0; 3], candidates);
            if let Some(periodic) = self.periodic {
                self.collect_images(simd, periodic, low, high, candidates);
            }
            self.test(simd, queries, first..end, candidates, lists);
            first = end;
        }
    }

    /// Adds the images of targets whose distance from the box is less than the radius, at the places of those images. A
    /// query is within the radius of at most one of them.
    #[inline(always)]
    fn collect_images<S: Simd>(
        &self,
        simd: S,
        periodic: &Periodic,
        low: [f32; 3],
        high: [f32; 3],
        candidates: &mut Candidates,
    ) {
        let mut shifts = std::mem::take(&mut candidates.shifts);
        periodic.shifts(low, high, self.radius, &mut shifts);
        for shift in &shifts {
            self.collect::<S, true>(simd, low, high, *shift, candidates);
        }
        candidates.shifts = shifts;
    }

    /// Adds the targets whose distance from the box is less than the radius, shifted for images.
    #[inline(always)]
    fn collect<S: Simd, const SHIFTED: bool>(
        &self,
        simd: S,
        low: [f32; 3],
        high: [f32; 3],
        shift: [f32; 3],
        candidates: &mut Candidates,
    ) {
        let radius = self.radius;
        let near = |axis: usize| (low[axis] - radius - shift[axis], high[axis] + radius - shift[axis]);
        let [x, y, z] = [near(0), near(1), near(2)];
        self.cells.spans([x.0, y.0, z.0], [x.1, y.1, z.1], &mut candidates.spans);
        candidates.reserve();
        let shifts = vector::splat(simd, shift);
        let (lows, highs) = (vector::splat(simd, low), vector::splat(simd, high));
        let (zero, square) = (lanes::splat(simd, 0.0), lanes::splat(simd, radius * radius));
        let lane_index = u32x8::from_fn(simd, |lane| lane as u32);
        let [all_x, all_y, all_z] = self.planes;
        let Candidates { x, y, z, row, spans, .. } = candidates;
        let mut count = candidates.count;
        for &[begin, end] in &*spans {
            let ends = u32x8::splat(simd, end);
            for first in (begin..end).step_by(LANES) {
                let at = first as usize;
                let (xs, ys, zs) = (
                    lanes::load(simd, all_x, at),
                    lanes::load(simd, all_y, at),
                    lanes::load(simd, all_z, at),
                );
                let (xs, ys, zs) =
                    if SHIFTED { (xs + shifts[0], ys + shifts[1], zs + shifts[2]) } else { (xs, ys, zs) };
                let rows = lane_index + first;
                let dx = (lows[0] - xs).max(xs - highs[0]).max(zero);
                let dy = (lows[1] - ys).max(ys - highs[1]).max(zero);
                let dz = (lows[2] - zs).max(zs - highs[2]).max(zero);
                let near = (dx * dx + dy * dy + dz * dz).simd_lt(square) & rows.simd_lt(ends);
                // No branch: whether there are any is unpredictable.
                let to = count..count + LANES;
                xs.compress(near).store_slice(&mut x[to.clone()]);
                ys.compress(near).store_slice(&mut y[to.clone()]);
                zs.compress(near).store_slice(&mut z[to.clone()]);
                simd.compress_u32x8(rows, near).store_slice(&mut row[to]);
                count += near.to_bitmask().count_ones() as usize;
            }
        }
        x[count..count + LANES].fill(FAR);
        candidates.count = count;
    }

    /// Lists of the queries of `range`: the candidates within the radius.
    #[inline(always)]
    fn test<S: Simd>(
        &self,
        simd: S,
        queries: &[[f32; 4]],
        range: Range<usize>,
        candidates: &Candidates,
        GroupLists { lists, lengths }: &mut GroupLists,
    ) {
        let square = lanes::splat(simd, self.radius * self.radius);
        let Candidates { x, y, z, row, count, .. } = candidates;
        let blocks = count.div_ceil(LANES);
        for list in &mut lists[range.clone()] {
            if list.len() < (blocks + 1) * LANES {
                list.resize((blocks + 1) * LANES * 2, 0);
            }
        }
        let (x, y, z, row) = (x.as_chunks().0, y.as_chunks().0, z.as_chunks().0, row.as_chunks::<LANES>().0);
        let mut unused = Vec::new();
        // Two queries at a time share the loads of the candidates.
        for lane in range.clone().step_by(2) {
            let other = (lane + 1).min(range.end - 1);
            let (left, right) = lists.split_at_mut(lane + 1);
            let list_a = &mut left[lane];
            let list_b = if other > lane { &mut right[0] } else { &mut unused };
            list_b.resize(list_b.len().max((blocks + 1) * LANES), 0);
            let a = vector::splat(simd, [queries[lane][0], queries[lane][1], queries[lane][2]]);
            let b = vector::splat(simd, [queries[other][0], queries[other][1], queries[other][2]]);
            let (mut length_a, mut length_b) = (0, 0);
            for (((x, y), z), row) in x.iter().zip(y).zip(z).zip(row).take(blocks) {
                let points =
                    [lanes::load_array(simd, x), lanes::load_array(simd, y), lanes::load_array(simd, z)];
                let rows = u32x8::load_array_ref(simd, row);
                let (to_a, to_b) = (minus(points, a), minus(points, b));
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
}
