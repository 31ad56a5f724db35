//! A digest of the state: equal digests mean equal bits.

use sorb_kernels::{
    column::Life,
    columns::{Column, Columns},
};
use xxhash_rust::xxh3::Xxh3;

use crate::clock::{Clock, Dormant};

/// Digest of all state columns in their order, the clock, and the sleeping parts.
pub(crate) fn digest(columns: &Columns, clock: &Clock, dormant: &Dormant) -> u64 {
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
    // Without sleeping parts the digest is that of a world that cannot sleep.
    if *dormant != Dormant::default() {
        hasher.update(&[u8::from(dormant.fluid)]);
        for numbers in [&dormant.sponges, &dormant.bodies] {
            hasher.update(&(numbers.len() as u64).to_le_bytes());
            numbers.iter().for_each(|number| hasher.update(&(*number as u64).to_le_bytes()));
        }
    }
    hasher.digest()
}
