//! A digest of the state: equal digests mean equal bits.

use sorb_kernels::columns::{Column, Columns, Life};
use xxhash_rust::xxh3::Xxh3;

use crate::clock::Clock;

/// Digest of all state columns, in their order, and of the clock.
pub(crate) fn digest(columns: &Columns, clock: &Clock) -> u64 {
    let mut hasher = Xxh3::new();
    hasher.update(&clock.time.to_bits().to_le_bytes());
    hasher.update(&clock.steps.to_le_bytes());
    let mut buffer = Vec::new();
    for column in Column::ALL.iter().filter(|column| column.life() == Life::State) {
        buffer.clear();
        let rows = columns.rows.of(column.store());
        columns.data(*column).visit_words(rows, &mut |word| buffer.extend_from_slice(&word.to_le_bytes()));
        hasher.update(&buffer);
    }
    hasher.digest()
}
