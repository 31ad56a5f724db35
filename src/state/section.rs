//! Columns as little-endian bytes.

use sorb_kernels::{
    column::{Plain, bits},
    columns::{Column, Columns},
};

/// Appends words.
pub(super) fn append_words(words: &[u32], out: &mut Vec<u8>) {
    if cfg!(target_endian = "little") {
        out.extend_from_slice(bytemuck::cast_slice(words));
    } else {
        words.iter().for_each(|word| out.extend_from_slice(&word.to_le_bytes()));
    }
}

/// Floats that are looked at together.
const AT_ONCE: usize = 64;

/// Appends floats, with the same bits for every NaN.
fn append_floats(values: &[f32], out: &mut Vec<u8>) {
    // A fold, unlike `any`, compares several at a time.
    let has_nan = |values: &[f32]| values.iter().fold(false, |found, value| found | value.is_nan());
    if values.chunks(AT_ONCE).any(has_nan) {
        values.iter().for_each(|value| out.extend_from_slice(&bits(*value).to_le_bytes()));
    } else {
        append_words(bytemuck::cast_slice(values), out);
    }
}

/// Words of a column that a state has: of as many rows as the column has of those of its store.
pub(crate) fn append_column(columns: &Columns, column: Column, out: &mut Vec<u8>) {
    let rows = columns.rows.of(column.store());
    match columns.data(column).plain() {
        Some(Plain::Rows(data)) => append_floats(data[..rows.min(data.len())].as_flattened(), out),
        Some(Plain::Values(data)) => append_floats(&data[..rows.min(data.len())], out),
        Some(Plain::Words(data)) => append_words(&data[..rows.min(data.len())], out),
        None => {
            columns.data(column).visit_words(rows, &mut |word| out.extend_from_slice(&word.to_le_bytes()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_nan_has_the_same_bytes_and_other_floats_have_their_own() {
        let with = |value: f32| {
            let (mut values, mut bytes) = ([1.5, f32::INFINITY].repeat(AT_ONCE), Vec::new());
            values[AT_ONCE + 3] = value;
            append_floats(&values, &mut bytes);
            bytes
        };
        let others = [0xFFC0_0000, 0x7FC0_0001, 0x7F80_0001].map(f32::from_bits);
        for other in others {
            assert_eq!(with(other), with(f32::NAN), "{:x}", other.to_bits());
        }
        // Negative control.
        assert_ne!(with(0.0), with(-0.0));
        assert_ne!(with(0.0), with(f32::NAN));
    }
}
