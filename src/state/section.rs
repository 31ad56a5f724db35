//! Columns as little-endian bytes.

use sorb_kernels::{
    column::Plain,
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

/// Words of a column that a state has: of as many rows as the column has of those of its store.
pub(super) fn append_column(columns: &Columns, column: Column, out: &mut Vec<u8>) {
    let rows = columns.rows.of(column.store());
    match columns.data(column).plain() {
        Some(Plain::Rows(data)) => append_words(bytemuck::cast_slice(&data[..rows.min(data.len())]), out),
        Some(Plain::Values(data)) => append_words(bytemuck::cast_slice(&data[..rows.min(data.len())]), out),
        Some(Plain::Words(data)) => append_words(&data[..rows.min(data.len())], out),
        None => {
            columns.data(column).visit_words(rows, &mut |word| out.extend_from_slice(&word.to_le_bytes()));
        }
    }
}
