//! Nodes of sleeping sponges: their rows are constant and cost almost nothing.
//!
//! A sleeping sponge is at rest, and no awake part is within its reach (`World` ensures that). Its nodes are held in place:
//! `pbd::predict` gives them no inverse mass, and `pbd::velocity` leaves position and velocity alone. No bit of them
//! changes, and the step after waking is the one that would have come next. Passes over nodes leave out groups that sleep as
//! a whole. Nobody reads their results: neighbours belong to the same sponge, and `couple::controls` leaves the nodes out.

use std::ops::Range;

/// Rows of sleeping nodes. On a device these are whole sponges, marked in their parameters.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Asleep {
    /// In order; adjacent ranges are joined.
    ranges: Vec<Range<usize>>,
}

impl Asleep {
    /// From ranges of rows in any order.
    #[must_use]
    pub fn new(mut ranges: Vec<Range<usize>>) -> Self {
        ranges.retain(|range| !range.is_empty());
        ranges.sort_unstable_by_key(|range| range.start);
        let mut joined: Vec<Range<usize>> = Vec::with_capacity(ranges.len());
        for range in ranges {
            match joined.last_mut() {
                Some(last) if last.end >= range.start => last.end = last.end.max(range.end),
                _ => joined.push(range),
            }
        }
        Self { ranges: joined }
    }

    /// Whether no node is asleep.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ranges.is_empty()
    }

    /// Whether a node is asleep.
    #[must_use]
    pub fn has(&self, row: usize) -> bool {
        self.has_all(row..row + 1)
    }

    /// Whether all nodes of a range are asleep; false for an empty one.
    #[must_use]
    pub fn has_all(&self, rows: Range<usize>) -> bool {
        if self.ranges.is_empty() || rows.is_empty() {
            return false;
        }
        let after = self.ranges.partition_point(|range| range.end <= rows.start);
        self.ranges.get(after).is_some_and(|range| range.start <= rows.start && range.end >= rows.end)
    }

    /// The ranges of the other rows, of `count` in all.
    pub(crate) fn others(&self, count: usize) -> impl Iterator<Item = Range<usize>> + '_ {
        // Ranges beyond the last row are empty.
        let starts = std::iter::once(0).chain(self.ranges.iter().map(|range| range.end));
        let ends = self.ranges.iter().map(|range| range.start).chain(std::iter::once(count));
        starts.zip(ends).map(move |(start, end)| start.min(count)..end.min(count))
    }

    /// The other rows of a range, in whole groups of a given size from its beginning on. A group may have some sleeping
    /// rows.
    pub(crate) fn awake_groups(&self, rows: Range<usize>, group: usize) -> Vec<Range<usize>> {
        let mut awake: Vec<Range<usize>> = Vec::new();
        for own in self.others(rows.end).filter(|own| own.start.max(rows.start) < own.end) {
            let (start, end) = (own.start.max(rows.start) - rows.start, own.end - rows.start);
            let start = rows.start + start / group * group;
            let end = (rows.start + end.div_ceil(group) * group).min(rows.end);
            match awake.last_mut() {
                Some(last) if last.end >= start => last.end = end,
                _ => awake.push(start..end),
            }
        }
        awake
    }

    /// Whether all nodes of a group with consecutive rows are asleep; the last may be repeated.
    pub(crate) fn has_group<const N: usize>(&self, nodes: &[u32; N]) -> bool {
        !self.ranges.is_empty() && self.has_all(nodes[0] as usize..nodes[N - 1] as usize + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_joined_and_found() {
        let asleep = Asleep::new(vec![10..20, 40..50, 5..10, 20..20, 60..61]);
        let expected = |row: usize| (5..20).contains(&row) || (40..50).contains(&row) || row == 60;
        assert!((0..100).all(|row| asleep.has(row) == expected(row)));
        for first in 0..70 {
            for end in first..70 {
                let all = end > first && (first..end).all(expected);
                assert_eq!(asleep.has_all(first..end), all, "{first}..{end}");
            }
        }
        let others: Vec<usize> = asleep.others(100).flatten().collect();
        assert!(others.iter().copied().eq((0..100).filter(|row| !expected(*row))));
        for (first, end) in [(0, 100), (3, 61), (5, 20), (12, 19), (30, 45), (60, 61), (7, 7)] {
            let found: Vec<usize> = asleep.awake_groups(first..end, 4).into_iter().flatten().collect();
            let group =
                |row: usize| first + (row - first) / 4 * 4..(first + (row - first) / 4 * 4 + 4).min(end);
            let kept = (first..end).filter(|row| !group(*row).all(expected));
            assert!(found.iter().copied().eq(kept), "{first}..{end}: {found:?}");
        }
        assert!(Asleep::default().awake_groups(3..50, 8).into_iter().eq(std::iter::once(3..50)));
        assert!(asleep.has_group(&[8, 9, 10, 10]) && !asleep.has_group(&[18, 19, 20, 20]));
        assert!(!asleep.is_empty() && Asleep::new(vec![3..3, 9..9]).is_empty());
    }
}
