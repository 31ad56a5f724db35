//! Stable sort of rows by an integer key.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use crate::cpu::{Cpu, PerChunk};

/// Rows of a chunk of the sort.
const SORT_CHUNK: usize = 4096;
const DIGITS: usize = 256;

/// Working memory of the sort.
#[derive(Debug, Default)]
pub(crate) struct Sort {
    from: Vec<AtomicU32>,
    to: Vec<AtomicU32>,
    offsets: Vec<[u32; DIGITS]>,
}

impl Clone for Sort {
    /// Working memory has nothing to copy.
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Sort {
    /// Rows in the order of their keys, rows of equal key in their previous order. Least significant digit first, eight bits
    /// per pass; digits in which all keys agree are skipped.
    pub(crate) fn stable_by_key(&mut self, cpu: &Cpu, keys: &[u64], order: &mut Vec<u32>) {
        let rows = keys.len();
        let first = keys.first().copied().unwrap_or(0);
        let varying = keys.iter().fold(0, |bits, key| bits | (key ^ first));
        self.from.clear();
        self.from.extend((0..rows).map(|row| AtomicU32::new(row as u32)));
        self.to.resize_with(rows, AtomicU32::default);
        for shift in (0..64).step_by(8).filter(|shift| (varying >> shift) & 0xff != 0) {
            self.pass(cpu, keys, shift);
            std::mem::swap(&mut self.from, &mut self.to);
        }
        order.clear();
        order.extend(self.from.iter().map(|row| row.load(Relaxed)));
    }

    fn pass(&mut self, cpu: &Cpu, keys: &[u64], shift: u32) {
        let rows = keys.len();
        let digit = |row: u32| (keys[row as usize] >> shift) as usize % DIGITS;
        self.offsets.clear();
        self.offsets.resize(rows.div_ceil(SORT_CHUNK), [0; DIGITS]);
        let from = &self.from;
        let chunk_rows = |chunk: usize| &from[chunk * SORT_CHUNK..rows.min((chunk + 1) * SORT_CHUNK)];
        cpu.for_chunks_of(1, &mut self.offsets[..], |chunk, counts| {
            chunk_rows(chunk).iter().for_each(|row| counts[0][digit(row.load(Relaxed))] += 1);
        });
        // Offsets in the order of (digit, chunk) make the sort stable for any number of threads.
        let mut sum = 0;
        for digit in 0..DIGITS {
            for counts in &mut self.offsets {
                let next = sum + counts[digit];
                counts[digit] = sum;
                sum = next;
            }
        }
        let to = &self.to;
        cpu.for_chunks_of(1, &mut self.offsets[..], |chunk, offsets| {
            for row in chunk_rows(chunk) {
                let row = row.load(Relaxed);
                let offset = &mut offsets[0][digit(row)];
                // Every slot is written once; the atomics only tell the compiler that threads do not collide.
                to[*offset as usize].store(row, Relaxed);
                *offset += 1;
            }
        });
    }
}

/// Fills `sorted` with the rows of `source` in the given order.
pub(crate) fn permute<T: Copy + Send + Sync>(cpu: &Cpu, order: &[u32], source: &[T], sorted: &mut [T]) {
    cpu.for_chunks(&mut sorted[..order.len()], |first, sorted| {
        let order = &order[first..first + sorted.len()];
        for (sorted, row) in sorted.iter_mut().zip(order) {
            *sorted = source[*row as usize];
        }
    });
}

/// One element for every chunk of rows, for results that are combined later in the order of the chunks.
pub(crate) fn per_chunk<T: Default + Clone>(values: &mut Vec<T>, rows: usize) -> PerChunk<'_, T> {
    values.clear();
    values.resize(rows.div_ceil(crate::cpu::CHUNK), T::default());
    PerChunk(values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::SimdLevel;

    #[test]
    fn equal_keys_keep_their_order() {
        for threads in [1, 3] {
            let cpu = Cpu::with_threads(SimdLevel::Fallback, threads).expect("the fallback is always there");
            for rows in [0_u64, 1, 2, 4095, 4097, 30_000] {
                let keys: Vec<u64> =
                    (0..rows).map(|i| ((i.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40) % 97) << 20).collect();
                let mut order = Vec::new();
                cpu.enter(|| Sort::default().stable_by_key(&cpu, &keys, &mut order));
                let mut expected: Vec<u32> = (0..rows as u32).collect();
                expected.sort_by_key(|row| keys[*row as usize]);
                assert_eq!(order, expected);
            }
        }
    }
}
