//! Neighbour lists with a value beside every entry, made by a function.

use super::neighbors::{ChunkLists, GROUPS, ListValues, Neighbors};
use crate::{
    cpu::{CHUNK, Cpu, PerChunk},
    lanes::LANES,
};

/// The lists of eight queries: targets, and the values of the pairs.
#[derive(Default)]
pub(crate) struct WeightedLists {
    targets: Vec<[u32; LANES]>,
    values: Vec<[f32; LANES]>,
    lengths: [usize; LANES],
}

impl WeightedLists {
    /// Makes room for as many more entries in every list.
    pub(crate) fn reserve(&mut self, entries: usize) {
        let room = self.lengths.into_iter().max().unwrap_or(0) + entries;
        if room > self.targets.len() {
            self.targets.resize(room, [0; LANES]);
            self.values.resize(room, [0.0; LANES]);
        }
    }

    /// Appends an entry to the list of a lane, for which there is room.
    #[inline(always)]
    pub(crate) fn push(&mut self, lane: usize, target: u32, value: f32) {
        let at = self.lengths[lane];
        (self.targets[at][lane], self.values[at][lane]) = (target, value);
        self.lengths[lane] = at + 1;
    }

    /// The entries, of the same number in all lists; `padding` with the value 0 fills up shorter ones.
    fn finish(&mut self, padding: u32) -> (&[[u32; LANES]], &[[f32; LANES]]) {
        let most = self.lengths.into_iter().max().unwrap_or(0);
        for (lane, length) in self.lengths.into_iter().enumerate() {
            self.targets[length..most].iter_mut().for_each(|targets| targets[lane] = padding);
            self.values[length..most].iter_mut().for_each(|values| values[lane] = 0.0);
        }
        self.lengths = [0; LANES];
        (&self.targets[..most], &self.values[..most])
    }
}

impl Neighbors {
    /// Makes the lists of eight queries at a time with a function that receives the first of them, and the values beside their entries.
    /// `padding` fills up a group, with the value 0.
    pub(crate) fn fill_weighted(
        &mut self,
        cpu: &Cpu,
        queries: usize,
        padding: u32,
        values: &mut ListValues,
        make: impl Fn(usize, &mut WeightedLists) + Sync,
    ) {
        let chunks = queries.div_ceil(CHUNK);
        self.chunks.resize_with(chunks, ChunkLists::default);
        values.0.resize_with(chunks, Vec::new);
        let rows = (PerChunk(&mut self.chunks), PerChunk(&mut values.0));
        cpu.for_chunks_with(rows, |lists: &mut WeightedLists, first, (chunk, values)| {
            let (ChunkLists { start, entries }, values) = (&mut chunk.0[0], &mut values.0[0]);
            entries.clear();
            values.clear();
            for (group, start) in start.iter_mut().enumerate() {
                *start = entries.len() as u32;
                let row = first + group * LANES;
                if group < GROUPS && row < queries {
                    make(row, lists);
                    let (targets, own) = lists.finish(padding);
                    entries.extend_from_slice(targets);
                    values.extend_from_slice(own);
                }
            }
        });
    }
}
